// SPDX-License-Identifier: GPL-3.0-or-later
// Surface levels: one simplification of a large surface, of whose levels chunks fit together.
#pragma once

#include "model/surface_level.h"
#include "simplify/simplify.h"

namespace lodestone::simplify {

struct SimplifiedSurface {
    std::shared_ptr<const SurfaceLevel> original;
    std::vector<Mesh> levels;                                 // fine to coarse, as simplify_chain's
    std::vector<std::shared_ptr<const SurfaceLevel>> chunks;  // of each level
};

/// Simplifies as simplify_chain() does, but lets no vertex on a border of chunks move. `tree` and
/// `chunks`: the result of geometry::part_surface for the mesh. Coarser levels have larger chunks,
/// with about as many triangles each, until the last ones are whole. As long as there are several,
/// the topology stays; where a target cannot be met so, that level and all after it are whole. Any
/// number of threads gives the same bits.
/// source: dissertation 3.2.2; Hoppe 1998 (blocks of one simplification, borders of which agree).
SimplifiedSurface simplify_surface(const Mesh& mesh, std::shared_ptr<const SurfaceTree> tree,
                                   std::span<const uint16_t> chunks,
                                   std::span<const size_t> targets,
                                   const SimplifyOptions& options = {}, const Job& job = {});

}  // namespace lodestone::simplify
