// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that measuring by rays sees alpha and texels: half a leaf is half as visible, and green.
#include "base/parallel.h"
#include "measure/visible/surface_opacity.h"
#include "measure/visible/visible_attributes.h"
#include "scenes/leaf_cards.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace lodestone;
using measure::measure_visible;
using measure::VisibleOptions;

namespace {

Attributes attributes_with(const Mesh& mesh, const std::vector<Material>& materials,
                           uint64_t rays = 16384) {
    VisibleOptions options;
    options.rays = rays;
    return measure_visible(mesh, materials, options).attributes;
}

}  // namespace

TEST(VisibleAlpha, CardOfWhichHalfIsCoveredIsHalfAsVisible) {
    const Mesh card = foliage::card(2, 1);
    const Attributes half = attributes_with(card, {foliage::leaf(foliage::left_half())});
    EXPECT_NEAR(half.visible_area, 2, 0.02);  // half of both sides
    EXPECT_NEAR(glm::length(half.centroid - glm::dvec3(0.5, 0.5, 0)), 0, 0.01);
    EXPECT_NEAR(half.moments[0][0], half.visible_area / 12, 0.01);
    EXPECT_NEAR(half.moments[1][1], half.visible_area / 12, 0.01);
    EXPECT_NEAR(glm::length(half.color - glm::dvec3(0.1, 0.6, 0.1)), 0, 0.01)
        << "not the red of what is not there";
    const Attributes whole = attributes_with(card, {Material{}});
    EXPECT_NEAR(whole.visible_area, 4, 0.02);
}

TEST(VisibleAlpha, BlendedCardsBehindOneAnotherCoverWhatIsLeft) {
    // Far apart beside each other both show half; the light that comes through stays visible.
    Material veil;
    veil.alpha_mode = AlphaMode::Blend;
    veil.alpha = 0.5;
    EXPECT_NEAR(attributes_with(shapes::quad(1, 1), {veil}).visible_area, 1, 0.02);
    // Two in one place: of a ray 1 - 0.5^2 ends at one of them.
    Mesh two = shapes::quad(1, 1);
    append(two, shapes::quad(1, 1), {glm::dmat3(1.0), {0, 0, 1e-3}});
    EXPECT_NEAR(attributes_with(two, {veil}, 65536).visible_area, 1.5, 0.03);
}

TEST(VisibleAlpha, InsideOfAClosedBoxWithHolesIsSeen) {
    const Mesh box = shapes::box({0, 0, 0}, {1, 1, 1});
    Material lattice;
    lattice.alpha_mode = AlphaMode::Blend;
    lattice.alpha = 0.5;
    const double visible = attributes_with(box, {lattice}, 65536).visible_area;
    EXPECT_GT(visible, 4.2) << "outer sides are 3, and the inner ones show through the holes";
    EXPECT_LT(visible, 6);
    EXPECT_NEAR(attributes_with(box, {Material{}}).visible_area, 6, 0.05);
}

TEST(VisibleAlpha, ClearShellsAreKnownAsWellAsSolidOnes) {
    // 39 of 40 rays started where nothing was, and left the centroid unknown to a twentieth of the
    // radius of gyration.
    Mesh balls = shapes::sphere(1);
    append(balls, shapes::sphere(1), {glm::dmat3(1.0), {3, 0, 0}});
    Material clear;
    clear.alpha_mode = AlphaMode::Blend;
    clear.alpha = 0.025;
    const Attributes once = attributes_with(balls, {clear});
    // Both sides, each a fortieth of the time, and nearly nothing hides them.
    EXPECT_NEAR(once.visible_area / (0.025 * once.surface_area), 0.98, 0.02);
    EXPECT_NEAR(glm::length(once.centroid - glm::dvec3(1.5, 0, 0)), 0, 0.01);
    // The same by lines.
    VisibleOptions lines;
    lines.rays = uint64_t{1} << 18u;
    lines.casting = measure::CastMethod::FromBound;
    EXPECT_NEAR(
        measure_visible(balls, std::vector<Material>{clear}, lines).attributes.visible_area /
            once.visible_area,
        1, 0.03);
}

TEST(VisibleAlpha, ClearFlatSheetIsNotAllThere) {
    // Every ray that leaves it gets away, but it is half transparent: no traversal.
    Material veil;
    veil.alpha_mode = AlphaMode::Blend;
    veil.alpha = 0.5;
    EXPECT_NEAR(attributes_with(shapes::quad(2, 1), {veil}).visible_area, 2, 1e-9);
    veil.alpha = 0;
    EXPECT_EQ(attributes_with(shapes::quad(2, 1), {veil}).visible_area, 0);
}

TEST(VisibleAlpha, SlotsCountAsTheyCover) {
    // Two sheets far apart, one of them clear: the centroid is nearer to the other.
    Mesh two = shapes::quad(1, 1);
    append(two, shapes::quad(1, 1), {glm::dmat3(1.0), {0, 0, 100}});
    two.slots.assign(two.triangles.size(), 0);
    std::fill(two.slots.begin() + static_cast<std::ptrdiff_t>(two.slots.size() / 2),
              two.slots.end(), uint16_t{1});
    Material veil;
    veil.alpha_mode = AlphaMode::Blend;
    veil.alpha = 0.25;
    const Attributes seen = attributes_with(two, {Material{}, veil});
    EXPECT_NEAR(seen.visible_area, 2.5, 0.01);
    EXPECT_NEAR(seen.centroid.z, 20, 0.2);
}

TEST(VisibleAlpha, NothingOfASurfaceThatIsNotThere) {
    Material nothing;
    nothing.alpha_mode = AlphaMode::Clip;
    nothing.alpha = 0.2;
    const Attributes out = attributes_with(shapes::cube(), {nothing});
    EXPECT_TRUE(out.empty());
}

TEST(VisibleTexels, AtlasGivesEachObjectItsOwnColor) {
    const PicturePtr atlas = foliage::picture(64, [](double x, double) {
        return x < 0.5 ? glm::dvec4(0.8, 0.1, 0.1, 1) : glm::dvec4(0.1, 0.1, 0.8, 1);
    });
    Material material;
    material.base_color = glm::dvec3(atlas->mean);
    material.base_color_texture = foliage::texture(atlas);
    for (const bool left : {true, false}) {
        Mesh mesh = foliage::card(1, 1);
        for (glm::vec2& uv : mesh.uvs)
            uv.x = (left ? 0.05f : 0.55f) + 0.4f * uv.x;
        const glm::dvec3 color = attributes_with(mesh, {material}).color;
        EXPECT_NEAR(color.x, left ? 0.8 : 0.1, 0.01);
        EXPECT_NEAR(color.z, left ? 0.1 : 0.8, 0.01);
    }
    // Without coordinates it is the mean.
    const glm::dvec3 mean = attributes_with(shapes::quad(1, 1), {material}).color;
    EXPECT_NEAR(glm::length(mean - glm::dvec3(atlas->mean)), 0, 1e-9);
}

TEST(VisibleTexels, NumbersVertexColorsAndEmissionAreLookedUp) {
    const PicturePtr ramp =
        foliage::picture(64, [](double x, double) { return glm::dvec4(x, x, x, 1); });
    Material material;
    material.base_color = {0.5, 0.5, 0.5};
    material.vertex_colors = true;
    material.roughness_texture = foliage::texture(ramp, TextureChannel::Red);
    material.emission_texture = foliage::texture(ramp);
    material.emission_texture.scale = glm::dvec3(10);
    Mesh mesh = foliage::card(1, 1);
    mesh.colors = {{1, 0, 0, 1}, {1, 0, 0, 1}, {0, 0, 1, 1}, {0, 0, 1, 1}};
    const Attributes out = attributes_with(mesh, {material});
    EXPECT_NEAR(glm::length(out.color - glm::dvec3(0.25, 0, 0.25)), 0, 0.01);
    EXPECT_NEAR(out.roughness, 0.5, 0.01);
    EXPECT_NEAR(out.emission.x, 5, 0.1);
    EXPECT_EQ(out.metallic, 0);
}

TEST(VisibleTexels, MixturesShowTheMeanOfWhatTheyMix) {
    Material material;
    material.base_color = {1, 0, 0};
    Material second;
    second.base_color = {0, 0, 1};
    second.metallic = 1;
    material.other = std::make_shared<Material>(second);
    material.mix = 0.25;
    const Attributes out = attributes_with(shapes::cube(), {material});
    EXPECT_NEAR(glm::length(out.color - glm::dvec3(0.75, 0, 0.25)), 0, 1e-9);
    EXPECT_NEAR(out.metallic, 0.25, 1e-9);
}

TEST(VisibleAlpha, SameBitsOnOneAndManyThreads) {
    const Mesh tree = foliage::tree(60);
    const std::vector<Material> materials{Material{},
                                          foliage::leaf(foliage::left_half(), AlphaMode::Blend)};
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        const Attributes out = attributes_with(tree, materials);
        return std::tuple(out.visible_area, out.centroid, out.moments, out.color);
    };
    EXPECT_EQ(run(1), run(0));
}

TEST(Opacity, IsTheMeanOverTheSurface) {
    image::TexelCache texels;
    const Mesh card = foliage::card(1, 2);
    const auto opacity = [&](const Mesh& mesh, const std::vector<Material>& materials) {
        return measure::mean_opacity(mesh, ray::MeshSkin(materials, texels), 1);
    };
    EXPECT_EQ(opacity(Mesh{}, {}), 1);
    EXPECT_EQ(opacity(card, {Material{}}), 1);
    EXPECT_NEAR(opacity(card, {foliage::leaf(foliage::left_half())}), 0.5, 0.02);
    Material glass;
    glass.transmission = 0.9;
    EXPECT_NEAR(opacity(card, {glass}), 0.1, 1e-9);
    Mesh pair = card;
    append(pair, card, {glm::dmat3(1.0), {3, 0, 0}}, 1);
    EXPECT_NEAR(opacity(pair, {glass, Material{}}), 0.55, 0.02);
}
