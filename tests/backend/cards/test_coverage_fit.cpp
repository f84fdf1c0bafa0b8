// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that crossed cards cover what a thing covers, from all sides.
#include "base/parallel.h"
#include "cards/crossed_cards.h"
#include "measure/pictures/picture_agreement.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

class CoverageFits : public WithRays {
protected:
    std::vector<Material> materials_{
        models::colored("bark", {0.2, 0.1, 0.05}),
        foliage::leaf(foliage::picture(32, [](double x, double y) {
            return glm::dvec4(0.1, 0.5, 0.1, std::hypot(x - 0.5, y - 0.5) < 0.4 ? 1 : 0);
        }))};
    image::TexelCache texels_;
    ray::SkinPtr skin_;

    cards::CrossedCards made(const Mesh& tree, uint64_t seed) {
        skin_ = std::make_shared<const ray::MeshSkin>(materials_, texels_);
        Attributes attributes;
        attributes.visible_area = 1;
        attributes.centroid = {0, 0, 2};
        return cards::crossed_cards(tree, ray::MeshScene(tree, skin_), *skin_, attributes, {seed},
                                    {})
            .value();
    }
};

}  // namespace

TEST_F(CoverageFits, CrowdsOfLeavesCoverAsMuch) {
    for (const int leaves : {40, 150, 600}) {
        const Mesh tree = foliage::tree(leaves);
        const cards::CrossedCards one = made(tree, 3);
        const measure::AgreementReference pictures(tree, skin_, 7);
        const auto skin =
            std::make_shared<const ray::MeshSkin>(std::vector<Material>{one.material}, texels_);
        const measure::PictureAgreement seen = pictures.of(one.mesh, skin);
        EXPECT_NEAR(seen.coverage, 1, 0.05) << leaves << " leaves, in other samples";
    }
}

TEST_F(CoverageFits, AreTheSameBitsOnAnyNumberOfThreads) {
    const Mesh tree = foliage::tree(100);
    const cards::CrossedCards one = made(tree, 5);
    const ThreadLimit alone(1);
    const cards::CrossedCards other = made(tree, 5);
    EXPECT_EQ(hash_of(one.mesh), hash_of(other.mesh));
    EXPECT_EQ(hash_of(one.material), hash_of(other.material));
}
