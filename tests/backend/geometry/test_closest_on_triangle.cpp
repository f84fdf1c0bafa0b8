// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that four triangles looked at together give what one after the other does.
#include "geometry/closest_on_triangle.h"

#include <bit>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

using namespace lodestone;
using namespace lodestone::geometry;

namespace {

/// Corners on a coarse lattice: points lie on edges, at corners and inside, some triangles have no
/// area.
std::vector<TrianglePoints> lattice_triangles(std::mt19937& random, size_t count) {
    std::uniform_int_distribution<int> number(-2, 2);
    std::vector<TrianglePoints> triangles(count);
    for (TrianglePoints& corners : triangles) {
        for (glm::vec3& corner : corners)
            corner = glm::vec3(number(random), number(random), number(random));
    }
    return triangles;
}

bool same_bits(float a, float b) {
    return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

}  // namespace

TEST(NearestOnTriangle, ManyTrianglesGiveWhatOneAfterTheOtherDoes) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> number(-6, 6);
    for (int round = 0; round < 5000; ++round) {
        const size_t count = static_cast<size_t>(round) % 10;
        const std::vector<TrianglePoints> triangles = lattice_triangles(random, count);
        const glm::vec3 point = 0.5f * glm::vec3(number(random), number(random), number(random));
        std::vector<uint32_t> ring(count);
        std::iota(ring.begin(), ring.end(), 0u);
        TriangleSpot together;
        nearest_of_triangles(
            ring, point, [&](uint32_t t) { return triangles[t]; }, together);
        TriangleSpot single;
        for (const uint32_t t : ring) {
            TriangleSpot spot = nearest_spot(triangles[t], point);
            spot.triangle = t;
            if (spot.square < single.square)
                single = spot;
        }
        ASSERT_EQ(together.triangle, single.triangle) << round;
        ASSERT_TRUE(same_bits(together.square, single.square)) << round;
        for (int k = 0; k < 3; ++k)
            ASSERT_EQ(together.weights[k], single.weights[k]) << round;
    }
}

TEST(NearestOnTriangle, NothingFartherThanTheBestIsTaken) {
    const TrianglePoints corners{glm::vec3(0, 0, 1), glm::vec3(1, 0, 1), glm::vec3(0, 1, 1)};
    const std::vector<uint32_t> ring{3, 4, 5, 6, 7};
    TriangleSpot best{0.5f, 9, glm::vec3(1, 0, 0)};
    nearest_of_triangles(
        ring, glm::vec3(0.0f), [&](uint32_t) { return corners; }, best);
    EXPECT_EQ(best.triangle, 9u);
    best.square = 2;
    nearest_of_triangles(
        ring, glm::vec3(0.0f), [&](uint32_t) { return corners; }, best);
    EXPECT_EQ(best.triangle, 3u);  // the first of those that are equally near
}
