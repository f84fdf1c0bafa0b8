// SPDX-License-Identifier: GPL-3.0-or-later
// Guards lamps: what glows in the midst of something else stays there, and stays as bright.
#include "hierarchy/lamp_materials.h"
#include "hierarchy/proposers/lamp_levels.h"
#include "measure/deviation/surface_deviation.h"
#include "measure/pictures/picture_agreement.h"
#include "scenes/built_models.h"
#include "scenes/small_models.h"
#include "scenes/street_lamps.h"
#include "scenes/with_rays.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::lamps;

namespace {

class Glow : public WithRays {};

Mesh lamp() {
    return lamps::lamp(0.08);
}

size_t triangles_of(const Mesh& mesh, uint16_t slot) {
    return static_cast<size_t>(std::count(mesh.slots.begin(), mesh.slots.end(), slot));
}

Mesh without(const Mesh& mesh, uint16_t slot) {
    std::vector<uint8_t> keep;
    for (const uint16_t other : mesh.slots)
        keep.push_back(other == slot ? 0 : 1);
    return subset(mesh, keep);
}

double error_of(const Mesh& stand_in, std::span<const Material> own) {
    const Mesh finest = lamp();
    const std::vector<Material> truth = materials();
    measure::LookPalette palette;
    const std::vector<uint16_t> looks = palette.of(finest, truth);
    image::TexelCache texels;
    const measure::DeviationReference reference(
        finest, {2048, 2048}, {looks, &palette, std::make_shared<ray::MeshSkin>(truth, texels)});
    const std::vector<uint16_t> theirs = palette.of(stand_in, own);
    return reference.of(stand_in, {theirs, &palette, std::make_shared<ray::MeshSkin>(own, texels)})
        .error;
}

}  // namespace

TEST_F(Glow, WithoutLampsLevelsAreThoseOfSimplification) {
    const Mesh ball = shapes::sphere(1, 3);
    const std::vector<size_t> targets{200, 20};
    const std::vector<Mesh> plain = simplify::simplify_chain(ball, targets);
    const std::vector<Mesh> levels = hierarchy::simplify_with_lamps(ball, {}, targets, {});
    ASSERT_EQ(levels.size(), plain.size());
    for (size_t i = 0; i < levels.size(); ++i)
        EXPECT_EQ(levels[i].positions, plain[i].positions);
    for (const Mesh& level : hierarchy::simplify_with_lamps(Mesh{}, materials(), targets, {}))
        EXPECT_TRUE(level.empty());
}

TEST_F(Glow, ABulbInItsGlobeIsThereInEveryLevel) {
    const std::vector<size_t> targets{700, 280, 112, 45, 24};
    const std::vector<Mesh> levels =
        hierarchy::simplify_with_lamps(lamp(), materials(), targets, {});
    ASSERT_EQ(levels.size(), targets.size());
    for (size_t i = 0; i < levels.size(); ++i) {
        EXPECT_GE(triangles_of(levels[i], kBulb), 4u) << i;
        EXPECT_LE(levels[i].triangles.size(), targets[i]) << i;
    }
}

TEST_F(Glow, WhatGlowsAllOverIsNoLampAmongOtherThings) {
    std::vector<Material> all = materials();
    for (Material& material : all)
        material.emission = {0.1, 0.1, 0.1};
    const std::vector<size_t> targets{100};
    EXPECT_EQ(hierarchy::simplify_with_lamps(lamp(), all, targets, {})[0].positions,
              simplify::simplify_chain(lamp(), targets)[0].positions);
}

TEST_F(Glow, ALampThatIsGoneIsMissedHoweverNearItsGlobeIs) {
    const Mesh whole = lamp();
    EXPECT_LT(error_of(whole, materials()), 1e-5);
    EXPECT_GT(error_of(without(whole, kBulb), materials()), 2)
        << "the globe is .11 m away and of the bulb's color";
    // What does not glow is missed by its way to what is there instead.
    EXPECT_LT(error_of(without(whole, kGlass), materials()), 0.4);
}

TEST_F(Glow, GlassAndWhatGlowsAreNoneOfTheirColorsLooks) {
    measure::LookPalette looks;
    Material plain = models::colored("plain", {0.9, 0.95, 0.95});
    Material glass = plain;
    glass.transmission = 1;
    Material lamp = models::colored("lamp", {0.1, 0.15, 0.15});
    lamp.emission = {0.8, 0.8, 0.8};
    Material brighter = lamp;
    brighter.emission *= 50.0;
    const uint16_t first = looks.of(plain);
    EXPECT_EQ(looks.of(plain), first);
    EXPECT_NE(looks.of(glass), first);
    EXPECT_NE(looks.of(lamp), first);
    EXPECT_NE(looks.of(brighter), looks.of(lamp));
    EXPECT_EQ(looks.emission(looks.of(lamp)), lamp.emission);
    EXPECT_EQ(looks.opacity(looks.of(glass)), 0);
}

TEST_F(Glow, GlassShowsWhatIsInItLargerByItsIndex) {
    // All light from inside of glass leaves it as if from a surface ior^2 as large.
    const std::vector<Material> truth = materials();
    std::vector<Material> bare = truth;
    bare[kGlass].ior = 1;
    image::TexelCache texels;
    Mesh globe = moved_up(shapes::sphere(0.2, 2), 0, kGlass);
    append(globe, moved_up(shapes::sphere(0.09, 2), 0, kBulb), {});
    globe.normals.clear();
    for (const glm::vec3& position : globe.positions)
        globe.normals.push_back(glm::normalize(position));
    std::vector<Material> in_glass = truth;
    in_glass[kBulb].base_color = bare[kBulb].base_color = {0, 0, 0};
    const measure::AgreementReference pictures(globe, std::make_shared<ray::MeshSkin>(bare, texels),
                                               1);
    const measure::PictureAgreement seen =
        pictures.of(globe, std::make_shared<ray::MeshSkin>(in_glass, texels));
    EXPECT_NEAR(1 / seen.light.x, 1.45 * 1.45, 0.06 * 1.45 * 1.45);
    EXPECT_NEAR(seen.coverage, 1.45 * 1.45, 0.06 * 1.45 * 1.45);
}

TEST_F(Glow, EveryLevelOfALampSendsAsMuchLight) {
    Model model;
    const std::vector<Material> truth = materials();
    model.root = models::add_leaf(model, "lamp", lamp(), truth[0]);
    Representation& finest = model.objects[model.root].representations[0];
    for (const uint16_t slot : {kGlass, kBulb}) {
        finest.materials.push_back(static_cast<uint32_t>(model.materials.size()));
        model.materials.push_back(truth[slot]);
    }
    summarize(finest, model);
    build_in(model, "lamp");
    const Object& object = model.objects[model.root];
    ASSERT_GE(object.representations.size(), 3u);
    image::TexelCache texels;
    const auto skin_of = [&](const Representation& level) {
        std::vector<Material> own;
        for (const uint32_t index : level.materials)
            own.push_back(model.materials[index]);
        return std::make_shared<const ray::MeshSkin>(own, texels);
    };
    for (size_t i = 1; i < object.representations.size(); ++i) {
        const Representation& level = object.representations[i];
        double light = 0;
        for (const uint64_t seed : {7, 8, 9})
            light += measure::AgreementReference(lamp(), skin_of(object.representations[0]), seed)
                         .of(level.mesh(), skin_of(level))
                         .light.x /
                     3;
        EXPECT_NEAR(light, 1, 0.08) << i;
    }
}
