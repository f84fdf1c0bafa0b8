// SPDX-License-Identifier: GPL-3.0-or-later
// Budget: the finest threshold whose cut costs no more than asked (5.5.3 with counts instead of
// time).
#pragma once

#include "choose/cut.h"

namespace lodestone::choose {

struct BudgetedCut {
    Cut cut;
    double pixel_error = 0;  // the threshold it was chosen with
    bool fits = false;       // false: the coarsest cut, which costs more than the budget
    uint32_t cuts = 0;       // passes over the model
};

/// The cut of the least threshold not below view.pixel_error whose cost fits. So a larger budget
/// never gives a coarser threshold, also where memory rises with it, as a mesh is then used at two
/// levels instead of one. Throws Error(InvalidArgument) for DetailCriterion::Distance. cost: the view's
/// own cut, given up when it is known not to fit, a CostSweep, and the cut found
BudgetedCut fit_cut_to_budget(const Model& model, const View& view, const CutBudget& budget,
                              const Job& job = {});
/// The same with a whole table of the model for the view's kinds.
BudgetedCut fit_cut_to_budget(const ChoiceTable& table, const View& view, const CutBudget& budget,
                              const Job& job = {});

}  // namespace lodestone::choose
