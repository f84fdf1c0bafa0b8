// SPDX-License-Identifier: GPL-3.0-or-later
// Guards simplified outlines: the area stays, no point is farther away than allowed.
#include "geometry/ring_simplification.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {
namespace {

constexpr RingFrame kFar{1e6, 1e6};

Ring circle(int count, double radius, const glm::dvec2& center) {
    Ring ring;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        ring.emplace_back(center.x + radius * std::cos(angle), center.y + radius * std::sin(angle));
    }
    return ring;
}

double distance_to(const Ring& ring, const glm::dvec2& point) {
    double least = 1e300;
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2& a = ring[i];
        const glm::dvec2 along = ring[(i + 1) % ring.size()] - a;
        const double at = std::clamp(glm::dot(point - a, along) / glm::dot(along, along), 0.0, 1.0);
        least = std::min(least, glm::length(point - a - at * along));
    }
    return least;
}

TEST(RingSimplification, ATriangleAndNothingStay) {
    EXPECT_TRUE(simplified({}, 1, kFar).empty());
    EXPECT_EQ(simplified({{1, 1}, {2, 1}, {1, 2}}, 10, kFar).size(), 3u);
}

TEST(RingSimplification, ACircleKeepsItsAreaAndStaysNear) {
    const Ring ring = circle(1000, 40, {100, 100});
    for (const double tolerance : {0.1, 0.5, 2.0}) {
        const Ring found = simplified(ring, tolerance, kFar);
        EXPECT_NEAR(signed_area(found), signed_area(ring), 1e-6 * signed_area(ring));
        // A polygon of equal area that is off by d at its corners and sides has about
        // pi / sqrt(d / r) corners.
        EXPECT_LT(static_cast<double>(found.size()), 10 + 5 / std::sqrt(tolerance / 40));
        for (const glm::dvec2& point : ring)
            EXPECT_LE(distance_to(found, point), 2 * tolerance + 1e-9);
        for (const glm::dvec2& point : found)
            EXPECT_NEAR(glm::length(point - glm::dvec2(100)), 40, 2 * tolerance);
    }
}

TEST(RingSimplification, NoToleranceChangesNoShape) {
    const Ring ring = circle(100, 10, {50, 50});
    EXPECT_EQ(simplified(ring, 0, kFar).size(), ring.size());
}

TEST(RingSimplification, PointsOnTheFrameStay) {
    // A half disk on the left side of the frame, whose straight side has points in between.
    Ring ring;
    for (int i = 0; i <= 100; ++i) {
        const double angle = std::numbers::pi * (i / 100.0 - 0.5);
        ring.emplace_back(i == 0 || i == 100 ? 0 : 20 * std::cos(angle), 32 + 20 * std::sin(angle));
    }
    for (int i = 1; i < 20; ++i)
        ring.emplace_back(0, 52 - 2 * i);
    const Ring found = simplified(ring, 1, {64, 64});
    EXPECT_NEAR(signed_area(found), signed_area(ring), 1e-6);
    std::vector<double> heights;
    for (const glm::dvec2& at : found) {
        if (at.x == 0)
            heights.push_back(at.y);
    }
    std::sort(heights.begin(), heights.end());
    EXPECT_EQ(heights, (std::vector<double>{12, 52}));
    EXPECT_LT(found.size(), 20u);
}

TEST(RingSimplification, AStripeKeptACornerForEachTexel) {
    // Upright, between points on the frame; then slanted, far from it.
    Ring stripe;
    Ring slanted;
    for (int i = 0; i <= 64; ++i) {
        stripe.emplace_back(10.3, 64 - i);
        slanted.emplace_back(100 + i / 4.0, 100 + i / 8.0);
    }
    for (int i = 0; i <= 64; ++i) {
        stripe.emplace_back(20.7, i);
        slanted.emplace_back(116 - i / 4.0, 118 - i / 8.0);
    }
    for (const Ring& ring : {stripe, slanted}) {
        const Ring found = simplified(ring, 0.5, {64, 64});
        EXPECT_EQ(found.size(), 4u);
        EXPECT_DOUBLE_EQ(signed_area(found), signed_area(ring));
    }
    EXPECT_EQ(simplified(stripe, 0, {64, 64}).size(), 4u);
    // There and back again is no straight way.
    EXPECT_GE(simplified({{0.5, 1}, {5, 1}, {3, 1}, {9, 1}, {9, 9}}, 0, kFar).size(), 5u);
}

TEST(RingSimplification, EqualPointsAndSpikesEnd) {
    EXPECT_LE(simplified(Ring(50, {3, 3}), 1, kFar).size(), 50u);
    Ring spike;
    for (int i = 0; i < 100; ++i)
        spike.emplace_back(i % 2 == 0 ? 0.5 : 1000, 1 + i * 1e-9);
    EXPECT_LE(simplified(spike, 1, kFar).size(), 100u);
}

}  // namespace
}  // namespace lodestone
