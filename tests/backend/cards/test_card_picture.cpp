// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the picture of cards: what is cast, where nothing is, and how it is kept.
#include "cards/card_picture.h"
#include "image/texture_sampler.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using cards::CardPicture;
using cards::CardPlane;

namespace {

class CardPictures : public WithRays {
protected:
    /// The picture of a mesh on upright and level planes through a middle.
    CardPicture cast(const Mesh& mesh, const std::vector<Material>& materials,
                     const glm::dvec3& middle, int texels = 32) {
        image::TexelCache cache;
        const auto skin = std::make_shared<const ray::MeshSkin>(materials, cache);
        const std::vector<CardPlane> planes = cards::crossed_planes(mesh, middle);
        CardPicture out = cards::picture_of_cards(planes, texels);
        cards::cast_picture(out, planes, mesh, ray::MeshScene(mesh, skin), *skin, 1, {});
        return out;
    }
};

/// The mean share of a card's texels.
double covered(const CardPicture& picture, size_t card) {
    const cards::CardPatch& patch = picture.patches[card];
    double sum = 0;
    for (int row = 0; row < patch.height; ++row) {
        for (int column = 0; column < patch.width; ++column)
            sum += double{picture.texels[picture.index(patch.left + column, patch.top + row)].w};
    }
    return sum / patch.width / patch.height;
}

}  // namespace

TEST(CardPictureLayout, NoPlanesHaveNoPicture) {
    const CardPicture picture = cards::picture_of_cards({}, 32);
    EXPECT_TRUE(picture.texels.empty());
    EXPECT_TRUE(picture.patches.empty());
}

TEST(CardPictureLayout, CardsLieBesideEachOtherWithClearTexelsBetweenAndFitWhatIsMeasured) {
    const std::vector<CardPlane> planes =
        cards::crossed_planes(shapes::box({-40, -1, 0}, {40, 1, 1}), {0, 0, 0.5});
    for (const int texels : {1, 32, 100000}) {
        const CardPicture picture = cards::picture_of_cards(planes, texels);
        ASSERT_EQ(picture.patches.size(), planes.size());
        EXPECT_LE(picture.width, 256);
        EXPECT_LE(picture.height, 256);
        int end = 0;
        for (const cards::CardPatch& patch : picture.patches) {
            EXPECT_GE(patch.left, end + 1);
            EXPECT_GE(patch.top, 1);
            EXPECT_GE(patch.width, 1);
            EXPECT_GE(patch.height, 1);
            EXPECT_LT(patch.top + patch.height, picture.height);
            end = patch.left + patch.width + 1;
        }
        EXPECT_EQ(end, picture.width);
    }
}

TEST_F(CardPictures, ABoxCoversItsCardsInItsColor) {
    const CardPicture picture = cast(shapes::box({-1, -1, 0}, {1, 1, 2}),
                                     {models::colored("red", {0.5, 0.2, 0.1})}, {0, 0, 1});
    ASSERT_EQ(picture.normals.size(), 5u);
    for (size_t card = 0; card < 5; ++card)
        EXPECT_NEAR(covered(picture, card), 1, 0.01) << card;
    const cards::CardPatch& patch = picture.patches[0];
    const glm::vec4& texel =
        picture.texels[picture.index(patch.left + patch.width / 2, patch.top + patch.height / 2)];
    EXPECT_NEAR(texel.x, 0.5, 1e-5);
    EXPECT_NEAR(texel.y, 0.2, 1e-5);
    EXPECT_NEAR(texel.z, 0.1, 1e-5);
    // Each side has the normals of what it shows: the box's own.
    const glm::dvec3 front = picture.normals[0][0].at({0, 0});
    EXPECT_NEAR(glm::dot(front, glm::dvec3(0, -1, 0)), 1, 0.02);
    EXPECT_NEAR(glm::dot(picture.normals[0][1].at({0, 0}), glm::dvec3(0, 1, 0)), 1, 0.02);
}

TEST_F(CardPictures, AMaskCoversItsShareAndKeepsItsColorToTheEdge) {
    Mesh leaves;  // a ball of cards, half of each there
    leaves = foliage::tree(300);
    CardPicture picture = cast(
        leaves, {models::colored("bark", {0.1, 0.6, 0.1}), foliage::leaf(foliage::left_half())},
        {0, 0, 2});
    EXPECT_GT(covered(picture, 0), 0.1);
    EXPECT_LT(covered(picture, 0), 0.9);
    cards::fill_clear(picture);
    for (const glm::vec4& texel : picture.texels) {
        EXPECT_NEAR(texel.x, 0.1, 0.01) << "what is cut away is red and must not bleed";
        EXPECT_NEAR(texel.y, 0.6, 0.01);
    }
}

TEST_F(CardPictures, TheTextureShowsTheColorsThatWereCast) {
    CardPicture picture = cast(shapes::box({-1, -1, 0}, {1, 1, 2}),
                               {models::colored("dark", {0.02, 0.01, 0.005})}, {0, 0, 1});
    cards::fill_clear(picture);
    const Texture texture = cards::texture_of(picture);
    EXPECT_EQ(texture.picture->width, picture.width);
    EXPECT_LE(texture.scale.x, 1);
    const image::TextureSampler sampler(texture, glm::dvec3(0.0), 256);
    const glm::dvec3 color = sampler.color({0.1, 0.5});
    EXPECT_NEAR(color.x, 0.02, 2e-4);
    EXPECT_NEAR(color.y, 0.01, 2e-4);
    EXPECT_NEAR(color.z, 0.005, 2e-4);
}

TEST_F(CardPictures, BlackHasATexture) {
    CardPicture picture =
        cast(shapes::box({-1, -1, 0}, {1, 1, 2}), {models::colored("black", {0, 0, 0})}, {0, 0, 1});
    cards::fill_clear(picture);
    const Texture texture = cards::texture_of(picture);
    EXPECT_TRUE(std::isfinite(texture.scale.x));
    EXPECT_NEAR(image::TextureSampler(texture, glm::dvec3(1.0), 256).color({0.1, 0.5}).x, 0, 1e-6);
}
