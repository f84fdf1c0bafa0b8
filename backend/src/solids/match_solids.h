// SPDX-License-Identifier: GPL-3.0-or-later
// Match solids: solids that together show as much as their original, in the same place and spread.
#pragma once

#include "model/attributes.h"
#include "solids/visible_solids.h"

namespace lodestone::solids {

/// Moves and stretches solids, altogether as little as possible (matching_step.h), until their
/// visible surface has the area that is wanted and, with `shape`, its centroid and variances; where
/// no size gives both area and variances (plates around a closed body), their ratios, as for a
/// single solid. There are at most `rounds` with an eighth of the rays of `visible`, and three with
/// all (eight where the solids are far off); the best round is kept. Nothing reaches below `floor`.
void match_composite(Composite& composite, const Attributes& wanted, double floor,
                     const VisibleSolids& visible, bool shape, int rounds, const Job& job);

/// The change, in parts of the radius of gyration, below which more rays are not needed; as
/// kSettled, for several solids.
/// Fitted: by tests/bench/sheets/bench_replace.py and pictures of samples/street.
inline constexpr double kSettledComposite = 0.0005;

/// Sets area and centroid, as all rays see them, right by scaling and moving all solids alike,
/// which hides no more of any. A standing solid keeps its foot and follows along Z by half, so all
/// go farther.
void settle_composite(Composite& composite, const Attributes& wanted, double floor,
                      const VisibleSolids& visible, const Job& job);

}  // namespace lodestone::solids
