// SPDX-License-Identifier: GPL-3.0-or-later
// Shown mesh: a representation as the triangles that viewers draw.
#pragma once

#include "model/mesh.h"
#include "model/representation.h"

namespace lodestone::view {

/// The triangles of a box.
/// Law: six sides of two triangles.
inline constexpr uint64_t kBoxTriangles = 12;

/// The number of triangles; for composites an upper estimate, since a summary does not count their
/// solids; 0 for assemblies.
uint64_t shown_triangles(const RepresentationSummary& summary);

/// The triangles themselves; not for assemblies. A mesh must be resident.
Mesh shown_mesh(const Representation& representation);

}  // namespace lodestone::view
