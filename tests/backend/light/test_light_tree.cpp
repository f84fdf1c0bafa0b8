// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the tree of lamps: energy, what may be joined, walls, determinism, hostile numbers.
#include "base/parallel.h"
#include "base/random.h"
#include "light/light_arrival.h"
#include "light/light_tree.h"

#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <set>

using namespace lodestone;
using namespace lodestone::light;

namespace {

const Clear kOpen = [](const glm::dvec3&, const glm::dvec3&) { return true; };

Light point(const glm::dvec3& position, double power = 1, const glm::dvec3& color = {1, 1, 1}) {
    Light light;
    light.kind = LightKind::Point;
    light.position = position;
    light.power = power;
    light.color = color;
    return light;
}

std::vector<Light> scattered(size_t count) {
    PcgRandom random(3);
    std::vector<Light> lights;
    for (size_t i = 0; i < count; ++i)
        lights.push_back(
            point({random.uniform() * 100, random.uniform() * 80, random.uniform() * 9},
                  1 + random.uniform(), {1, random.uniform(), random.uniform()}));
    return lights;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double within) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], within);
}

}  // namespace

TEST(LightTree, NoLampsMakeNoTree) {
    const LightTree tree = make_light_tree({}, kOpen);
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_TRUE(tree.roots.empty());
}

TEST(LightTree, TwoLampsBecomeOneAtTheirCentroidOfEnergy) {
    const std::vector<Light> lights{point({0, 0, 0}, 1, {1, 0, 0}), point({4, 0, 0}, 1, {1, 0, 0}),
                                    point({100, 0, 0}, 8, {0, 0.25, 0})};
    const LightTree tree = make_light_tree(lights, kOpen);
    ASSERT_EQ(tree.nodes.size(), 5u);
    EXPECT_EQ(tree.roots, std::vector<uint32_t>{4});
    expect_near(tree.nodes[3].light.position, {2, 0, 0}, 1e-12);
    expect_near(energy_of(tree.nodes[3].light), {2, 0, 0}, 0);
    expect_near(energy_of(tree.nodes[4].light), {2, 2, 0}, 0);
    const double red = 2 * 0.2126;
    const double green = 2 * 0.7152;
    EXPECT_NEAR(tree.nodes[4].light.position.x, (2 * red + 100 * green) / (red + green), 1e-9);
}

TEST(LightTree, EveryNodeHasExactlyTheEnergyOfItsLamps) {
    const std::vector<Light> lights = scattered(500);
    const LightTree tree = make_light_tree(lights, kOpen);
    ASSERT_EQ(tree.roots.size(), 1u);
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
        glm::dvec3 sum(0.0);
        for (const uint32_t lamp : tree.lamps(i))
            sum += energy_of(lights[lamp]);
        expect_near(energy_of(tree.nodes[i].light), sum, 1e-12 * sum.x);
    }
    const std::set<uint32_t> all(tree.order.begin(), tree.order.end());
    EXPECT_EQ(all.size(), lights.size());
}

TEST(LightTree, SeenFromAfarAJoinedLightIsItsLamps) {
    Light area;
    area.kind = LightKind::Area;
    area.position = {0, 0, 3};
    area.edge_u = {0.6, 0, 0};
    area.edge_v = {0, 0.6, 0};
    area.power = 10;
    Light spot = point({0, 0, 3}, 10);
    spot.kind = LightKind::Spot;
    for (const Light& kind : {area, spot, point({0, 0, 3}, 10)}) {
        std::vector<Light> lights(4, kind);
        for (size_t i = 0; i < 4; ++i) {
            const size_t row = i / 2;
            lights[i].position += glm::dvec3(i % 2, row, 0);
        }
        const LightTree tree = make_light_tree(lights, kOpen);
        ASSERT_EQ(tree.roots.size(), 1u);
        const glm::dvec3 from{0.5, 0.5, -200};
        glm::dvec3 sum(0.0);
        for (const Light& light : lights)
            sum += light_arrival(light, from, {0, 0, 1}).surface;
        EXPECT_GT(sum.x, 0);
        expect_near(light_arrival(tree.nodes.back().light, from, {0, 0, 1}).surface / sum.x,
                    {1, 1, 1}, 1e-3);
    }
}

TEST(LightTree, AreasTogetherAreAsLargeAsTheirSecondMoments) {
    Light left;
    left.kind = LightKind::Area;
    Light right = left;
    left.position = {-0.5, 0, 0};
    right.position = {0.5, 0, 0};
    const Light both = joined_light(left, right);  // two squares side by side
    EXPECT_NEAR(glm::length(both.edge_u), 2, 1e-12);
    EXPECT_NEAR(glm::length(both.edge_v), 1, 1e-12);
    expect_near(both.position, {0, 0, 0}, 1e-12);
}

TEST(LightTree, OnlyLampsThatShineAlikeAreJoined) {
    Light sun;
    Light up = point({0, 0, 0});
    up.kind = LightKind::Spot;
    up.direction = {0, 0, 1};
    Light down = up;
    down.direction = {0, 0, -1};
    Light narrow = up;
    narrow.spot_size = 0.1;
    Light dark = point({0, 0, 0}, -3);
    Light shadowless = point({0, 0, 0});
    shadowless.shadow = false;
    const std::vector<Light> lights{sun,       sun, up, down, narrow, dark, dark, point({0, 0, 0}),
                                    shadowless};
    const LightTree tree = make_light_tree(lights, kOpen);
    EXPECT_EQ(tree.nodes.size(), lights.size());
    EXPECT_EQ(tree.roots.size(), lights.size());
}

TEST(LightTree, AWallPartsWhatIsOnBothSidesOfIt) {
    // Rooms of 4 m along x: pairs of lamps on both sides of a wall are nearer than those of a room.
    std::vector<Light> lights;
    for (int room = 0; room < 20; ++room) {
        for (const double x : {0.2, 3.8})
            lights.push_back(point({4.0 * room + x, 0, 0}));
    }
    const Clear walls = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::floor(a.x / 4) == std::floor(b.x / 4);
    };
    const LightTree tree = make_light_tree(lights, walls);
    EXPECT_EQ(tree.roots.size(), 20u);
    for (const LightNode& node : tree.nodes)
        EXPECT_EQ(std::floor(node.box.low.x / 4), std::floor(node.box.high.x / 4));
    EXPECT_EQ(make_light_tree(lights, kOpen).roots.size(), 1u);
}

TEST(LightTree, ALampShadedFromAllOthersStaysAlone) {
    std::vector<Light> lights = scattered(50);
    const glm::dvec3 shaded = lights[17].position;
    const Clear clear = [&](const glm::dvec3& a, const glm::dvec3& b) {
        return a != shaded && b != shaded;
    };
    const LightTree tree = make_light_tree(lights, clear);
    EXPECT_EQ(tree.roots.front(), 17u);
    EXPECT_EQ(tree.roots.size(), 2u);
}

TEST(LightTree, IsTheSameOnAnyNumberOfThreadsAndEveryTime) {
    const std::vector<Light> lights = scattered(300);
    const LightTree once = make_light_tree(lights, kOpen);
    const ThreadLimit one(1);
    const LightTree again = make_light_tree(lights, kOpen);
    EXPECT_EQ(once.order, again.order);
    ASSERT_EQ(once.nodes.size(), again.nodes.size());
    for (size_t i = 0; i < once.nodes.size(); ++i)
        EXPECT_EQ(once.nodes[i].light.position, again.nodes[i].light.position);
}

TEST(LightTree, NonsenseStaysAloneAndDoesNotSpread) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    std::vector<Light> lights{
        point({0, 0, 0}, nan), point({nan, 0, 0}),         point({0, infinite, 0}),
        point({0, 0, 0}, 0),   point({0, 0, 0}, infinite), point({1, 0, 0}),
        point({2, 0, 0})};
    Light flat;
    flat.kind = LightKind::Area;
    flat.edge_v = flat.edge_u;
    Light lost = flat;
    lost.edge_v = {0, 1, 0};
    lost.direction = {0, 0, 0};
    lights.push_back(flat);
    lights.push_back(lost);
    const LightTree tree = make_light_tree(lights, kOpen);
    ASSERT_EQ(tree.nodes.size(), lights.size() + 1);
    expect_near(tree.nodes.back().light.position, {1.5, 0, 0}, 1e-12);
    // Powers whose sum is too large are not summed.
    const std::vector<Light> huge{point({0, 0, 0}, 1e308), point({1, 0, 0}, 1e308)};
    EXPECT_EQ(make_light_tree(huge, kOpen).roots.size(), 2u);
}

TEST(LightTree, TenThousandLampsAreJoinedAlsoWhereAllAreInOnePlace) {
    EXPECT_EQ(make_light_tree(scattered(10000), kOpen).roots.size(), 1u);
    const LightTree one_place = make_light_tree(std::vector<Light>(10000, point({3, 4, 5})), kOpen);
    ASSERT_EQ(one_place.roots.size(), 1u);
    expect_near(energy_of(one_place.nodes.back().light), {1e4, 1e4, 1e4}, 1e-8);
    expect_near(one_place.nodes.back().light.position, {3, 4, 5}, 1e-9);
}

TEST(LightArrival, KnownAnswers) {
    const double pi = std::numbers::pi;
    const Light lamp = point({0, 0, 2}, 4 * pi * pi);
    EXPECT_NEAR(light_arrival(lamp, {0, 0, 0}, {0, 0, 1}).surface.x, 0.25, 1e-9);
    EXPECT_EQ(light_arrival(lamp, {0, 0, 0}, {0, 0, -1}).surface.x, 0);
    Light spot = lamp;
    spot.kind = LightKind::Spot;
    spot.spot_size = pi / 2;
    EXPECT_NEAR(light_arrival(spot, {0, 0, 0}, {0, 0, 1}).surface.x, 0.25, 1e-9);
    EXPECT_EQ(light_arrival(spot, {2.1, 0, 0}, {0, 0, 1}).surface.x, 0);
    Light area;
    area.kind = LightKind::Area;
    area.position = {0, 0, 100};
    area.power = 4 * pi * 1e4;
    EXPECT_NEAR(light_arrival(area, {0, 0, 0}, {0, 0, 1}).surface.x, 1, 1e-3);
    EXPECT_NEAR(display_step(0), 1 / (255 * 12.92), 1e-12);
    EXPECT_NEAR(display_step(5), 2.4 / (255 * 1.055), 1e-12);
}
