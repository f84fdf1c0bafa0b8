// SPDX-License-Identifier: GPL-3.0-or-later
// Guards by how many rays lamps are sampled: one where nothing softer shows, all of them near by.
#include "base/parallel.h"
#include "base/random.h"
#include "light/lamp_grids.h"

#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::light;

namespace {

Light panel(double size, double power) {
    Light light;
    light.kind = LightKind::Area;
    light.position = {0, 0, 2};
    light.edge_u = {size, 0, 0};
    light.edge_v = {0, size, 0};
    light.power = power;
    return light;
}

View from_above() {
    View view;
    view.width = 640;
    view.height = 360;
    view.camera.position = {0, 0, 6};
    view.camera.direction = {0, 0, -1};
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 0.5625, 0};
    return view;
}

/// Points of a floor about a place, which get this much light besides.
std::vector<LitPoint> floor_at(double x, double others) {
    PcgRandom random(5);
    std::vector<LitPoint> points(40);
    for (LitPoint& point : points) {
        point.position = {x + random.uniform(), random.uniform(), 0};
        point.other_light = glm::dvec3(others);
    }
    return points;
}

LampGrid grid_of(
    const Light& light, const std::vector<LitPoint>& points, const GridDemands& demands = {},
    const IsSoft& soft = [](const Light&, const LitPoint&) { return true; }) {
    const LightTree tree =
        make_light_tree({&light, 1}, [](const glm::dvec3&, const glm::dvec3&) { return true; });
    const LightShares shares(points.size(), {1.0f});
    return fit_lamp_grids(tree, {{0}}, points, shares, soft, from_above(), demands).at(0).at(0);
}

}  // namespace

TEST(LampGrids, APointOrALampWithoutShadowHasOneRay) {
    Light light = panel(1, 100);
    light.kind = LightKind::Point;
    EXPECT_EQ(finest_grid(light, 17).rays, 1);
    light.radius = 0.1;
    EXPECT_EQ(finest_grid(light, 17).rays, 17);
    EXPECT_EQ(finest_grid(light, 1).rays, 1);
    light.shadow = false;
    EXPECT_EQ(finest_grid(light, 17).rays, 1);
    EXPECT_EQ(shadow_rays(light, {1, false}), 1);
    EXPECT_EQ(shadow_rays(light, {2, false}), 4);
    EXPECT_EQ(shadow_rays(light, {3, false}), 5.25);  // it begins at the corners
    light.kind = LightKind::Area;
    EXPECT_EQ(shadow_rays(light, {3, true, true}), 9);
    EXPECT_EQ(shadow_rays(light, {3, true, false}), 5.25);  // no soft shadow shows
}

TEST(LampGrids, LongPanelsHaveLongGrids) {
    Light light = panel(1, 100);
    EXPECT_EQ(finest_grid(light, 17), (LampGrid{9, true, true}));
    EXPECT_EQ(shorter_edge(light, 9), 9);
    light.edge_v *= 0.2;
    EXPECT_EQ(finest_grid(light, 17).rays, 17);
    EXPECT_EQ(shorter_edge(light, 17), 5);
    light.edge_v *= 0.2;
    EXPECT_EQ(finest_grid(light, 17).rays, 33);
    EXPECT_EQ(shorter_edge(light, 33), 3);
    for (const int rays : {1, 2, 3, 5})
        EXPECT_LE(shorter_edge(light, rays), rays);
}

TEST(LampGrids, NearAndStrongIsFinestFarOrFaintIsOneRay) {
    const Light light = panel(1, 100);
    EXPECT_EQ(grid_of(light, floor_at(0, 0)), (LampGrid{9, true, true}));
    EXPECT_EQ(grid_of(light, floor_at(60, 1)), LampGrid{});
    EXPECT_EQ(grid_of(panel(1, 0.01), floor_at(0, 0.5)), LampGrid{});
    // In bright light fewer steps of its shadow can be told apart.
    int before = 9;
    for (const double others : {0.0, 0.1, 0.3, 1.0}) {
        const int rays = grid_of(panel(1, 4), floor_at(1, others)).rays;
        EXPECT_LE(rays, before);
        before = rays;
    }
    EXPECT_LT(before, 9);
}

TEST(LampGrids, RoughPicturesHaveFewerRaysAndNoneHasMoreThanAsked) {
    const Light light = panel(0.2, 10);
    int before = 9;
    for (const double error : {0.0, 1.0, 4.0, 16.0, 64.0}) {
        const int rays = grid_of(light, floor_at(0, 0.1), {error, error, 17, 0}).rays;
        EXPECT_LE(rays, before);
        before = rays;
    }
    EXPECT_LT(before, 9);
    EXPECT_LE(grid_of(light, floor_at(0, 0), {0, 0, 5, 0}).rays, 3);
    EXPECT_EQ(grid_of(light, floor_at(0, 0), {0, 0, 1, 0}).rays, 1);
}

TEST(LampGrids, ASmallLampLightsAsAWhole) {
    const LampGrid small = grid_of(panel(0.02, 100), floor_at(4, 0));
    EXPECT_GT(small.rays, 1);
    EXPECT_FALSE(small.parts);
    EXPECT_TRUE(grid_of(panel(2, 100), floor_at(0, 0)).parts);
}

// Frames of windows were dark: points lay a cell beside them, from where a window is small.
TEST(LampGrids, WhatLiesBetweenPointsAndALampIsNearIt) {
    const Light light = panel(1, 0.3);
    const std::vector<LitPoint> points = floor_at(2, 0.5);
    GridDemands demands;
    EXPECT_LT(grid_of(light, points, demands).rays, 9);
    demands.apart = 640.0 * 0.3;                                   // 1.8 m at the floor
    EXPECT_LT(grid_of(panel(0.1, 0.3), points, demands).rays, 9);  // too small to be seen so near
    EXPECT_EQ(grid_of(panel(3, 0.3), points, demands), (LampGrid{9, true, false}));
}

// Windows close before a wall are sampled finely for the light beside them: where no shadow of them
// shows, all parts that light alike need no more than corners.
TEST(LampGrids, OnlySoftShadowsNeedMoreThanCornersWhereAllLightsAlike) {
    const auto near_by = [&](bool soft) {
        return grid_of(panel(1, 100), floor_at(0, 0), {},
                       [soft](const Light&, const LitPoint&) { return soft; });
    };
    EXPECT_EQ(near_by(true), (LampGrid{9, true, true}));
    EXPECT_EQ(near_by(false).parts, true);
    EXPECT_GT(near_by(false).rays, 2);
    EXPECT_FALSE(near_by(false).soft);
}

// Bulbs on a tree lit all of its cones through grids of rays, all of which ended at the same place.
TEST(LampGrids, WherePointsSeeAllOfALampOrNothingOneRayIsEnough) {
    Light bulb = panel(0.3, 100);
    bulb.kind = LightKind::Point;
    bulb.radius = 0.15;
    std::vector<LitPoint> points;
    for (int i = 0; i < 20; ++i) {
        const std::vector<LitPoint> more = floor_at(1, 0);
        points.insert(points.end(), more.begin(), more.end());
    }
    const auto rays = [&](double share) {
        size_t asked = 0;
        return grid_of(bulb, points, {},
                       [&](const Light&, const LitPoint&) {
                           return static_cast<double>(asked++) <
                                  share * static_cast<double>(points.size());
                       })
            .rays;
    };
    EXPECT_EQ(rays(0), 1);
    EXPECT_EQ(rays(0.005), 1);  // a few points count for nothing
    EXPECT_GT(rays(0.02), 2);
    EXPECT_EQ(rays(0.02), rays(1));
}
