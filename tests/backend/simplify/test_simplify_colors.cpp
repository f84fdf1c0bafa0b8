// SPDX-License-Identifier: GPL-3.0-or-later
// Guards vertex colors in simplification: ramps and paint stay where they are.
#include "scenes/fine_grids.h"
#include "simplify/simplify.h"

#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using simplify::simplify_mesh;
using namespace lodestone::shapes;

TEST(SimplifyColors, SmoothColorsStayWhereTheyAre) {
    Mesh mesh = shapes::terrain(60);
    for (const glm::vec3& p : mesh.positions)
        mesh.colors.emplace_back(p.x, p.y, 1 - p.x, 0.5f);
    const Mesh level = simplify_mesh(mesh, 360);
    ASSERT_LE(level.triangles.size(), 360u);
    ASSERT_NO_THROW(check(level));
    ASSERT_FALSE(level.colors.empty());
    for (size_t i = 0; i < level.positions.size(); ++i) {
        EXPECT_NEAR(level.colors[i].x, level.positions[i].x, 0.02);
        EXPECT_NEAR(level.colors[i].y, level.positions[i].y, 0.02);
        EXPECT_NEAR(level.colors[i].w, 0.5f, 1e-5);
    }
}

TEST(SimplifyColors, SplitColorsKeepTheirBorder) {
    // Red left of x = 1/2, blue right of it: corners there have both.
    Mesh mesh;
    for (int half = 0; half < 2; ++half) {
        Mesh side = grid(20);
        for (glm::vec3& p : side.positions)
            p.x = 0.5f * (p.x + static_cast<float>(half));
        side.colors.assign(side.positions.size(),
                           half == 0 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 0, 1, 1));
        append(mesh, side, Affine{});
    }
    const Mesh level = simplify_mesh(mesh, 40);
    ASSERT_LE(level.triangles.size(), 40u);
    ASSERT_NO_THROW(check(level));
    ASSERT_FALSE(level.colors.empty());
    double red = 0;
    for (size_t i = 0; i < level.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = level.triangles[i][corner];
            const bool is_red = level.colors[vertex].x > 0.5f;
            EXPECT_EQ(level.colors[vertex], is_red ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 0, 1, 1));
            EXPECT_EQ(is_red, level.colors[level.triangles[i].x].x > 0.5f) << "smeared";
        }
        if (level.colors[level.triangles[i].x].x > 0.5f)
            red += 0.5 * glm::length(area_vector(level, i));
    }
    EXPECT_NEAR(red, 0.5, 1e-6);
}

TEST(SimplifyColors, PaintOnAPlaneKeepsItsOutline) {
    // A white disk on black; the plane alone would be two triangles.
    Mesh mesh = grid(48);
    for (const glm::vec3& p : mesh.positions) {
        const float square = (p.x - 0.5f) * (p.x - 0.5f) + (p.y - 0.5f) * (p.y - 0.5f);
        mesh.colors.emplace_back(glm::vec3(square < 0.09f ? 1.0f : 0.0f), 1.0f);
    }
    const auto white = [](const Mesh& level) {
        double sum = 0;
        for (size_t i = 0; i < level.triangles.size(); ++i) {
            const Triangle& t = level.triangles[i];
            const float mean =
                (level.colors[t.x].x + level.colors[t.y].x + level.colors[t.z].x) / 3;
            sum += 0.5 * glm::length(area_vector(level, i)) * static_cast<double>(mean);
        }
        return sum;
    };
    const Mesh level = simplify_mesh(mesh, 460);
    ASSERT_LE(level.triangles.size(), 460u);
    EXPECT_NEAR(white(level) / white(mesh), 1, 0.03);
    // Far from the outline nothing is left but white or black.
    for (size_t i = 0; i < level.positions.size(); ++i) {
        const double radius = std::hypot(static_cast<double>(level.positions[i].x) - 0.5,
                                         static_cast<double>(level.positions[i].y) - 0.5);
        if (std::abs(radius - 0.3) > 0.05) {
            EXPECT_NEAR(level.colors[i].x, radius < 0.3 ? 1 : 0, 0.02) << radius;
        }
    }
}

TEST(SimplifyColors, NoNumbersBecomeWhite) {
    Mesh mesh = grid(10);
    mesh.colors.assign(mesh.positions.size(), glm::vec4(std::numeric_limits<float>::quiet_NaN()));
    for (const glm::vec4& color : simplify_mesh(mesh, 20).colors)
        EXPECT_EQ(color, glm::vec4(1));
}
