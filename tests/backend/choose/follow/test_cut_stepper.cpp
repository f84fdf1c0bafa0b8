// SPDX-License-Identifier: GPL-3.0-or-later
// Guards a cut that goes along with the camera: it is, to the last bit, the one that would be made
// anew.
#include "choose/cut_budget.h"
#include "scenes/camera_walks.h"

#include <limits>

using namespace lodestone;
using forest::expect_same;
using forest::Forest;
using forest::table_of;
using forest::walk;

TEST(Step, OfAnEmptyGroupIsEmpty) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    choose::CutStepper stepper(table_of(model));
    choose::Cut cut;
    View view;
    stepper.step(view, cut);
    view.camera.position.x += 1;
    stepper.step(view, cut);
    EXPECT_TRUE(cut.chosen.empty());
    EXPECT_EQ(cut.largest_error_node, choose::kNoParent);
}

TEST(Step, ChangesALevelExactlyWhereItsErrorIsAPixel) {
    // LOD 2 of a ball is off by .2 m: good enough from 128 m on, to its nearest point.
    const Model model = bent::pairs(2);
    choose::CutStepper stepper(table_of(model));
    choose::Cut cut;
    const double turns = 1 + 0.2 * 640;
    stepper.step(models::view_from(turns - 1), cut);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0/left 1, pair 0/right 1");
    stepper.step(models::view_from(turns + 0.001), cut);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0/left 2, pair 0/right 2");
    EXPECT_EQ(stepper.decided_nodes(), 2u) << "the pair itself cannot change so near";
    stepper.step(models::view_from(turns + 0.0015), cut);
    EXPECT_EQ(stepper.decided_nodes(), 0u);
    stepper.step(models::view_from(300), cut);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0 1");
    stepper.step(models::view_from(turns - 1), cut);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0/left 1, pair 0/right 1");
    EXPECT_NEAR(cut.largest_error_px, 0.1 / 0.2 * 128 / 127, 1e-12);
}

TEST(Step, IsTheCutMadeAnewOnRandomWalks) {
    double most = 0;
    for (uint32_t seed = 0; seed < 30; ++seed) {
        Forest forest(seed);
        View view = forest.view();
        view.camera.orthographic = false;
        most = std::max(most, walk(forest, view, 40).looked);
    }
    EXPECT_LT(most, 0.6);  // it looks at few
}

TEST(Step, IsTheCutMadeAnewWhereBallsAndBoxesHaveOtherCenters) {
    for (uint32_t seed = 600; seed < 615; ++seed) {
        Forest forest(seed);
        for (Object& object : forest.model.objects) {
            Bound& bound = object.representations[0].summary.bound;
            const glm::dvec3 aside(forest.any(), forest.any(), forest.any() < 0.5 ? 0 : 20);
            bound.center += aside;
            bound.radius += glm::length(aside);
        }
        View view = forest.view();
        view.camera.orthographic = false;
        walk(forest, view, 40);
    }
}

TEST(Step, IsTheCutMadeAnewWithinRoundingOfWhereItTurns) {
    // The eye goes to and fro by a few last bits where LOD 2 of a ball begins to be good enough.
    const Model model = bent::pairs(2);
    const auto table = table_of(model);
    choose::CutStepper stepper(table);
    choose::Cut cut;
    int changes = 0;
    std::string before;
    for (int step = 0; step < 200; ++step) {
        View view = models::view_from(129 + (step % 7 - 3) * std::exp2(-10 - step / 6));
        stepper.step(view, cut);
        expect_same(cut, choose::choose_cut(*table, view));
        changes += bent::drawn(model, cut) != before ? 1 : 0;
        before = bent::drawn(model, cut);
    }
    EXPECT_GE(changes, 50);
}

TEST(Step, LooksAtNothingThatItPassesSideways) {
    // Half a metre nearer both balls would be LOD 1; 10 m to the side they are farther by .4 m.
    const Model model = bent::pairs(2);
    const auto table = table_of(model);
    choose::CutStepper stepper(table);
    choose::Cut cut;
    View view = models::view_from(129.5);
    stepper.step(view, cut);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0/left 2, pair 0/right 2");
    for (const double x : {-10.0, 10.0, -5.0}) {
        view.camera.position.x = x;
        stepper.step(view, cut);
        EXPECT_EQ(stepper.decided_nodes(), 0u);
        expect_same(cut, choose::choose_cut(*table, view));
    }
    view.camera.position = {0, -128.9, 0};
    stepper.step(view, cut);
    EXPECT_GT(stepper.decided_nodes(), 0u);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0/left 1, pair 0/right 1");
}

TEST(Step, IsTheCutOfABudgetAtTheThresholdThatItFinds) {
    for (uint32_t seed = 500; seed < 515; ++seed) {
        Forest forest(seed);
        const auto table = table_of(forest.model);
        choose::CutStepper stepper(table);
        choose::Cut cut;
        View view = forest.view();
        view.camera.orthographic = false;
        for (int step = 0; step < 10; ++step) {
            const uint64_t triangles = 500 + static_cast<uint64_t>(20000 * forest.any());
            const choose::BudgetedCut found =
                choose::fit_cut_to_budget(*table, view, {triangles, 0});
            View at = view;
            at.pixel_error = found.pixel_error;
            stepper.step(at, cut);
            expect_same(cut, found.cut);
            view.camera.position.x += forest.any() - 0.5;
            at.camera = view.camera;
            stepper.step(at, cut);
            expect_same(cut, choose::choose_cut(*table, at));
        }
    }
}

TEST(Step, IsTheCutMadeAnewWhateverElseChanges) {
    // Each of these makes all that was kept worthless, or is no perspective camera's distance at
    // all.
    Forest forest(7);
    const auto table = table_of(forest.model);
    for (int i = 0; i < 160; ++i) {
        choose::CutStepper stepper(table);
        choose::Cut cut;
        View view = forest.view();
        view.modifiers = {};
        const View first = view;
        stepper.step(view, cut);
        switch (i % 10) {
            case 0:
                view.pixel_error *= 2;
                break;
            case 1:
                view.camera.right *= 0.5;
                break;
            case 2:
                view.width *= 2;
                break;
            case 3:
                view.camera.orthographic = !view.camera.orthographic;
                break;
            case 4:
                view.camera.near_clip = 50;
                break;
            case 5:
                view.modifiers.lenses = {bent::lens(0, 300, 4)};
                break;
            case 6:
                view.modifiers.screen_lenses = {bent::screen_lens(320, 180, 200, 3)};
                break;
            case 7:
                view.modifiers.depth = 1.5;
                break;
            case 8:
                view.modifiers.criterion = DetailCriterion::Area;
                break;
            default:
                view.modifiers.off_screen = OffScreen::Shadows;
                break;
        }
        for (const View& next : {view, first}) {
            View at = next;
            at.camera.position.y += 0.25;
            stepper.step(at, cut);
            expect_same(cut, choose::choose_cut(*table, at));
        }
    }
}

TEST(Step, KeepsNothingWhileStepsAreInVain) {
    // Leaps change everything, again and again; slow motion afterwards is followed again.
    const Model model = bent::pairs(400);
    const auto table = table_of(model);
    choose::CutStepper stepper(table);
    choose::Cut cut;
    for (int leap = 0; leap < 200; ++leap) {
        stepper.step(models::view_from(leap % 2 == 0 ? 30 : 300), cut);
        expect_same(cut, choose::choose_cut(*table, models::view_from(leap % 2 == 0 ? 30 : 300)));
        EXPECT_EQ(stepper.decided_nodes(), cut.nodes.size());
    }
    size_t followed = 0;
    for (int step = 0; step < 100; ++step) {
        const View view = models::view_from(200 + 1e-4 * step);
        stepper.step(view, cut);
        expect_same(cut, choose::choose_cut(*table, view));
        followed += stepper.decided_nodes() == 0 ? 1 : 0;
    }
    EXPECT_GE(followed, 60u);
    EXPECT_LE(followed, 90u) << "nothing was kept of the last leaps";
}

TEST(Step, RefusesNonsenseAndKeepsTheCut) {
    Forest forest(3);
    const auto table = table_of(forest.model);
    choose::CutStepper stepper(table);
    choose::Cut cut;
    View view = forest.view();
    view.camera.orthographic = false;
    stepper.step(view, cut);
    const choose::Cut before = cut;
    for (int wrong = 0; wrong < 4; ++wrong) {
        View bad = view;
        if (wrong == 0)
            bad.camera.position.x = std::numeric_limits<double>::quiet_NaN();
        else if (wrong == 1)
            bad.pixel_error = -1;
        else if (wrong == 2)
            bad.width = 0;
        else  // as large as the one that is known, but flat
            bad.camera.direction = bad.camera.right;
        EXPECT_THROW(stepper.step(bad, cut), Error);
        expect_same(cut, before);
    }
    volatile int32_t cancelled = 1;
    EXPECT_THROW(stepper.step(view, cut, Job(&cancelled, nullptr, nullptr)), Error);
    expect_same(cut, before);
    view.camera.position.x += 1e8;
    stepper.step(view, cut);
    expect_same(cut, choose::choose_cut(*table, view));
    view.camera.position.x -= 1e300;
    stepper.step(view, cut);
    expect_same(cut, choose::choose_cut(*table, view));
}

TEST(Step, StaysExactAfterAMillionMetresInSmallSteps) {
    const Model model = bent::pairs(16);
    const auto table = table_of(model);
    choose::CutStepper stepper(table);
    choose::Cut cut;
    for (int lap = 0; lap < 4; ++lap) {
        View view = models::view_from(100 + 100 * lap);
        view.camera.position.x = 1e6 * lap;
        stepper.step(view, cut);
        view.camera.position.x = 0;
        for (int step = 0; step < 300; ++step) {
            view.camera.position.x += 0.37;
            stepper.step(view, cut);
            expect_same(cut, choose::choose_cut(*table, view));
        }
    }
}
