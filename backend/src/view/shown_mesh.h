// SPDX-License-Identifier: GPL-3.0-or-later
// Shown: a representation as the triangles that viewers draw.
#pragma once

#include "model/mesh.h"
#include "model/representation.h"

namespace lodestone::view {

inline constexpr uint64_t kBoxTriangles = 12;

/// How many there are: of composites a guess from above, since a summary does not count their
/// parts; 0 for assemblies.
uint64_t shown_triangles(const RepresentationSummary& summary);

/// They themselves, but for assemblies. A mesh must be resident.
Mesh shown_mesh(const Representation& representation);

}  // namespace lodestone::view
