// SPDX-License-Identifier: GPL-3.0-or-later
// Guards deviations of what materials vary on: alpha, textures, vertex colors.
#include "base/parallel.h"
#include "measure/deviation/surface_deviation.h"
#include "scenes/fine_grids.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;
using measure::DeviationReference;
using measure::SurfaceDeviation;

namespace {

/// Both with skins, and told apart by looks.
SurfaceDeviation of_skins(const Mesh& finest, const std::vector<Material>& materials,
                          const Mesh& stand_in, const std::vector<Material>& own) {
    image::TexelCache texels;
    measure::LookPalette palette;
    const std::vector<uint16_t> looks = palette.of(finest, materials);
    const DeviationReference reference(
        finest, {}, {looks, &palette, std::make_shared<const ray::MeshSkin>(materials, texels)});
    const std::vector<uint16_t> theirs = palette.of(stand_in, own);
    return reference.of(stand_in,
                        {theirs, &palette, std::make_shared<const ray::MeshSkin>(own, texels)});
}

/// Stripes of 2 m along x, dark and light, on 16 m.
PicturePtr stripes() {
    return foliage::picture(128, [](double x, double) {
        return std::fmod(8 * x, 2) < 1 ? glm::dvec4(0.05, 0.05, 0.05, 1)
                                       : glm::dvec4(0.8, 0.8, 0.8, 1);
    });
}

Material striped() {
    Material material;
    material.base_color_texture = foliage::texture(stripes());
    material.base_color = glm::dvec3(material.base_color_texture.picture->mean);
    return material;
}

}  // namespace

TEST(DeviationAlpha, EmptyCornersOfALeafCardAreNeitherMissedNorMatched) {
    const std::vector<Material> leaf{foliage::leaf(foliage::left_half())};
    const std::vector<Material> solid(1);
    const Mesh card = foliage::card(1, 1);
    const auto error = [&](const std::vector<Material>& finest, const Mesh& other,
                           const std::vector<Material>& own) {
        image::TexelCache texels;
        const DeviationReference reference(
            card, {}, {{}, nullptr, std::make_shared<const ray::MeshSkin>(finest, texels)});
        return reference
            .of(other, {{}, nullptr, std::make_shared<const ray::MeshSkin>(own, texels)})
            .error;
    };
    EXPECT_LT(error(leaf, card, leaf), 1e-6);
    // The half that is there, cut out as geometry, is the same thing.
    EXPECT_LT(error(leaf, shapes::quad(0.5f, 1), solid), 0.02);
    // The whole card in its place sticks out by half of it; and the other way round that is
    // missing.
    EXPECT_NEAR(error(leaf, card, solid), 0.5, 0.03);
    EXPECT_NEAR(error(solid, card, leaf), 0.5, 0.03);
    EXPECT_LT(error(solid, card, solid), 1e-6);
}

TEST(DeviationTexels, GroundThatKeepsItsTextureIsNotPunished) {
    Mesh ground = shapes::terrain(40);
    Mesh coarse = shapes::terrain(10);
    for (Mesh* mesh : {&ground, &coarse}) {
        for (glm::vec3& position : mesh->positions) {
            mesh->uvs.emplace_back(position.x, position.y);
            position *= 16;
        }
    }
    const double shape = DeviationReference(ground, {}).of(coarse).error;
    EXPECT_GT(shape, 0.01);
    EXPECT_NEAR(of_skins(ground, {striped()}, coarse, {striped()}).error, shape, 0.02);
}

TEST(DeviationTexels, GroundThatLosesItsTextureIsWrongByTheSizeOfItsFeatures) {
    Mesh ground = foliage::card(16, 16);
    Mesh bare = ground;
    bare.uvs.clear();
    const double error = of_skins(ground, {striped()}, bare, {striped()}).error;
    EXPECT_GT(error, 0.5);
    EXPECT_LT(error, 6);
    EXPECT_LT(of_skins(ground, {striped()}, ground, {striped()}).error, 1e-5);
    // Details too faint to be seen may go.
    const PicturePtr faint = foliage::picture(64, [](double x, double) {
        return glm::dvec4(glm::dvec3(std::fmod(8 * x, 2) < 1 ? 0.2 : 0.22), 1);
    });
    Material pale;
    pale.base_color_texture = foliage::texture(faint);
    pale.base_color = glm::dvec3(faint->mean);
    EXPECT_LT(of_skins(ground, {pale}, bare, {pale}).error, 1e-5);
}

TEST(DeviationTexels, TextureThatSlidIsWrongByAsMuch) {
    const Mesh ground = foliage::card(16, 16);
    Mesh slid = ground;
    for (glm::vec2& uv : slid.uvs)
        uv.x += 0.5f / 16;
    EXPECT_NEAR(of_skins(ground, {striped()}, slid, {striped()}).error, 0.5, 0.05);
    // By a whole tile it shows the same.
    for (glm::vec2& uv : slid.uvs)
        uv.x += 1 - 0.5f / 16;
    EXPECT_LT(of_skins(ground, {striped()}, slid, {striped()}).error, 1e-5);
}

TEST(DeviationTexels, VertexColorsThatAreGoneAreMissed) {
    Mesh ground = shapes::grid(16);
    Material painted;
    painted.base_color = glm::dvec3(0.5);
    painted.vertex_colors = true;
    for (glm::vec3& position : ground.positions) {
        ground.colors.emplace_back(glm::vec3(position.x < 0.5f ? 0.0f : 1.0f), 1.0f);
        position *= 16;
    }
    Mesh bare = ground;
    bare.colors.clear();
    EXPECT_LT(of_skins(ground, {painted}, ground, {painted}).error, 1e-5);
    EXPECT_GT(of_skins(ground, {painted}, bare, {painted}).error, 2);
}

TEST(DeviationTexels, RepaintedTrianglesShowTheRightPartOfTheTexture) {
    // Boards under a carpet, above and below. Where each piece of it shows another part of the
    // atlas, boards of two triangles cannot show them all.
    const PicturePtr atlas =
        foliage::picture(64, [](double x, double y) { return glm::dvec4(x, y, 0.2, 1); });
    Material carpet;
    carpet.base_color_texture = foliage::texture(atlas);
    const std::vector<Material> materials{Material{}, carpet};
    image::TexelCache texels;
    const auto skin = std::make_shared<const ray::MeshSkin>(materials, texels);
    const auto repainted = [&](bool whole) {
        Mesh floor = foliage::card(4, 4);
        for (int i = 0; i < 64; ++i) {
            const int row = i / 8;
            Mesh tile = foliage::card(0.5f, 0.5f);
            for (glm::vec2& uv : tile.uvs)
                uv = whole ? (uv + glm::vec2(i % 8, row)) / 8.0f
                           : (uv + glm::vec2((i * 37) % 8, (i * 53) % 7)) / 8.0f;
            for (const double height : {-0.01, 0.01})
                append(floor, tile, {glm::dmat3(1.0), {0.5 * (i % 8), 0.5 * row, height}}, 1);
        }
        measure::LookPalette palette;
        const std::vector<uint16_t> looks = palette.of(floor, materials);
        const DeviationReference reference(floor, {}, {looks, &palette, skin});
        Mesh boards = foliage::card(4, 4);
        for (glm::vec2& uv : boards.uvs)
            uv = 1.0f - uv;
        boards.slots = {0, 0};
        reference.repaint(boards, skin.get());
        EXPECT_NO_THROW(check(boards));
        return boards;
    };
    const Mesh one = repainted(true);
    EXPECT_EQ(one.slots, (std::vector<uint16_t>{1, 1}));
    for (uint32_t triangle = 0; triangle < 2; ++triangle) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = one.triangles[triangle][corner];
            EXPECT_NEAR(one.uvs[vertex].x, one.positions[vertex].x / 4, 0.03);
            EXPECT_NEAR(one.uvs[vertex].y, one.positions[vertex].y / 4, 0.03);
        }
    }
    const Mesh many = repainted(false);
    EXPECT_EQ(many.slots, (std::vector<uint16_t>{0, 0})) << "rather boards than a wrong carpet";
}

TEST(DeviationTexels, SameBitsOnOneAndManyThreads) {
    const Mesh tree = foliage::tree(40);
    const std::vector<Material> materials{striped(), foliage::leaf(foliage::left_half())};
    Mesh moved = tree;
    for (glm::vec3& position : moved.positions)
        position.x += 0.01f;
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        const SurfaceDeviation out = of_skins(tree, materials, moved, materials);
        return std::pair(out.error, out.max);
    };
    EXPECT_EQ(run(1), run(0));
}
