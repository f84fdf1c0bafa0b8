// SPDX-License-Identifier: GPL-3.0-or-later
// Guards budgets: the finest cut that costs no more, and what is said where there is none.
#include "choose/criterion.h"
#include "choose/cut_budget.h"
#include "scenes/random_models.h"

#include <gtest/gtest.h>

using namespace lodestone;
using bent::drawn;
using models::view_from;

namespace {

View from(double distance) {
    return view_from(distance, 0);
}

}  // namespace

TEST(CutBudget, WithoutLimitsIsTheViewsOwnThreshold) {
    const Model model = bent::pairs();
    const choose::BudgetedCut found = choose::fit_cut_to_budget(model, from(300), {});
    EXPECT_TRUE(found.fits);
    EXPECT_EQ(found.pixel_error, 0);
    EXPECT_EQ(found.cut.triangles, 4u * 1280u);
    EXPECT_EQ(found.cuts, 1u);
}

TEST(CutBudget, FindsTheLeastThresholdThatFits) {
    // Four balls of 20 triangles (LOD 2, .2 m) or two cubes of 12 (.4 m), seen from 300 m.
    const Model model = bent::pairs();
    const choose::BudgetedCut balls = choose::fit_cut_to_budget(model, from(301), {80, 0});
    EXPECT_EQ(balls.cut.triangles, 80u);
    EXPECT_NEAR(balls.pixel_error, 0.2 * 640 / 300, 1e-12);
    const choose::BudgetedCut cubes = choose::fit_cut_to_budget(model, from(301), {79, 0});
    EXPECT_EQ(cubes.cut.triangles, 12u + 40u);  // the far pair first: its bound is 300.02 m away
    const choose::BudgetedCut both = choose::fit_cut_to_budget(model, from(301), {51, 0});
    EXPECT_EQ(both.cut.triangles, 24u);
    EXPECT_NEAR(both.pixel_error, 0.4 * 640 / 300, 1e-12);
    View view = from(301);
    view.pixel_error = both.pixel_error;  // to the last bit
    EXPECT_EQ(choose::choose_cut(model, view).triangles, 24u);
    view.pixel_error = std::nextafter(both.pixel_error, 0);
    EXPECT_EQ(choose::choose_cut(model, view).triangles, 52u);
}

TEST(CutBudget, CountsBytesAsPovRayKeepsThem) {
    // 20 triangles once and 1,500 bytes for each of four balls.
    const Model model = bent::pairs();
    const uint64_t bytes = 20 * model.costs.triangle_bytes + 4 * model.costs.occurrence_bytes;
    const choose::BudgetedCut found = choose::fit_cut_to_budget(model, from(301), {0, bytes});
    EXPECT_EQ(found.cut.bytes, bytes);
    EXPECT_NEAR(found.pixel_error, 0.2 * 640 / 300, 1e-12);
    EXPECT_LT(choose::fit_cut_to_budget(model, from(301), {0, bytes - 1}).cut.bytes, bytes);
}

TEST(CutBudget, IsNeverFinerThanTheView) {
    const Model model = bent::pairs();
    const choose::BudgetedCut found =
        choose::fit_cut_to_budget(model, view_from(301, 3), {1000000, 0});
    EXPECT_EQ(found.pixel_error, 3);
    EXPECT_EQ(found.cut.triangles, 24u);
}

TEST(CutBudget, WhereNothingFitsTheCoarsestIsMadeAndSaysSo) {
    const Model model = bent::pairs();
    const choose::BudgetedCut found = choose::fit_cut_to_budget(model, from(301), {23, 0});
    EXPECT_FALSE(found.fits);
    EXPECT_EQ(found.cut.triangles, 24u);
    EXPECT_NEAR(found.pixel_error, 0.4 * 640 / 300, 1e-12);
    EXPECT_FALSE(choose::fit_cut_to_budget(model, from(301), {0, 1}).fits);
}

TEST(CutBudget, IsNeverExceededAndMoreNeverMeansCoarser) {
    Model model = bent::pairs(40);
    for (const bool bytes : {false, true}) {
        double last = std::numeric_limits<double>::infinity();
        for (uint64_t most = 200; most < 80000; most = most * 6 / 5) {
            const uint64_t limit = bytes ? 100 * most : most;
            const choose::CutBudget budget{bytes ? 0 : limit, bytes ? limit : 0};
            const choose::BudgetedCut found = choose::fit_cut_to_budget(model, from(40), budget);
            if (found.fits) {
                EXPECT_LE(bytes ? found.cut.bytes : found.cut.triangles, limit);
            }
            EXPECT_LE(found.pixel_error, last);
            last = found.pixel_error;
        }
        EXPECT_EQ(last, 0);
    }
}

TEST(CutBudget, NothingFinerFitsWhateverBendsQuality) {
    int found = 0;
    for (uint32_t seed = 0; seed < 64; ++seed) {
        forest::Forest forest(seed);
        View view = forest.view();
        QualityModifiers& modifiers = view.modifiers;
        view.pixel_error = seed % 3 == 0 ? 0.3 * forest.any() : 0;
        modifiers.lenses = {bent::lens(100 * forest.any(), 300 * forest.any(), 5),
                            bent::lens(-100 * forest.any(), 300 * forest.any(), 0.3)};
        modifiers.lenses[0].filter = LensFilter(seed % 3);
        modifiers.lenses[0].objects = {1, 5};
        // Two ways at once, as seeds come to all pairs; one way more than there are is none.
        const int ways = bent::ways_to_bend();
        bent::bend(modifiers, static_cast<int>(seed) % (ways + 1));
        bent::bend(modifiers, static_cast<int>(seed) / (ways + 1) % (ways + 1));
        const auto table = choose::ChoiceTable::whole(forest.model, forest.model.root, view.kinds);
        const choose::Cut finest = choose::choose_cut(table, view);
        for (const double share : {0.02, 0.3, 0.9, 1.0}) {
            const auto part = [&](uint64_t all) {
                return 1 + static_cast<uint64_t>(share * static_cast<double>(all));
            };
            const choose::CutBudget budget{seed % 2 == 0 ? part(finest.triangles) : 0,
                                           seed % 2 == 0 ? 0 : part(finest.bytes)};
            const choose::BudgetedCut made = choose::fit_cut_to_budget(table, view, budget);
            EXPECT_LE(made.cuts, 3u);
            EXPECT_EQ(made.fits, budget.fits(made.cut));
            View other = view;
            other.pixel_error = made.pixel_error;
            forest::expect_same(choose::choose_cut(table, other), made.cut);
            if (made.pixel_error == view.pixel_error || !made.fits)
                continue;
            ++found;
            for (int i = 0; i < 60; ++i) {
                other.pixel_error = std::nextafter(made.pixel_error, 0) * std::exp2(-0.2 * i);
                EXPECT_FALSE(other.pixel_error >= view.pixel_error &&
                             budget.fits(choose::choose_cut(table, other)))
                    << other.pixel_error << " fits, too, not only " << made.pixel_error;
            }
            if (testing::Test::HasFailure()) {
                ADD_FAILURE() << "with seed " << seed << ", " << share;
                return;
            }
        }
    }
    EXPECT_GT(found, 60);
}

TEST(CutBudget, ThresholdsAreExactToTheLastBit) {
    for (const DetailCriterion criterion :
         {DetailCriterion::Resolution, DetailCriterion::Feature, DetailCriterion::Area}) {
        forest::Forest any(5);
        for (int i = 0; i < 200; ++i) {
            View view = any.view();
            view.modifiers.criterion = criterion;
            const double error = std::exp2(200 * any.any() - 100);
            choose::OccurrenceSight sight{100 * any.any(), any.any(), 2 * any.any(), 3 * any.any(),
                                          any.any()};
            const double least = choose::least_threshold(view, sight, error, 1, 3);
            view.pixel_error = least;
            EXPECT_TRUE(choose::good_enough(view, sight, error, 1, 3));
            view.pixel_error = std::nextafter(least, 0);
            EXPECT_FALSE(choose::good_enough(view, sight, error, 1, 3));
        }
    }
    View view = from(300);
    EXPECT_EQ(choose::least_threshold(view, {300, 0.5, 1, 1, 0}, 0, 0, 1), 0);
    EXPECT_EQ(choose::least_threshold(view, {300, 0.5, 1, kInfinity, 0}, 1, 1, 2), kInfinity);
    EXPECT_EQ(choose::least_threshold(view, {0, 0, 1, 1, 0}, 1, 1, 2), kInfinity);
}

TEST(CutBudget, OneThingThatIsTooDearDoesNotFit) {
    Model model;
    model.root = models::add_leaf(model, "ball", shapes::sphere(1, 3));
    summarize_assemblies(model, bottom_up(model));
    EXPECT_FALSE(choose::fit_cut_to_budget(model, from(300), {1279, 0}).fits);
    EXPECT_TRUE(choose::fit_cut_to_budget(model, from(300), {1280, 0}).fits);
}

TEST(CutBudget, LensesKeepTheirPartOfIt) {
    const Model model = bent::pairs();
    View view = from(301);
    view.modifiers.lenses = {bent::lens(-1, 0.5, 4)};
    EXPECT_EQ(drawn(model, choose::fit_cut_to_budget(model, view, {120, 0}).cut),
              "pair 0/left 1, pair 0/right 2, pair 1 1");
}

TEST(CutBudget, ByDistancesIsRefused) {
    View view = from(300);
    view.modifiers.criterion = DetailCriterion::Distance;
    EXPECT_THROW(choose::fit_cut_to_budget(bent::pairs(), view, {1, 0}), Error);
}

TEST(CutBudget, CancelledJobStops) {
    const int32_t cancel = 1;
    EXPECT_THROW(
        choose::fit_cut_to_budget(bent::pairs(), from(300), {1, 0}, Job(&cancel, nullptr, nullptr)),
        Error);
}
