// SPDX-License-Identifier: GPL-3.0-or-later
// Beside: the environment of a group as a mesh of few triangles, and solids for everything else in
// it.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

namespace lodestone::hierarchy {

/// One mesh each: the environment simplified to about as many triangles as what stands on it has,
/// which is a box, an ellipsoid, or a composite of four or eight. Judged by distance, to be proven
/// by patches. `environment`: by triangle of the finest. Nothing where it has no environment,
/// or nothing else.
void add_environment_stand_ins(std::vector<StandInCandidate>& candidates,
                               const std::vector<uint8_t>& environment,
                               const MeasuredFinest& finest, const Job& job);

}  // namespace lodestone::hierarchy
