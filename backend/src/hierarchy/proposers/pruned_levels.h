// SPDX-License-Identifier: GPL-3.0-or-later
// Pruned levels: foliage, fences and crowds with fewer and larger parts.
#pragma once

#include "hierarchy/evaluators/picture_error.h"
#include "hierarchy/finest.h"
#include "prune/part_pruning.h"

namespace lodestone::hierarchy {

/// Levels of a mesh with a crowd in it: of the crowd some parts, enlarged until each kind shows as
/// much as in the mesh; of the rest as many triangles in proportion; none of more than about `most`
/// triangles. Judged by the pictures that were taken of the same mesh.
void add_pruned_levels(std::vector<StandInCandidate>& candidates, const Mesh& mesh,
                       const prune::Crowd& crowd, double level_ratio, size_t most,
                       const MeasuredFinest& finest, const FinestPictures& pictures,
                       const Job& job);

}  // namespace lodestone::hierarchy
