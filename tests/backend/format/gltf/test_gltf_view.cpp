// SPDX-License-Identifier: GPL-3.0-or-later
// Guards cameras and lights of glTF files: where they are, what they see and how bright they are.
#include "scenes/gltf_text.h"

#include <gtest/gtest.h>
#include <numbers>

using namespace lodestone;
using namespace lodestone::format;
using namespace gltf_text;

namespace {

std::string with(const std::string& cameras, const std::string& lights, const std::string& nodes) {
    return gltf(kOneMesh + R"("extensionsUsed":["KHR_lights_punctual"],)" + R"("cameras":[)" +
                cameras + R"(],"extensions":{"KHR_lights_punctual":{"lights":[)" + lights +
                R"(]}},"nodes":[{"mesh":0},)" + nodes + R"(],"scenes":[{"nodes":[0,1]}])");
}

const std::string kCamera =
    R"({"type":"perspective","name":"eye","perspective":{"yfov":0.9,"aspectRatio":2,"znear":0.5}})";
const std::string kSun = R"({"type":"directional","intensity":2049,"color":[1,0.5,0.25]})";

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-9) << a.x << ' ' << a.y << ' ' << a.z;
}

}  // namespace

TEST(GltfView, ACameraLooksAlongItsNodesMinusZWhateverTheScale) {
    // Its parent turns it by 90 degrees about glTF's Y, our Z, and enlarges it
    Problems problems;
    const Model model = read(
        with(
            kCamera, kSun,
            R"({"children":[2],"rotation":[0,0.7071067811865476,0,0.7071067811865476],"scale":[3,3,3]},)"
            R"({"camera":0,"name":"Front","translation":[0,1,2]})"),
        problems);
    ASSERT_EQ(model.cameras.size(), 1u);
    const Camera& camera = model.cameras[0];
    EXPECT_EQ(camera.name, "Front");
    EXPECT_FALSE(camera.orthographic);
    EXPECT_EQ(camera.near_clip, 0.5);
    expect_near(camera.position, {6, 0, 3});
    expect_near(camera.direction, {-1, 0, 0});
    const double height = 2 * std::tan(0.45);
    expect_near(camera.up, {0, 0, height});
    expect_near(camera.right, {0, 2 * height, 0});
    EXPECT_TRUE(problems.empty());
}

TEST(GltfView, OrthographicCamerasKeepTheirSize) {
    Problems problems;
    const Model model = read(
        with(R"({"type":"orthographic","orthographic":{"xmag":4,"ymag":3,"zfar":9,"znear":0.1}})",
             kSun, R"({"camera":0})"),
        problems);
    ASSERT_EQ(model.cameras.size(), 1u);
    EXPECT_TRUE(model.cameras[0].orthographic);
    EXPECT_NEAR(glm::length(model.cameras[0].right), 8, 1e-9);
    EXPECT_NEAR(glm::length(model.cameras[0].up), 6, 1e-9);
}

TEST(GltfView, LightsBecomeBlendersWatts) {
    const std::string lights =
        kSun + R"(,{"type":"point","intensity":683},{"type":"spot","intensity":683,)" +
        R"("spot":{"innerConeAngle":0,"outerConeAngle":0.5}})";
    const auto lit = [](int light) {
        return R"({"extensions":{"KHR_lights_punctual":{"light":)" + std::to_string(light) +
               R"(}},"translation":[1,2,3]})";
    };
    Problems problems;
    const auto only = [&](int light) {
        Model model = read(with(kCamera, lights, lit(light)), problems);
        return model.lights.at(0);
    };
    EXPECT_EQ(only(0).kind, LightKind::Sun);
    EXPECT_NEAR(only(0).power, 3, 1e-9);
    expect_near(only(0).color, {1, 0.5, 0.25});
    expect_near(only(0).direction, {0, 1, 0});
    EXPECT_EQ(only(1).kind, LightKind::Point);
    EXPECT_NEAR(only(1).power, 4 * kPi, 1e-9);
    expect_near(only(1).position, {1, -3, 2});
    EXPECT_EQ(only(2).kind, LightKind::Spot);
    EXPECT_NEAR(only(2).spot_size, 1, 1e-9);
    EXPECT_NEAR(only(2).spot_blend, 1, 1e-9);
    EXPECT_TRUE(problems.empty());
}

TEST(GltfView, WhatHasNoSizeOrIsNotThereIsLeftOut) {
    Problems problems;
    const std::string flat = R"({"type":"perspective","perspective":{"yfov":0,"znear":0.1}},)"
                             R"({"type":"perspective","perspective":{"yfov":4,"znear":0.1}})";
    for (const char* node :
         {R"({"camera":0})", R"({"camera":1})", R"({"camera":0,"scale":[0,0,0]})"})
        EXPECT_TRUE(read(with(flat, kSun, node), problems).cameras.empty()) << node;
    EXPECT_TRUE(has(problems, "bad_view"));
    for (const char* node : {R"({"extensions":{"KHR_lights_punctual":{"light":7}}})",
                             R"({"extensions":{"KHR_lights_punctual":{"light":"x"}}})",
                             R"({"extensions":{"KHR_lights_punctual":{}}})"})
        EXPECT_TRUE(read(with(kCamera, kSun, node), problems).lights.empty()) << node;
}
