// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what else bends quality (5.5.5): screen lenses, depth, motion, darkness, and how all of it
// goes together and is told.
#include "choose/criterion.h"
#include "choose/detail_factors.h"
#include "scenes/lens_views.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

using namespace lodestone;
using bent::ball;
using bent::drawn;
using bent::kBall;
using bent::kPair;
using models::view_from;

namespace {

constexpr const char* kUntouched = "pair 0 1, pair 1 1";

/// 640 pixels of 1/64 m, seen along y.
View flat_view() {
    View view = view_from(300);
    view.camera.orthographic = true;
    view.camera.right = {10, 0, 0};
    view.camera.up = {0, 0, 5.625};
    return view;
}

choose::ChoiceReason reason_of(const Model& model, const View& view, size_t position = 0) {
    const choose::Cut cut = choose::choose_cut(model, view);
    return choose::explain_choice(model, view, cut, cut.chosen.at(position));
}

std::string refusal(const View& view) {
    try {
        choose::choose_cut(bent::pairs(), view);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(ImageFrame, ABallsRectangleTouchesItsTangents) {
    View view = view_from(0);
    const choose::ImageFrame frame(view.camera, 640, 360);
    // Seen from 5 m a ball of 3 m has tangents of 3/4; a pixel is 1/640 of the distance.
    const choose::ImageRect rect = frame.rect(ball({0, 5, 0}, 3));
    EXPECT_NEAR(rect.low.x, 320 - 480, 1e-9);
    EXPECT_NEAR(rect.high.x, 320 + 480, 1e-9);
    EXPECT_NEAR(rect.low.y, 180 - 480, 1e-9);
    EXPECT_NEAR(rect.high.y, 180 + 480, 1e-9);
    EXPECT_TRUE(frame.rect(ball({0, -5, 0}, 3)).behind);
    EXPECT_EQ(frame.rect(ball({0, 1, 0}, 3)).nearest({1e6, 1e6}), 0);  // around the eye
    view.camera.right = {-1, 0, 0};                                    // mirrored
    const choose::ImageFrame mirrored(view.camera, 640, 360);
    EXPECT_NEAR(mirrored.rect(ball({1, 10, 0}, 0.001)).low.x, 320 - 64, 0.1);
}

TEST(ImageFrame, WithoutAreaIsRefused) {
    View view = view_from(300);
    view.camera.up = view.camera.right;
    EXPECT_NE(refusal(view).find("has no area"), std::string::npos);
    view = view_from(300);
    view.camera.direction = {0, 0, 0};
    EXPECT_NE(refusal(view).find("has no area"), std::string::npos);
}

TEST(ScreenLens, RefinesWhatIsSeenThroughIt) {
    View view = view_from(300);
    view.modifiers.screen_lenses = {bent::screen_lens(318, 180, 1, 4)};  // on the first ball
    EXPECT_EQ(drawn(bent::pairs(), view), "pair 0/left 1, pair 0/right 2, pair 1 1");
    view.modifiers.screen_lenses = {bent::screen_lens(300, 180, 10, 64)};
    EXPECT_EQ(drawn(bent::pairs(), view), kUntouched);
    view.camera.direction = {0, -1, 0};  // all is behind the eye
    view.modifiers.screen_lenses = {bent::screen_lens(320, 180, 1000, 64)};
    EXPECT_EQ(drawn(bent::pairs(), view), kUntouched);
}

TEST(ScreenLens, CountsWithItsLargestValueInTheBound) {
    // In an orthographic view the first ball covers pixels 256 to 384.
    View view = flat_view();
    view.pixel_error = 1000;
    view.kinds = mask_of(Kind::Mesh);
    Model model;
    model.root = models::add_leaf(model, "ball", shapes::sphere(1, 3));
    summarize_assemblies(model, bottom_up(model));
    view.modifiers.screen_lenses = {bent::screen_lens(484, 180, 200, 4)};  // 100 from its rim
    EXPECT_NEAR(reason_of(model, view).factors.screen_lenses, 1 + 3 / std::numbers::sqrt2, 1e-3);
    view.modifiers.screen_lenses[0].strength = 0.25;  // 228 and more from the far rim: outside
    EXPECT_EQ(reason_of(model, view).factors.screen_lenses, 1);
}

TEST(Depth, ExaggerationIsAPowerOfTheDistance) {
    Model model = bent::pairs();
    View view = view_from(301);
    view.modifiers.depth = 2;
    view.modifiers.depth_focus = 150;
    EXPECT_NEAR(reason_of(model, view).factors.depth, 2, 1e-12);  // the bound's face is at 300 m
    EXPECT_NEAR(reason_of(model, view).chosen.total, 0.5, 1e-12);
    view.modifiers.depth = 3;
    EXPECT_NEAR(reason_of(model, view).factors.depth, 4, 1e-12);
    view.modifiers.depth_focus = 600;
    EXPECT_NEAR(reason_of(model, view).factors.depth, 0.25, 1e-12);
    for (const double bad : {-1.0, 9.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        view.modifiers.depth = bad;
        EXPECT_NE(refusal(view).find("depth exaggeration is"), std::string::npos) << bad;
    }
    view.modifiers.depth = 2;
    view.modifiers.depth_focus = 0;
    EXPECT_NE(refusal(view).find("about a distance of 0 m"), std::string::npos);
}

TEST(Motion, OfAPlacementCoarsensItByItsWayOnTheScreen) {
    Model model = bent::pairs();
    View view = flat_view();
    view.pixel_error = 100;
    view.modifiers.when_moving = true;
    EXPECT_EQ(reason_of(model, view).factors.motion, 1);  // all rests
    bent::move(model, model.root, 0, models::moved(0.125, 0, 0));
    EXPECT_NEAR(reason_of(model, view, 0).factors.motion, std::sqrt(65.0), 1e-9);  // 8 pixels
    EXPECT_EQ(reason_of(model, view, 1).factors.motion, 1);
    bent::move(model, model.root, 0, models::moved(0, 1, 0));  // along the view
    EXPECT_EQ(reason_of(model, view, 0).factors.motion, 1);
    bent::move(model, model.root, 0, models::moved(10, 0, 0));
    EXPECT_EQ(reason_of(model, view, 0).factors.motion, 64);
    view.modifiers.when_moving = false;
    EXPECT_EQ(reason_of(model, view, 0).factors.motion, 1);
}

TEST(Motion, InsideAGroupOpensNothingAndCoarsensItsPartOnly) {
    Model model = bent::pairs();
    View view = flat_view();
    view.modifiers.when_moving = true;
    bent::move(model, kPair, 1, models::moved(3, 0, 0.125));  // right, in both pairs
    const choose::Cut cut = choose::choose_cut(model, view);
    ASSERT_EQ(cut.chosen.size(), 4u);
    EXPECT_EQ(choose::explain_choice(model, view, cut, cut.chosen[0]).factors.motion, 1);
    EXPECT_NEAR(choose::explain_choice(model, view, cut, cut.chosen[1]).factors.motion,
                std::sqrt(65.0), 1e-9);
    EXPECT_EQ(
        choose::explain_choice(model, view, cut, cut.nodes[cut.chosen[1]].parent).factors.motion,
        1);
}

TEST(Motion, OfTheCameraCoarsensWhatCrossesTheScreen) {
    Model model = bent::pairs();
    View view = flat_view();
    view.pixel_error = 100;
    view.modifiers.when_moving = true;
    view.modifiers.closing = view.camera;
    EXPECT_EQ(reason_of(model, view).factors.motion, 1);
    view.modifiers.closing->position.x += 0.125;
    EXPECT_NEAR(reason_of(model, view).factors.motion, std::sqrt(65.0), 1e-9);
    // What moves along rests on the screen.
    bent::move(model, model.root, 0, models::moved(0.125, 0, 0));
    EXPECT_NEAR(reason_of(model, view, 0).factors.motion, 1, 1e-9);
}

TEST(Darkness, IsWhatIsDisplayedOverTheMiddle) {
    EXPECT_EQ(choose::coarser_by_darkness(1), 1);
    EXPECT_EQ(choose::coarser_by_darkness(0.5), 1);
    EXPECT_EQ(choose::coarser_by_darkness(0.25), 2);
    EXPECT_EQ(choose::coarser_by_darkness(0), 64);
}

TEST(Darkness, CoarsensWhereNoLampReaches) {
    Model model = bent::pairs();
    model.world.color = glm::dvec3(0.0);
    View view = view_from(200);
    EXPECT_EQ(reason_of(model, view).factors.darkness, 1);  // not asked for
    view.modifiers.when_dark = true;
    EXPECT_EQ(reason_of(model, view).factors.darkness, 64);
    Light sun;
    sun.power = 0.21404114 * std::numbers::pi;
    model.lights = {sun};
    EXPECT_NEAR(reason_of(model, view).factors.darkness, 1, 1e-6);
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.position = {-11, 0, 0};  // 10 m from the first pair
    // A white surface sends P / 4 pi^2 d^2.
    lamp.power = 0.05087609 * 4 * std::numbers::pi * std::numbers::pi * 100;  // displayed as .25
    model.lights = {lamp};
    EXPECT_NEAR(reason_of(model, view, 0).factors.darkness, 2, 1e-3);
    EXPECT_GT(reason_of(model, view, 1).factors.darkness, 2.5);
}

TEST(Darkness, DoesNotCountBeforeABrightBackgroundOrOnWhatGlows) {
    Model model = bent::pairs();
    model.world.color = glm::dvec3(0.3);
    View view = view_from(200);
    view.modifiers.when_dark = true;
    EXPECT_EQ(reason_of(model, view).factors.darkness, 1);
    model.world.color = glm::dvec3(0.0);
    model.world.transparent = true;  // what is put behind it is not known
    EXPECT_EQ(reason_of(model, view).factors.darkness, 1);
    model.world.transparent = false;
    EXPECT_EQ(reason_of(model, view).factors.darkness, 64);
    model.materials[0].emission = glm::dvec3(1.0);
    EXPECT_EQ(reason_of(model, view).factors.darkness, 1);
}

TEST(DetailFactors, MultiplyAndStayWithinTheirRange) {
    choose::DetailFactors factors;
    EXPECT_EQ(factors.total(), 1);
    factors = {2, 3, 1.5, 0.5, 2, 4, 1.5};
    EXPECT_DOUBLE_EQ(factors.total(), 2 * 3 * 1.5 * 0.5 / (2 * 4 * 1.5));
    factors.motion = 1e9;
    EXPECT_EQ(factors.total(), 1.0 / 64);
    factors.lenses = 1e30;
    EXPECT_EQ(factors.total(), 64);
    factors.demand = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(std::isinf(factors.total()));
}

TEST(Why, NamesTheNumbersOfTheChoice) {
    Model model = bent::pairs();
    const View view = view_from(301);
    const choose::ChoiceReason reason = reason_of(model, view);
    EXPECT_EQ(reason.chosen.object, kPair);
    EXPECT_EQ(reason.chosen.lod, 1u);
    EXPECT_NEAR(reason.z, 300, 1e-9);
    EXPECT_NEAR(reason.pixel, 300.0 / 640, 1e-12);
    EXPECT_NEAR(reason.chosen.error_px, 0.4 * 640 / 300, 1e-9);
    EXPECT_EQ(reason.stretch, 1);
    EXPECT_FALSE(reason.coarser);  // the row itself has none
    const choose::ChoiceReason near = reason_of(model, view_from(201));
    EXPECT_EQ(near.chosen.object, kBall);
    EXPECT_EQ(near.chosen.lod, 2u);
    ASSERT_TRUE(near.coarser);
    EXPECT_EQ(near.coarser->object, kPair);
    EXPECT_NEAR(near.coarser->error_px, 0.4 * 640 / 200, 1e-9);
    const choose::ChoiceReason nearer = reason_of(model, view_from(101));
    EXPECT_EQ(nearer.chosen.lod, 1u);
    ASSERT_TRUE(nearer.coarser);
    EXPECT_EQ(nearer.coarser->lod, 2u);
    EXPECT_NEAR(nearer.coarser->error_px, 0.2 * 640 / 100, 1e-9);
    EXPECT_FALSE(nearer.pinned);
}

TEST(Why, FromInsideTheBoundTheDistanceIsTheNearClip) {
    Model model = bent::pairs();
    View view = view_from(0);
    EXPECT_EQ(reason_of(model, view).z, view.camera.near_clip);
    EXPECT_EQ(reason_of(model, view).chosen.lod, 0u);
    view.camera.position.x = std::nan("");
    EXPECT_THROW(choose::choose_cut(model, view), Error);
}

TEST(Criteria, FeatureIsTheShareOfThePictureThatItCovers) {
    // From 300 m the picture is 300 x 168.75 m; a feature of .4 m is .16 of that.
    const Model model = bent::pairs();
    View view = view_from(301);
    view.modifiers.criterion = DetailCriterion::Feature;
    view.pixel_error = 0.16 / (300 * 168.75) * 1.0001;
    EXPECT_EQ(drawn(model, view), kUntouched);
    view.pixel_error *= 0.999;
    EXPECT_EQ(drawn(model, view), "pair 0/left 2, pair 0/right 2, pair 1/left 2, pair 1/right 2");
}

TEST(Criteria, DistanceServesTwiceAsFarForEachLevel) {
    const Model model = bent::pairs(2);
    View view = view_from(101);
    view.modifiers.criterion = DetailCriterion::Distance;
    view.pixel_error = 49;
    EXPECT_EQ(drawn(model, view), "pair 0 1");
    view.pixel_error = 101;  // the pair, and balls, are nearer
    EXPECT_EQ(drawn(model, view), "pair 0/left 0, pair 0/right 0");
    Model ball;
    ball.root = models::add_leaf(ball, "ball", shapes::sphere(1, 3));
    models::add_level(ball, 0, 0.1, shapes::sphere(1, 1));
    models::add_level(ball, 0, 0.2, shapes::sphere(1, 0));
    summarize_assemblies(ball, bottom_up(ball));
    for (const auto& [threshold, lod] : {std::pair{101.0, 0u}, {99.0, 1u}, {49.0, 2u}}) {
        view.pixel_error = threshold;
        EXPECT_EQ(choose::choose_cut(ball, view).nodes[0].lod, lod);
    }
}

TEST(Criteria, AreaServesFourTimesAsMuchForEachFinerLevel) {
    Model ball;
    ball.root = models::add_leaf(ball, "ball", shapes::sphere(1, 3));
    models::add_level(ball, 0, 0.1, shapes::sphere(1, 1));
    models::add_level(ball, 0, 0.2, shapes::sphere(1, 0));
    summarize_assemblies(ball, bottom_up(ball));
    View view = flat_view();
    view.modifiers.criterion = DetailCriterion::Area;
    const double share = 4 / (10 * 5.625);  // of its box, 2 x 2 m
    for (const auto& [threshold, lod] : {std::pair{1.01, 2u}, {0.99, 1u}, {0.26, 1u}, {0.24, 0u}}) {
        view.pixel_error = threshold * share;
        EXPECT_EQ(choose::choose_cut(ball, view).nodes[0].lod, lod) << threshold;
    }
}
