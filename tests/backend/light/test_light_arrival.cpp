// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how much light of a lamp counts at a point, and what the point may be off by.
#include "base/maths.h"
#include "light/light_arrival.h"

#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::light;

namespace {

/// A panel of 1 m x 1 m at the origin, which shines along x.
Light panel(bool round = false) {
    Light light;
    light.kind = LightKind::Area;
    light.direction = {1, 0, 0};
    light.edge_u = {0, 1, 0};
    light.edge_v = {0, 0, 1};
    light.round = round;
    light.power = 4 * kPi * (round ? kPi / 4 : 1);  // of radiance pi
    return light;
}

/// What a white surface sends back of radiance pi from everywhere on the panel.
double exact(const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
    constexpr int kParts = 400;
    double sum = 0;
    for (int i = 0; i < kParts * kParts; ++i) {
        const double u = (i % kParts + 0.5) / kParts - 0.5;
        const int row = i / kParts;
        const double v = (row + 0.5) / kParts - 0.5;
        if (light.round && u * u + v * v > 0.25)
            continue;
        const glm::dvec3 way = u * light.edge_u + v * light.edge_v - point;
        const double square = glm::dot(way, way);
        sum += std::max(0.0, glm::dot(way, normal)) * std::max(0.0, -way.x) / (square * square);
    }
    return sum / (kParts * kParts);
}

}  // namespace

TEST(LightArrival, FarAwayAPanelCountsAsItsMiddle) {
    for (const bool round : {false, true}) {
        for (const glm::dvec3& point : {glm::dvec3(3, 0, 0), glm::dvec3(4, 2, 1)}) {
            const glm::dvec3 normal = glm::normalize(-point);
            const double expected = exact(panel(round), point, normal);
            EXPECT_NEAR(light_arrival(panel(round), point, normal).surface.x, expected,
                        0.05 * expected);
        }
    }
}

// The frames of windows were without the light of the window between them.
TEST(LightArrival, WhatIsBesideAPanelIsLitByItsNearParts) {
    for (const double depth : {0.05, 0.1, 0.2, 0.4}) {
        const glm::dvec3 point(depth, 0.5, 0);
        const glm::dvec3 normal(0, -1, 0);
        const double found = light_arrival(panel(), point, normal).surface.x;
        const double expected = exact(panel(), point, normal);
        EXPECT_GT(found, 0.5 * expected) << depth;
        EXPECT_LT(found, 2 * expected) << depth;
    }
    // The panel's middle is behind, and a part of it in front.
    const glm::dvec3 aside(0.1, 0.3, 0);
    const double part = exact(panel(), aside, {0, 1, 0});
    EXPECT_GT(part, 0);
    EXPECT_NEAR(light_arrival(panel(), aside, {0, 1, 0}).surface.x, part, 0.5 * part);
    EXPECT_EQ(light_arrival(panel(), {0.1, 0.6, 0}, {0, 1, 0}).surface.x, 0);
    EXPECT_EQ(light_arrival(panel(), {-0.1, 0, 0}, {1, 0, 0}).surface.x, 0);
    EXPECT_GE(light_arrival(panel(), {0, 0, 0}, {1, 0, 0}).surface.x, 0);
}

TEST(LightArrival, APointMayBeOffByAThousandthOrByTheStepsOfTheError) {
    EXPECT_DOUBLE_EQ(light_tolerance(glm::dvec3(0.5), 0).x, 0.5 / 1024);
    EXPECT_DOUBLE_EQ(light_tolerance(glm::dvec3(0.5), 2).x, 2 * display_step(0.5));
    EXPECT_DOUBLE_EQ(light_tolerance(glm::dvec3(100.0), 1).x, 100.0 / 1024);
    EXPECT_EQ(light_tolerance(glm::dvec3(0.0), 0), glm::dvec3(0.0));
    // Of a saturated color the others may be off by what nobody sees.
    const glm::dvec3 red = light_tolerance({1, 0, 0}, 0);
    EXPECT_DOUBLE_EQ(red.x, 1.0 / 1024);
    EXPECT_GT(red.y, 0);
    EXPECT_LE(red.y, display_step(0) / 8);
    EXPECT_GE(light_tolerance({-1, 0.5, 0}, 0).x, 0);
}
