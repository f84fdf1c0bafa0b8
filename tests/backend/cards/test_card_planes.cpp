// SPDX-License-Identifier: GPL-3.0-or-later
// Guards where crossed cards stand: through the middle, around all that is there.
#include "cards/card_planes.h"
#include "scenes/small_meshes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using cards::CardPlane;

TEST(CardPlanes, NothingHasNone) {
    EXPECT_TRUE(cards::crossed_planes({}, glm::dvec3(0.0)).empty());
}

TEST(CardPlanes, AFlatSheetHasNone) {
    EXPECT_TRUE(cards::crossed_planes(shapes::quad(1, 1), glm::dvec3(0.0)).empty());
}

TEST(CardPlanes, ACubeHasThreeUprightOnesAroundItAndTwoLevelOnes) {
    const Mesh cube = shapes::box({-1, -1, 0}, {1, 1, 4});
    const std::vector<CardPlane> planes = cards::crossed_planes(cube, {0, 0, 2});
    ASSERT_EQ(planes.size(), 5u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(planes[i].normal().z, 0, 1e-12);
        EXPECT_NEAR(planes[i].half_size.y, 2, 1e-6);
        const double turn = 3.14159265358979 * static_cast<double>(i) / 3;
        EXPECT_NEAR(planes[i].half_size.x, std::abs(std::cos(turn)) + std::abs(std::sin(turn)),
                    1e-6);
        EXPECT_NEAR(glm::length(planes[i].middle - glm::dvec3(0, 0, 2)), 0, 1e-6);
    }
    for (size_t i = 3; i < 5; ++i) {
        EXPECT_FALSE(planes[i].upright());
        EXPECT_NEAR(planes[i].normal().z, 1, 1e-12);
        EXPECT_NEAR(planes[i].half_size.x, 1, 1e-6);
        EXPECT_NEAR(planes[i].half_size.y, 1, 1e-6);
        EXPECT_NEAR(planes[i].middle.z, i == 3 ? 1 : 3, 1e-6)
            << "a quarter and three of the height";
    }
}

TEST(CardPlanes, GoThroughTheGivenMiddleWhereMoreIsOnOneSide) {
    const std::vector<CardPlane> planes =
        cards::crossed_planes(shapes::box({-1, -1, 0}, {3, 1, 2}), {0.5, 0, 0.5});
    ASSERT_EQ(planes.size(), 5u);
    for (const CardPlane& plane : planes) {
        const double off = glm::dot(glm::dvec3(0.5, 0, 0.5) - plane.middle, plane.normal());
        EXPECT_NEAR(plane.upright() ? off : 0, 0, 1e-6);
    }
    EXPECT_NEAR(planes[0].middle.x, 1, 1e-6);
    EXPECT_NEAR(planes[0].half_size.x, 2, 1e-6);
}

TEST(CardPlanes, CornersThatAreNoNumbersDoNotCount) {
    Mesh mesh = shapes::box({-1, -1, 0}, {1, 1, 4});
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    mesh.positions.emplace_back(std::numeric_limits<float>::infinity(), 0, 0);
    mesh.triangles.emplace_back(0, 8, 9);
    const std::vector<CardPlane> planes = cards::crossed_planes(mesh, {0, 0, 2});
    ASSERT_EQ(planes.size(), 5u);
    EXPECT_NEAR(planes[0].half_size.x, 1, 1e-6);
}
