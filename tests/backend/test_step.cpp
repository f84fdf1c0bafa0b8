// SPDX-License-Identifier: GPL-3.0-or-later
// Guards a cut that goes along with the camera: it is, to the last bit, the one that would be made anew.
#include "backend/forest.h"
#include "quality/budget.h"
#include "quality/step.h"

#include <functional>
#include <limits>

using namespace lodestone;
using forest::expect_same;
using forest::Forest;

namespace {

std::shared_ptr<const quality::Table> table_of(const Model& model) {
    return std::make_shared<const quality::Table>(
        quality::Table::whole(model, model.root, kAllKinds));
}

/// A camera that is turned around the vertical: its pixels differ in the last bits.
void turn(View& view, double angle) {
    const glm::dvec3 across(std::cos(angle), std::sin(angle), 0);
    view.camera.right = glm::length(view.camera.right) * across;
    view.camera.direction = glm::cross(glm::dvec3(0, 0, 1), across);
    view.camera.up = {0, 0, glm::length(view.camera.up)};
}

/// Walks over a forest, most steps short, some far, and compares every cut. `change`: what else becomes
/// of the view between steps. Returns the share of nodes that was looked at in steps from a known cut.
double walk(
    Forest& forest, View view, int steps, const std::function<void(View&)>& change = [](View&) {}) {
    const auto table = table_of(forest.model);
    quality::Stepper stepper(table);
    quality::Cut cut;
    double looked = 0;
    double all = 0;
    size_t most = 0;
    for (int step = 0; step < steps; ++step) {
        stepper.step(view, cut);
        expect_same(cut, quality::choose(*table, view));
        most = std::max(most, cut.nodes.size());
        EXPECT_LE(cut.transforms.size(), most) << "those of what is gone are used again";
        if (testing::Test::HasFailure()) {
            ADD_FAILURE() << "at step " << step;
            return 1;
        }
        looked += step > 0 ? static_cast<double>(stepper.looked_at()) : 0;
        all += step > 0 ? static_cast<double>(cut.nodes.size()) : 0;
        const double far = forest.any() < 0.1 ? 400 : std::exp2(8 * forest.any() - 6);
        for (int axis = 0; axis < 3; ++axis)
            view.camera.position[axis] += far * (forest.any() - 0.5);
        if (forest.any() < 0.3)
            turn(view, 6 * forest.any());
        change(view);
    }
    return looked / all;
}

}  // namespace

TEST(Step, OfAnEmptyGroupIsEmpty) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    quality::Stepper stepper(table_of(model));
    quality::Cut cut;
    View view;
    stepper.step(view, cut);
    view.camera.position.x += 1;
    stepper.step(view, cut);
    EXPECT_TRUE(cut.chosen.empty());
    EXPECT_EQ(cut.largest_error_node, quality::kNoParent);
}

TEST(Step, ChangesALevelExactlyWhereItsErrorIsAPixel) {
    // LOD 2 of a ball is off by .2 m: good enough from 128 m on, to its nearest point.
    const Model model = bent::pairs(2);
    quality::Stepper stepper(table_of(model));
    quality::Cut cut;
    const double turns = 1 + 0.2 * 640;
    stepper.step(models::view_from(turns - 1), cut);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0/left 1, pair 0/right 1");
    stepper.step(models::view_from(turns + 0.001), cut);
    EXPECT_EQ(bent::drawn(model, cut), "pair 0/left 2, pair 0/right 2");
    EXPECT_EQ(stepper.looked_at(), 2u) << "the pair itself cannot change so near";
    stepper.step(models::view_from(turns + 0.0015), cut);
    EXPECT_EQ(stepper.looked_at(), 0u);
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
        most = std::max(most, walk(forest, view, 40));
    }
    EXPECT_LT(most, 0.6);  // it looks at few
}

TEST(Step, IsTheCutMadeAnewAmongLenses) {
    for (uint32_t seed = 100; seed < 120; ++seed) {
        Forest forest(seed);
        View view = forest.view();
        view.camera.orthographic = false;
        view.modifiers.lenses = {
            bent::lens(100 * forest.any(), 300 * forest.any(), 5),
            bent::lens(-100 * forest.any(), 300 * forest.any(), 0.3),
            bent::lens(200 * forest.any() - 100, 200 * forest.any(), 2),
        };
        view.modifiers.lenses[1].shape = LensShape::Box;
        view.modifiers.lenses[2].filter = seed % 2 == 0 ? LensFilter::Show : LensFilter::Refine;
        view.modifiers.lenses[2].objects = {0, 4};
        walk(forest, view, 30);
    }
}

TEST(Step, IsTheCutMadeAnewWhileLensesMove) {
    double most = 0;
    for (uint32_t seed = 200; seed < 230; ++seed) {
        Forest forest(seed);
        View view = forest.view();
        view.camera.orthographic = false;
        view.modifiers.lenses = {bent::lens(0, 100, 5), bent::lens(50, 60, 0.3),
                                 bent::lens(-50, 80, 2)};
        view.modifiers.lenses[1].shape = LensShape::Box;
        view.modifiers.lenses[2].filter = LensFilter::Refine;
        view.modifiers.lenses[2].objects = {0, 4};
        const double looked = walk(forest, view, 40, [&](View& next) {
            std::vector<DetailLens>& lenses = next.modifiers.lenses;
            const double what = forest.any();
            if (what < 0.1 && lenses.size() > 3)
                lenses.pop_back();
            else if (what < 0.2 && lenses.size() < 6)
                lenses.push_back(bent::lens(300 * forest.any() - 150, 90 * forest.any(), 3));
            else if (what < 0.3)
                lenses[1].strength = 0.2 + 4 * forest.any();
            else if (what < 0.4)
                lenses[2].objects = {static_cast<ObjectIndex>(forest.any() * 8)};
            else if (what < 0.5)
                lenses[0].radius = forest.any() < 0.2 ? 0 : 150 * forest.any();
            else if (what < 0.9)
                lenses[static_cast<size_t>(forest.any() * 2.99)].transform.offset +=
                    glm::dvec3(forest.any() - 0.5, forest.any() - 0.5, forest.any() - 0.5) * 40.0;
        });
        most = std::max(most, looked);
    }
    EXPECT_LT(most, 0.9);
}

TEST(Step, IsTheCutMadeAnewWhileAllThatBendsComesAndGoes) {
    // Half of the steps change a modifier, so that cuts are stepped with, between and after them.
    for (uint32_t seed = 400; seed < 430; ++seed) {
        Forest forest(seed);
        View view = forest.view();
        view.camera.orthographic = false;
        view.modifiers.lenses = {bent::lens(0, 100, 5), bent::lens(50, 60, 2)};
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.position = {0, 0, 100};
        forest.model.lights = {lamp};
        walk(forest, view, 60, [&](View& next) {
            Modifiers& bends = next.modifiers;
            DetailLens& lens = bends.lenses[forest.any() < 0.5 ? 0 : 1];
            switch (static_cast<int>(24 * forest.any())) {
                case 0:
                    lens.falloff = 0.5 + 4 * forest.any();
                    break;
                case 1:
                    lens.transform.linear *= 0.5 + forest.any();
                    break;
                case 2:
                    lens.filter = static_cast<LensFilter>(2.99 * forest.any());
                    lens.objects = {static_cast<ObjectIndex>(8 * forest.any()),
                                    static_cast<ObjectIndex>(12 * forest.any())};
                    break;
                case 3:
                    lens.shape = lens.shape == LensShape::Box ? LensShape::Sphere : LensShape::Box;
                    break;
                case 4:
                    bends.screen_lenses = {bent::screen_lens(640 * forest.any(), 180, 90, 3)};
                    break;
                case 5:
                    bends.screen_lenses.clear();
                    break;
                case 6:
                    bends.depth = forest.any() < 0.5 ? 1 : 1.6;
                    break;
                case 7:
                    bends.off_screen = static_cast<OffScreen>(2.99 * forest.any());
                    break;
                case 8:
                    bends.ray_classes = forest.any() < 0.5 ? 0 : kShadowRays | kReflectionRays;
                    break;
                case 9:
                    bends.when_dark = !bends.when_dark;
                    break;
                case 10:
                    bends.when_moving = !bends.when_moving;
                    bends.closing = next.camera;
                    bends.closing->position.x += 1;
                    break;
                case 11:
                    next.border = forest.any() < 0.5 ? std::optional<Border>()
                                                     : std::optional<Border>({10, 20, 300, 200});
                    break;
                default:
                    break;
            }
        });
    }
}

TEST(Step, IsTheCutOfABudgetAtTheThresholdThatItFinds) {
    for (uint32_t seed = 500; seed < 515; ++seed) {
        Forest forest(seed);
        const auto table = table_of(forest.model);
        quality::Stepper stepper(table);
        quality::Cut cut;
        View view = forest.view();
        view.camera.orthographic = false;
        for (int step = 0; step < 10; ++step) {
            const uint64_t triangles = 500 + static_cast<uint64_t>(20000 * forest.any());
            const quality::Budgeted found = quality::choose_within(*table, view, {triangles, 0});
            View at = view;
            at.pixel_error = found.pixel_error;
            stepper.step(at, cut);
            expect_same(cut, found.cut);
            view.camera.position.x += forest.any() - 0.5;
            at.camera = view.camera;
            stepper.step(at, cut);
            expect_same(cut, quality::choose(*table, at));
        }
    }
}

TEST(Step, IsTheCutMadeAnewWhileALensThatHidesMoves) {
    for (uint32_t seed = 300; seed < 310; ++seed) {
        Forest forest(seed);
        View view = forest.view();
        view.camera.orthographic = false;
        view.modifiers.lenses = {bent::lens(0, 100, 5), bent::lens(50, 150, 2)};
        view.modifiers.lenses[1].filter = LensFilter::Show;
        view.modifiers.lenses[1].objects = {1, 5};
        walk(forest, view, 30, [&](View& next) {
            next.modifiers.lenses[forest.any() < 0.5 ? 0 : 1].transform.offset.x +=
                60 * forest.any() - 30;
        });
    }
}

TEST(Step, AMovedLensIsLookedAtWhereItIsAndWas) {
    // From 300 m each of 20 pairs is drawn as one; a lens opens the one that it lies on.
    const Model model = bent::pairs(40);
    quality::Stepper stepper(table_of(model));
    quality::Cut cut;
    View view = models::view_from(300);
    view.modifiers.lenses = {bent::lens(-1, 0.5, 4)};
    stepper.step(view, cut);
    EXPECT_EQ(bent::drawn(model, cut).substr(0, 31), "pair 0/left 1, pair 0/right 2, ");
    view.modifiers.lenses[0].transform.offset.x += 1e3;
    stepper.step(view, cut);
    EXPECT_EQ(bent::drawn(model, cut).substr(0, 20), "pair 0 1, pair 1 1, ");
    EXPECT_LE(stepper.looked_at(), 4u);  // the root, the pair, and what was below it
    stepper.step(view, cut);
    EXPECT_EQ(stepper.looked_at(), 0u);
}

TEST(Step, RefusesALensThatMakesNoSenseAndKeepsTheCut) {
    const Model model = bent::pairs(8);
    const auto table = table_of(model);
    quality::Stepper stepper(table);
    quality::Cut cut;
    View view = models::view_from(300);
    view.modifiers.lenses = {bent::lens(-1, 0.5, 4)};
    stepper.step(view, cut);
    const quality::Cut before = cut;
    View bad = view;
    bad.modifiers.lenses[0].strength = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(stepper.step(bad, cut), Error);
    expect_same(cut, before);
    view.modifiers.lenses[0].strength = 2;
    stepper.step(view, cut);
    expect_same(cut, quality::choose(*table, view));
}

TEST(Step, IsTheCutMadeAnewWhateverElseChanges) {
    // Each of these makes all that was kept worthless, or is no perspective camera's distance at all.
    Forest forest(7);
    const auto table = table_of(forest.model);
    for (int i = 0; i < 160; ++i) {
        quality::Stepper stepper(table);
        quality::Cut cut;
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
                view.modifiers.criterion = Criterion::Area;
                break;
            default:
                view.modifiers.off_screen = OffScreen::Shadows;
                break;
        }
        for (const View& next : {view, first}) {
            View at = next;
            at.camera.position.y += 0.25;
            stepper.step(at, cut);
            expect_same(cut, quality::choose(*table, at));
        }
    }
}

TEST(Step, KeepsNothingWhileStepsAreInVain) {
    // Leaps change everything, again and again; slow motion afterwards is followed again.
    const Model model = bent::pairs(400);
    const auto table = table_of(model);
    quality::Stepper stepper(table);
    quality::Cut cut;
    for (int leap = 0; leap < 200; ++leap) {
        stepper.step(models::view_from(leap % 2 == 0 ? 30 : 300), cut);
        expect_same(cut, quality::choose(*table, models::view_from(leap % 2 == 0 ? 30 : 300)));
        EXPECT_EQ(stepper.looked_at(), cut.nodes.size());
    }
    size_t followed = 0;
    for (int step = 0; step < 100; ++step) {
        const View view = models::view_from(200 + 1e-4 * step);
        stepper.step(view, cut);
        expect_same(cut, quality::choose(*table, view));
        followed += stepper.looked_at() == 0 ? 1 : 0;
    }
    EXPECT_GE(followed, 60u);
    EXPECT_LE(followed, 90u) << "nothing was kept of the last leaps";
}

TEST(Step, RefusesNonsenseAndKeepsTheCut) {
    Forest forest(3);
    const auto table = table_of(forest.model);
    quality::Stepper stepper(table);
    quality::Cut cut;
    View view = forest.view();
    view.camera.orthographic = false;
    stepper.step(view, cut);
    const quality::Cut before = cut;
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
    expect_same(cut, quality::choose(*table, view));
    view.camera.position.x -= 1e300;
    stepper.step(view, cut);
    expect_same(cut, quality::choose(*table, view));
}

TEST(Step, StaysExactAfterAMillionMetresInSmallSteps) {
    const Model model = bent::pairs(16);
    const auto table = table_of(model);
    quality::Stepper stepper(table);
    quality::Cut cut;
    for (int lap = 0; lap < 4; ++lap) {
        View view = models::view_from(100 + 100 * lap);
        view.camera.position.x = 1e6 * lap;
        stepper.step(view, cut);
        view.camera.position.x = 0;
        for (int step = 0; step < 300; ++step) {
            view.camera.position.x += 0.37;
            stepper.step(view, cut);
            expect_same(cut, quality::choose(*table, view));
        }
    }
}
