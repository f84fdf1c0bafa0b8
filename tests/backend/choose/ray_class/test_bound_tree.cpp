// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how near things are said to be: as asking each of them says.
#include "choose/ray_class/bound_tree.h"
#include "scenes/lens_views.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using bent::ball;
using choose::BoundTree;

TEST(BoundTree, NothingIsNearWhereThereIsNothing) {
    EXPECT_EQ(BoundTree({}).nearest(ball({}, 1), 0, 7), 7);
    EXPECT_EQ(BoundTree({ball({}, 1)}).nearest(ball({}, 1), 0, 7), 7);
    EXPECT_EQ(BoundTree({ball({}, 1), Bound{}}).nearest(ball({}, 1), 0, 7), 7);
}

TEST(BoundTree, DistancesAreTheLargerOfBoxesAndSpheres) {
    EXPECT_NEAR(choose::distance(ball({}, 1), ball({5, 0, 0}, 1)), 3, 1e-12);
    // Boxes of balls touch across the corner earlier than the balls
    EXPECT_NEAR(choose::distance(ball({}, 1), ball({2, 2, 2}, 1)), std::sqrt(12.0) - 2, 1e-12);
    Bound floor;
    floor.box = {{-100, -100, -1}, {100, 100, 0}};
    floor.radius = 142;
    EXPECT_NEAR(choose::distance(ball({0, 0, 3}, 1), floor), 2, 1e-12);
}

TEST(BoundTree, FindsWhatAskingEachFinds) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<Bound> bounds;
    bounds.reserve(500);
    for (int i = 0; i < 500; ++i)
        bounds.push_back(
            ball({20 * any(random), 20 * any(random), any(random)}, 0.3 + 0.2 * any(random)));
    bounds[7].box.low.x = std::numeric_limits<double>::quiet_NaN();  // left out
    const BoundTree tree(bounds);
    for (uint32_t i = 0; i < bounds.size(); ++i) {
        if (i == 7)
            continue;
        double least = 30;
        for (uint32_t j = 0; j < bounds.size(); ++j) {
            if (j != i && j != 7)
                least = std::min(least, std::max(0.0, choose::distance(bounds[i], bounds[j])));
        }
        EXPECT_NEAR(tree.nearest(bounds[i], i, 30), least, 1e-12);
    }
}
