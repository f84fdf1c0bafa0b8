// SPDX-License-Identifier: GPL-3.0-or-later
// Guards hair: tubes that are closed, as wide as their strands, and never more than is needed.
#include "geometry/strand_tubes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

using namespace lodestone;

namespace {

Mesh tubes(const std::vector<glm::vec3>& points, const std::vector<float>& radii,
           const std::vector<uint32_t>& counts, const std::vector<uint16_t>& slots = {},
           const std::vector<glm::vec2>& uvs = {}) {
    return tubes_of({points, radii, counts, slots, uvs});
}

/// A quarter of a circle of radius 1 in `count` points.
std::vector<glm::vec3> bow(int count) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < count; ++i) {
        const double angle = std::numbers::pi / 2 * i / (count - 1);
        points.emplace_back(std::cos(angle), 0, std::sin(angle));
    }
    return points;
}

double volume(const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        sum += glm::dot(
            a, glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z])));
    }
    return sum / 6;
}

}  // namespace

TEST(HairStrands, NothingGivesNothing) {
    EXPECT_TRUE(tubes({}, {}, {}).empty());
    EXPECT_TRUE(tubes({}, {}, {0, 0}).empty());
    EXPECT_TRUE(tubes({{1, 2, 3}}, {0.1f}, {1}).empty());
}

TEST(HairStrands, OneSegmentIsAClosedPrism) {
    const Mesh mesh = tubes({{0, 0, 0}, {0, 0, 2}}, {0.1f, 0.1f}, {2});
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_TRUE(closed(mesh));
    EXPECT_TRUE(mesh.slots.empty());
    EXPECT_GT(volume(mesh), 0);  // faces look outwards
    check(mesh);
}

TEST(HairStrands, MantleIsAsLargeAsTheRoundTubes) {
    // Cauchy: equal perimeter, equal mean width over all directions.
    const Mesh mesh = tubes({{0, 0, 0}, {0, 0, 2}}, {0.1f, 0.1f}, {2});
    double mantle = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec3 area = area_vector(mesh, t);
        if (std::abs(area.z) < 1e-6)
            mantle += 0.5 * glm::length(area);
    }
    EXPECT_NEAR(mantle, 2 * std::numbers::pi * 0.1 * 2, 1e-5);
}

TEST(HairStrands, TipWithoutRadiusIsAPoint) {
    const Mesh mesh = tubes({{0, 0, 0}, {0, 0, 1}}, {0.1f, 0}, {2});
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_TRUE(closed(mesh));
    EXPECT_GT(volume(mesh), 0);
    const Mesh both = tubes({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, {0, 0.1f, 0}, {3});
    EXPECT_EQ(both.triangles.size(), 6u);
    EXPECT_TRUE(closed(both));
    EXPECT_GT(volume(both), 0);
}

TEST(HairStrands, HairWasShadedAsIfItTurnedToItsTip) {
    const Mesh mesh = tubes({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, {0, 0.1f, 0}, {3});
    for (const glm::vec3& normal : mesh.normals)
        EXPECT_NEAR(normal.z, 0, 1e-6);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {  // and stands in the middle of its side
        const glm::dvec3 outward = glm::normalize(area_vector(mesh, t));
        double turned = -1;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 normal(mesh.normals[mesh.triangles[t][corner]]);
            turned = std::max(turned, glm::dot(normal, outward));
        }
        EXPECT_GT(turned, 0.99);
    }
}

TEST(HairStrands, StraightRunsCostOneSegmentAndBendsAreKept) {
    std::vector<glm::vec3> line;
    std::vector<float> taper;
    for (int i = 0; i < 9; ++i) {
        line.emplace_back(0.1f * static_cast<float>(i), 0, 0);
        taper.push_back(0.01f * (1 - static_cast<float>(i) / 8));
    }
    EXPECT_EQ(tubes(line, taper, {9}).triangles.size(), 4u);
    const Mesh bent = tubes(bow(33), std::vector<float>(33, 0.01f), {33});
    EXPECT_TRUE(closed(bent));
    EXPECT_GT(bent.triangles.size(), 60u);
    EXPECT_LE(bent.triangles.size(), 32u * 6 + 2);
    for (const glm::vec3& p : bent.positions)
        EXPECT_NEAR(glm::length(p), 1, 0.0135);  // widened, and the straightened runs
    const Mesh few = tubes(bow(5), std::vector<float>(5, 0.01f), {5});
    for (const glm::vec3& p : few.positions)  // nearly as round as through 33 points
        EXPECT_NEAR(glm::length(p), 1, 0.025);
    EXPECT_GT(few.triangles.size(), 4u * 6 + 2);
    for (const glm::vec3& n : bent.normals)
        EXPECT_NEAR(glm::length(n), 1, 1e-5);
}

TEST(HairStrands, EachStrandHasItsSlotAndTheUvOfItsRoot) {
    const std::vector<glm::vec3> points{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}};
    const Mesh mesh = tubes(points, {.1f, .1f, .1f, .1f}, {2, 2}, {0, 3});
    ASSERT_EQ(mesh.slots.size(), 16u);
    EXPECT_EQ(mesh.slots[0], 0);
    EXPECT_EQ(mesh.slots[15], 3);
    const Mesh colored =
        tubes(points, {.1f, .1f, .1f, .1f}, {2, 2}, {}, {{0.25f, 0.5f}, {0.75f, 1}});
    ASSERT_EQ(colored.uvs.size(), colored.positions.size());
    EXPECT_EQ(colored.uvs.front(), glm::vec2(0.25f, 0.5f));
    EXPECT_EQ(colored.uvs[6], glm::vec2(0.75f, 1));
    // What draws nothing takes nobody's place
    const Mesh second = tubes(points, {0, 0, .1f, .1f}, {2, 2}, {}, {{0.25f, 0.5f}, {0.75f, 1}});
    EXPECT_EQ(second.uvs, std::vector<glm::vec2>(6, {0.75f, 1}));
}

TEST(HairStrands, ArraysThatDoNotFitAreRefused) {
    EXPECT_THROW(tubes({{0, 0, 0}}, {}, {1}), Error);
    EXPECT_THROW(tubes({{0, 0, 0}}, {1}, {2}), Error);
    EXPECT_THROW(tubes({{0, 0, 0}}, {1}, {4294967295u, 2}), Error);
    EXPECT_THROW(tubes({{0, 0, 0}}, {1}, {1}, {0, 0}), Error);
    EXPECT_THROW(tubes({{0, 0, 0}}, {1}, {1}, {}, {{0, 0}, {1, 1}}), Error);
}

TEST(HairStrands, BrokenPointsAreLeftOutAndTheRestIsDrawn) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const Mesh mesh = tubes({{0, 0, 0}, {nan, 0, 0}, {0, 0, 1}, {0, infinity, 0}, {0, 0, 1}},
                            {.1f, .1f, nan, .1f, .1f}, {5});
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_TRUE(closed(mesh));
    EXPECT_TRUE(tubes({{0, 0, 0}, {0, 0, 1}}, {-1, 0}, {2}).empty());
    EXPECT_TRUE(tubes({{0, 0, 0}, {0, 0, 0}}, {1, 1}, {2}).empty());
    // There and back again: no way to look along at the turn, none between its ends.
    const Mesh back = tubes({{0, 0, 0}, {0, 0, 1}, {0, 0, 0}}, {.1f, .1f, .1f}, {3});
    EXPECT_GE(back.triangles.size(), 14u);
    for (const glm::vec3& n : back.normals)
        EXPECT_NEAR(glm::length(n), 1, 1e-5);
}

TEST(HairStrands, AHundredThousandHairs) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < 100000; ++i) {
        for (const glm::vec3& p : bow(5))
            points.push_back(p + glm::vec3(0, 0.01f * static_cast<float>(i), 0));
    }
    const Mesh mesh =
        tubes(points, std::vector<float>(points.size(), 0.001f), std::vector<uint32_t>(100000, 5));
    EXPECT_GT(mesh.triangles.size(), 100000u * (4 * 6 + 2));
    EXPECT_LE(mesh.triangles.size(), 100000u * (16 * 6 + 2));
}
