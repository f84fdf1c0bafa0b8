// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what leaves answer to whose places are lit unevenly, and what corners share.
#include "backend/light/sky/sky_places.h"
#include "light/sky/corner_shares.h"

using namespace lodestone;
using namespace lodestone::light;

namespace {

/// Squares of a metre side by side, 3 metres apart, `width` of each from its left edge.
Mesh squares(int count, float width, float z) {
    Mesh out;
    for (int i = 0; i < count; ++i) {
        const auto first = static_cast<uint32_t>(out.positions.size());
        for (const glm::vec3& at : shapes::quad(width, 1).positions)
            out.positions.emplace_back(at + glm::vec3(3 * i, 0, z));
        for (const Triangle& t : shapes::quad(width, 1).triangles)
            out.triangles.emplace_back(first + t);
    }
    return out;
}

class CornerSharesTest : public SkyPlaces {
protected:
    /// The mean share of cards on a ground, half of each of which lies under a roof.
    double mean(int count, bool leaves, bool roofs = true) {
        Material leaf;
        leaf.alpha = 0.99;
        leaf.alpha_mode = AlphaMode::Blend;
        const ObjectIndex cards = builder.mesh(
            squares(count, 1, 0), {leaves ? builder.material(leaf) : builder.matte({1, 1, 1})});
        Mesh below = squares(count, 0.5f, 0.02f);
        for (Triangle& t : below.triangles)
            std::swap(t.y, t.z);
        const ObjectIndex roof = builder.mesh(below);
        const ObjectIndex ground = builder.mesh(shapes::quad(4000, 4000));
        std::vector<std::pair<ObjectIndex, Affine>> things{
            {cards, {}}, {ground, {glm::dmat3(1.0), {-2000, -2000, -0.02}}}};
        if (roofs)
            things.emplace_back(roof, Affine{});
        const SkyPlace place(*this, things);
        return sky_shares({place.surfaces.of(finest(cards)), {}, &*place.scene, 0, 128, 0}, {})
            .mean;
    }
};

}  // namespace

// Crowns were darker than Cycles': what is seen of a card is what nothing covers.
TEST_F(CornerSharesTest, ALeafIsAsLightAsThePlacesThatAreSeenOfIt) {
    EXPECT_NEAR(mean(60, false), 0.5, 0.05);
    EXPECT_GT(mean(60, true), 0.75);
}

// Cards that the picture does not show, with two rays each, told that all were lit unevenly.
TEST_F(CornerSharesTest, WhatIsNotSeenTellsNothingOfPlaces) {
    Material leaf;
    leaf.alpha = 0.99;
    leaf.alpha_mode = AlphaMode::Blend;
    Mesh mesh = squares(400, 1, 0);
    for (glm::vec3& at : mesh.positions)  // upright, on the ground: each side sees half of the sky
        at = {at.x, 0, at.y};
    const ObjectIndex cards = builder.mesh(mesh, {builder.material(leaf)});
    const ObjectIndex ground = builder.mesh(shapes::quad(4000, 4000));
    // And one of the sides nothing, in a corner.
    const ObjectIndex wall = builder.mesh(shapes::box({-2000, -1, -1}, {2000, -0.02, 2000}));
    const SkyPlace place(
        *this, {{cards, {}}, {ground, {glm::dmat3(1.0), {-2000, -2000, -0.02}}}, {wall, {}}});
    std::vector<uint8_t> seen(mesh.triangles.size(), 0);
    std::fill(seen.begin(), seen.begin() + 40, uint8_t{1});
    SkyRequest request{place.surfaces.of(finest(cards)), {}, &*place.scene, 0, 128, 0};
    const SkyShares all = sky_shares(request, {});
    request.seen = seen;
    const SkyShares some = sky_shares(request, {});
    double of_all = 0;
    double of_some = 0;
    for (size_t i = 0; i < 60; ++i) {
        of_all += share_of_byte(all.corners[i]) / 60;
        of_some += share_of_byte(some.corners[i]) / 60;
    }
    EXPECT_NEAR(of_all, 0.5, 0.05);
    EXPECT_NEAR(of_some, of_all, 0.05);
}

TEST_F(CornerSharesTest, LeavesThatAreLitEvenlyStayAsTheyAre) {
    EXPECT_NEAR(mean(60, true, false), 1, 0.01);
    // Of one card the rays are too few to tell.
    EXPECT_LT(mean(1, true), 0.72);
}

// Balls in a room with few windows had blotches.
TEST_F(CornerSharesTest, CornersOfWhatIsRoundShareTheirRays) {
    const auto above = [](const glm::dvec3& offset) { return Affine{glm::dmat3(1.0), offset}; };
    const Mesh ball = shapes::sphere(1, 3);
    const SkyPlace place(*this,
                         {{builder.mesh(ball), above({0, 0, 2})},
                          {builder.mesh(shapes::quad(4000, 4000)), above({-2000, -2000, 0})}});
    SkyRequest request{place.surfaces.of(*place.occluders[0].representation),
                       above({0, 0, 2}),
                       &*place.scene,
                       0,
                       8,
                       0};
    const auto off = [&](bool round) {
        request.round = round;
        const SkyShares shares = sky_shares(request, {});
        EXPECT_NEAR(shares.mean, 0.5, 0.03);
        double sum = 0;
        for (size_t i = 0; i < shares.corners.size(); ++i) {
            const uint32_t vertex = ball.triangles[i / 3][static_cast<int>(i % 3)];
            // The floor is all that is below: the cosine-weighted share is (1 + cos e) / 2.
            const double cosine = ball.positions[vertex].z / glm::length(ball.positions[vertex]);
            sum += std::abs(share_of_byte(shares.corners[i]) - (1 + cosine) / 2);
        }
        return sum / static_cast<double>(shares.corners.size());
    };
    EXPECT_LT(off(true), 0.6 * off(false));
}
