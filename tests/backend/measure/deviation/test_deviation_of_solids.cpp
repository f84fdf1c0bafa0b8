// SPDX-License-Identifier: GPL-3.0-or-later
// Guards errors of boxes and ellipsoids, whose distances are exact: they are those of as many
// triangles as one likes.
#include "base/random.h"
#include "measure/deviation/distinct_looks.h"
#include "measure/deviation/surface_deviation.h"
#include "scenes/small_meshes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using measure::DeviationReference;
using measure::SurfaceDeviation;

TEST(DeviationOfSolids, AreThoseOfTheirTriangles) {
    PcgRandom random(7);
    const auto any = [&] {
        return glm::dvec3(random.uniform(), random.uniform(), random.uniform());
    };
    constexpr double kAny = std::numeric_limits<double>::infinity();
    for (const Mesh& finest : {shapes::sphere(3, 4), shapes::terrain(40), shapes::book(20)}) {
        const DeviationReference reference(finest, {2048, 2048, 1});
        const Bound bound = bound_of(finest.positions);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 x = glm::normalize(any() - 0.5);
            const glm::dvec3 y = glm::normalize(glm::cross(x, any() - 0.5));
            const Primitive primitive{bound.center + bound.radius * (0.4 * any() - 0.2),
                                      glm::dmat3(x, y, glm::cross(x, y)),
                                      bound.radius * (0.1 + 0.8 * any())};
            const SurfaceDeviation box = reference.of(Solid{true, primitive}, 0, kAny, {});
            const SurfaceDeviation same = reference.of(tessellate_box(primitive));
            EXPECT_NEAR(box.error, same.error, 1e-6 * bound.radius);
            EXPECT_NEAR(box.max, same.max, 1e-6 * bound.radius);
            const SurfaceDeviation ellipsoid = reference.of(Solid{false, primitive}, 0, kAny, {});
            const double fine = reference.of(tessellate_ellipsoid(primitive, 5)).error;
            EXPECT_NEAR(ellipsoid.error, fine, 0.05 * fine);
        }
    }
}

TEST(DeviationOfSolids, AreThoseOfTheirTrianglesWhereColorsDiffer) {
    Mesh finest = shapes::cube();
    finest.slots.assign(finest.triangles.size(), 0);
    std::fill(finest.slots.begin(), finest.slots.begin() + 4, uint16_t{1});
    std::vector<Material> materials(2);
    materials[0].base_color = {1, 0, 0};
    materials[1].base_color = {0, 0, 1};
    measure::LookPalette looks;
    const std::vector<uint16_t> of_finest = looks.of(finest, materials);
    const DeviationReference reference(finest, {2048, 2048, 1}, {of_finest, &looks, nullptr});
    Primitive box;
    box.center = glm::dvec3(0.5);
    box.half_size = glm::dvec3(0.5);
    constexpr double kAny = std::numeric_limits<double>::infinity();
    Material mixed;
    mixed.base_color = {0.5, 0, 0.5};
    for (const Material& material : {materials[0], mixed}) {
        const uint16_t look = looks.of(material);
        const Mesh mesh = tessellate_box(box);
        const std::vector<uint16_t> by_triangle(mesh.triangles.size(), look);
        const double right = reference.of(mesh, {by_triangle, &looks, nullptr}).error;
        EXPECT_GT(right, 0.1);  // blue sides are missing
        EXPECT_NEAR(reference.of(Solid{true, box}, look, kAny, {}).error, right, 1e-6);
    }
}
