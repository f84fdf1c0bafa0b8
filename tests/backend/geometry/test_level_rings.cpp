// SPDX-License-Identifier: GPL-3.0-or-later
// Guards outlines of grids: areas with known answers, closed rings, borders.
#include "geometry/level_rings.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {
namespace {

constexpr size_t kAny = 1'000'000;  // Law: no limit to these.

std::vector<float> filled(int width, int height, const std::function<double(int, int)>& value) {
    std::vector<float> out;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            out.push_back(static_cast<float>(value(x, y)));
    }
    return out;
}

double area_of(const std::vector<Ring>& rings) {
    double sum = 0;
    for (const Ring& ring : rings)
        sum += signed_area(ring);
    return sum;
}

std::vector<uint8_t> all(const LevelGrid& grid) {
    return std::vector<uint8_t>(static_cast<size_t>(grid.width() * grid.height()), 1);
}

std::vector<Ring> rings(const LevelGrid& grid, double level) {
    bool too_many = true;
    std::vector<Ring> out = grid.rings(level, kAny, too_many);
    EXPECT_FALSE(too_many);
    return out;
}

/// A smooth edge of a disk, a texel wide.
double disk(double x, double y, double cx, double cy, double radius) {
    return std::clamp(radius - std::hypot(x + 0.5 - cx, y + 0.5 - cy) + 0.5, 0.0, 1.0);
}

TEST(LevelRings, NothingHasNoOutline) {
    const LevelGrid grid(5, 3, std::vector<float>(15, 0.0f), true);
    EXPECT_TRUE(rings(grid, 0.5).empty());
    EXPECT_EQ(grid.area(0.5, all(grid)), 0);
}

TEST(LevelRings, OneFullTexelIsItsSquare) {
    const LevelGrid grid(1, 1, {1.0f}, false);
    const std::vector<Ring> found = rings(grid, 0.5);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(signed_area(found[0]), 1);
    for (const glm::dvec2& at : found[0])
        EXPECT_TRUE(at.x == 0 || at.x == 1 || at.y == 0 || at.y == 1);
}

TEST(LevelRings, AHalfFullRowEndsHalfWayBetweenTexels) {
    // Rows run from the top: the upper one is full, so that y from 1 to 2 is inside.
    const LevelGrid grid(4, 2, filled(4, 2, [](int, int y) { return y == 0 ? 1 : 0; }), false);
    const std::vector<Ring> found = rings(grid, 0.5);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(signed_area(found[0]), 4, 1e-12);
    for (const glm::dvec2& at : found[0])
        EXPECT_GE(at.y, 1);
    EXPECT_NEAR(grid.area(0.5, all(grid)), 4, 1e-12);
}

TEST(LevelRings, ADiskHasItsAreaAndRadius) {
    const LevelGrid grid(
        64, 64, filled(64, 64, [](int x, int y) { return disk(x, y, 30, 34, 20); }), false);
    const std::vector<Ring> found = rings(grid, 0.5);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(signed_area(found[0]), std::numbers::pi * 400, 2);
    for (const glm::dvec2& at : found[0])
        EXPECT_NEAR(std::hypot(at.x - 30, at.y - 30), 20, 0.1);  // y = 64 - 34
}

TEST(LevelRings, AHoleTurnsTheOtherWay) {
    const LevelGrid grid(
        64, 64,
        filled(64, 64,
               [](int x, int y) { return disk(x, y, 32, 32, 25) - disk(x, y, 32, 32, 10); }),
        false);
    const std::vector<Ring> found = rings(grid, 0.5);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_LT(signed_area(found[0]) * signed_area(found[1]), 0);
    EXPECT_NEAR(area_of(found), std::numbers::pi * (625 - 100), 3);
}

TEST(LevelRings, AreaIsThatOfTheRingsAtEveryLevel) {
    // Numbers without order have saddles, joined and apart.
    uint32_t state = 1;
    const LevelGrid grid(40, 30,
                         filled(40, 30,
                                [&](int, int) {
                                    state = state * 1664525u + 1013904223u;
                                    return (state >> 8u) / 16777216.0;
                                }),
                         true);
    for (const double level : {0.1, 0.37, 0.5, 0.63, 0.9})
        EXPECT_NEAR(area_of(rings(grid, level)), grid.area(level, all(grid)), 1e-6) << level;
}

TEST(LevelRings, TheLevelOfAnAreaHasThatArea) {
    const LevelGrid grid(64, 64,
                         filled(64, 64,
                                [](int x, int y) {
                                    return std::clamp(1.2 - std::hypot(x - 31.5, y - 31.5) / 30,
                                                      0.0, 1.0);
                                }),
                         false);
    for (const double wanted : {300.0, 1000.0, 2000.0})
        EXPECT_NEAR(grid.area(grid.level_of(wanted, all(grid)), all(grid)), wanted, 10);
}

TEST(LevelRings, ADiskOverTheSeamOfARepeatedPictureFitsTogether) {
    const auto wrapped = [](int x, int y) {
        double most = 0;
        for (const int cx : {0, 64})
            most = std::max(most, disk(x, y, cx, 32, 20));
        return most;
    };
    const std::vector<Ring> found = rings(LevelGrid(64, 64, filled(64, 64, wrapped), true), 0.5);
    EXPECT_EQ(found.size(), 2u);
    EXPECT_NEAR(area_of(found), std::numbers::pi * 400, 2);
    // Both halves meet the border at the same heights.
    std::vector<double> heights[2];
    for (const Ring& ring : found) {
        for (const glm::dvec2& at : ring) {
            if (at.x == 0 || at.x == 64)
                heights[at.x == 0 ? 0 : 1].push_back(at.y);
        }
    }
    for (std::vector<double>& side : heights)
        std::sort(side.begin(), side.end());
    EXPECT_GT(heights[0].size(), 2u);
    EXPECT_EQ(heights[0], heights[1]);
}

TEST(LevelRings, NoiseIsTooMuch) {
    const LevelGrid grid(64, 64, filled(64, 64, [](int x, int y) { return (x + y) % 2; }), true);
    bool too_many = false;
    EXPECT_TRUE(grid.rings(0.4, 1000, too_many).empty());
    EXPECT_TRUE(too_many);
}

}  // namespace
}  // namespace lodestone
