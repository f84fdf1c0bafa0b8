// SPDX-License-Identifier: GPL-3.0-or-later
// Kept: which of an object's candidates stay, looked at, and as bright as the finest.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/evaluators/stand_in_evaluator.h"

#include <functional>

namespace lodestone::hierarchy {

/// Drops what is of no use beside the others, and sorts the rest, finest first.
using Keep = std::function<void(std::vector<StandInCandidate>&)>;

/// Looks at those of `some` that nobody has looked at: what shows too little is in neither list any
/// more, and what does not look like the finest is farther off. Whether anything changed.
bool prove_candidates(std::vector<StandInCandidate>& some, std::vector<StandInCandidate>& all,
                      const StandInEvaluator& judge, const Job& job);

/// Those that `keep` leaves of all (finest first), as bright as the finest. What turns out to be
/// farther off than it was thought is one among all again, what shows too little is gone.
std::vector<StandInCandidate> select_candidates(std::vector<StandInCandidate>& all,
                                                const Keep& keep, StandInEvaluator& judge,
                                                const Mesh& finest, const Job& job);

/// Gives boxes the colors of their sides, if something is of use then: they cost more.
void paint_boxes(std::vector<StandInCandidate>& kept, const Keep& keep,
                 const StandInEvaluator& judge);

}  // namespace lodestone::hierarchy
