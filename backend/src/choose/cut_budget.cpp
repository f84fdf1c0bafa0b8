// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/cut_budget.h"

#include "choose/cost_sweep.h"

namespace lodestone::choose {
namespace {

class BudgetSearch {
public:
    BudgetSearch(const ChoiceTable& table, const View& view, const CutBudget& budget,
                 const Job& job)
        : table_(table), view_(view), budget_(budget), job_(job) {}

    BudgetedCut run() {
        if (try_at(view_.pixel_error, budget_))
            return std::move(found_);
        ++found_.cuts;
        CostSweep sweep(table_, view_, job_);
        const std::optional<double> least =
            sweep.least_that_fits(table_.find(table_.model().root), budget_);
        if (!try_at(least.value_or(sweep.coarsest()), least ? budget_ : CutBudget{}))
            fail(Status::Internal, "a Pixel Error of ", least.value_or(0),
                 " does not fit the budget");
        found_.fits = least.has_value();
        return std::move(found_);
    }

private:
    bool try_at(double threshold, const CutBudget& budget) {
        View view = view_;
        view.pixel_error = threshold;
        std::optional<Cut> cut = choose_cut_if_within(table_, view, budget, job_);
        ++found_.cuts;
        if (!cut)
            return false;
        found_.cut = std::move(*cut);
        found_.pixel_error = threshold;
        found_.fits = true;
        return true;
    }

    const ChoiceTable& table_;
    const View& view_;
    const CutBudget& budget_;
    const Job& job_;
    BudgetedCut found_;
};

}  // namespace

BudgetedCut fit_cut_to_budget(const ChoiceTable& table, const View& view, const CutBudget& budget,
                              const Job& job) {
    if (view.modifiers.criterion == DetailCriterion::Distance)
        fail(Status::InvalidArgument, "a budget cannot be kept by distances");
    return BudgetSearch(table, view, budget, job).run();
}

BudgetedCut fit_cut_to_budget(const Model& model, const View& view, const CutBudget& budget,
                              const Job& job) {
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the model has no root object");
    return fit_cut_to_budget(ChoiceTable::whole(model, model.root, view.kinds), view, budget, job);
}

}  // namespace lodestone::choose
