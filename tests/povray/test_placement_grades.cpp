// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the few factors of many placements: they are few, and light no less than all of them.
#include "base/maths.h"
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/lamp/sky_occlusion.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <numeric>
#include <set>

using lodestone::kInfinity;
using namespace lodestone::povray;

namespace {

std::vector<PlacementShade> shades_of(const std::vector<double>& shares) {
    std::vector<PlacementShade> out;
    out.reserve(shares.size());
    for (const double share : shares)
        out.push_back({share, share, {}});
    return out;
}

/// The shares alone, graded.
std::vector<double> graded_shares(const std::vector<double>& shares) {
    std::vector<double> out;
    out.reserve(shares.size());
    for (const PlacementShade& shade : graded(shades_of(shares)))
        out.push_back(shade.share);
    return out;
}

}  // namespace

TEST(PlacementGrades, NoneAndOneStayAsTheyAre) {
    EXPECT_TRUE(graded_shares({}).empty());
    EXPECT_EQ(graded_shares({0.3}), std::vector<double>{0.3});
    EXPECT_EQ(graded_shares({0, 0, 0}), std::vector<double>(3, 0));
    EXPECT_EQ(graded_shares({1, 1}), std::vector<double>(2, 1));
}

TEST(PlacementGrades, WhatIsAboutAsLightSharesAGrade) {
    const std::vector<double> shares = graded_shares({0.50, 0.52, 0.54});
    EXPECT_EQ(std::set<double>(shares.begin(), shares.end()).size(), 1u);
    EXPECT_NEAR(shares[0], 0.52, 1e-12);
    const std::vector<double> apart = graded_shares({0.1, 0.9});
    EXPECT_EQ(apart, (std::vector<double>{0.1, 0.9}));
}

TEST(PlacementGrades, ThereAreFourAtMostOfTheSameMeanAndOrder) {
    std::vector<double> shares;
    for (int i = 0; i <= 100; ++i)
        shares.push_back(i / 100.0);
    const std::vector<double> grades = graded_shares(shares);
    ASSERT_EQ(grades.size(), shares.size());
    EXPECT_EQ(std::set<double>(grades.begin(), grades.end()).size(), size_t{kPlacementGrades});
    EXPECT_TRUE(std::is_sorted(grades.begin(), grades.end()));
    EXPECT_NEAR(std::accumulate(grades.begin(), grades.end(), 0.0),
                std::accumulate(shares.begin(), shares.end(), 0.0), 1e-9);
}

TEST(PlacementGrades, SlopesAreTheMeansOfTheirGrade) {
    const std::vector<PlacementShade> found =
        graded({{0.5, 0.25, {1, 0, 0}}, {0.1, 0.1, {0, 8, 0}}, {0.5, 1.25, {0, 0, 3}}});
    EXPECT_EQ(found[0].slope, glm::dvec3(0.5, 0, 1.5));
    EXPECT_EQ(found[2].slope, found[0].slope);
    EXPECT_EQ(found[1].slope, glm::dvec3(0, 8, 0));
    EXPECT_EQ(found[0].middle, 0.75);
    EXPECT_EQ(found[0].share, 0.5);
}

TEST(SkyGrades, ASlopeIsAsCoarseAsAFactorOverTheThing) {
    EXPECT_EQ(stepped_slope({0.5, -0.25, 0}, 1), glm::dvec3(0.5, -0.25, 0));
    EXPECT_EQ(stepped_slope({0.5001, 0.0001, 0}, 1), glm::dvec3(0.5, 0, 0));
    EXPECT_EQ(stepped_slope({0.0501, 0, 0}, 100).x, stepped_slope({0.05011, 0, 0}, 100).x);
    EXPECT_NEAR(100 * stepped_slope({0.0501, 0, 0}, 100).x, 5.01, 1.0 / 256);
    for (const double size : {0.0, kInfinity, std::nan("")})
        EXPECT_EQ(stepped_slope({1, 1, 1}, size), glm::dvec3(0.0));
    EXPECT_EQ(stepped_slope(glm::dvec3(std::nan("")), 1), glm::dvec3(0.0));
}

TEST(SkyGrades, ACornerHasTheShareOfItsPlace) {
    SkyLight light;
    auto shares = std::make_shared<lodestone::light::SkyShares>();
    shares->corners.assign(3, lodestone::light::share_byte(1));
    light.shares = shares;
    light.factor = 0.5;
    light.slope = {0, 0, 0.25};
    light.middle = {0, 0, 1};
    EXPECT_EQ(light.share(0, 1, {7, 7, 1}), 0.5);
    EXPECT_EQ(light.share(0, 1, {7, 7, 2}), 0.75);
    EXPECT_EQ(light.share(0, 1, {7, 7, 9}), 1);
    EXPECT_EQ(light.share(0, 1, {7, 7, -9}), 0);
}

TEST(SkyGrades, AreTheNearestToShares) {
    EXPECT_EQ(grade_of_share(1), kSkyGrades - 1);
    EXPECT_EQ(share_of_grade(kSkyGrades - 1), 1);
    EXPECT_EQ(grade_of_share(0), 0);
    EXPECT_EQ(grade_of_share(std::nan("")), 0);
    for (int grade = 0; grade < kSkyGrades; ++grade)
        EXPECT_EQ(grade_of_share(share_of_grade(static_cast<uint8_t>(grade))), grade);
}
