// SPDX-License-Identifier: GPL-3.0-or-later
// Whole: solids that together show as much as what they stand for, there and as it is spread.
#pragma once

#include "model/attributes.h"
#include "solids/visible_solids.h"

namespace lodestone::solids {

/// Moves and stretches solids, altogether as little as possible (matching_step.h), until what can
/// be seen of them has the area that is wanted and, with `shape`, its centroid and variances; where
/// no size gives both area and variances (plates around a closed body) their ratios, as for a
/// single solid. In at most `rounds` with an eighth of the rays of `visible`, and three with all
/// (eight where it is far off), of which the best one is kept. Nothing reaches below `floor`.
void match_composite(Composite& composite, const Attributes& wanted, double floor,
                     const VisibleSolids& visible, bool shape, int rounds, const Job& job);

/// As kSettled, for several solids.
inline constexpr double kSettledComposite = 0.0005;

/// Area and centroid as all rays see them, set right by scaling and moving the solids alike, which
/// hides nothing more of any. What stands keeps its foot and follows along Z by half, so all go
/// farther.
void settle_composite(Composite& composite, const Attributes& wanted, double floor,
                      const VisibleSolids& visible, const Job& job);

}  // namespace lodestone::solids
