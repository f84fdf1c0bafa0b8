// SPDX-License-Identifier: GPL-3.0-or-later
// Guards crossed cards: what they are made of, and that POV-Ray shows their normals as they are.
#include "cards/crossed_cards.h"
#include "povray_export/mesh/leaf_normals.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <gtest/gtest.h>
#include <set>

using namespace lodestone;

namespace {

class CrossedCards : public WithRays {
protected:
    std::optional<cards::CrossedCards> made(const Mesh& mesh,
                                            const std::vector<Material>& materials) {
        image::TexelCache texels;
        const auto skin = std::make_shared<const ray::MeshSkin>(materials, texels);
        Attributes attributes;
        attributes.visible_area = 1;
        attributes.centroid = bound_of(mesh.positions).box.empty()
                                  ? glm::dvec3(0.0)
                                  : bound_of(mesh.positions).box.center();
        return cards::crossed_cards(mesh, ray::MeshScene(mesh, skin), *skin, attributes, {}, {});
    }
    std::vector<Material> leafy_{models::colored("bark", {0.2, 0.1, 0.05}),
                                 foliage::leaf(foliage::left_half())};
};

}  // namespace

TEST_F(CrossedCards, OfNothingAndOfASheetAreNone) {
    EXPECT_FALSE(made({}, leafy_));
    EXPECT_FALSE(made(shapes::quad(1, 1), leafy_));
}

TEST_F(CrossedCards, ThePictureHasAsManyBytesAsToldBefore) {
    EXPECT_EQ(cards::picture_bytes({}, {0, 0, 0}, {}), 0);
    EXPECT_EQ(cards::picture_bytes(shapes::quad(1, 1), {0, 0, 0}, {}), 0) << "a sheet has none";
    const Mesh tree = foliage::tree(100);
    const auto one = made(tree, leafy_);
    ASSERT_TRUE(one);
    const Picture& picture = *one->material.base_color_texture.picture;
    EXPECT_EQ(cards::picture_bytes(tree, bound_of(tree.positions).box.center(), {}),
              4.0 * picture.width * picture.height);
}

TEST_F(CrossedCards, OfWhatIsAllCutAwayAreNone) {
    const PicturePtr clear =
        foliage::picture(8, [](double, double) { return glm::dvec4(0.5, 0.5, 0.5, 0); });
    Mesh ball = shapes::sphere(1, 2);
    ball.uvs.assign(ball.positions.size(), glm::vec2(0.5f));
    EXPECT_FALSE(made(ball, {foliage::leaf(clear)}));
}

TEST_F(CrossedCards, AreFivePlanesSeenFromBothSidesInOneMask) {
    const auto one = made(foliage::tree(100), leafy_);
    ASSERT_TRUE(one);
    EXPECT_NO_THROW(check(one->mesh));
    EXPECT_EQ(one->mesh.triangles.size(), cards::kCardTriangles);
    EXPECT_TRUE(one->mesh.slots.empty());
    EXPECT_EQ(one->material.alpha_mode, AlphaMode::Clip);
    EXPECT_EQ(one->material.base_color_texture.picture, one->material.alpha_texture.picture);
    EXPECT_GT(one->material.alpha_texture.picture->mean.w, 0);
    for (const glm::vec2& uv : one->mesh.uvs) {
        EXPECT_GE(std::min(uv.x, uv.y), 0);
        EXPECT_LE(std::max(uv.x, uv.y), 1);
    }
    std::set<std::array<int, 3>> faces;
    for (size_t i = 0; i < one->mesh.triangles.size(); ++i) {
        const glm::dvec3 face = glm::normalize(area_vector(one->mesh, i));
        faces.insert({static_cast<int>(std::lround(100 * face.x)),
                      static_cast<int>(std::lround(100 * face.y)),
                      static_cast<int>(std::lround(100 * face.z))});
        EXPECT_FALSE(povray::face_of_bent(one->mesh, i)) << "POV-Ray would show other normals";
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_GT(glm::dot(glm::dvec3(one->mesh.normals[one->mesh.triangles[i][corner]]), face),
                      0.965);
    }
    EXPECT_EQ(faces.size(), 8u) << "each side of each plane";
}

TEST_F(CrossedCards, WhatWasAddedBesideTheirOutlineWasBlack) {
    const auto one = made(foliage::tree(100), {models::colored("bark", {0.1, 0.6, 0.1}),
                                               foliage::leaf(foliage::left_half())});
    ASSERT_TRUE(one);
    for (const glm::vec4& texel : one->picture.texels) {
        EXPECT_GT(texel.y, 0.4) << "as bright as the tree, nearly";
        EXPECT_NEAR(texel.x / texel.y, 1.0 / 6, 0.02) << "and of its hue";
    }
}
