// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is said about convex meshes, and about solids inside and around them.
#include "measure/visible/convex_shape.h"
#include "scenes/small_meshes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using namespace lodestone::measure;

namespace {

glm::dmat3 turned(double angle) {
    return {
        {std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, {0, 0, 1}};
}

Mesh placed(const Mesh& mesh, const Affine& transform) {
    Mesh out;
    append(out, mesh, transform);
    return out;
}

double reach(const Mesh& mesh, const glm::dvec3& along) {
    double most = -1e300;
    for (const glm::vec3& position : mesh.positions)
        most = std::max(most, glm::dot(glm::dvec3(position), along));
    return most;
}

}  // namespace

TEST(ShapeConvexity, NothingAndNonsenseAreNotConvex) {
    EXPECT_FALSE(convexity_of({}).convex);
    Mesh nowhere = shapes::cube();
    nowhere.positions[3].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(convexity_of(nowhere).convex);
    EXPECT_FALSE(inside(nowhere, {}, false));
    EXPECT_FALSE(around({}, {}, true));
    EXPECT_FALSE(inside(shapes::cube(), {{}, glm::dmat3(1.0), {1, 0, 1}}, false));
}

TEST(ShapeConvexity, ClosedSolidsThatHideNothingAreConvex) {
    EXPECT_TRUE(convexity_of(shapes::cube()).convex);
    for (int subdivisions = 0; subdivisions < 6; ++subdivisions)
        EXPECT_TRUE(convexity_of(shapes::sphere(1, subdivisions)).convex) << subdivisions;
    EXPECT_TRUE(
        convexity_of(placed(shapes::ellipsoid({1, 20, 0.05}, 3), {turned(0.7), {100, -3, 7}}))
            .convex);
}

TEST(ShapeConvexity, WhatIsOpenHollowInTwoPartsOrInsideOutIsNot) {
    EXPECT_FALSE(convexity_of(shapes::quad(1, 1)).convex);
    EXPECT_FALSE(convexity_of(shapes::terrain(4)).convex);
    EXPECT_FALSE(convexity_of(shapes::fan()).convex);
    Mesh pair = shapes::cube();
    append(pair, shapes::cube(), {glm::dmat3(1.0), {3, 0, 0}});
    EXPECT_FALSE(convexity_of(pair).convex);
    Mesh turned_out = shapes::sphere(1, 2);
    for (Triangle& t : turned_out.triangles)
        std::swap(t.x, t.y);
    EXPECT_FALSE(convexity_of(turned_out).convex);
    Mesh open = shapes::sphere(1, 2);
    open.triangles.pop_back();
    EXPECT_FALSE(convexity_of(open).convex);
    Mesh dented = shapes::sphere(1, 3);
    const glm::vec3 where = dented.positions[0];
    for (glm::vec3& position : dented.positions) {
        if (position == where)
            position *= 0.9f;
    }
    EXPECT_FALSE(convexity_of(dented).convex);
}

TEST(ShapeConvexity, ImagesAreNoLargerInWhatIsFlatOrConvexAndLooksIt) {
    EXPECT_TRUE(convexity_of(shapes::quad(2, 1)).flattens);
    EXPECT_TRUE(convexity_of(placed(shapes::quad(2, 1), {turned(0.3), {1, 2, 3}})).flattens);
    EXPECT_TRUE(convexity_of(shapes::sphere(1, 3)).flattens);
    EXPECT_FALSE(convexity_of(shapes::terrain(4)).flattens);
    Mesh rippled = shapes::quad(1, 1);  // flat, but shaded as if it were a bowl
    rippled.normals = {{.3f, .3f, .9f}, {-.3f, .3f, .9f}, {-.3f, -.3f, .9f}, {.3f, -.3f, .9f}};
    EXPECT_FALSE(convexity_of(rippled).flattens);
    Mesh bowl = shapes::sphere(1, 3);
    for (glm::vec3& normal : bowl.normals)
        normal = -normal;
    EXPECT_FALSE(convexity_of(bowl).flattens);
}

TEST(ShapeConvexity, ABallInACubeAndACubeInABallAreAsLargeAsTheyShouldBe) {
    const Primitive unit;
    const double corner = std::sqrt(3.0) / 2;
    const std::optional<ScaledSolid> ball = inside(shapes::cube(), unit, false);
    ASSERT_TRUE(ball);
    EXPECT_NEAR(ball->scale, 0.5, 1e-5);
    EXPECT_NEAR(ball->gap, 1.03 * (corner - 0.5), 1e-4);
    const std::optional<ScaledSolid> hull = around(shapes::cube(), unit, false);
    ASSERT_TRUE(hull);
    EXPECT_NEAR(hull->scale, corner, 1e-5);
    EXPECT_NEAR(hull->gap, 1.03 * (corner - 0.5), 1e-4);
    const std::optional<ScaledSolid> same = inside(shapes::cube(), unit, true);
    ASSERT_TRUE(same);
    EXPECT_NEAR(same->scale, 0.5, 1e-5);
    EXPECT_LT(same->gap, 1e-5);
    EXPECT_FALSE(inside(shapes::cube(), {{2, 0, 0}, glm::dmat3(1.0), glm::dvec3(1.0)}, false));
}

TEST(ShapeConvexity, OutlinesAreNeverFartherApartThanTheGapFromAnyDirection) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int round = 0; round < 12; ++round) {
        const Primitive solid{{0.1 * any(random), 0.1 * any(random), 0.1 * any(random)},
                              turned(any(random)),
                              {1 + 0.2 * any(random), 1 + 0.2 * any(random), 1}};
        const bool box = round % 3 == 0;
        const Mesh mesh = box ? placed(shapes::cube(), {glm::dmat3(2.0), {}})
                              : shapes::ellipsoid({1, 1.1, 0.9}, 1 + round % 3);
        for (const bool out : {false, true}) {
            const std::optional<ScaledSolid> fitted =
                out ? around(mesh, solid, box) : inside(mesh, solid, box);
            ASSERT_TRUE(fitted);
            for (int i = 0; i < 4000; ++i) {
                const glm::dvec3 along =
                    glm::normalize(glm::dvec3(any(random), any(random), any(random)));
                const glm::dvec3 own =
                    glm::transpose(solid.axes) * along * solid.half_size * fitted->scale;
                const double reaches =
                    glm::dot(solid.center, along) +
                    (box ? std::abs(own.x) + std::abs(own.y) + std::abs(own.z) : glm::length(own));
                const double off = (out ? 1 : -1) * (reaches - reach(mesh, along));
                EXPECT_GT(off, -1e-5);
                EXPECT_LE(off, fitted->gap);
            }
        }
    }
}
