// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what the picture does not show: how coarse its shadows and its images allow it to be.
#include "choose/criterion.h"
#include "choose/off_screen.h"
#include "scenes/lens_views.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using bent::ball;
using bent::drawn;
using choose::OffScreenField;
using choose::ViewPyramid;
using models::add_group;
using models::add_leaf;
using models::moved;
using models::view_from;

namespace {

constexpr double kPixel = 1.0 / 640;  // of the distance, metres

/// Ground of 1 km all around, and a mirror of this material 10 m in front of the eye.
Model plain(const Material& mirror = {}) {
    Model model;
    const ObjectIndex ground = add_leaf(model, "ground", shapes::cube());
    const ObjectIndex pane = add_leaf(model, "pane", shapes::cube(), mirror);
    Affine wide;
    wide.linear = glm::dmat3(1000.0);
    model.root =
        add_group(model, "scene", {{ground, wide, "ground"}, {pane, moved(0, 10, 0), "pane"}});
    summarize_assemblies(model, bottom_up(model));
    return model;
}

Light sun(const glm::dvec3& direction) {
    Light light;
    light.direction = direction;
    return light;
}

View from_origin(OffScreen off_screen) {
    View view = view_from(0);
    view.modifiers.off_screen = off_screen;
    return view;
}

double z_of(const Bound& bound) {
    return distance(bound, glm::dvec3(0.0));
}

double shadows_only(const Model& model, const Bound& bound) {
    const View view = from_origin(OffScreen::Shadows);
    return OffScreenField(model, view).coarser(bound, z_of(bound));
}

}  // namespace

TEST(ViewPyramid, KnowsWhatIsOutside) {
    for (const double hand : {1.0, -1.0}) {  // also mirrored
        View view = view_from(0);
        view.camera.right *= hand;
        const ViewPyramid pyramid(view);
        EXPECT_FALSE(pyramid.outside(ball({0, 10, 0}, 1)));
        EXPECT_FALSE(pyramid.outside(ball({0, 0, 0}, 1)));  // around the eye
        EXPECT_TRUE(pyramid.outside(ball({0, -5, 0}, 1)));
        EXPECT_TRUE(pyramid.outside(ball({10, 1, 0}, 1)));
        // 10 m away the frame ends at 5 m, and a pixel later
        EXPECT_TRUE(pyramid.outside(ball({6, 10, 0}, 0.85)));
        EXPECT_FALSE(pyramid.outside(ball({6, 10, 0}, 0.95)));
        EXPECT_FALSE(pyramid.outside(ball({5 + 5 * kPixel, 10, 0}, 1e-3)));
        EXPECT_TRUE(pyramid.outside(ball({0, 10, 3.9}, 0.9)));
        EXPECT_TRUE(pyramid.outside(Bound{}));
    }
}

TEST(ViewPyramid, OrthographicShowsWhatIsBeforeItsFrame) {
    View view = view_from(0);
    view.camera.orthographic = true;
    view.camera.right = {10, 0, 0};
    view.camera.up = {0, 0, 5.625};
    const ViewPyramid pyramid(view);
    EXPECT_FALSE(pyramid.outside(ball({5.5, 1000, 0}, 1)));
    EXPECT_TRUE(pyramid.outside(ball({6.2, 1000, 0}, 1)));
    EXPECT_TRUE(pyramid.outside(ball({0, -2, 0}, 1)));
}

TEST(ViewPyramid, ABlurredEdgeIsShown) {
    View view = view_from(0);
    const Bound beside = ball({6, 10, 0}, 0.5);
    EXPECT_TRUE(ViewPyramid(view).outside(beside));
    view.camera.focus_distance = 100;
    view.camera.aperture = 0.05;
    view.camera.near_clip = 0.1;  // what is there is blurred by half the frame
    EXPECT_FALSE(ViewPyramid(view).outside(beside));
}

TEST(OffScreen, WhatMayBeInThePictureIsNotCoarser) {
    const Model model = plain();
    EXPECT_EQ(shadows_only(model, ball({0, 10, 0}, 1)), 1);
    EXPECT_EQ(shadows_only(model, ball({0, 0, 0}, 100)), 1);
}

TEST(OffScreen, WithoutLightsAndMirrorsItIsAsCoarseAsCanBe) {
    EXPECT_EQ(shadows_only(plain(), ball({0, -20, 0}, 1)), kMostImportance);
}

TEST(OffScreen, AShadowThatFallsBehindTheEyeDoesNotCount) {
    Model model = plain();
    model.lights = {sun({0, 0, -1})};
    EXPECT_EQ(shadows_only(model, ball({0, -20, 0}, 1)), kMostImportance);
    model.lights[0].direction = {0, 1, 0};  // through the eye
    EXPECT_EQ(shadows_only(model, ball({0, -20, 0}, 1)), 1);
    model.lights[0].shadow = false;
    EXPECT_EQ(shadows_only(model, ball({0, -20, 0}, 1)), kMostImportance);
}

TEST(OffScreen, AShadowCountsWhereItEntersThePicture) {
    Model model = plain();
    model.lights = {sun({-1, 3, 0})};
    // The way of the ball's center meets the frame's side, x = y / 2, at (46, 92, 0), 103 m away;
    // the ball itself is 77 m away.
    const double coarser = shadows_only(model, ball({60, 50, 0}, 1));
    EXPECT_NEAR(coarser, 102.7 / 77.1, 0.04);
    EXPECT_LT(coarser, 102.7 / 77.1);
}

TEST(OffScreen, ALampEnlargesTheErrorsOfItsShadows) {
    Model model = plain();
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.power = 100;
    lamp.position = {62, 44, 0};  // 6.3 m from the ball, its shadows on the way of the test before
    model.lights = {lamp};
    EXPECT_EQ(shadows_only(model, ball({60, 50, 0}, 0.1)), 1);
    model.lights[0].position = {-1000, 50, 0};  // to the other side
    EXPECT_EQ(shadows_only(model, ball({60, 50, 0}, 0.1)), kMostImportance);
    model.lights[0].position = {60, 50, 0};  // inside
    EXPECT_EQ(shadows_only(model, ball({60, 50, 0}, 0.1)), 1);
}

TEST(OffScreen, NoPointOfAShadowInThePictureIsNearerThanItSays) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    Model model = plain();
    const View view = from_origin(OffScreen::Shadows);
    const ViewPyramid pyramid(view);
    for (int round = 0; round < 300; ++round) {
        const bool lamp = round % 2 == 1;
        Light light = sun({any(random), any(random), any(random)});
        light.angle = 0.02;
        if (lamp) {
            light.kind = LightKind::Point;
            light.position = 100.0 * glm::dvec3(any(random), any(random), any(random));
        }
        model.lights = {light};
        const Bound bound =
            ball(100.0 * glm::dvec3(any(random), any(random), any(random)), 1 + any(random));
        const double z = z_of(bound);
        const double coarser = OffScreenField(model, view).coarser(bound, z);
        if (pyramid.outside(bound) && coarser > 1) {
            const glm::dvec3 from = light.position;
            const glm::dvec3 along =
                lamp ? glm::normalize(bound.center - from) : glm::normalize(light.direction);
            const double away = lamp ? glm::length(bound.center - from) : 1e300;
            for (int step = 0; step < 1600; ++step) {
                const double t = 0.25 * step;
                const glm::dvec3 at = bound.center + t * along;
                if (pyramid.outside(ball(at, 1e-6)) || glm::length(at) > 400)
                    continue;
                const double allowed = glm::length(at) * kPixel / (1 + t / away);
                EXPECT_LE(coarser * z * kPixel, allowed * (1 + 1e-9)) << round;
            }
        }
    }
}

TEST(OffScreen, WhatAMirrorShowsIsAsFarAsTheWayToIt) {
    Material metal;
    metal.metallic = 1;
    metal.roughness = 0;
    const Bound behind = ball({0, -20, 0}, 1);
    const View view = from_origin(OffScreen::Reflected);
    const auto coarser = [&](const Material& mirror) {
        const Model model = plain(mirror);
        return OffScreenField(model, view).coarser(behind, z_of(behind));
    };
    EXPECT_EQ(shadows_only(plain(metal), behind), kMostImportance);
    const double edge = std::sqrt(0.75);  // of a cube's ball, if its sides are 1 m
    const double way = (10 - 0.5) + (30 - 1 - edge);
    EXPECT_NEAR(coarser(metal), way / 19, 0.06 * way / 19);
    Material lacquer;
    lacquer.roughness = 0;
    EXPECT_NEAR(coarser(lacquer) / coarser(metal), 1 / std::sqrt(choose::imaged_share(lacquer)),
                1e-9);
    Material rough;
    EXPECT_EQ(coarser(rough), kMostImportance);
    EXPECT_EQ(choose::imaged_share(rough), 0);
    EXPECT_EQ(choose::imaged_share(metal), 1);
}

TEST(OffScreen, WithoutAMirrorNothingButShadowsOfItIsSeen) {
    Material metal;
    metal.metallic = 1;
    metal.roughness = 0;
    const View view = from_origin(OffScreen::Reflected);
    const auto only_shadows = [&](const Material& pane, const Bound& bound, const View& of) {
        const Model model = plain(pane);
        return OffScreenField(model, of).only_shadows(bound);
    };
    const Bound behind = ball({0, -20, 0}, 1);
    EXPECT_TRUE(only_shadows({}, behind, view));
    EXPECT_FALSE(only_shadows({}, ball({0, 20, 0}, 1), view));
    EXPECT_FALSE(only_shadows(metal, behind, view));
    EXPECT_TRUE(only_shadows(metal, behind, from_origin(OffScreen::Shadows)));
}

TEST(OffScreen, APictureOfTheSkyLimitsIt) {
    Model model = plain();
    model.world.environment = models::checker();
    EXPECT_NEAR(shadows_only(model, ball({0, -20, 0}, 1)), std::sqrt(12.0), 1e-9);
}

TEST(OffScreen, CutsAreCoarserOutsideAndTheSameInside) {
    Model model = bent::pairs();
    View view = view_from(60);
    view.camera.position = {1.5, -60, 0};
    view.camera.right = {0.1, 0, 0};  // shows x = -1.5 to 4.5: the first pair
    const std::string full = drawn(model, view);
    view.modifiers.off_screen = OffScreen::Shadows;
    const std::string coarse = drawn(model, view);
    EXPECT_NE(coarse, full);
    EXPECT_EQ(coarse.substr(0, coarse.find(", pair 1")), full.substr(0, full.find(", pair 1")));
    const choose::Cut cut = choose::choose_cut(model, view);
    EXPECT_LE(cut.largest_error_px, view.pixel_error);
    EXPECT_EQ(choose::explain_choice(model, view, cut, cut.chosen.back()).factors.off_screen,
              kMostImportance);
    view.pixel_error = 0;
    const std::string originals = drawn(model, view);
    view.modifiers.off_screen = OffScreen::Full;
    EXPECT_EQ(originals, drawn(model, view));
}

TEST(OffScreen, ACoarseSolidBesideTheFrameDoesNotReachIntoIt) {
    // Its original ends a metre beside the frame, its next level 2 m inside.
    for (const double x : {7.0, 20.0}) {
        Model model;
        const ObjectIndex leaf = add_leaf(model, "leaf", shapes::cube());
        models::add_level(model, leaf, 0.5, shapes::sphere(4, 1));
        const ObjectIndex group = add_group(model, "group", {{leaf, Affine{}, "leaf"}});
        model.root = add_group(model, "scene", {{group, moved(x, 10, 0), "group"}});
        summarize_assemblies(model, bottom_up(model));
        EXPECT_EQ(drawn(model, from_origin(OffScreen::Full)), "group/leaf 0");
        for (const OffScreen off_screen : {OffScreen::Shadows, OffScreen::Reflected})
            EXPECT_EQ(drawn(model, from_origin(off_screen)),
                      x < 10 ? "group/leaf 0" : "group/leaf 1");
    }
}

TEST(OffScreen, AMirrorThatReachesIntoTheFrameByACoarseLevelShowsWhatIsBehind) {
    Material metal;
    metal.metallic = 1;
    metal.roughness = 0;
    const View view = from_origin(OffScreen::Reflected);
    const Bound behind = ball({0, -20, 0}, 1);
    for (const double x : {7.0, 20.0}) {
        Model model;
        const ObjectIndex pane = add_leaf(model, "pane", shapes::cube(), metal);
        models::add_level(model, pane, 0.5, shapes::sphere(4, 1));
        const ObjectIndex group = add_group(model, "group", {{pane, moved(x, 0, 0), "pane"}});
        model.root = add_group(model, "scene", {{group, moved(0, 10, 0), "group"}});
        summarize_assemblies(model, bottom_up(model));
        const double coarser = OffScreenField(model, view).coarser(behind, z_of(behind));
        EXPECT_EQ(coarser < kMostImportance, x < 10) << coarser;
    }
}

TEST(OffScreen, NonsenseLightsDoNoHarm) {
    Model model = plain();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {nan, std::numeric_limits<double>::infinity(), 0.0, -1e300}) {
        Light lamp;
        lamp.kind = LightKind::Area;
        lamp.position = {bad, 0, 0};
        lamp.edge_u = {bad, 0, 0};
        Light flat = sun({bad, bad, bad});
        flat.angle = bad;
        model.lights = {lamp, flat};
        const double coarser = shadows_only(model, ball({0, -20, 0}, 1));
        EXPECT_GE(coarser, 1);
        EXPECT_LE(coarser, kMostImportance);
    }
}
