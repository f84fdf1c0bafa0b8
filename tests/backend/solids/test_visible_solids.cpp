// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is seen of boxes and ellipsoids that hide parts of each other, found without
// triangles.
#include "measure/visible/visible_attributes.h"
#include "scenes/with_rays.h"
#include "solids/visible_solids.h"

#include <gtest/gtest.h>
#include <numbers>

using namespace lodestone;
using solids::VisibleSolids;

namespace {

class VisibleSolidsBesideTriangles : public WithRays {};

constexpr uint32_t kRays = 65536;

Solid ball(const glm::dvec3& center, const glm::dvec3& half) {
    return {false, {center, glm::dmat3(1.0), half}, 0};
}

Solid box(const glm::dvec3& center, const glm::dvec3& half) {
    return {true, {center, glm::dmat3(1.0), half}, 0};
}

measure::SurfaceInertia seen(const Composite& composite, double share = 1) {
    return VisibleSolids(kRays, 1).of(composite, share, {});
}

}  // namespace

TEST(VisibleSolids, OfNothingNothingIsSeen) {
    EXPECT_TRUE(seen({}).empty());
    EXPECT_TRUE(VisibleSolids(0, 1).of({{ball({0, 0, 0}, {1, 1, 1})}}, 1, {}).empty());
    EXPECT_TRUE(seen({{ball({0, 0, 0}, {0, 0, 0})}}).empty());
}

TEST(VisibleSolids, WhatHidesNothingIsExact) {
    const auto one = seen({{ball({3, 0, 0}, {2, 2, 2})}});
    EXPECT_NEAR(one.area, 16 * std::numbers::pi, 1e-6);
    EXPECT_NEAR(one.center.x, 3, 1e-9);
    EXPECT_NEAR(one.moments[0][0] / one.area, 4.0 / 3, 1e-6);
    const auto cube = seen({{box({0, 0, 5}, {1, 1, 1})}});
    EXPECT_NEAR(cube.area, 24, 1e-9);
    EXPECT_NEAR(cube.moments[1][1], 24 * 5.0 / 9, 1e-6);
}

TEST(VisibleSolids, WhatLiesInsideIsNotSeen) {
    const auto both = seen({{ball({0, 0, 0}, {2, 2, 2}), box({0.3, 0, 0}, {0.5, 0.5, 0.5})}});
    EXPECT_NEAR(both.area, 16 * std::numbers::pi, 0.01);
    EXPECT_NEAR(both.center.x, 0, 1e-3);
}

TEST(VisibleSolids, CubesThatTouchShowTheSurfaceOfBoth) {
    const auto both = seen({{box({-1, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {1, 1, 1})}});
    EXPECT_NEAR(both.area, 40, 0.2);
    EXPECT_NEAR(both.center.x, 0, 0.01);
}

TEST(VisibleSolids, WhatIsSeenOfEachIsWhatIsSeenOfAll) {
    const Composite composite{{box({0, 0, 1}, {1, 0.5, 0.05}), ball({0.2, 0, 1.4}, {0.3, 0.4, 0.3}),
                               ball({0, 0, 0.5}, {0.4, 0.4, 0.6}),
                               ball({0, 0, 0.5}, {0.1, 0.1, 0.1})}};
    std::vector<measure::SurfaceInertia> each;
    const auto all = VisibleSolids(kRays, 1).of(composite, 1, {}, &each);
    ASSERT_EQ(each.size(), 4u);
    double area = 0;
    glm::dvec3 center(0.0);
    for (const measure::SurfaceInertia& one : each) {
        area += one.area;
        center += one.area / all.area * one.center;
    }
    EXPECT_NEAR(area / all.area, 1, 1e-3);  // what seems less than nothing is nothing
    EXPECT_NEAR(glm::length(center - all.center), 0, 1e-3);
    EXPECT_LT(each[3].area, 0.02 * all.area);  // lies inside
}

TEST_F(VisibleSolidsBesideTriangles, WhatIsPartlyHiddenIsWhatRaysFindOfItsTriangles) {
    Composite composite{{box({0, 0, 1}, {1, 0.5, 0.05}), ball({0.2, 0, 1.4}, {0.3, 0.4, 0.3}),
                         ball({0, 0, 0.5}, {0.4, 0.4, 0.6}), box({0, 0, 0}, {0.6, 0.6, 0.02})}};
    const double c = std::cos(0.5);
    const double s = std::sin(0.5);
    composite.solids[1].primitive.axes = glm::dmat3({c, s, 0}, {-s, c, 0}, {0, 0, 1});
    const auto now = seen(composite);
    measure::VisibleOptions options;
    options.rays = 65536;
    const Attributes wanted =
        measure::measure_visible(tessellate(composite, 4), {}, options).attributes;
    EXPECT_NEAR(now.area / wanted.visible_area, 1, 0.005);
    EXPECT_LT(glm::length(now.center - wanted.centroid), 0.004 * wanted.radius_of_gyration());
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(now.moments[i][i] / wanted.moments[i][i], 1, 0.02) << i;
    EXPECT_NEAR(seen(composite, 0.125).area / now.area, 1, 0.01);
    Composite far = composite;
    for (Solid& solid : far.solids)
        solid.primitive.center += glm::dvec3(4096, -2048, 512);
    EXPECT_NEAR(seen(far).area / now.area, 1, 1e-3);
}

TEST(VisibleSolids, FlatNeedleLikeAndBrokenOnesGiveNumbersOrNothing) {
    const auto flat = seen({{box({0, 0, 0}, {1, 1, 1e-9}), ball({0, 0, 1}, {1e-9, 1e-9, 1})}});
    EXPECT_NEAR(flat.area, 8, 0.1);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(seen({{box({0, 0, 0}, {nan, 1, 1})}}).empty());
    EXPECT_TRUE(seen({{ball({0, 0, 0}, {1e200, 1e200, 1e200})}}).empty());
}
