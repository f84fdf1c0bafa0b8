// SPDX-License-Identifier: GPL-3.0-or-later
// Guards projected texture coordinates: Blender's formulas, seams and poles.
#include "geometry/uv_projection.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace lodestone {
namespace {

using Corners = std::array<glm::dvec3, 3>;

constexpr glm::dvec3 kUp(0, 0, 1);
const Corners kPoints = {glm::dvec3(0.1, 0.2, 0.3), glm::dvec3(0.4, 0.5, 0.6),
                         glm::dvec3(0.7, 0.8, 0.9)};

void expect_uv(const glm::dvec2& found, double u, double v) {
    EXPECT_NEAR(found.x, u, 1e-9);
    EXPECT_NEAR(found.y, v, 1e-9);
}

TEST(UvProjection, FlatIsXAndY) {
    expect_uv(project_uvs(UvProjection::Flat, kPoints, kUp)[2], 0.7, 0.8);
}

TEST(UvProjection, BoxTakesTheSideTheTriangleFaces) {
    const auto first = [](const glm::dvec3& normal) {
        return project_uvs(UvProjection::Box, kPoints, normal)[0];
    };
    expect_uv(first({3, 1, 1}), 0.2, 0.3);
    expect_uv(first({-3, 1, 1}), 0.8, 0.3);
    expect_uv(first({1, -3, 1}), 0.1, 0.3);
    expect_uv(first({1, 3, 1}), 0.9, 0.3);
    expect_uv(first({1, 1, -3}), 0.2, 0.1);
    expect_uv(first({1, 1, 3}), 0.8, 0.1);
}

TEST(UvProjection, SphereIsLongitudeAndLatitude) {
    const Corners points = {glm::dvec3(0.5, 1, 0.5), glm::dvec3(1, 0.5, 0.5),
                            glm::dvec3(0.5, 1, 1)};
    const auto uvs = project_uvs(UvProjection::Sphere, points, kUp);
    expect_uv(uvs[0], 0.5, 0.5);
    expect_uv(uvs[1], 0.25, 0.5);
    expect_uv(uvs[2], 0.5, 0.75);
    expect_uv(project_uvs(UvProjection::Tube, points, kUp)[2], 0.5, 1);
}

TEST(UvProjection, TrianglesAcrossTheSeamGoOn) {
    const Corners points = {glm::dvec3(0.4, 0, 0.5), glm::dvec3(0.6, 0, 0.5),
                            glm::dvec3(0.6, 0, 0.6)};
    for (const UvProjection kind : {UvProjection::Sphere, UvProjection::Tube}) {
        const auto uvs = project_uvs(kind, points, kUp);
        for (const glm::dvec2& uv : uvs)
            EXPECT_NEAR(uv.x, 1, 0.1);
        EXPECT_GT(std::abs(uvs[0].x - uvs[1].x), 0.01);
    }
}

TEST(UvProjection, APoleLiesBetweenTheOthers) {
    const Corners points = {glm::dvec3(0.5, 0.5, 1), glm::dvec3(1, 0.5, 0.5),
                            glm::dvec3(0.5, 1, 0.5)};
    expect_uv(project_uvs(UvProjection::Sphere, points, kUp)[0], 0.375, 1);
    const Corners nothing = {glm::dvec3(0.5), glm::dvec3(0.5), glm::dvec3(0.5)};
    for (const glm::dvec2& uv : project_uvs(UvProjection::Sphere, nothing, kUp))
        expect_uv(uv, 0, 0);
}

}  // namespace
}  // namespace lodestone
