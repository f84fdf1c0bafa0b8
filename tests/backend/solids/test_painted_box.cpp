// SPDX-License-Identifier: GPL-3.0-or-later
// Guards painted boxes: as few colors as tell the sides apart, and as much light as was asked for.
#include "scenes/small_models.h"
#include "solids/painted_box.h"

#include <gtest/gtest.h>
#include <set>

using namespace lodestone;
using namespace lodestone::solids;

namespace {

Primitive book() {
    Primitive box;
    box.center = {1, 2, 3};
    box.half_size = {0.1, 0.15, 0.02};
    return box;
}

/// What the vertices of the cover (up and down) and those of all other sides show.
std::vector<glm::dvec4> shown(const glm::dvec4& cover, const glm::dvec4& sides) {
    std::vector<glm::dvec4> out;
    for (const glm::vec3& normal : tessellate_box(book()).normals)
        out.push_back(std::abs(normal.z) > 0.5f ? cover : sides);
    return out;
}

std::set<std::array<float, 3>> colors_of(const PaintedBox& painted) {
    std::set<std::array<float, 3>> out;
    for (const glm::vec4& color : painted.mesh.colors)
        out.insert({color.x, color.y, color.z});
    return out;
}

}  // namespace

TEST(PaintedBox, NothingSeenOrOneColorIsNoPaint) {
    EXPECT_FALSE(painted_box(book(), {}, shown(glm::dvec4(0.0), glm::dvec4(0.0))));
    EXPECT_FALSE(painted_box(book(), {}, shown(glm::dvec4(0.0, 0.0, 0.0, 5.0), glm::dvec4(0.0))));
    EXPECT_FALSE(painted_box(book(), {}, shown({0.3, 0.2, 0.1, 5}, {0.33, 0.22, 0.1, 1})));
}

TEST(PaintedBox, NarrowBrightSidesAreNotLostInALargeDarkCover) {
    Material material = models::colored("stand-in", {0.1, 0.1, 0.1}, 0.7);
    material.metallic = 0.25;
    const auto painted =
        painted_box(book(), material, shown({0.05, 0.04, 0.03, 20}, {0.6, 0.5, 0.4, 1}));
    ASSERT_TRUE(painted);
    EXPECT_EQ(painted->mesh.triangles.size(), 12u);
    EXPECT_EQ(colors_of(*painted).size(), 2u);
    EXPECT_TRUE(painted->material.vertex_colors);
    EXPECT_EQ(painted->material.roughness, 0.7);
    EXPECT_EQ(painted->material.metallic, 0.25);
    for (size_t i = 0; i < painted->mesh.colors.size(); ++i) {
        const bool cover = std::abs(painted->mesh.normals[i].z) > 0.5f;
        const glm::dvec3 wanted = cover ? glm::dvec3(0.05, 0.04, 0.03) : glm::dvec3(0.6, 0.5, 0.4);
        const glm::dvec3 color = painted->material.base_color * glm::dvec3(painted->mesh.colors[i]);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(color[c], wanted[c], cover ? 0.002 : 0.05);
    }
}

TEST(PaintedBox, MergedColorsShowAsMuchLight) {
    std::vector<glm::dvec4> wanted = shown({0.1, 0.2, 0.3, 4}, {0.5, 0.4, 0.3, 2});
    for (size_t i = 0; i < wanted.size(); ++i)
        wanted[i].x *= 1 + 0.05 * static_cast<double>(i % 3);
    const auto painted = painted_box(book(), {}, wanted);
    ASSERT_TRUE(painted);
    glm::dvec3 all(0.0);
    glm::dvec3 light(0.0);
    for (size_t i = 0; i < wanted.size(); ++i) {
        all += wanted[i].w * glm::dvec3(wanted[i]);
        light += wanted[i].w * painted->material.base_color * glm::dvec3(painted->mesh.colors[i]);
    }
    EXPECT_LT(colors_of(*painted).size(), 6u);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light[c] / all[c], 1, 0.005);
}

TEST(PaintedBox, NothingIsBrighterThanWhite) {
    const auto painted = painted_box(book(), {}, shown({0.2, 0.2, 0.2, 3}, {7, 0.5, 0, 1}));
    ASSERT_TRUE(painted);
    for (int c = 0; c < 3; ++c)
        EXPECT_LE(painted->material.base_color[c], 1);
    for (const glm::vec4& color : painted->mesh.colors) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(color[c], 0);
            EXPECT_LE(color[c], 1);
        }
    }
}

TEST(PaintedBox, ColorsOfAnotherMeshAreRefused) {
    EXPECT_THROW(painted_box(book(), {}, std::vector<glm::dvec4>(8)), Error);
}
