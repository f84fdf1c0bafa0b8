// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the few factors of many placements: they are few, and light no less than all of them.
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/lamp/sky_occlusion.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <set>

using namespace lodestone::povray;

TEST(PlacementGrades, NoneAndOneStayAsTheyAre) {
    EXPECT_TRUE(graded({}).empty());
    EXPECT_EQ(graded({0.3}), std::vector<double>{0.3});
    EXPECT_EQ(graded({0, 0, 0}), std::vector<double>(3, 0));
    EXPECT_EQ(graded({1, 1}), std::vector<double>(2, 1));
}

TEST(PlacementGrades, WhatIsAboutAsLightSharesAGrade) {
    const std::vector<double> shares = graded({0.50, 0.52, 0.54});
    EXPECT_EQ(std::set<double>(shares.begin(), shares.end()).size(), 1u);
    EXPECT_NEAR(shares[0], 0.52, 1e-12);
    const std::vector<double> apart = graded({0.1, 0.9});
    EXPECT_EQ(apart, (std::vector<double>{0.1, 0.9}));
}

TEST(PlacementGrades, ThereAreFourAtMostOfTheSameMeanAndOrder) {
    std::vector<double> shares;
    for (int i = 0; i <= 100; ++i)
        shares.push_back(i / 100.0);
    const std::vector<double> grades = graded(shares);
    ASSERT_EQ(grades.size(), shares.size());
    EXPECT_EQ(std::set<double>(grades.begin(), grades.end()).size(), size_t{kPlacementGrades});
    EXPECT_TRUE(std::is_sorted(grades.begin(), grades.end()));
    EXPECT_NEAR(std::accumulate(grades.begin(), grades.end(), 0.0),
                std::accumulate(shares.begin(), shares.end(), 0.0), 1e-9);
}

TEST(SkyGrades, AreTheNearestToShares) {
    EXPECT_EQ(grade_of_share(1), kSkyGrades - 1);
    EXPECT_EQ(share_of_grade(kSkyGrades - 1), 1);
    EXPECT_EQ(grade_of_share(0), 0);
    EXPECT_EQ(grade_of_share(std::nan("")), 0);
    for (int grade = 0; grade < kSkyGrades; ++grade)
        EXPECT_EQ(grade_of_share(share_of_grade(static_cast<uint8_t>(grade))), grade);
}
