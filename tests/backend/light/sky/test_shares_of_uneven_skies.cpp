// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the light that surfaces have of a sky that is not equally bright everywhere.
#include "backend/light/sky/sky_places.h"
#include "base/color.h"
#include "light/environment/environment_lights.h"
#include "light/sky/sky_means.h"
#include "scenes/sky_worlds.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <functional>

using namespace lodestone;
using namespace lodestone::light;

namespace {

using Radiance = std::function<glm::dvec3(const glm::dvec3&)>;

UnevenSky sky_of(const Radiance& radiance) {
    return *environment_peaks(world_of_sky(radiance), 24).uneven;
}
/// A sky of radiance 1 + x, in red 1 - x: a surface that faces n receives pi (1 +- 2/3 n.x).
UnevenSky uneven_sky(bool red_behind) {
    return sky_of([red_behind](const glm::dvec3& d) {
        return glm::dvec3(red_behind ? 1 - d.x : 1 + d.x, 1 + d.x, 1 + d.x);
    });
}
UnevenSky black_below() {
    return sky_of([](const glm::dvec3& d) { return glm::dvec3(d.z > 0 ? 1.0 : 0.0); });
}

class SharesOfUnevenSkies : public SkyPlaces {
protected:
    const Mesh box = shapes::box({-1, -1, -1}, {1, 1, 1});
    const UnevenSky sky = uneven_sky(false);
    const ObjectIndex object = builder.mesh(box);

    /// The mean share of the corners on the side of the box that faces there.
    double side(const SkyShares& shares, const glm::dvec3& way) const {
        double sum = 0;
        int count = 0;
        for (size_t i = 0; i < box.triangles.size(); ++i) {
            if (glm::dot(glm::normalize(area_vector(box, i)), way) < 0.9)
                continue;
            for (size_t k = 0; k < 3; ++k, ++count)
                sum += share_of_byte(shares.corners[3 * i + k]);
        }
        return sum / count;
    }
    SkyShares shares(const Affine& world) { return shares(world, sky); }
    SkyShares shares(const Affine& world, const UnevenSky& around) {
        const SkyPlace place(*this, {{object, world}});
        SkyRequest request{place.surfaces.of(finest(object)), world, &*place.scene, 0, 256, 0};
        request.uneven = &around;
        return sky_shares(request, {});
    }
};

}  // namespace

TEST_F(SharesOfUnevenSkies, EachSideHasTheLightOfWhereItFaces) {
    const SkyShares found = shares({});
    EXPECT_NEAR(side(found, {1, 0, 0}), 1, 0.03);
    EXPECT_NEAR(side(found, {-1, 0, 0}), 0.2, 0.03);
    for (const glm::dvec3& way : {glm::dvec3(0, 1, 0), {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
        EXPECT_NEAR(side(found, way), 0.6, 0.03);
}

TEST_F(SharesOfUnevenSkies, ATurnedThingIsLitFromTheSameSide) {
    const Affine quarter{glm::dmat3(glm::rotate(glm::dmat4(1.0), kPi / 2, {0, 0, 1})), {}};
    const SkyShares found = shares(quarter);  // its own -Y faces X
    EXPECT_NEAR(side(found, {0, -1, 0}), 1, 0.03);
    EXPECT_NEAR(side(found, {0, 1, 0}), 0.2, 0.03);
    EXPECT_NEAR(side(found, {1, 0, 0}), 0.6, 0.03);
}

TEST_F(SharesOfUnevenSkies, WhatIsSharedByCopiesHasTheMeanOfAllWays) {
    const SkyPlace place(*this, {{object, {}}});
    SkyRequest request{place.surfaces.of(finest(object)), {}, nullptr, 0, 256, 0};
    request.uneven = &sky;
    EXPECT_NEAR(sky_shares(request, {}).mean, 1, 0.01);  // times what each copy has of it
    request.horizon.upright = true;
    EXPECT_NEAR(sky_shares(request, {}).mean, 0.6, 0.02);
    request.around = &*place.scene;
    const SkyMeans upright = mean_sky_shares(request, 2048);
    EXPECT_NEAR(upright.placed, 0.6, 0.02);
    EXPECT_NEAR(upright.alone, 0.6, 0.02);
    request.horizon.upright = false;
    const SkyMeans any = mean_sky_shares(request, 2048);
    EXPECT_NEAR(any.placed, 0.6, 0.02);
    EXPECT_NEAR(any.alone, 1, 0.01);
}

TEST_F(SharesOfUnevenSkies, EachSideHasTheHueOfWhereItFaces) {
    EXPECT_TRUE(shares({}).tints.empty());  // a gray sky has one hue
    const UnevenSky colored = uneven_sky(true);
    EXPECT_FALSE(colored.one_hue());
    const SkyShares found = shares({}, colored);
    ASSERT_EQ(found.tints.size(), 2 * found.corners.size());
    for (size_t i = 0; i < found.corners.size(); ++i) {
        const glm::dvec3 up = glm::normalize(area_vector(box, i / 3));
        const double red = 1 - 2.0 / 3 * up.x;
        const double blue = 1 + 2.0 / 3 * up.x;
        const double bright = luminance(glm::dvec3(red, blue, blue));
        EXPECT_NEAR(octaves_of_tint(found.tints[2 * i]), std::log2(red / bright), 0.2);
        EXPECT_NEAR(octaves_of_tint(found.tints[2 * i + 1]), std::log2(blue / bright), 0.2);
    }
    const auto again = SkyShares::of_bytes(found.bytes(), box.triangles.size());
    ASSERT_TRUE(again);
    EXPECT_EQ(again->tints, found.tints);
    EXPECT_EQ(again->corners, found.corners);
    std::string damaged = found.bytes();
    damaged.resize(damaged.size() - 3);
    EXPECT_FALSE(SkyShares::of_bytes(damaged, box.triangles.size()));
}

TEST(SkyTints, PartsThatDoNotArriveAreTheSmallest) {
    EXPECT_EQ(octaves_of_tint(tint_byte(1, 1)), 0);
    EXPECT_EQ(octaves_of_tint(tint_byte(2, 1)), 1);
    EXPECT_EQ(octaves_of_tint(tint_byte(0, 1)), -8);
    EXPECT_EQ(octaves_of_tint(tint_byte(1, 0)), 0);  // black
    EXPECT_EQ(octaves_of_tint(tint_byte(kInfinity, 1)), 0);
}

// Open ground under a sky that is black below had a mean of 1.001, which was refused when it was
// read: it was found anew for every picture.
TEST_F(SharesOfUnevenSkies, OpenGroundHasAMeanOfAtMostOneAndIsKept) {
    const ObjectIndex ground = builder.mesh(shapes::quad(4, 4));
    const UnevenSky above = black_below();
    const SkyPlace place(*this, {{ground, {}}});
    SkyRequest request{place.surfaces.of(finest(ground)), {}, &*place.scene, 0, 256, 0};
    request.uneven = &above;
    const SkyShares found = sky_shares(request, {});
    EXPECT_NEAR(found.mean, 1, 0.01);
    EXPECT_TRUE(SkyShares::of_bytes(found.bytes(), 2));
    EXPECT_NEAR(above.mean(0), 0.5, 0.01);
    EXPECT_NEAR(above.mean(1), 0.5, 0.01);
}

TEST_F(SharesOfUnevenSkies, WhereTheSkyIsBlackNothingCountsAsInside) {
    // A sky that is black below: the lower side is dark, and not because something is around it.
    const UnevenSky above = black_below();
    const SkyPlace place(*this, {{object, {}}});
    SkyRequest request{place.surfaces.of(finest(object)), {}, &*place.scene, 0, 256, 0};
    request.uneven = &above;
    const SkyShares found = sky_shares(request, {});
    EXPECT_NEAR(side(found, {0, 0, -1}), 0, 1e-3);
    EXPECT_GT(side(found, {0, 0, 1}), 2 * side(found, {1, 0, 0}) * 0.9);
}
