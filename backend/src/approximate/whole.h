// SPDX-License-Identifier: GPL-3.0-or-later
// Whole: solids that together show as much as what they stand for, there and as it is spread.
#pragma once

#include "approximate/visible_solids.h"
#include "model/attributes.h"

namespace lodestone::approximate {

/// Moves and stretches solids, altogether as little as possible (least_change.h), until what can be
/// seen of them has the area that is wanted and, with `shape`, its centroid and variances; where no
/// size gives both area and variances (plates around a closed body) their ratios, as for a single
/// solid. In at most `rounds` with a 64th of the rays of `visible`, and three with an eighth, of which
/// the best one is kept; then, with `shape`, all solids are scaled and moved alike to the area and
/// centroid that all rays see. Nothing reaches below `floor`.
void match_whole(Composite& composite, const Attributes& wanted, double floor,
                 const VisibleSolids& visible, bool shape, int rounds, const Job& job);

}  // namespace lodestone::approximate
