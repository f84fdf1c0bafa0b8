// SPDX-License-Identifier: GPL-3.0-or-later
// Guards distances to boxes and ellipsoids against the nearest of many triangles and closed forms.
#include "base/random.h"
#include "geometry/primitive_distance.h"
#include "ray/mesh_scene.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;

namespace {

glm::dvec3 point_in(PcgRandom& random, double size) {
    return size * (2.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0);
}

/// Turned, placed, and up to a hundred times longer than wide.
Primitive any_primitive(PcgRandom& random) {
    Primitive out;
    out.center = point_in(random, 3);
    const glm::dvec3 x = glm::normalize(point_in(random, 1));
    const glm::dvec3 y = glm::normalize(glm::cross(x, point_in(random, 1)));
    out.axes = glm::dmat3(x, y, glm::cross(x, y));
    for (int i = 0; i < 3; ++i)
        out.half_size[i] = std::pow(10.0, -2 * random.uniform());
    return out;
}

Primitive upright(const glm::dvec3& half_size) {
    return {glm::dvec3(0.0), glm::dmat3(1.0), half_size};
}

}  // namespace

TEST(PrimitiveDistance, OfABoxIsThatOfItsTwelveTriangles) {
    PcgRandom random(1);
    for (int i = 0; i < 50; ++i) {
        const Primitive box = any_primitive(random);
        const ray::MeshScene scene(tessellate_box(box), nullptr, ray::SceneUse::ClosestPoints);
        for (int k = 0; k < 100; ++k) {
            const glm::dvec3 point = box.center + point_in(random, k < 50 ? 0.1 : 2);
            ASSERT_NEAR(distance_to_box(box, point), scene.closest_point(point).distance, 2e-6);
        }
    }
}

TEST(PrimitiveDistance, OfAnEllipsoidIsThatOfManyTriangles) {
    PcgRandom random(2);
    for (int i = 0; i < 10; ++i) {
        const Primitive ellipsoid = any_primitive(random);
        const ray::MeshScene scene(tessellate_ellipsoid(ellipsoid, 6), nullptr,
                                   ray::SceneUse::ClosestPoints);
        for (int k = 0; k < 200; ++k) {
            const glm::dvec3 point = ellipsoid.center + point_in(random, k < 100 ? 0.1 : 2);
            ASSERT_NEAR(distance_to_ellipsoid(ellipsoid, point),
                        scene.closest_point(point).distance, 2e-3 * largest(ellipsoid.half_size));
        }
    }
}

TEST(PrimitiveDistance, OfAnEllipsoidIsExactAlongItsNormals) {
    PcgRandom random(3);
    for (int i = 0; i < 1000; ++i) {
        const Primitive ellipsoid = any_primitive(random);
        const glm::dvec3 on = glm::normalize(point_in(random, 1));
        const glm::dvec3 normal = glm::normalize(ellipsoid.axes * (on / ellipsoid.half_size));
        const glm::dvec3 surface = frame_of(ellipsoid)(on);
        const glm::dvec3& half = ellipsoid.half_size;
        const double least = std::min({half.x, half.y, half.z});
        const double size = largest(half);
        // Inside up to where normals meet at the least radius of curvature.
        for (const double away : {100.0, 1.0, 1e-3, 0.0, -0.99 * least * least / size})
            ASSERT_NEAR(distance_to_ellipsoid(ellipsoid, surface + away * normal), std::abs(away),
                        1e-9 * (size + std::abs(away)));
    }
}

TEST(PrimitiveDistance, OfAnEllipsoidHoldsInItsPlanesOfSymmetry) {
    const Primitive ball = upright(glm::dvec3(2));
    EXPECT_NEAR(distance_to_ellipsoid(ball, {0, 0, 0}), 2, 1e-9);
    EXPECT_NEAR(distance_to_ellipsoid(ball, {0, 0, 5}), 3, 1e-9);
    const Primitive long_one = upright({3, 2, 1});
    EXPECT_NEAR(distance_to_ellipsoid(long_one, {0, 0, 0}), 1, 1e-9);
    // Not .8, which is farther.
    EXPECT_NEAR(distance_to_ellipsoid(long_one, {0, 1.2, 0}), std::sqrt(0.52), 1e-9);
    EXPECT_NEAR(distance_to_ellipsoid(long_one, {-4, 0, 0}), 1, 1e-9);
}

TEST(PrimitiveDistance, HoldsWithoutThickness) {
    for (const double thick : {0.0, 1e-300, 1e-15}) {
        const Primitive disc = upright({2, 1, thick});
        EXPECT_NEAR(distance_to_ellipsoid(disc, {0, 0, 0.5}), 0.5, 1e-9);
        EXPECT_NEAR(distance_to_ellipsoid(disc, {0.5, 0.5, -0.5}), 0.5, 1e-9);
        EXPECT_NEAR(distance_to_ellipsoid(disc, {0, 3, 0}), 2, 1e-9);
        EXPECT_NEAR(distance_to_ellipsoid(disc, {0.1, 0.1, 0}), 0, 1e-9);
        EXPECT_NEAR(distance_to_box(disc, {0, 0, 0.5}), 0.5, 1e-12);
        EXPECT_NEAR(distance_to_box(disc, {0.1, 3, 0}), 2, 1e-12);
        EXPECT_NEAR(distance_to_ellipsoid(upright({2, thick, thick}), {1, 0, 0.5}), 0.5, 1e-9);
    }
    const glm::dvec3 point(1, 2, 2);
    EXPECT_EQ(distance_to_ellipsoid(upright(glm::dvec3(0)), point), 3);
    EXPECT_EQ(distance_to_box(upright(glm::dvec3(0)), point), 3);
}

TEST(PrimitiveDistance, OfWhatIsNotAPointIsNotFinite) {
    for (const double value : {std::nan(""), kInfinity}) {
        EXPECT_FALSE(std::isfinite(distance_to_box({}, {0, value, 0})));
        EXPECT_FALSE(std::isfinite(distance_to_ellipsoid({}, {0, value, 0})));
    }
}

TEST(PrimitiveDistance, HoldsFarAway) {
    const Primitive flat = upright({1, 1, 1e-3});
    EXPECT_NEAR(distance_to_ellipsoid(flat, {1e30, 0, 0}) / 1e30, 1, 1e-9);
    EXPECT_NEAR(distance_to_box(flat, {0, 1e30, 0}) / 1e30, 1, 1e-9);
}
