// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which lights stand for a sky: those that a picture can tell, for each casts a ray a point.
#include "image/image.h"
#include "image/texture_sampler.h"
#include "povray_export/lamp/sky_writer.h"
#include "scratch.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numbers>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// A sky of one gray above, and of another on one side.
World world_of(float sky, float side) {
    image::Image picture;
    picture.width = 64;
    picture.height = 32;
    for (int i = 0; i < 64 * 32; ++i) {
        const float value = i % 64 < 16 ? side : sky;
        for (const float channel : {value, value, value, 1.0f})
            picture.pixels.push_back(channel);
    }
    World world;
    world.environment = image::make_picture(image::png_bytes(picture), ColorSpace::Linear, "sky");
    return world;
}

WrittenSky written(const World& world, const SkySampling& sampling = {}) {
    Problems problems;
    return write_sky(world, sampling, own_scratch(), problems);
}

}  // namespace

TEST(PovraySky, OneGrayIsAmbientAndNeedsNoLights) {
    const WrittenSky sky = written(world_of(0.5f, 0.5f));
    EXPECT_NEAR(sky.ambient.x, 0.5, 0.01);
    EXPECT_TRUE(sky.lights.empty());
}

TEST(PovraySky, ABrightSideHasLightsAndNoneThatNoPictureCouldTell) {
    const WrittenSky sky = written(world_of(0.25f, 0.75f));
    ASSERT_FALSE(sky.lights.empty());
    double brightest = sky.ambient.x;
    for (const Light& light : sky.lights)
        brightest = std::max(brightest, light.color.x);
    for (const Light& light : sky.lights)
        EXPECT_GE(light.color.x, 2e-3 * brightest);
}

TEST(PovraySky, WhereRaysFindItOnlyPeaksAreLights) {
    const WrittenSky sky = written(world_of(0.25f, 0.75f), {24, true, true});
    EXPECT_TRUE(sky.lights.empty());
    ASSERT_TRUE(sky.uneven);
    EXPECT_EQ(sky.ambient, sky.uneven->color());
}

TEST(PovraySky, WithoutLightsAllOfItsLightIsUniform) {
    const World world = world_of(0.25f, 0.75f);
    const WrittenSky with = written(world);
    const WrittenSky without = written(world, {0, true});
    EXPECT_TRUE(without.lights.empty());
    double energy = with.ambient.x;
    for (const Light& light : with.lights)
        energy += light.color.x / (4 * std::numbers::pi);
    EXPECT_NEAR(without.ambient.x, energy, 0.05 * energy);
}

TEST(PovraySky, ADraftsLightsCastNoShadows) {
    for (const Light& light : written(world_of(0.25f, 0.75f), {12, false}).lights)
        EXPECT_FALSE(light.shadow);
}
