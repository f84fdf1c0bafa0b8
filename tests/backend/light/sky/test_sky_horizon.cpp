// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how much of the sky below them what things stand on leaves to their placements.
#include "backend/light/sky/sky_places.h"
#include "light/sky/sky_horizon.h"
#include "light/sky/sky_means.h"

#include <glm/gtc/matrix_transform.hpp>

using namespace lodestone;
using namespace lodestone::light;

namespace {

class SkyHorizonTest : public SkyPlaces {
protected:
    using Things = std::vector<std::pair<ObjectIndex, Affine>>;

    /// The horizon of a thing at all places, and among others.
    SkyHorizon horizon(ObjectIndex thing, const std::vector<Affine>& places, Things others = {}) {
        for (const Affine& world : places)
            others.emplace_back(thing, world);
        const SkyPlace place(*this, others);
        return sky_horizon(place.surfaces.of(finest(thing)), places, *place.scene);
    }

    ObjectIndex box = builder.mesh(shapes::box({-1, -1, 0}, {1, 1, 3}));
    ObjectIndex ground = builder.mesh(shapes::quad(4000, 4000));
};

Affine at(double x, double y, double z = 0) {
    return {glm::dmat3(1.0), {x, y, z}};
}

Affine turned(double degrees, const glm::dvec3& axis, const glm::dvec3& offset) {
    return {glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis)), offset};
}

const std::vector<Affine> kApart{at(1000, 1000), at(2000, 1000), at(2000, 3000), at(3000, 2000)};

}  // namespace

TEST_F(SkyHorizonTest, NothingLiesBelowWhatIsNowhereOrFloats) {
    const SkyPlace place(*this, {{box, {}}});
    EXPECT_EQ(sky_horizon(place.surfaces.of(finest(box)), {}, *place.scene).below, 1);
    EXPECT_EQ(horizon(box, kApart).below, 1);
}

TEST_F(SkyHorizonTest, OfThingsOnAGroundNoSkyIsBelow) {
    const SkyHorizon found = horizon(box, kApart, {{ground, {}}});
    EXPECT_EQ(found.below, 0);
    EXPECT_EQ(found.up, glm::dvec3(0, 0, 1));
}

TEST_F(SkyHorizonTest, WhereHalfOfThemFloatItIsAHalf) {
    const std::vector<Affine> half{at(1000, 1000), at(2000, 3000), at(9000, 0), at(12000, 9000)};
    EXPECT_EQ(horizon(box, half, {{ground, {}}}).below, 0.5);
}

TEST_F(SkyHorizonTest, UpIsAnAxisOfThePlacementsAndThereIsNoneOfThoseThatTumble) {
    std::vector<Affine> places;
    places.reserve(kApart.size());
    for (const Affine& place : kApart)
        places.push_back(turned(90, {1, 0, 0}, place.offset + glm::dvec3(0, 0, 2)));
    EXPECT_EQ(horizon(box, places, {{ground, {}}}).up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(horizon(box, places, {{ground, {}}}).below, 0);
    for (size_t i = 0; i < places.size(); i += 2)
        places[i] = turned(-90, {1, 0, 0}, places[i].offset);
    EXPECT_EQ(horizon(box, places, {{ground, {}}}).below, 1);
}

TEST_F(SkyHorizonTest, PlacesThatAreNoNumbersOrFlatHaveNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Affine& bad : {Affine{glm::dmat3(nan), {}}, Affine{glm::dmat3(0.0), {}}})
        EXPECT_EQ(horizon(box, {bad, bad}, {{ground, {}}}).below, 1);
}

TEST_F(SkyHorizonTest, AllOfTheSurfaceCountsByItsArea) {
    // A thousand small squares stand on a table, and beside it floats a large one.
    Mesh mesh = shapes::quad(10, 10);
    for (glm::vec3& at : mesh.positions)
        at.z = 1;
    for (int i = 0; i < 1000; ++i) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const glm::vec3& at : shapes::quad(1, 1).positions)
            mesh.positions.push_back(at + glm::vec3(20 + 2 * (i % 40), 2 * (i / 40), 1));
        for (const Triangle& t : shapes::quad(1, 1).triangles)
            mesh.triangles.emplace_back(first + t);
    }
    for (Triangle& t : mesh.triangles)
        std::swap(t.y, t.z);  // all face down
    const ObjectIndex thing = builder.mesh(mesh);
    const ObjectIndex table = builder.mesh(shapes::box({15, -900, 0}, {900, 900, 0.9}));
    EXPECT_EQ(horizon(thing, {{}}, {{table, {}}}).below, 0);
}

// The tops of copies were as much darker as the ground hid of the sky under them.
TEST_F(SkyHorizonTest, CopiesOnTheGroundAreAsLightAsTheyAreAlone) {
    const Affine above = at(1000, 1000, 0.05);
    const SkyPlace place(*this, {{box, above}, {ground, {}}});
    SkyRequest request{place.surfaces.of(finest(box)), above, &*place.scene, 0, 64, 0};
    const SkyMeans before = mean_sky_shares(request, 2048);
    EXPECT_LT(before.placed / before.alone, 0.6);
    request.horizon = horizon(box, kApart, {{ground, {}}});
    const SkyMeans means = mean_sky_shares(request, 2048);
    EXPECT_NEAR(means.placed, before.placed, 0.01);
    EXPECT_NEAR(means.placed / means.alone, 1, 0.01);
    // Alone its top sees all of the sky, and its sides the upper half.
    SkyRequest alone{place.surfaces.of(finest(box)), {}, nullptr, 0, 256, 0};
    alone.horizon = request.horizon;
    const SkyShares shares = sky_shares(alone, {});
    EXPECT_NEAR(*std::max_element(shares.corners.begin(), shares.corners.end()), share_byte(1), 2);
    EXPECT_NEAR(*std::min_element(shares.corners.begin(), shares.corners.end()), share_byte(0), 2);
    EXPECT_NEAR(shares.mean, (4 * 1 + 4 * 6 * 0.5) / (4 + 4 + 4 * 6), 0.02);
}
