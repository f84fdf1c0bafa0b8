// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which lights light what: differences within Pixel Error, nothing left out that shows, finer
// never fewer.
#include "base/parallel.h"
#include "base/random.h"
#include "light/light_arrival.h"
#include "light/light_cut.h"

#include <gtest/gtest.h>
#include <numeric>

using namespace lodestone;
using namespace lodestone::light;

namespace {

const Clear kOpen = [](const glm::dvec3&, const glm::dvec3&) { return true; };
const Reaches kEverywhere = [](const Light&, const LitPoint&, uint32_t&) { return 1.0; };

/// Lamps 3 m above a floor, from x = 0 on.
std::vector<Light> lamps(size_t count, double apart, double power = 30) {
    std::vector<Light> lights(count);
    for (size_t i = 0; i < count; ++i) {
        lights[i].kind = LightKind::Point;
        lights[i].position = {apart * static_cast<double>(i), 0, 3};
        lights[i].power = power;
    }
    return lights;
}

std::vector<LitPoint> floor_at(double x, size_t count = 64, uint32_t region = 0) {
    PcgRandom random(9);
    std::vector<LitPoint> points(count);
    for (LitPoint& point : points) {
        point.position = {x + random.uniform(), random.uniform(), 0};
        point.region = region;
    }
    return points;
}

std::vector<uint32_t> cut(const LightTree& tree, const std::vector<LitPoint>& points,
                          double pixel_error, const Reaches& reaches = kEverywhere) {
    return cut_lights(tree, points, find_shares(tree, points, reaches, pixel_error), 1, reaches,
                      pixel_error)[0];
}

glm::dvec3 energy(const LightTree& tree, const std::vector<uint32_t>& nodes) {
    glm::dvec3 sum(0.0);
    for (const uint32_t node : nodes)
        sum += energy_of(tree.nodes[node].light);
    return sum;
}

}  // namespace

TEST(LightCut, ARegionWithoutPointsHasNoLights) {
    const LightTree tree = make_light_tree(lamps(8, 1), kOpen);
    const LightCut cut = cut_lights(tree, {}, {}, 2, kEverywhere, 1);
    EXPECT_EQ(cut.size(), 2u);
    EXPECT_TRUE(cut[0].empty());
}

TEST(LightCut, FarLampsAreOneNearOnesAreThemselves) {
    const LightTree tree = make_light_tree(lamps(32, 0.2, 3000), kOpen);
    EXPECT_EQ(cut(tree, floor_at(-90), 1).size(), 1u);
    const std::vector<uint32_t> near = cut(tree, floor_at(3), 1);
    EXPECT_GT(near.size(), 2u);
}

TEST(LightCut, ALightForSeveralHasTheirEnergy) {
    const LightTree tree = make_light_tree(lamps(100, 0.5, 3e7), kOpen);
    const glm::dvec3 all = energy(tree, tree.roots);
    for (const double error : {0.1, 1.0, 8.0}) {
        const std::vector<uint32_t> nodes = cut(tree, floor_at(-900), error);
        EXPECT_LT(nodes.size(), 20u);
        EXPECT_NEAR(energy(tree, nodes).x, all.x, 1e-9 * all.x);
    }
}

TEST(LightCut, WhatIsLeftOutIsTogetherLessThanOfAllTheLightCanBeSeen) {
    const LightTree tree = make_light_tree(lamps(64, 3), kOpen);
    std::vector<LitPoint> points = floor_at(-20);
    size_t before = 64;
    for (const double others : {0.0, 1.0, 10.0, 1000.0}) {
        for (LitPoint& point : points)
            point.other_light = glm::dvec3(others);
        const std::vector<uint32_t> nodes = cut(tree, points, 0);
        EXPECT_LE(nodes.size(), before);
        before = nodes.size();
        for (const LitPoint& point : points) {
            double all = 0;
            double drawn = 0;
            for (const uint32_t root : tree.roots) {
                for (const uint32_t lamp : tree.lamps(root))
                    all += sent_radiance(tree.nodes[lamp].light, point).x;
            }
            for (const uint32_t node : nodes)
                drawn += sent_radiance(tree.nodes[node].light, point).x;
            EXPECT_LE(std::abs(all - drawn), (all + others) / 1024);
        }
    }
    EXPECT_EQ(before, 0u);  // the lamps send less than a thousandth of 1000
}

TEST(LightCut, NoRayIsCastToWhatCannotMatter) {
    const LightTree tree = make_light_tree(lamps(64, 3), kOpen);
    std::vector<LitPoint> points = floor_at(-20);
    for (LitPoint& point : points)
        point.other_light = glm::dvec3(1000.0);
    size_t asked = 0;
    const ThreadLimit one(1);
    const Reaches counted = [&](const Light&, const LitPoint&, uint32_t&) {
        ++asked;
        return 1.0;
    };
    find_shares(tree, points, counted, 0);
    EXPECT_EQ(asked, 0u);
    points[0].other_light = glm::dvec3(0.0);
    find_shares(tree, points, counted, 0);
    EXPECT_GT(asked, 0u);
    EXPECT_LE(asked, 64u);
}

TEST(LightCut, OfARoughPictureNoMoreThanAStepIsLeftOut) {
    const LightTree tree = make_light_tree(lamps(64, 3, 1000), kOpen);
    std::vector<LitPoint> points = floor_at(-20);
    for (LitPoint& point : points)
        point.other_light = glm::dvec3(0.5);
    double all = 0;
    for (const Light& light : lamps(64, 3, 1000))
        all += sent_radiance(light, points[0]).x;
    ASSERT_GT(all, 2 * display_step(0.5));
    double drawn = 0;
    for (const uint32_t node : cut(tree, points, 64))
        drawn += sent_radiance(tree.nodes[node].light, points[0]).x;
    EXPECT_GT(drawn, 0.5 * all);
}

TEST(LightCut, AFinerNumberNeverGivesFewerLights) {
    const LightTree tree = make_light_tree(lamps(64, 0.7), kOpen);
    for (const double x : {-20.0, -3.0, 5.0}) {
        size_t before = 0;
        for (const double error : {64.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.01, 0.0}) {
            const size_t now = cut(tree, floor_at(x), error).size();
            EXPECT_GE(now, before);
            before = now;
        }
        EXPECT_GT(before, 10u);
    }
}

TEST(LightCut, DifferencesAreWithinTheNumber) {
    const std::vector<Light> lights = lamps(64, 0.7);
    const LightTree tree = make_light_tree(lights, kOpen);
    for (const double error : {0.5, 1.0, 4.0}) {
        const std::vector<LitPoint> points = floor_at(-6);
        const std::vector<uint32_t> nodes = cut(tree, points, error);
        EXPECT_LT(nodes.size(), lights.size());
        double square = 0;
        for (const LitPoint& point : points) {
            glm::dvec3 exact(0.0);
            glm::dvec3 drawn(0.0);
            for (const Light& light : lights)
                exact += point.albedo * light_arrival(light, point.position, point.normal).surface;
            for (const uint32_t node : nodes)
                drawn +=
                    point.albedo *
                    light_arrival(tree.nodes[node].light, point.position, point.normal).surface;
            const double steps = std::abs(drawn.x - exact.x) / display_step(exact.x);
            EXPECT_LE(steps, 3.01 * error);
            square += steps * steps;
        }
        EXPECT_LE(std::sqrt(square / static_cast<double>(points.size())), 1.01 * error);
    }
}

TEST(LightCut, WhatReachesNothingIsLeftOutAndARoomIsNoBrighter) {
    // A wall at x = 8 between two rooms of sixteen lamps each.
    const auto side = [](double x) { return x < 8; };
    const LightTree tree = make_light_tree(
        lamps(32, 0.5),
        [&](const glm::dvec3& a, const glm::dvec3& b) { return side(a.x) == side(b.x); });
    const Reaches wall = [&](const Light& light, const LitPoint& point, uint32_t&) {
        return side(light.position.x) == side(point.position.x) ? 1.0 : 0.0;
    };
    std::vector<LitPoint> points = floor_at(2);
    const std::vector<LitPoint> others = floor_at(12, 64, 1);
    points.insert(points.end(), others.begin(), others.end());
    const LightCut both = cut_lights(tree, points, find_shares(tree, points, wall, 1), 2, wall, 1);
    for (size_t room = 0; room < 2; ++room) {
        EXPECT_NEAR(energy(tree, both[room]).x, 16 * 30, 1e-9);
        for (const uint32_t node : both[room])
            EXPECT_EQ(side(tree.nodes[node].light.position.x), room == 0);
    }
}

TEST(LightCut, ALightWhosePlaceIsHiddenWhereItsLampsAreNotIsOpened) {
    const LightTree tree = make_light_tree(lamps(8, 0.5), kOpen);
    // A column hides every joined light, and no lamp.
    const Reaches column = [&](const Light& light, const LitPoint&, uint32_t&) {
        return std::fmod(light.position.x, 0.5) == 0 ? 1.0 : 0.0;
    };
    EXPECT_EQ(cut(tree, floor_at(-20), 0.1, column).size(), 8u);
}

TEST(LightCut, LampsSeenByAPointBesideCount) {
    const LightTree tree = make_light_tree(lamps(2, 20), kOpen);
    std::vector<LitPoint> points = floor_at(0, 2);
    points[1].region = 1;
    const Reaches slit = [&](const Light& light, const LitPoint& point, uint32_t&) {
        return light.position.x > 10 && point.region == 0 ? 0.0 : 1.0;
    };
    const auto count = [&] {
        return cut_lights(tree, points, find_shares(tree, points, slit, 0), 2, slit, 0)[0].size();
    };
    // Two lamps joined are found together; make them strangers.
    std::vector<Light> strangers = lamps(2, 20);
    strangers[1].shadow = false;
    const LightTree apart = make_light_tree(strangers, kOpen);
    const auto count_apart = [&] {
        return cut_lights(apart, points, find_shares(apart, points, slit, 0), 2, slit, 0)[0].size();
    };
    EXPECT_EQ(count(), 2u);
    EXPECT_EQ(count_apart(), 1u);
    points[0].beside = {1};
    EXPECT_EQ(count_apart(), 2u);
}

TEST(LightCut, IsTheSameOnAnyNumberOfThreads) {
    const LightTree tree = make_light_tree(lamps(200, 0.3), kOpen);
    std::vector<LitPoint> points;
    for (uint32_t region = 0; region < 12; ++region) {
        const std::vector<LitPoint> some = floor_at(region * 6.0 - 9, 40, region);
        points.insert(points.end(), some.begin(), some.end());
    }
    const auto all = [&] {
        return cut_lights(tree, points, find_shares(tree, points, kEverywhere, 1), 12, kEverywhere,
                          1);
    };
    const LightCut many = all();
    const ThreadLimit one(1);
    EXPECT_EQ(many, all());
}
