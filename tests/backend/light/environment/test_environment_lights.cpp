// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that few suns light surfaces as the whole picture of a sky does, whichever way they face.
#include "base/parallel.h"
#include "image/image.h"
#include "image/texture_sampler.h"
#include "light/environment/environment_lights.h"
#include "light/environment/environment_sky.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>

using namespace lodestone;
using light::environment_lights;
using light::EnvironmentLights;

namespace {

using Radiance = std::function<double(const glm::dvec3&)>;

/// A world whose picture (8 bit, linear numbers) has this radiance by direction, in red.
World world_of(const Radiance& radiance, int width = 128) {
    image::Image sky;
    sky.width = width;
    sky.height = width / 2;
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            const glm::dvec3 d =
                light::equirectangular_direction((x + 0.5) / sky.width, 1 - (y + 0.5) / sky.height);
            const auto red = static_cast<float>(radiance(d));
            for (const float value : {red, 0.25f, 0.0f, 1.0f})
                sky.pixels.push_back(value);
        }
    }
    World world;
    world.environment = image::make_picture(image::png_bytes(sky), ColorSpace::Linear, "sky");
    return world;
}

double received(const EnvironmentLights& sky, const glm::dvec3& normal, int channel = 0) {
    double sum = kPi * sky.ambient[channel];
    for (const light::EnvironmentLight& light : sky.lights)
        sum += light.irradiance[channel] * std::max(0.0, -glm::dot(normal, light.direction));
    return sum;
}

double integrated(const Radiance& radiance, const glm::dvec3& normal) {
    double sum = 0;
    constexpr int kSteps = 256;
    for (int y = 0; y < kSteps; ++y) {
        const double theta = kPi * (y + 0.5) / kSteps;
        for (int x = 0; x < 2 * kSteps; ++x) {
            const double phi = kPi * (x + 0.5) / kSteps;
            const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                               std::cos(theta));
            sum += radiance(d) * std::max(0.0, glm::dot(normal, d)) * std::sin(theta) *
                   (kPi / kSteps) * (kPi / kSteps);
        }
    }
    return sum;
}

const glm::dvec3 kNormals[] = {{0, 0, 1},  {1, 0, 0},   {0, 1, 0},    {-1, 0, 0},     {0, -1, 0},
                               {0, 0, -1}, {.6, 0, .8}, {0, -.6, .8}, {-.48, .6, .64}};

double gradient(const glm::dvec3& d) {
    return 0.5 + 0.5 * d.z;
}
/// A bright patch 20 degrees wide over a dim sky and dark ground.
double sunny(const glm::dvec3& d) {
    const glm::dvec3 sun(0.48, -0.6, 0.64);
    return glm::dot(d, sun) > std::cos(kPi / 18) ? 1.0 : d.z > 0 ? 0.02 : 0.0;
}

}  // namespace

TEST(EnvironmentLights, WithoutAPictureThereIsNoLight) {
    EXPECT_TRUE(environment_lights({}, 16).lights.empty());
    EXPECT_EQ(environment_lights({}, 16).ambient, glm::dvec3(0.0));
}

TEST(EnvironmentLights, AUniformPictureIsAllAmbient) {
    World world = world_of([](const glm::dvec3&) { return 1.0; }, 16);
    world.environment_strength = {2, 2, 2};
    const EnvironmentLights sky = environment_lights(world, 16);
    EXPECT_NEAR(sky.ambient.x, 2, 1e-4);
    EXPECT_NEAR(received(sky, {0, 0, 1}), 2 * kPi, 1e-4);
}

TEST(EnvironmentLights, SurfacesFacingAnyWayReceiveWhatTheSkyGives) {
    for (const Radiance& radiance : {Radiance(gradient), Radiance(sunny)}) {
        const double most = integrated(radiance, {0, 0, 1});
        for (const size_t count : {12u, 24u}) {
            const EnvironmentLights sky = environment_lights(world_of(radiance), count);
            EXPECT_LE(sky.lights.size(), count);
            for (const glm::dvec3& normal : kNormals)
                EXPECT_NEAR(received(sky, normal), integrated(radiance, normal),
                            (count == 12 ? 0.06 : 0.03) * most)
                    << count << ": " << normal.x << ' ' << normal.y << ' ' << normal.z;
            EXPECT_NEAR(received(sky, {0, 0, 1}, 1), kPi * 64 / 255, 0.01);  // green is uniform
        }
    }
}

TEST(EnvironmentLights, TurningThePictureTurnsTheLight) {
    const Radiance radiance(sunny);
    World world = world_of(radiance);
    const double c = std::cos(1.0);
    const double s = std::sin(1.0);
    world.environment_turn = {c, -s, 0, s, c, 0, 0, 0, 1};  // columns
    const EnvironmentLights sky = environment_lights(world, 24);
    for (const glm::dvec3& normal : kNormals)
        EXPECT_NEAR(received(sky, normal), integrated(radiance, world.environment_turn * normal),
                    0.03 * integrated(radiance, {0, 0, 1}));
}

TEST(EnvironmentLights, TheSameOnOneThreadAndMany) {
    const World world = world_of(sunny);
    const EnvironmentLights many = environment_lights(world, 24);
    const ThreadLimit limit(1);
    const EnvironmentLights one = environment_lights(world, 24);
    ASSERT_EQ(one.lights.size(), many.lights.size());
    for (size_t i = 0; i < one.lights.size(); ++i)
        EXPECT_EQ(one.lights[i].irradiance, many.lights[i].irradiance);
}

TEST(EnvironmentLights, TinyAndBlackPicturesAndStrangeTurnsAreFine) {
    EXPECT_TRUE(
        environment_lights(world_of([](const glm::dvec3&) { return 0.0; }, 2), 8).lights.size() <
        2);
    World world = world_of(sunny, 2);
    world.environment_turn = glm::dmat3(0.0);
    for (const light::EnvironmentLight& light : environment_lights(world, 300).lights)
        EXPECT_NEAR(glm::length(light.direction), 1, 1e-9);
}

TEST(EnvironmentLights, ABrokenPictureIsAnError) {
    World world;
    auto broken = std::make_shared<Picture>();
    broken->bytes = "no picture";
    world.environment = broken;
    EXPECT_THROW(environment_lights(world, 8), Error);
}
