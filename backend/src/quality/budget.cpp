// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::quality {
namespace {

constexpr int kFinestPower = -10;  // 1/1024 px: below it the eye, and POV-Ray, see nothing
constexpr int kCoarsestPower = 40;
constexpr double kClose = 1 + 1e-9;  // thresholds nearer than this are one
constexpr int kMostSteps = 64;

class Search {
public:
    Search(const Table& table, const View& view, const Budget& budget, const Job& job)
        : table_(table), view_(view), budget_(budget), job_(job) {}

    Budgeted run() {
        double fails = view_.pixel_error;
        if (try_at(fails))
            return std::move(best_);
        const int first =
            std::max(kFinestPower,
                     fails > 0 ? static_cast<int>(std::floor(std::log2(fails))) + 1 : kFinestPower);
        bool found = false;
        for (int power = first; power <= kCoarsestPower && !found; ++power) {
            found = try_at(std::ldexp(1, power));
            if (!found)
                fails = std::ldexp(1, power);
        }
        if (!found && !try_at(std::numeric_limits<double>::infinity())) {
            best_.cut = cut_at(std::numeric_limits<double>::infinity(), {}).value();
            best_.pixel_error = least_;
            return std::move(best_);
        }
        bisect(fails);
        snap(fails);
        return std::move(best_);
    }

private:
    std::optional<Cut> cut_at(double threshold, const Budget& budget) {
        job_.check();
        view_.pixel_error = threshold;
        return choose_within_budget(table_, view_, budget, least_, job_);
    }

    bool try_at(double threshold) {
        std::optional<Cut> cut = cut_at(threshold, budget_);
        ++best_.cuts;
        if (!cut)
            return false;
        best_.cut = std::move(*cut);
        best_.pixel_error = threshold;
        best_.fits = true;
        return true;
    }

    /// Leaves in best_ the finest that fits, in `fails` the threshold just below that does not.
    void bisect(double& fails) {
        for (int step = 0; step < kMostSteps; ++step) {
            const double least = fails > 0 ? fails : std::ldexp(1, kFinestPower - kMostSteps);
            const double most = std::isinf(best_.pixel_error) ? std::ldexp(1, 2 * kCoarsestPower)
                                                              : best_.pixel_error;
            if (most <= least * kClose)
                return;
            const double middle = std::sqrt(least * most);
            if (!try_at(middle))
                fails = middle;
        }
    }

    /// The least threshold that gives the cut found, to the last bit.
    void snap(double fails) {
        double exact = least_;
        for (int step = 0; step < 4 && exact > fails && exact < best_.pixel_error; ++step) {
            if (try_at(exact))
                return;
            exact = std::nextafter(exact, std::numeric_limits<double>::infinity());
        }
    }

    const Table& table_;
    View view_;
    const Budget& budget_;
    const Job& job_;
    Budgeted best_;
    double least_ = 0;  // threshold of the cut found last
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

}  // namespace lodestone::quality
