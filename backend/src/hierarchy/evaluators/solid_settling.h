// SPDX-License-Identifier: GPL-3.0-or-later
// Settling: area and centroid of solids, set right by many more rays.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

#include <span>

namespace lodestone::hierarchy {

/// Settles those candidates whose solids were matched by few rays; of a group the composites alone.
/// Solids that stand at `floor` or would reach below it keep their foot. Single solids stay as they
/// are where the finest was measured exactly, and all do whose error is the radius or more.
void settle_solids(std::span<StandInCandidate> candidates, const MeasuredFinest& finest,
                   double floor, const Job& job);

}  // namespace lodestone::hierarchy
