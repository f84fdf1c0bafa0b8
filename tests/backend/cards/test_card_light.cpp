// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the light of cards: as much as the thing's, each kind of card by its own factor.
#include "base/parallel.h"
#include "cards/card_light.h"
#include "cards/card_views.h"
#include "cards/crossed_cards.h"
#include "measure/pictures/picture_agreement.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

class CardLight : public WithRays {
protected:
    image::TexelCache texels_;

    std::vector<Material> leafy(const glm::dvec3& color) {
        return {models::colored("bark", {0.2, 0.1, 0.05}),
                foliage::leaf(foliage::picture(32, [color](double x, double y) {
                    return glm::dvec4(color, std::hypot(x - 0.5, y - 0.5) < 0.4 ? 1 : 0);
                }))};
    }
    ray::SkinPtr skin_of(const std::vector<Material>& materials) {
        return std::make_shared<const ray::MeshSkin>(materials, texels_);
    }
    cards::CrossedCards made(const Mesh& tree, const ray::SkinPtr& skin) {
        Attributes attributes;
        attributes.visible_area = 1;
        attributes.centroid = {0, 0, 2};
        return cards::crossed_cards(tree, ray::MeshScene(tree, skin), *skin, attributes, {}, {})
            .value();
    }
    static float brightest(const cards::CardPicture& picture, size_t plane) {
        float out = 0;
        const cards::CardPatch& patch = picture.patches[plane];
        for (int row = patch.top; row < patch.top + patch.height; ++row) {
            for (int column = patch.left; column < patch.left + patch.width; ++column) {
                const glm::vec4& texel = picture.texels[picture.index(column, row)];
                out = texel.w > 0 ? std::max(out, texel.y) : out;
            }
        }
        return out;
    }
};

}  // namespace

TEST_F(CardLight, OfWhatShowsNothingStaysAsItIs) {
    const Mesh cube = shapes::box({-1, -1, -1}, {1, 1, 1});
    const std::vector<cards::CardPlane> planes = cards::crossed_planes(cube, glm::dvec3(0.0));
    cards::CardPicture picture = cards::picture_of_cards(planes, 16);
    picture.normals.resize(planes.size());
    for (glm::vec4& texel : picture.texels)
        texel = {0.25F, 0.5F, 0.75F, 0.0F};
    const std::vector<glm::vec4> before = picture.texels;
    const ray::SkinPtr skin = skin_of({});
    cards::match_light(picture, planes, cube, ray::MeshScene(cube, skin), *skin, 1, {});
    EXPECT_EQ(picture.texels, before) << "clear cards";
    cards::match_light(picture, planes, {}, ray::MeshScene(Mesh{}), *skin, 1, {});
    EXPECT_EQ(picture.texels, before) << "no thing";
}

TEST_F(CardLight, IsThatOfTheCrownUnderSunsAllAround) {
    const Mesh tree = foliage::tree(300);
    const ray::SkinPtr skin = skin_of(leafy({0.1, 0.5, 0.05}));
    const cards::CrossedCards one = made(tree, skin);
    const measure::AgreementReference pictures(tree, ray::MeshScene(tree, skin), skin, 7,
                                               measure::AgreementReference::kSide, {},
                                               measure::PictureViews::OfCrowns);
    const glm::dvec3 light = pictures.of(one.mesh, skin_of({one.material})).light;
    EXPECT_NEAR(light.y, 1, 0.12) << "other views and suns, of which there are 13";
}

TEST_F(CardLight, LevelCardsUnderAHighSunWereTooBright) {
    const Mesh tree = foliage::tree(300);
    const cards::CrossedCards one = made(tree, skin_of(leafy({0.1, 0.5, 0.05})));
    EXPECT_LT(brightest(one.picture, 3), 0.95F * brightest(one.picture, 0));
    EXPECT_NEAR(brightest(one.picture, 4), brightest(one.picture, 3), 0.05F) << "one kind";
}

TEST_F(CardLight, IsTheSameBitsOnAnyNumberOfThreads) {
    const Mesh tree = foliage::tree(100);
    const ray::SkinPtr skin = skin_of(leafy({0.1, 0.5, 0.05}));
    const cards::CrossedCards one = made(tree, skin);
    const ThreadLimit alone(1);
    EXPECT_EQ(one.picture.texels, made(tree, skin).picture.texels);
}
