// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the order along a curve in which meshes are collapsed, and scratch memory.
#include "base/random.h"
#include "base/scratch.h"
#include "geometry/morton_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <set>

using namespace lodestone;
using geometry::morton_order;

namespace {

std::vector<glm::vec3> lattice(uint32_t n) {
    std::vector<glm::vec3> points;
    for (uint32_t x = 0; x < n; ++x) {
        for (uint32_t y = 0; y < n; ++y)
            points.emplace_back(x, y, 0);
    }
    return points;
}

double length_along(const std::vector<glm::vec3>& points, const std::vector<uint32_t>& order) {
    double sum = 0;
    for (size_t i = 1; i < order.size(); ++i)
        sum += glm::length(glm::dvec3(points[order[i]] - points[order[i - 1]]));
    return sum;
}

TEST(Curve, NoPointsHaveNoOrder) {
    std::vector<uint32_t> first{7};
    EXPECT_TRUE(morton_order({}, first).empty());
    EXPECT_TRUE(first.empty());
}

TEST(Curve, EveryPlaceIsThereOnceByItsFirstPoint) {
    const std::vector<glm::vec3> points{{1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {-0.0f, 0, 0}, {1, 2, 3}};
    std::vector<uint32_t> first;
    EXPECT_EQ(morton_order(points, first), (std::vector<uint32_t>{1, 0}));
    EXPECT_EQ(first, (std::vector<uint32_t>{0, 1, 0, 1, 0}));
}

TEST(Curve, NeighborsInTheOrderLieNear) {
    std::vector<glm::vec3> points = lattice(64);
    PcgRandom random(5);
    for (size_t i = points.size(); i > 1; --i)
        std::swap(points[i - 1],
                  points[static_cast<size_t>(random.uniform() * static_cast<double>(i))]);
    std::vector<uint32_t> shuffled(points.size());
    std::iota(shuffled.begin(), shuffled.end(), 0u);
    std::vector<uint32_t> first;
    const std::vector<uint32_t> order = morton_order(points, first);
    EXPECT_EQ(std::set<uint32_t>(order.begin(), order.end()).size(), points.size());
    EXPECT_LT(length_along(points, order), 2.0 * static_cast<double>(points.size()));
    EXPECT_GT(length_along(points, shuffled), 20.0 * static_cast<double>(points.size()));
}

TEST(Curve, PointsThatAreNowhereStandForThemselvesAndHaveNoPlace) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float most = std::numeric_limits<float>::max();
    const std::vector<glm::vec3> points{{nan, 0, 0}, {most, 0, 0}, {-most, most, 0}, {nan, 0, 0}};
    std::vector<uint32_t> first;
    EXPECT_EQ(morton_order(points, first).size(), 2u);
    EXPECT_EQ(first, (std::vector<uint32_t>{0, 1, 2, 3}));
}

TEST(Curve, ManyPointsInOneCellOfItAreStillToldApart) {
    // All but one within a millionth of what the curve can see.
    std::vector<glm::vec3> points = lattice(40);
    for (glm::vec3& point : points)
        point *= 1e-9f;
    points.emplace_back(1, 1, 1);
    const size_t distinct = points.size();
    points.insert(points.end(), points.begin(), points.end());
    std::vector<uint32_t> first;
    EXPECT_EQ(morton_order(points, first).size(), distinct);
    for (uint32_t i = 0; i < distinct; ++i) {
        EXPECT_EQ(first[i], i);
        EXPECT_EQ(first[distinct + i], i);
    }
}

TEST(ScratchArena, WithoutOneVectorsAreAsOthers) {
    EXPECT_EQ(ScratchArena::current(), nullptr);
    ScratchVector<uint32_t> numbers(1000, 7);
    numbers.resize(2000, 8);
    EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0u), 15000u);
}

TEST(ScratchArena, VectorsThatGrowKeepWhatTheyHave) {
    for (const size_t expected : {size_t{0}, size_t{1000}, size_t{64} << 20u}) {
        const ScratchArena scratch(expected);
        ScratchVector<uint32_t> numbers[3];
        for (uint32_t i = 0; i < 30000; ++i)
            numbers[i % 3].push_back(i);
        for (uint32_t i = 0; i < 30000; ++i)
            ASSERT_EQ(numbers[i % 3][i / 3], i);
        for (const ScratchVector<uint32_t>& each : numbers)
            EXPECT_EQ(reinterpret_cast<uintptr_t>(each.data()) % 64, 0u);
    }
}

TEST(ScratchArena, WhatIsGivenBackIsUsedAgain) {
    ScratchArena scratch(1 << 20);
    void* const first = scratch.take(1000);
    void* const second = scratch.take(3000);
    void* const third = scratch.take(64);
    scratch.give_back(first, 1000);
    EXPECT_EQ(scratch.take(500), first);
    scratch.give_back(third, 64);  // the last
    EXPECT_EQ(scratch.take(5000), third);
    scratch.give_back(second, 3000);  // joins what is left of the first
    EXPECT_EQ(scratch.take(3300), static_cast<std::byte*>(first) + 512);
    EXPECT_THROW(scratch.take(~size_t{0} - 10), std::bad_alloc);
}

TEST(ScratchArena, TheInnerOfTwoIsUsed) {
    const ScratchArena outer(1000);
    EXPECT_EQ(ScratchArena::current(), &outer);
    {
        const ScratchArena inner(1000);
        EXPECT_EQ(ScratchArena::current(), &inner);
    }
    EXPECT_EQ(ScratchArena::current(), &outer);
}

}  // namespace
