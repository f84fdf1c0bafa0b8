// SPDX-License-Identifier: GPL-3.0-or-later
// Surface partition: parts a large mesh into chunks of as many triangles each.
#pragma once

#include "model/surface_level.h"

namespace lodestone::geometry {

/// A tree whose chunks have about `triangles` of a mesh each, but not more than 2^`deepest` chunks;
/// `chunks` gets the chunk of each triangle. Triangles lie where their middle does, and each region
/// is parted across the longest side of the box of its middles. The mesh must be finite.
SurfaceTree part_surface(const Mesh& mesh, size_t triangles, uint32_t deepest,
                         std::vector<uint16_t>& chunks);

}  // namespace lodestone::geometry
