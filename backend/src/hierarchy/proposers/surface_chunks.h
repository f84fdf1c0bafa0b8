// SPDX-License-Identifier: GPL-3.0-or-later
// Surface chunks: which meshes are parted into chunks, and their levels.
#pragma once

#include "simplify/surface_levels.h"

namespace lodestone::hierarchy {

/// Whether a mesh has enough triangles, all finite, for a picture to need a part of it only.
bool is_large_surface(const Mesh& mesh);

/// The levels of such a mesh, with its chunks.
simplify::SimplifiedSurface simplify_in_chunks(const Mesh& mesh, std::span<const size_t> targets,
                                               const Job& job);

}  // namespace lodestone::hierarchy
