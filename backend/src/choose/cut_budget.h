// SPDX-License-Identifier: GPL-3.0-or-later
// Cut budget: the finest threshold whose cut costs no more than asked (5.5.3, with counts instead
// of time).
#pragma once

#include "choose/cut.h"

namespace lodestone::choose {

struct BudgetedCut {
    Cut cut;
    double pixel_error = 0;  // the threshold it was chosen with
    bool fits = false;       // false: the cut is the coarsest one and costs more than the budget
    uint32_t cuts = 0;       // how often the model was visited as a whole
};

/// The cut of the least threshold not below view.pixel_error whose cost fits. So a larger budget
/// never gives a coarser threshold, even where memory rises with the threshold because a mesh is
/// then used at two levels instead of one. Throws Error(InvalidArgument) for
/// DetailCriterion::Distance. cost: the view's own cut, which is given up as soon as it is known
/// not to fit, a CostSweep, and the cut that is found
BudgetedCut fit_cut_to_budget(const Model& model, const View& view, const CutBudget& budget,
                              const Job& job = {});
/// The same cut, chosen from a whole table of the model for the view's kinds.
BudgetedCut fit_cut_to_budget(const ChoiceTable& table, const View& view, const CutBudget& budget,
                              const Job& job = {});

}  // namespace lodestone::choose
