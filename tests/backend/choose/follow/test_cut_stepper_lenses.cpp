// SPDX-License-Identifier: GPL-3.0-or-later
// Guards a cut that goes along with the camera where more than Pixel Error counts: lenses that
// move, all that bends quality, and what rays meet are as of a cut made anew.
#include "scenes/camera_walks.h"

#include <limits>

using namespace lodestone;
using forest::expect_same;
using forest::Forest;
using forest::table_of;
using forest::walk;

TEST(Step, IsMetByRaysAsACutMadeAnew) {
    size_t own = 0;
    for (uint32_t seed = 700; seed < 712; ++seed) {
        Forest forest(seed);
        Light lamp;
        lamp.kind = seed % 2 == 0 ? LightKind::Sun : LightKind::Point;
        lamp.position = {0, 0, 1000};
        lamp.power = 1000;
        forest.model.lights = {lamp};
        View view = forest.view();
        view.camera.orthographic = false;
        view.modifiers.ray_classes = kShadowRays | kReflectionRays;
        own += walk(forest, view, 30).own;
    }
    EXPECT_GT(own, 100u);
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
        const forest::Walked walked = walk(forest, view, 40, [&](View& next) {
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
        most = std::max(most, walked.looked);
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
            QualityModifiers& bends = next.modifiers;
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
                    next.border = forest.any() < 0.5
                                      ? std::optional<RenderBorder>()
                                      : std::optional<RenderBorder>({10, 20, 300, 200});
                    break;
                default:
                    break;
            }
        });
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
    choose::CutStepper stepper(table_of(model));
    choose::Cut cut;
    View view = models::view_from(300);
    view.modifiers.lenses = {bent::lens(-1, 0.5, 4)};
    stepper.step(view, cut);
    EXPECT_EQ(bent::drawn(model, cut).substr(0, 31), "pair 0/left 1, pair 0/right 2, ");
    view.modifiers.lenses[0].transform.offset.x += 1e3;
    stepper.step(view, cut);
    EXPECT_EQ(bent::drawn(model, cut).substr(0, 20), "pair 0 1, pair 1 1, ");
    EXPECT_LE(stepper.decided_nodes(), 4u);  // the root, the pair, and what was below it
    stepper.step(view, cut);
    EXPECT_EQ(stepper.decided_nodes(), 0u);
}

TEST(Step, RefusesALensThatMakesNoSenseAndKeepsTheCut) {
    const Model model = bent::pairs(8);
    const auto table = table_of(model);
    choose::CutStepper stepper(table);
    choose::Cut cut;
    View view = models::view_from(300);
    view.modifiers.lenses = {bent::lens(-1, 0.5, 4)};
    stepper.step(view, cut);
    const choose::Cut before = cut;
    View bad = view;
    bad.modifiers.lenses[0].strength = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(stepper.step(bad, cut), Error);
    expect_same(cut, before);
    view.modifiers.lenses[0].strength = 2;
    stepper.step(view, cut);
    expect_same(cut, choose::choose_cut(*table, view));
}
