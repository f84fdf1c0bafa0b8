// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that small scenes get their shadows, and that others stay as large as they are.
#include "povray/povray_scenes.h"
#include "povray_export/scene/magnification.h"

#include <limits>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

Bound ball(double radius, const glm::dvec3& center = {}) {
    Bound bound;
    bound.center = center;
    bound.radius = radius;
    bound.box = {center - radius, center + radius};
    return bound;
}

/// 100 pixels wide, a right angle, `away` from the origin.
View from(double away) {
    View view;
    view.width = view.height = 100;
    view.camera.position = {0, 0, away};
    view.camera.right = {2, 0, 0};
    view.camera.up = {0, 2, 0};
    view.camera.near_clip = away / 100;
    return view;
}

/// A cube that casts shadows of a sun and of a lamp on the ground, all of it `size` metres large.
scenes::Image drawn(double size, const std::string& name, bool shadow = true) {
    scenes::Builder builder;
    const auto resized = [&](Mesh mesh) {
        for (glm::vec3& position : mesh.positions)
            position *= static_cast<float>(size);
        return builder.mesh(std::move(mesh), {builder.matte({.8, .6, .4})});
    };
    builder.place_at(resized(shapes::quad(8, 8)), glm::dvec3(-4, -4, 0) * size);
    builder.place_at(resized(shapes::cube()), glm::dvec3(-.5, -.5, 0) * size);
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.position = glm::dvec3(-2, 1, 3) * size;
    lamp.radius = 0.5 * size;
    lamp.power = 300 * size * size;
    builder.model.lights = {scenes::sun(1, {1, .5, -1}), lamp};
    for (Light& light : builder.model.lights)
        light.shadow = shadow;
    View view = from(6);
    view.width = view.height = 64;
    view.camera.position *= size;
    view.camera.near_clip *= size;
    ExportOptions options;
    options.folder = scratch(name);
    return scenes::render(builder.finish(), view, options);
}

struct ImageDifference {
    double mean = 0;
    double worst = 0;
};

ImageDifference difference(const scenes::Image& a, const scenes::Image& b) {
    ImageDifference out;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const glm::dvec3 off = glm::abs(a.at(x, y) - b.at(x, y));
            out.worst = std::max({out.worst, off.x, off.y, off.z});
            out.mean += off.x / (a.width * a.height);
        }
    }
    return out;
}

}  // namespace

TEST(Magnification, NothingAndEverydaySizesStayAsTheyAre) {
    EXPECT_EQ(magnification(from(6), {}), 1);
    EXPECT_EQ(magnification(from(6), std::vector{ball(1)}), 1);
    EXPECT_EQ(magnification(from(1e6), std::vector{ball(1), ball(1e5)}), 1);
}

TEST(Magnification, APixelOfTheNearestBecomesLargerThanTheTolerance) {
    // 2 cm away a pixel is .4 mm wide.
    EXPECT_EQ(magnification(from(0.02), std::vector{ball(0.001)}), 4);
    EXPECT_EQ(magnification(from(0.02), std::vector{ball(0.001), ball(0.3)}), 4);
    // The eye is inside: as far as the radius.
    EXPECT_EQ(magnification(from(0.02), std::vector{ball(0.2)}), 1);
}

TEST(Magnification, AWholeLandscapeIsNotMadeTooLargeForOneGrain) {
    const std::vector<Bound> both{ball(1e-6), ball(20'000)};
    EXPECT_LE(magnification(from(1e-5), both) * 20'000, 1e5);
}

TEST(Magnification, WhatIsNotFiniteIsNotLookedAt) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(magnification(from(0.02), std::vector{ball(nan), ball(0.001, {nan, 0, 0})}), 1);
}

TEST(PovrayRenderMagnification, ASceneOfATenthOfAMillimetreLooksLikeOneOfAMetre) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const scenes::Image large = drawn(1, "metre");
    const ImageDifference found = difference(large, drawn(1e-4, "grain"));
    EXPECT_LE(found.mean, 0.0005);
    EXPECT_LE(found.worst, 0.1);  // of single pixels at the edges of shadows
    EXPECT_GE(difference(large, drawn(1, "shadowless", false)).worst, 0.1);
}
