// SPDX-License-Identifier: GPL-3.0-or-later
// Candidate selection: which of an object's candidates stay, proven, and as bright as the finest.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/evaluators/picture_error.h"
#include "hierarchy/finest.h"

#include <functional>

namespace lodestone::hierarchy {

/// Sorts by cost and drops every candidate that is no better than a cheaper one (Pareto front of
/// bytes and error), and those that cost no less than `finest_bytes`; with so many occurrences.
void keep_pareto_front(std::vector<StandInCandidate>& candidates, uint64_t finest_bytes,
                       const CostModel& costs, uint64_t uses = 1);

/// Drops what is of no use beside the others, and sorts what is left, finest first.
using Keep = std::function<void(std::vector<StandInCandidate>&)>;

/// Looks at those of `some` that nobody has looked at: what shows too little is in neither list any
/// more, and what does not look like the finest, or is seen to be farther off, is. Whether anything
/// changed.
bool prove_candidates(std::vector<StandInCandidate>& some, std::vector<StandInCandidate>& all,
                      const MeasuredFinest& finest, const Job& job);

/// Those that `keep` leaves of all (finest first), as bright as the finest. What turns out to be
/// farther off than it was thought is one among all again, what shows too little is gone.
std::vector<StandInCandidate> select_candidates(std::vector<StandInCandidate>& all,
                                                const Keep& keep, const MeasuredFinest& finest,
                                                FinestPictures& pictures, const Job& job);

/// Makes opaque boxes whose sides are not of one color meshes of vertex colors, about as bright
/// from each side as the finest, if something is of use then: they cost more.
void paint_boxes(std::vector<StandInCandidate>& kept, const Keep& keep,
                 const MeasuredFinest& finest);

}  // namespace lodestone::hierarchy
