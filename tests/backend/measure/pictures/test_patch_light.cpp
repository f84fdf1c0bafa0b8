// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what distances do not tell: what lies a little before something else, and how much of it.
#include "measure/pictures/patch_light.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <algorithm>

using namespace lodestone;

namespace {

class LightPatches : public WithRays {};

constexpr uint64_t kSeed = 3;
constexpr double kLeast = 0.05;

/// Two slots: 0 dark, 1 bright.
ray::SkinPtr dark_and_bright() {
    image::TexelCache texels;
    const std::vector<Material> materials{models::colored("dark", glm::dvec3(0.1)),
                                          models::colored("bright", glm::dvec3(0.6))};
    return std::make_shared<const ray::MeshSkin>(materials, texels);
}

measure::LightPatches patches_of(const Mesh& finest, const ray::MeshScene& scene,
                                 const ray::MeshSkin& skin) {
    const measure::VisibleSampler sampler(finest, scene, kSeed);
    std::vector<measure::CastPoints> cast(2048);
    for (uint32_t i = 0; i < cast.size(); ++i)
        cast[i].count = sampler.cast(i, cast[i].points);
    return {finest, sampler, skin, cast};
}

double unlike(const Mesh& finest, const Mesh& stand_in, bool matched) {
    const ray::SkinPtr skin = dark_and_bright();
    const ray::MeshScene scene(finest, skin);
    const measure::LightPatches patches = patches_of(finest, scene, *skin);
    return patches.largest_unlike_patch(stand_in, ray::MeshScene(stand_in, skin), *skin, matched,
                                        kLeast);
}

/// A wall of 4 x 2 m, with dark bricks that stand `out` of its bright mortar.
Mesh wall(double out) {
    constexpr double kLong = 0.25;
    constexpr double kHigh = 0.1;
    constexpr double kJoint = 0.01;
    Mesh mesh;
    append(mesh, shapes::box({0, 0, 0}, {4, 0.3, 2}), {}, 1);
    for (int row = 0; row < 20; ++row) {
        for (int column = 0; column < 16; ++column) {
            const double x = kLong * column;
            const double z = kHigh * row;
            for (const double y : {-out, 0.3}) {
                const glm::dvec3 low{x + kJoint, y, z + kJoint};
                append(mesh, shapes::box(low, {x + kLong - kJoint, y + out, z + kHigh - kJoint}),
                       {}, 0);
            }
        }
    }
    return mesh;
}

Mesh painted(Mesh mesh, uint16_t slot) {
    mesh.slots.assign(mesh.triangles.size(), slot);
    return mesh;
}

}  // namespace

TEST_F(LightPatches, AMeshIsLikeItself) {
    const Mesh mesh = wall(0.01);
    EXPECT_EQ(unlike(mesh, mesh, false), 0);
    EXPECT_EQ(unlike(mesh, mesh, true), 0);
}

TEST_F(LightPatches, MortarWithoutItsBricksIsUnlikeTheWall) {
    // Everywhere as near as the bricks are thick, and in each joint the right color.
    const Mesh bare = painted(shapes::box({0, 0, 0}, {4, 0.3, 2}), 1);
    EXPECT_GT(unlike(wall(0.01), bare, false), 4);
}

TEST_F(LightPatches, BricksThatSinkIntoTheirMortarAreUnlikeTheWall) {
    Mesh sunken = wall(0.01);
    for (glm::vec3& position : sunken.positions) {
        if (position.y < 0)
            position.y = 0.001f;
        else if (position.y > 0.3f)
            position.y = 0.299f;
    }
    EXPECT_GT(unlike(wall(0.01), sunken, false), 4);
    EXPECT_EQ(unlike(wall(0.01), wall(0.012), false), 0);
}

TEST_F(LightPatches, StripesThatChangePlacesAreUnlikeUpToTheirWidth) {
    const auto stripes = [](int first) {
        constexpr double kWide = 0.5;
        Mesh mesh;  // both ends are dark in any case
        append(mesh, shapes::box({-0.02, 0, 0}, {0, 1, 1}), {}, 0);
        append(mesh, shapes::box({4, 0, 0}, {4.02, 1, 1}), {}, 0);
        for (int i = 0; i < 8; ++i)
            append(mesh, shapes::box({kWide * i, 0, 0}, {kWide * (i + 1), 1, 1}), {},
                   static_cast<uint16_t>((i + first) % 2));
        return mesh;
    };
    const double found = unlike(stripes(0), stripes(1), false);
    EXPECT_GT(found, 0.25);
    EXPECT_LT(found, 1.5);
}

TEST_F(LightPatches, WhatWillBeMadeAsBrightIsNotUnlikeForBeingDarker) {
    const Mesh bright = painted(shapes::sphere(1), 1);
    const Mesh dark = painted(shapes::sphere(1), 0);
    EXPECT_GT(unlike(dark, bright, false), 2);
    EXPECT_GT(unlike(dark, bright, true), 2);  // six times
    EXPECT_EQ(unlike(bright, painted(shapes::sphere(1, 3), 1), true), 0);
}

TEST_F(LightPatches, NothingIsUnlikeNothing) {
    const Mesh sphere = painted(shapes::sphere(1), 0);
    EXPECT_GT(unlike(sphere, Mesh{}, false), 2);
    Mesh point;
    point.positions.resize(3);
    point.triangles = {{0, 1, 2}};
    const ray::SkinPtr skin = dark_and_bright();
    const ray::MeshScene scene(point, skin);
    const measure::VisibleSampler sampler(point, scene, kSeed);
    const measure::LightPatches patches(point, sampler, *skin, {});
    EXPECT_EQ(patches.largest_unlike_patch(sphere, ray::MeshScene(sphere, skin), *skin, false, 0),
              0);
}

TEST_F(LightPatches, TheSidesOfABookAreNotPaintedAsDarkAsItsCover) {
    Mesh book = painted(shapes::box({0, 0, 0}, {1, 1, 0.03}), 0);
    append(book, painted(shapes::box({0, 0, 0.03}, {1, 1, 0.27}), 0), {}, 1);
    append(book, painted(shapes::box({0, 0, 0.27}, {1, 1, 0.3}), 0), {});
    const ray::SkinPtr skin = dark_and_bright();
    const ray::MeshScene scene(book, skin);
    const measure::LightPatches patches = patches_of(book, scene, *skin);
    Primitive box;
    box.center = {0.5, 0.5, 0.15};
    box.half_size = {0.5, 0.5, 0.15};
    const Mesh mesh = tessellate_box(box);
    const std::vector<glm::dvec4> paint = patches.fitted_vertex_colors(mesh, scene);
    ASSERT_EQ(paint.size(), mesh.positions.size());
    glm::dvec4 cover(0.0);
    glm::dvec4 sides(0.0);
    for (size_t i = 0; i < paint.size(); ++i)
        (std::abs(mesh.normals[i].z) > 0.5f ? cover : sides) +=
            glm::dvec4(paint[i].w * glm::dvec3(paint[i]), paint[i].w);
    EXPECT_NEAR(cover.x / cover.w, 0.1, 0.005);
    EXPECT_NEAR(sides.x / sides.w, 0.8 * 0.6 + 0.2 * 0.1, 0.05);
}
