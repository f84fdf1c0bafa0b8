// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the views by which cards are fitted: where rays meet cards, and how much these cover.
#include "base/parallel.h"
#include "cards/card_views.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

class CardViews : public WithRays {
protected:
    Mesh cube_ = shapes::box({-1, -1, -1}, {1, 1, 1});
    std::vector<cards::CardPlane> planes_ = cards::crossed_planes(cube_, glm::dvec3(0.0));
    cards::CardPicture picture_ = cards::picture_of_cards(planes_, 16);
    ray::MeshScene scene_{cube_};

    void cover(float share) {
        for (glm::vec4& texel : picture_.texels)
            texel.w = share;
    }
};

}  // namespace

TEST_F(CardViews, LookFromAllOverTheHalfSphereAbove) {
    const std::vector<glm::dvec3> all = cards::SkyDirections{}.all();
    ASSERT_EQ(all.size(), 26u);
    EXPECT_NEAR(all.front().z, 0, 1e-12);
    EXPECT_NEAR(all.back().z, 1, 1e-12);
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& one : all) {
        EXPECT_NEAR(glm::length(one), 1, 1e-12);
        mean += one / 26.0;
    }
    EXPECT_NEAR(mean.x, 0, 0.05);
    EXPECT_NEAR(mean.y, 0, 0.05);
    EXPECT_NEAR(mean.z, 0.5, 0.05);
    EXPECT_EQ((cards::SkyDirections{26, 1, 2}).all()[0], all[1]) << "each second";
}

TEST_F(CardViews, ALineMeetsACardInTheMiddleOfItsTexels) {
    const auto met =
        cards::crossing_of(planes_[3], picture_.patches[3], picture_, {0, 0, 5}, {0, 0, -1});
    ASSERT_TRUE(met);
    EXPECT_NEAR(met->distance, 5 - planes_[3].middle.z, 1e-12);
    EXPECT_NEAR(met->parts[0] + met->parts[1] + met->parts[2] + met->parts[3], 1, 1e-6);
    EXPECT_FALSE(met->shows(picture_));
    cover(1);
    EXPECT_TRUE(met->shows(picture_));
    EXPECT_FALSE(
        cards::crossing_of(planes_[3], picture_.patches[3], picture_, {9, 0, 5}, {0, 0, -1}))
        << "beside it";
    EXPECT_FALSE(
        cards::crossing_of(planes_[3], picture_.patches[3], picture_, {0, 0, 5}, {1, 0, 0}))
        << "along it";
}

TEST_F(CardViews, TellHowMuchMoreCardsCover) {
    for (const cards::CardView& view : cards::card_views(picture_, planes_, scene_, {}, 1, {})) {
        EXPECT_GT(view.all_wanted, 0);
        EXPECT_DOUBLE_EQ(view.too_much(picture_), -double{view.all_wanted}) << "nothing is there";
    }
    cover(1);
    // Straight from above they cover all of the cube's square.
    const cards::CardView above =
        cards::card_views(picture_, planes_, scene_, {26, 25, 1}, 1, {}).at(0);
    EXPECT_NEAR(above.too_much(picture_) / double{above.all_wanted}, 0, 0.01);
}

TEST_F(CardViews, AreTheSameBitsOnAnyNumberOfThreads) {
    const auto many = cards::card_views(picture_, planes_, scene_, {}, 9, {});
    const ThreadLimit alone(1);
    const auto one = cards::card_views(picture_, planes_, scene_, {}, 9, {});
    ASSERT_EQ(one.size(), many.size());
    for (size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].wanted, many[i].wanted);
        EXPECT_EQ(one[i].begin, many[i].begin);
    }
}
