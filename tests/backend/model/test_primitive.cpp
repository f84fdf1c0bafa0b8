// SPDX-License-Identifier: GPL-3.0-or-later
// Guards tessellation of primitives.
#include "model/primitive.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>
#include <numbers>

using namespace lodestone;

TEST(Primitive, BoxIsClosedAndFacesOutward) {
    const Mesh mesh = shapes::box({-1, -2, -3}, {1, 2, 3});
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(surface_area(mesh), 2 * (2 * 4 + 4 * 6 + 6 * 2), 1e-5);
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        EXPECT_GT(glm::dot(area_vector(mesh, i), glm::dvec3(mesh.normals[mesh.triangles[i].x])), 0);
}

TEST(Primitive, SphereAreaConvergesAtSecondOrder) {
    double last = 0;
    for (int level = 1; level <= 4; ++level) {
        const double error = 4 * std::numbers::pi - surface_area(shapes::sphere(1, level));
        EXPECT_GT(error, 0);
        if (level > 1) {
            EXPECT_NEAR(last / error, 4, 0.4);  // edges halve, the error quarters
        }
        last = error;
    }
}

TEST(Primitive, EllipsoidVerticesLieOnItsSurfaceInsideItsBound) {
    Primitive p{{1, 2, 3}, glm::dmat3(1.0), {1, 0.5, 0.25}};
    p.axes = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
    const Mesh mesh = tessellate_ellipsoid(p, 3);
    EXPECT_TRUE(closed(mesh));
    const Bound bound = bound_of_ellipsoid(p);
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec3 local =
            (glm::transpose(p.axes) * (glm::dvec3(position) - p.center)) / p.half_size;
        EXPECT_NEAR(glm::length(local), 1, 1e-5);
        EXPECT_LT(distance(bound, glm::dvec3(position)), 1e-6);
    }
    EXPECT_NEAR(bound.box.size().y, 2, 1e-12);
}
