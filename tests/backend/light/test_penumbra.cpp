// SPDX-License-Identifier: GPL-3.0-or-later
// Guards when a sun's shadows are drawn soft: where a pixel could tell, and nowhere else.
#include "light/penumbra.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

using namespace lodestone;

namespace {

Bound box(const glm::dvec3& low, const glm::dvec3& high) {
    Bound bound;
    bound.box = {low, high};
    bound.center = 0.5 * (low + high);
    bound.radius = 0.5 * glm::length(high - low);
    return bound;
}

/// A ground of 200 m and a tower of 10 m at the origin; the eye is `away` m from the tower.
std::vector<Bound> scene() {
    return {box({-100, -100, 0}, {100, 100, 0}), box({-1, -1, 0}, {1, 1, 10})};
}

View from(double away) {
    View view;
    view.camera.position = {0, -away, 5};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 0, 0.5625};
    view.width = 640;
    view.height = 360;
    return view;
}

Light sun(double angle, const glm::dvec3& way = {0, 0, -1}) {
    Light light;
    light.angle = angle;
    light.direction = way;
    return light;
}

}  // namespace

TEST(Penumbra, NothingOrAPointCastsNone) {
    EXPECT_EQ(light::widest_penumbra(sun(0.1), from(100), {}), 0);
    EXPECT_EQ(light::widest_penumbra(sun(0), from(100), scene()), 0);
    const std::vector<Bound> ground{scene()[0]};
    EXPECT_EQ(light::widest_penumbra(sun(0.1), from(100), ground), 0);
}

TEST(Penumbra, ATowersIsItsHeightTimesTheAngleInPixelsThere) {
    // 10 m times 2 tan(.005) = .1 m, seen from 999 - 10 m: a pixel is (999 - 10) / 640 m wide.
    const double found = light::widest_penumbra(sun(0.01), from(1000), scene());
    EXPECT_NEAR(found, 0.1 * 640 / 989, 0.001);
    // A sun at 30 degrees throws it twice as far.
    const double slanted =
        light::widest_penumbra(sun(0.01, {std::sqrt(0.75), 0, -0.5}), from(1000), scene());
    EXPECT_NEAR(slanted, 0.2 * 640 / 979, 0.001);
}

TEST(Penumbra, ALampsIsTwiceItsSizeAsNearAsItStillLights) {
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.position = {0, 0, 5};
    lamp.power = 4 * std::numbers::pi * std::numbers::pi * 0.4;  // lights 10 m far
    lamp.radius = 0.1;
    EXPECT_NEAR(light::widest_penumbra(lamp, from(1010), scene()), 0.4 * 640 / 1000, 1e-6);
    lamp.radius = 0;
    EXPECT_EQ(light::widest_penumbra(lamp, from(1010), scene()), 0);
    lamp.kind = LightKind::Area;  // 1 m x 1 m, and half the solid angle gets more of its light
    lamp.power /= std::numbers::pi;
    EXPECT_NEAR(light::widest_penumbra(lamp, from(1010), scene()), 2 * std::sqrt(2) * 640 / 1000,
                1e-6);
}

TEST(Penumbra, NearerAndFlatterIsWider) {
    EXPECT_GT(light::widest_penumbra(sun(0.01), from(20), scene()),
              light::widest_penumbra(sun(0.01), from(200), scene()));
    const double low = light::widest_penumbra(sun(0.01, {1, 0, -0.01}), from(1000), scene());
    EXPECT_GT(low, light::widest_penumbra(sun(0.01), from(1000), scene()));
    EXPECT_TRUE(std::isfinite(low));
}
