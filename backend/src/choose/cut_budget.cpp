// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/cut_budget.h"

#include "choose/cost_sweep.h"

namespace lodestone::choose {
namespace {

class Search {
public:
    Search(const Table& table, const View& view, const Budget& budget, const Job& job)
        : table_(table), view_(view), budget_(budget), job_(job) {}

    Budgeted run() {
        if (try_at(view_.pixel_error, budget_))
            return std::move(found_);
        ++found_.cuts;
        CostSweep sweep(table_, view_, job_);
        const std::optional<double> least =
            sweep.least_that_fits(table_.find(table_.model().root), budget_);
        if (!try_at(least.value_or(sweep.coarsest()), least ? budget_ : Budget{}))
            fail(Status::Internal, "a Pixel Error of ", least.value_or(0),
                 " does not fit the budget");
        found_.fits = least.has_value();
        return std::move(found_);
    }

private:
    bool try_at(double threshold, const Budget& budget) {
        View view = view_;
        view.pixel_error = threshold;
        std::optional<Cut> cut = choose_within_budget(table_, view, budget, job_);
        ++found_.cuts;
        if (!cut)
            return false;
        found_.cut = std::move(*cut);
        found_.pixel_error = threshold;
        found_.fits = true;
        return true;
    }

    const Table& table_;
    const View& view_;
    const Budget& budget_;
    const Job& job_;
    Budgeted found_;
};

}  // namespace

Budgeted choose_within(const Table& table, const View& view, const Budget& budget, const Job& job) {
    if (view.modifiers.criterion == Criterion::Distance)
        fail(Status::InvalidArgument, "a budget cannot be kept by distances");
    return Search(table, view, budget, job).run();
}

Budgeted choose_within(const Model& model, const View& view, const Budget& budget, const Job& job) {
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the model has no root object");
    return choose_within(Table::whole(model, model.root, view.kinds), view, budget, job);
}

}  // namespace lodestone::choose
