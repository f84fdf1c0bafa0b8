// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the shading normals of cards: on their own side, and bent no farther than POV-Ray shows.
#include "cards/card_normals.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

using namespace lodestone;

TEST(CardNormals, OfASideThatShowsNothingAreItsFace) {
    const cards::SideNormals none({}, {0, 0, 1});
    EXPECT_NEAR(glm::length(none.at({0.3, -0.7}) - glm::dvec3(0, 0, 1)), 0, 1e-12);
}

TEST(CardNormals, FollowWhatIsSeenUpToFifteenDegrees) {
    cards::SeenNormals seen;
    for (int i = 0; i < 1000; ++i) {
        const double x = -1 + 2 * (i + 0.5) / 1000;
        seen.add({x, 0.5}, glm::normalize(glm::dvec3(x, 0, 2)));
        seen.add({x, -0.5}, glm::normalize(glm::dvec3(x, 0, 2)));
    }
    const cards::SideNormals normals(seen, {0, 0, 1});
    EXPECT_GT(normals.at({0.9, 0}).x, 0.15);
    EXPECT_LT(normals.at({-0.9, 0}).x, -0.15);
    EXPECT_NEAR(normals.at({0, 0}).x, 0, 0.02);
    for (const double x : {-1.0, 0.0, 1.0}) {
        EXPECT_GT(normals.at({x, 1}).z, 0.9659);
        EXPECT_NEAR(glm::length(normals.at({x, 1})), 1, 1e-12);
    }
}
