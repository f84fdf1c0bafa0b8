// SPDX-License-Identifier: GPL-3.0-or-later
// Guards standing stand-ins: at the floor, same top and area, never below.
#include "base/random.h"
#include "solids/keep_on_floor.h"
#include "solids/solid_replacement.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::solids;

namespace {

double area_of(const Primitive& primitive, bool box) {
    return (box ? box_shell(primitive.half_size) : ellipsoid_shell(primitive.half_size)).area;
}

glm::dmat3 tilted(double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {{c, 0, s}, {0, 1, 0}, {-s, 0, c}};
}

}  // namespace

TEST(Standing, WhatStandsAlreadyStays) {
    const Primitive box{{0, 0, 1}, glm::dmat3(1.0), {1, 2, 1}};
    const Primitive same = standing_on(box, true, 0);
    EXPECT_EQ(same.center, box.center);
    EXPECT_EQ(same.half_size, box.half_size);
}

TEST(Standing, FloatingAndSunkenOnesStandWithTheSameTopAndArea) {
    for (const bool box : {true, false}) {
        for (const double middle : {0.6, 1.0, 1.7}) {
            const Primitive before{{3, -2, middle}, glm::dmat3(1.0), {1.5, 0.7, 1}};
            const Primitive after = standing_on(before, box, 0);
            const HeightRange reach = reach_of(after, box);
            EXPECT_NEAR(reach.low, 0, 1e-12);
            EXPECT_NEAR(reach.high, middle + 1, 1e-6);
            EXPECT_NEAR(area_of(after, box) / area_of(before, box), 1, 1e-6);
        }
    }
}

TEST(Standing, TiltedOnesTouchTheFloorToo) {
    PcgRandom random(4);
    for (int i = 0; i < 200; ++i) {
        const bool box = i % 2 == 0;
        const Primitive before{
            {0, 0, 0.2 + 2 * random.uniform()},
            tilted(3 * random.uniform()),
            {0.2 + random.uniform(), 0.2 + random.uniform(), 0.2 + random.uniform()}};
        const Primitive after = standing_on(before, box, 0);
        EXPECT_NEAR(reach_of(after, box).low, 0, 1e-9);
        EXPECT_NEAR(area_of(after, box) / area_of(before, box), 1, 1e-9) << i;
    }
}

TEST(Standing, TiltedThingsMostlyBelowTheFloorKeepTheirShape) {
    for (const double angle : {0.1, 0.5, 0.9, 1.4}) {
        for (const double middle : {-0.9, -0.5, 0.0}) {
            const Primitive before{{0, 0, middle}, tilted(angle), {1.2, 0.5, 0.05}};
            for (const bool box : {true, false}) {
                const Primitive after = kept_above(before, box, 0);
                EXPECT_GE(reach_of(after, box).low, -1e-9);
                EXPECT_LT(std::max({after.half_size.x, after.half_size.y, after.half_size.z}), 3);
            }
        }
    }
}

TEST(Standing, NothingStaysBelowTheFloorAndNothingAboveMoves) {
    const Primitive above{{0, 0, 5}, glm::dmat3(1.0), {1, 1, 1}};
    EXPECT_EQ(kept_above(above, false, 0).center, above.center);
    for (const double middle : {-7.0, -1.0, -0.5, 0.3}) {
        const Primitive sunken{{0, 0, middle}, tilted(0.4), {1, 1, 1}};
        EXPECT_GE(reach_of(kept_above(sunken, true, 0), true).low, -1e-9) << middle;
    }
    const Primitive far{{0, 0, 1e9 + 0.5}, glm::dmat3(1.0), {1, 1, 1}};
    EXPECT_TRUE(std::isfinite(kept_above(far, true, 1e9).half_size.x));
}
