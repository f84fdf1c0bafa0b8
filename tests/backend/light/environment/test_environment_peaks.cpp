// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the light of skies by direction, and which of their peaks become lights.
#include "light/environment/environment_lights.h"
#include "scenes/sky_worlds.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using light::environment_peaks;
using light::EnvironmentLights;

namespace {

glm::dvec3 upper_half(const glm::dvec3& d) {
    return glm::dvec3(d.z > 0 ? 2 : 0);
}
/// A sun of a degree over a dim sky.
glm::dvec3 sunny(const glm::dvec3& d) {
    const glm::dvec3 sun = glm::normalize(glm::dvec3(1, -1, 1));
    return glm::dot(d, sun) > std::cos(0.04) ? glm::dvec3(4000, 3000, 2000)
                                             : glm::dvec3(0.5, 0.6, 1);
}

}  // namespace

TEST(EnvironmentPeaks, WithoutAPictureThereIsNoLight) {
    EXPECT_EQ(environment_peaks({}, 24).ambient, glm::dvec3(0.0));
    EXPECT_FALSE(environment_peaks({}, 24).uneven);
}

TEST(EnvironmentPeaks, ABlackPictureGivesNoLight) {
    const EnvironmentLights sky =
        environment_peaks(world_of_sky([](const glm::dvec3&) { return glm::dvec3(0.0); }), 24);
    EXPECT_EQ(sky.ambient, glm::dvec3(0.0));
    EXPECT_TRUE(sky.lights.empty());
    EXPECT_EQ(sky.uneven->toward({0, 0, 1}), glm::dvec3(0.0));
    EXPECT_EQ(sky.uneven->at_height(0.5), glm::dvec3(0.0));
}

TEST(EnvironmentPeaks, AUniformPictureIsOneEverywhere) {
    World world = world_of_sky([](const glm::dvec3&) { return glm::dvec3(1, 0.5, 0.25); });
    world.environment_strength = {2, 2, 2};
    const EnvironmentLights sky = environment_peaks(world, 24);
    EXPECT_TRUE(sky.lights.empty());
    EXPECT_TRUE(sky.uneven->one_hue());
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sky.ambient[c], glm::dvec3(2, 1, 0.5)[c], 0.01);
        for (const double z : {-1.0, -0.1, 0.5, 1.0}) {
            EXPECT_NEAR(sky.uneven->at_height(z)[c], 1, 0.01);
            EXPECT_NEAR(sky.uneven->toward({std::sqrt(1 - z * z), 0, z})[c], 1, 0.01);
        }
    }
}

TEST(EnvironmentPeaks, TheSurfaceThatIsLitMostHasAShareOfOne) {
    const EnvironmentLights sky = environment_peaks(world_of_sky(upper_half), 24);
    EXPECT_TRUE(sky.lights.empty());
    EXPECT_NEAR(sky.ambient.x, 2, 0.02);  // what level ground receives, over pi
    EXPECT_NEAR(sky.uneven->toward({0.6, 0, 0.8}).x, 1, 0.01);
    EXPECT_EQ(sky.uneven->toward({0.6, 0, -0.8}).x, 0);
    EXPECT_EQ(sky.uneven->at_height(-0.5).x, 0);
    EXPECT_NEAR(sky.uneven->at_height(0.5).x, 1, 0.01);
}

TEST(EnvironmentPeaks, ASunIsOneLightAndTheSkyIsWithoutIt) {
    const EnvironmentLights sky = environment_peaks(world_of_sky(sunny), 24);
    ASSERT_EQ(sky.lights.size(), 1u);
    const glm::dvec3 sun = glm::normalize(glm::dvec3(1, -1, 1));
    EXPECT_GT(-glm::dot(sky.lights[0].direction, sun), std::cos(0.02));
    const double solid_angle = 2 * kPi * (1 - std::cos(0.04));
    EXPECT_NEAR(sky.lights[0].irradiance.x, 4000 * solid_angle,
                0.25 * 4000 * solid_angle);  // a part is the sky's
    EXPECT_LT(sky.lights[0].angle, 0.1);
    EXPECT_NEAR(sky.lights[0].irradiance.y / sky.lights[0].irradiance.x, 0.75, 0.01);
    EXPECT_LT(sky.uneven->share_of(sky.uneven->toward(sun)), 10);
    EXPECT_NEAR(sky.uneven->share_of(sky.uneven->toward({-1, 1, 0})), 1, 0.05);
    EXPECT_NEAR(sky.ambient.z / sky.ambient.x, 2, 0.1);
}

TEST(EnvironmentPeaks, AWidePeakIsAWideLight) {
    const EnvironmentLights sky =
        environment_peaks(world_of_sky([](const glm::dvec3& d) {
                              return glm::dvec3(0.8 * d.x + 0.6 * d.z > std::cos(0.08) ? 100 : 1);
                          }),
                          8);
    ASSERT_EQ(sky.lights.size(), 1u);
    EXPECT_NEAR(sky.lights[0].angle, 0.12, 0.05);  // but for a texel
}

// Two lamps far apart were one light halfway between them.
TEST(EnvironmentPeaks, PeaksFarApartAreSeveralLights) {
    const glm::dvec3 ways[] = {{0, 1, 0}, glm::normalize(glm::dvec3(1, -1, 1))};
    const EnvironmentLights sky = environment_peaks(world_of_sky([&](const glm::dvec3& d) {
                                                        const bool lamp =
                                                            glm::dot(d, ways[0]) > std::cos(0.04) ||
                                                            glm::dot(d, ways[1]) > std::cos(0.04);
                                                        return glm::dvec3(lamp ? 20 : 1);
                                                    }),
                                                    24);
    ASSERT_EQ(sky.lights.size(), 2u);
    bool lit[2] = {false, false};
    for (const light::EnvironmentLight& light : sky.lights) {
        const bool second = glm::dot(light.direction, ways[1]) < glm::dot(light.direction, ways[0]);
        EXPECT_GT(-glm::dot(light.direction, ways[second ? 1 : 0]), std::cos(0.05));
        lit[second ? 1 : 0] = true;
    }
    EXPECT_TRUE(lit[0] && lit[1]);
}

TEST(EnvironmentPeaks, ASunAcrossThePicturesEdgeIsOne) {
    const glm::dvec3 sun = glm::normalize(glm::dvec3(-1, 0, 0.3));
    const EnvironmentLights sky =
        environment_peaks(world_of_sky([&](const glm::dvec3& d) {
                              return glm::dvec3(glm::dot(d, sun) > std::cos(0.06) ? 4000 : 1);
                          }),
                          24);
    ASSERT_EQ(sky.lights.size(), 1u);
    EXPECT_GT(-glm::dot(sky.lights[0].direction, sun), std::cos(0.02));
    EXPECT_LT(sky.lights[0].angle, 0.15);
}

TEST(EnvironmentPeaks, TurningThePictureTurnsTheSky) {
    World world = world_of_sky([](const glm::dvec3& d) {
        return glm::dvec3(d.x > 0.5 ? 4.0 : d.x < -0.5 ? 1.0 : 2.0);
    });
    world.environment_turn = glm::dmat3(glm::rotate(glm::dmat4(1.0), kPi / 2, {0, 0, 1}));
    const EnvironmentLights sky = environment_peaks(world, 24);
    const auto toward = [&](const glm::dvec3& d) { return sky.uneven->toward(d).x; };
    EXPECT_NEAR(toward({0, -1, 0}) / toward({0, 1, 0}), 4, 0.01);
    EXPECT_NEAR(toward({1, 0, 0}), toward({-1, 0, 0}), 0.01);
}

TEST(EnvironmentPeaks, OtherSkiesHaveOtherHashes) {
    const auto hash = [](const World& world) {
        return environment_peaks(world, 24).uneven->hash();
    };
    World turned = world_of_sky(sunny);
    turned.environment_turn = glm::dmat3(glm::rotate(glm::dmat4(1.0), 1.0, {0, 0, 1}));
    EXPECT_EQ(hash(world_of_sky(sunny)), hash(world_of_sky(sunny)));
    EXPECT_NE(hash(world_of_sky(sunny)), hash(turned));
    EXPECT_NE(hash(world_of_sky(sunny)), hash(world_of_sky(upper_half)));
}
