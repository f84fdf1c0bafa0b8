// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what the rays of a placement tell of the sky over it.
#include "backend/light/sky/sky_places.h"
#include "light/sky/sky_means.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace lodestone;
using namespace lodestone::light;

class SkyMeansTest : public SkyPlaces {
protected:
    SkyMeans means_of_first(const std::vector<std::pair<ObjectIndex, Affine>>& things) {
        const SkyPlace place(*this, things);
        return mean_sky_shares(
            {place.surfaces.of(finest(things[0].first)), things[0].second, &*place.scene, 0, 64, 0},
            2048);
    }
    static Affine at(const glm::dvec3& offset) { return {glm::dmat3(1.0), offset}; }
};

// A crown that looked over a hedge was as dark as its stem.
TEST_F(SkyMeansTest, ATowerBetweenWallsIsLighterAboveThem) {
    const ObjectIndex tower = builder.mesh(shapes::box({-1, -1, 0}, {1, 1, 8}));
    const ObjectIndex wall = builder.mesh(shapes::box({0, -50, 0}, {1, 50, 4}));
    const SkyMeans means =
        means_of_first({{tower, {}}, {wall, at({2, 0, 0})}, {wall, at({-3, 0, 0})}});
    EXPECT_GT(means.slope.z, 0.03);
    EXPECT_LT(std::abs(means.slope.x), 0.03);
    EXPECT_NEAR(means.middle.z, 4, 0.5);
    EXPECT_EQ(means_of_first({{tower, {}}}).slope, glm::dvec3(0.0));
    // A buried half is not seen, so it is no reason for a slope.
    const ObjectIndex ground = builder.mesh(shapes::quad(400, 400));
    EXPECT_LT(std::abs(means_of_first({{tower, {}}, {ground, at({-200, -200, 4})}}).slope.z), 0.03);
}

// One of 19 cherries was black: none of the sixteen rays that told its shade left it.
TEST_F(SkyMeansTest, ADenseThingIsNotBlackForFewOfItsRaysLeaveIt) {
    Mesh slices;
    for (int i = 0; i < 20; ++i) {
        const double low = 0.2 * i;
        const Mesh slice = shapes::box({-1, -1, low}, {1, 1, low + 0.02});
        const auto first = static_cast<uint32_t>(slices.positions.size());
        slices.positions.insert(slices.positions.end(), slice.positions.begin(),
                                slice.positions.end());
        for (const Triangle& t : slice.triangles)
            slices.triangles.emplace_back(first + t[0], first + t[1], first + t[2]);
    }
    const ObjectIndex stack = builder.mesh(slices);
    const ObjectIndex wall = builder.mesh(shapes::box({0, -50, 0}, {1, 50, 100}));
    for (int i = 0; i < 20; ++i) {
        const Affine turned = {
            glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.31 * i, glm::dvec3(0, 0, 1))), {0, 0, 0}};
        const SkyPlace place(*this, {{stack, turned}, {wall, at({2, 0, 0})}});
        const SkyMeans means = mean_sky_shares(
            {place.surfaces.of(finest(stack)), turned, &*place.scene, 0, 64, 0}, 16);
        ASSERT_GT(means.alone, 0);
        EXPECT_NEAR(means.placed / means.alone, 0.5, 0.4) << i;
    }
}
