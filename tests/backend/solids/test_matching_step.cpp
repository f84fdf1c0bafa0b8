// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the step that makes solids show what is wanted: exact where nothing hides anything, as
// little as possible, never into the ground.
#include "solids/keep_on_floor.h"
#include "solids/matching_step.h"
#include "solids/visible_solids.h"

#include <gtest/gtest.h>

using namespace lodestone;
using solids::MatchResidual;
using solids::VisibleSolids;

namespace {

constexpr double kNoFloor = -1e9;

Solid ball(const glm::dvec3& center, double radius) {
    return {false, {center, glm::dmat3(1.0), glm::dvec3(radius)}, 0};
}

Solid box(const glm::dvec3& center, const glm::dvec3& half) {
    return {true, {center, glm::dmat3(1.0), half}, 0};
}

Attributes attributes_of(const measure::SurfaceInertia& seen) {
    Attributes out;
    out.visible_area = seen.area;
    out.centroid = seen.center;
    out.moments = seen.moments;
    return out;
}

/// Area, centroid and variances that are still missing after so many steps.
double missed(Composite& composite, const Attributes& wanted, double floor, int steps,
              bool size = true) {
    const VisibleSolids visible(16384, 1);
    std::vector<measure::SurfaceInertia> each;
    double off = 0;
    for (int i = 0; i <= steps; ++i) {
        const measure::SurfaceInertia now = visible.of(composite, 1, {}, &each);
        const MatchResidual missing = solids::match_residual(now, wanted, size);
        off = std::abs(missing.area) + glm::length(missing.centroid);
        for (int axis = 0; axis < 3; ++axis)
            off += glm::length(missing.variances[axis]);
        if (i < steps)
            solids::gauss_newton_step(composite, now, each, missing, size, floor);
    }
    return off;
}

Attributes seen(const Composite& composite) {
    return attributes_of(VisibleSolids(16384, 1).of(composite, 1, {}));
}

/// Four balls away from each other.
Composite four() {
    return {{ball({0, 0, 1}, 1), ball({6, 0, 1}, 0.8), ball({0, 5, 1.5}, 1), ball({4, 4, 3}, 0.5)}};
}

}  // namespace

TEST(LeastChange, OfNothingNothingIsMade) {
    Composite none;
    solids::gauss_newton_step(none, {}, {}, {}, true, 0);
    EXPECT_TRUE(none.solids.empty());
}

TEST(LeastChange, WhatMissesNothingStaysAsItIs) {
    Composite composite = four();
    EXPECT_LT(missed(composite, seen(four()), kNoFloor, 1), 1e-12);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(
            glm::length(composite.solids[i].primitive.center - four().solids[i].primitive.center),
            0, 1e-9);
}

TEST(LeastChange, AnotherCentroidIsReachedWithoutChangingAnythingMuch) {
    Attributes wanted = seen(four());
    const glm::dvec3 by(0.1, -0.2, 0.05);
    wanted.centroid += by;
    Composite composite = four();
    EXPECT_LT(missed(composite, wanted, kNoFloor, 3), 0.002);
    for (size_t i = 0; i < 4; ++i) {
        const Primitive before = four().solids[i].primitive;
        const Primitive& after = composite.solids[i].primitive;
        EXPECT_LT(glm::length(after.center - before.center), 1.1 * glm::length(by));
        EXPECT_LT(glm::length(after.half_size / before.half_size - 1.0), 0.2);
    }
}

TEST(LeastChange, AFewStepsGiveAreaCentroidAndShapeOfSomethingElse) {
    // A cube by four solids that hide much of each other.
    const Attributes wanted = seen({{box({0, 0, 1}, {1, 1, 1})}});
    Composite composite{{ball({-0.4, -0.4, 0.6}, 0.6), ball({0.5, -0.3, 1.2}, 0.6),
                         box({-0.3, 0.5, 1.3}, {0.5, 0.4, 0.5}),
                         box({0.5, 0.5, 0.5}, {0.4, 0.4, 0.5})}};
    EXPECT_GT(missed(composite, wanted, kNoFloor, 0, false), 0.2);
    EXPECT_LT(missed(composite, wanted, kNoFloor, 10, false), 0.01);
}

TEST(LeastChange, WhatWouldSinkIntoTheGroundStandsThereAndTheOthersDoMore) {
    Composite composite = four();
    Attributes wanted = seen(composite);
    wanted.centroid.z -= 0.3;
    EXPECT_LT(missed(composite, wanted, 0, 8), 0.005);
    for (const Solid& solid : composite.solids)
        EXPECT_GE(solids::reach_of(solid.primitive, solid.box).low, -1e-6);
}

TEST(LeastChange, ScaleAndPlaceOfTheWholeDoNotMatter) {
    Attributes wanted = seen(four());
    wanted.centroid += glm::dvec3(0.2, 0, 0);
    wanted.moments *= 1.1;
    Composite near = four();
    Composite far = four();
    const glm::dvec3 to(1000, -500, 200);
    Attributes there = wanted;
    constexpr double kScale = 1024;
    for (Solid& solid : far.solids) {
        solid.primitive.center = to + kScale * solid.primitive.center;
        solid.primitive.half_size *= kScale;
    }
    there.centroid = to + kScale * wanted.centroid;
    there.visible_area *= kScale * kScale;
    there.moments *= kScale * kScale * kScale * kScale;
    missed(near, wanted, kNoFloor, 3);
    missed(far, there, kNoFloor, 3);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(glm::length(far.solids[i].primitive.center - to -
                                kScale * near.solids[i].primitive.center) /
                        kScale,
                    0, 1e-3);
    }
}

TEST(LeastChange, WhatCannotBeReachedOrIsBrokenGivesNumbers) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {nan, 1e30, -5.0}) {
        Attributes wanted = seen(four());
        wanted.centroid.z = bad;
        wanted.moments[0][0] = bad;
        Composite composite = four();
        missed(composite, wanted, 0, 4);
        for (const Solid& solid : composite.solids) {
            EXPECT_TRUE(finite(solid.primitive.center)) << bad;
            EXPECT_TRUE(finite(solid.primitive.half_size)) << bad;
        }
    }
    // One of them is not seen at all, another is flat.
    Composite composite{{ball({0, 0, 2}, 2), ball({0.1, 0, 2}, 0.2), box({5, 0, 1}, {1, 1, 1e-9})}};
    Attributes wanted = seen(composite);
    wanted.visible_area *= 1.2;
    missed(composite, wanted, 0, 8);
    for (const Solid& solid : composite.solids)
        EXPECT_TRUE(finite(solid.primitive.center) && finite(solid.primitive.half_size));
}
