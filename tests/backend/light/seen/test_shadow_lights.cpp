// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which lights' shadows are looked for from a place, and where on a light rays end.
#include "light/seen/shadow_lights.h"

#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using namespace lodestone::light;

namespace {

const glm::dvec3 kOrigin(0.0);
const glm::dvec3 kAllSides(0.0);

Light sun(double power) {
    Light out;
    out.power = power;
    return out;
}

/// A lamp that sends 1 W/m^2 to what is one metre away.
Light lamp(const glm::dvec3& position, double times = 1) {
    Light out;
    out.kind = LightKind::Point;
    out.position = position;
    out.power = 4 * kPi * times;
    return out;
}

/// How often each of the lights is picked for the origin.
std::vector<int> picked(const std::vector<Light>& lights, const glm::dvec3& normal, int times,
                        std::span<const uint32_t> among = {}) {
    const std::vector<ShadowLight> all = shadow_lights(lights);
    LightPicker picker(all);
    PcgRandom random(1);
    std::vector<int> out(all.size(), 0);
    for (int i = 0; i < times; ++i) {
        for (const uint32_t number : picker.pick(glm::dvec3(0.0), normal, among, random))
            ++out[number];
    }
    return out;
}

}  // namespace

TEST(ShadowLights, OfNoneNoneIsPicked) {
    EXPECT_TRUE(shadow_lights({}).empty());
    EXPECT_TRUE(picked({}, kAllSides, 3).empty());
    Light clear = sun(1);
    clear.shadow = false;
    Light broken = lamp({std::numeric_limits<double>::quiet_NaN(), 0, 0});
    EXPECT_TRUE(shadow_lights(std::vector<Light>{clear, broken, sun(0)}).empty());
}

TEST(ShadowLights, OneIsAlwaysPickedAndOnce) {
    EXPECT_EQ(picked({sun(-2)}, kAllSides, 5), std::vector<int>{5});  // takes light away
    EXPECT_EQ(picked({lamp({0, 0, 3})}, {0, 0, 1}, 5), std::vector<int>{5});
    EXPECT_EQ(picked({lamp({0, 0, -3})}, {0, 0, 1}, 5), std::vector<int>{0});
}

TEST(ShadowLights, LightIsThatOfTheSquareOfTheDistance) {
    const std::vector<Light> lights = {sun(3), lamp({0, 0, 2}, 8)};
    const std::vector<ShadowLight> all = shadow_lights(lights);
    EXPECT_NEAR(arriving(all[0], kOrigin, kAllSides), 3, 1e-12);
    EXPECT_NEAR(arriving(all[1], kOrigin, kAllSides), 2, 1e-12);
    EXPECT_NEAR(arriving(all[1], {0, 0, 1}, kAllSides), 8, 1e-12);
    const glm::dvec3 aslant(std::sqrt(0.75), 0, 0.5);
    EXPECT_NEAR(arriving(all[1], kOrigin, aslant), 1, 1e-12);
    Light area = lamp({0, 0, 2});
    area.kind = LightKind::Area;  // shines down
    EXPECT_GT(arriving(shadow_lights(std::span(&area, 1))[0], kOrigin, kAllSides), 0);
    EXPECT_EQ(arriving(shadow_lights(std::span(&area, 1))[0], {0, 0, 4}, kAllSides), 0);
    Light spot = area;
    spot.kind = LightKind::Spot;
    spot.spot_size = kPi / 2;
    EXPECT_GT(arriving(shadow_lights(std::span(&spot, 1))[0], {1, 0, 0}, kAllSides), 0);
    EXPECT_EQ(arriving(shadow_lights(std::span(&spot, 1))[0], {3, 0, 0}, kAllSides), 0);
}

TEST(ShadowLights, TheStrongestIsPickedAndOfTheOthersTheStronger) {
    const std::vector<Light> lights = {lamp({0, 0, 1}, 0.1), lamp({0, 0, 1}, 1),
                                       lamp({0, 0, 1}, 0.3)};
    const std::vector<int> found = picked(lights, kAllSides, 4000);
    EXPECT_EQ(found[1], 4000);
    EXPECT_EQ(found[0] + found[2], 4000);
    EXPECT_NEAR(found[2], 3000, 200);
    const std::vector<uint32_t> among = {0, 2};
    EXPECT_EQ(picked(lights, kAllSides, 100, among), (std::vector<int>{100, 0, 100}));
}

TEST(ShadowLights, FaintOnesAreSeldomPicked) {
    const std::vector<int> found = picked({sun(1), lamp({0, 0, 1}, 0.001)}, kAllSides, 10000);
    EXPECT_EQ(found[0], 10000);
    EXPECT_NEAR(found[1], 160, 60);
}

TEST(ShadowLights, RaysEndOnTheLight) {
    PcgRandom random(2);
    Light area = lamp({0, 0, 5});
    area.kind = LightKind::Area;
    area.edge_u = {2, 0, 0};
    area.edge_v = {0, 4, 0};
    Light ball = lamp({0, 0, 5});
    ball.radius = 0.5;
    Light disk = sun(1);
    disk.angle = 0.2;
    const std::vector<Light> lights = {area, ball, disk};
    const std::vector<ShadowLight> all = shadow_lights(lights);
    const Light& round = lights[1];
    for (int i = 0; i < 200; ++i) {
        WayToLight way = way_to(all[0], {1, 1, 0}, random);
        const glm::dvec3 on_area = glm::dvec3(1, 1, 0) + way.length * way.direction;
        EXPECT_NEAR(on_area.z, 5, 1e-9);
        EXPECT_LE(std::abs(on_area.x), 1 + 1e-9);
        EXPECT_LE(std::abs(on_area.y), 2 + 1e-9);
        way = way_to(all[1], {1, 1, 0}, random);
        EXPECT_LE(glm::length(glm::dvec3(1, 1, 0) + way.length * way.direction - round.position),
                  0.5 + 1e-9);
        way = way_to(all[2], {1, 1, 0}, random);
        EXPECT_EQ(way.length, kInfinity);
        EXPECT_GE(way.direction.z, std::cos(0.1) - 1e-9);
    }
    ball.radius = 0;
    const std::vector<Light> points = {ball};
    EXPECT_EQ(way_to(shadow_lights(points)[0], ball.position, random).length, 0);
}
