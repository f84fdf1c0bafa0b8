// SPDX-License-Identifier: GPL-3.0-or-later
// Guards triangles of outlines: all of the inside once, nothing else, well shaped.
#include "geometry/ring_triangulation.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {
namespace {

Ring rectangle(double left, double low, double right, double high) {
    return {{left, low}, {right, low}, {right, high}, {left, high}};
}

Ring reversed(Ring ring) {
    std::reverse(ring.begin(), ring.end());
    return ring;
}

double area_of(const std::vector<Ring>& rings) {
    double sum = 0;
    for (const Ring& ring : rings)
        sum += signed_area(ring);
    return sum;
}

double area_of(const PlaneTriangles& found, const glm::uvec3& t) {
    const glm::dvec2 u = found.points[t.y] - found.points[t.x];
    const glm::dvec2 v = found.points[t.z] - found.points[t.x];
    return (u.x * v.y - u.y * v.x) / 2;
}

void expect_whole(const std::vector<Ring>& rings, size_t triangles) {
    const PlaneTriangles found = triangulated(rings);
    // Corners on a line between others need no triangle.
    EXPECT_LE(found.triangles.size(), triangles);
    EXPECT_GE(found.triangles.size(), triangles * 2 / 3);
    double sum = 0;
    for (const glm::uvec3& t : found.triangles) {
        EXPECT_GT(area_of(found, t), 0);
        sum += area_of(found, t);
    }
    EXPECT_NEAR(sum, area_of(rings), 1e-9 * std::abs(area_of(rings)));
    EXPECT_NEAR(found.area(), sum, 1e-9 * sum);
}

TEST(RingTriangulation, NothingIsNothing) {
    EXPECT_TRUE(triangulated({}).triangles.empty());
}

TEST(RingTriangulation, ATriangleASquareAndAnArrow) {
    expect_whole({{{0, 0}, {1, 0}, {0, 1}}}, 1);
    expect_whole({rectangle(0, 0, 2, 1)}, 2);
    expect_whole({{{0, 0}, {2, -1}, {0.5, 0.4}, {2, 2}}}, 2);
}

TEST(RingTriangulation, HolesAreLeftOut) {
    // n corners and h holes are n + 2 h - 2 triangles.
    expect_whole({rectangle(0, 0, 10, 10), reversed(rectangle(4, 4, 6, 6))}, 8);
    expect_whole({rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 3, 9)),
                  reversed(rectangle(4, 1, 6, 9)), reversed(rectangle(7, 1, 9, 9))},
                 20);
}

TEST(RingTriangulation, AnIslandInAHoleBelongsToNobodyElse) {
    expect_whole({rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 9, 9)), rectangle(2, 2, 8, 8),
                  reversed(rectangle(3, 3, 7, 7))},
                 16);
}

TEST(RingTriangulation, ACombOfManyTeethIsWholeAndRound) {
    Ring comb{{0, 0}, {200, 0}};
    for (int i = 99; i >= 0; --i) {
        comb.emplace_back(2 * i + 1.9, 10 + i % 7);
        comb.emplace_back(2 * i + 0.2, 1);
    }
    expect_whole({comb}, comb.size() - 2);
}

TEST(RingTriangulation, EdgesAreTurnedToTheRounderTriangles) {
    // Ears from a corner would make slivers of a flat fan of points on a circle.
    Ring ring;
    for (int i = 0; i < 64; ++i)
        ring.emplace_back(std::cos(i * std::numbers::pi / 32), std::sin(i * std::numbers::pi / 32));
    ring.insert(ring.begin() + 1, glm::dvec2(0.9, 0.02));
    const PlaneTriangles found = triangulated({ring});
    EXPECT_EQ(found.triangles.size(), 63u);
    // No corner is inside the circle around a triangle of another.
    for (const glm::uvec3& t : found.triangles) {
        const glm::dvec2& a = found.points[t.x];
        const glm::dvec2 u = found.points[t.y] - a;
        const glm::dvec2 v = found.points[t.z] - a;
        const double d = 2 * (u.x * v.y - u.y * v.x);
        const double uu = u.x * u.x + u.y * u.y;
        const double vv = v.x * v.x + v.y * v.y;
        const glm::dvec2 center((v.y * uu - u.y * vv) / d, (u.x * vv - v.x * uu) / d);
        const double radius = std::hypot(center.x, center.y);
        for (const glm::dvec2& p : found.points)
            EXPECT_GE(std::hypot(p.x - a.x - center.x, p.y - a.y - center.y), radius * (1 - 1e-5));
    }
}

TEST(RingTriangulation, RingsThatCrossOrAreFlatEnd) {
    triangulated({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}});
    triangulated({{{0, 0}, {1, 0}, {2, 0}, {1, 0}}});
    triangulated({rectangle(0, 0, 2, 2), reversed(rectangle(1, 1, 3, 3))});
    triangulated({Ring(10, {1, 1})});
}

TEST(RingTriangulation, ALargeWavyDiskWithManyHoles) {
    std::vector<Ring> rings(1);
    for (int i = 0; i < 1500; ++i) {
        const double angle = 2 * std::numbers::pi * i / 1500;
        const double radius = 90 + 5 * std::sin(60 * angle);
        rings[0].emplace_back(100 + radius * std::cos(angle), 100 + radius * std::sin(angle));
    }
    size_t corners = rings[0].size();
    for (int y = 50; y <= 150; y += 10) {
        for (int x = 50; x <= 150; x += 10) {
            rings.push_back(reversed(rectangle(x - 3, y - 3, x + 2, y + 4)));
            corners += 4;
        }
    }
    expect_whole(rings, corners + 2 * (rings.size() - 1) - 2);
}

TEST(RingTriangulation, ASnakeOfManyTurnsTookTheCubeOfTheirNumber) {
    // Every turn but those at its ends has the corner of the other side in its ear.
    Ring snake;
    constexpr int kTurns = 4000;
    for (int i = 0; i < kTurns; ++i)
        snake.emplace_back(i % 2 == 0 ? 0 : 100, 2 * i);
    for (int i = kTurns - 1; i >= 0; --i)
        snake.emplace_back(i % 2 == 0 ? 1 : 101, 2 * i);
    if (signed_area(snake) < 0)
        std::reverse(snake.begin(), snake.end());
    expect_whole({snake}, snake.size() - 2);
    const volatile int32_t cancel = 1;
    EXPECT_THROW(triangulated({snake}, Job(&cancel, nullptr, nullptr)), Error);
}

}  // namespace
}  // namespace lodestone
