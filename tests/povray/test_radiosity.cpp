// SPDX-License-Identifier: GPL-3.0-or-later
// Guards light that surfaces hand on: its energy is what geometric series say, skies are not
// counted twice, rooms behind windows are not black, and nothing of it is there where nobody asked.
#include "image/image.h"
#include "povray/povray_scenes.h"
#include "povray_export/lamp/radiosity.h"

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

class PovrayRenderRadiosity : public testing::Test {
protected:
    void SetUp() override {
        if (!scenes::have_povray())
            GTEST_SKIP() << "no POV-Ray";
    }
};

ExportOptions bouncing(int bounces) {
    ExportOptions options;
    options.folder = own_scratch() / std::to_string(bounces);
    options.antialiasing = Antialiasing::Off;
    options.shading.bounces = bounces;
    options.shading.bounce_rays = 40;
    options.shading.bounce_error = 0.6;
    return options;
}

double mean_of(const scenes::Image& image) {
    double sum = 0;
    for (const double value : image.values)
        sum += value;
    return sum / static_cast<double>(image.values.size());
}

std::string text_of(const ExportOptions& options) {
    return read_file(options.folder / "scene.pov");
}

void add_box(Builder& builder, ObjectIndex box, const glm::dvec3& low, const glm::dvec3& high) {
    Affine place;
    for (int i = 0; i < 3; ++i)
        place.linear[i][i] = high[i] - low[i];
    place.offset = 0.5 * (low + high);
    builder.place(box, place);
}

}  // namespace

TEST(PovrayRadiosity, NobodyAskedSoNothingIsWritten) {
    Builder builder;
    builder.place(builder.mesh(shapes::cube(), {builder.matte({.5, .5, .5})}));
    Problems problems;
    const ExportOptions options = bouncing(0);
    scenes::write(builder.finish(), scenes::above(), options, problems);
    EXPECT_EQ(text_of(options).find("radiosity"), std::string::npos);
    EXPECT_EQ(read_file(options.folder / "scene.ini").find("Reproducib"), std::string::npos);
    // Nor where there is no light at all.
    ExportOptions flat = bouncing(2);
    flat.false_color = true;
    scenes::write(builder.model, scenes::above(), flat, problems);
    EXPECT_EQ(text_of(flat).find("radiosity"), std::string::npos);
}

TEST(PovrayRadiosity, ASkyIsABounceOfPovraysOwn) {
    Shading shading;
    shading.bounces = 2;
    const Shading full = filled_up(shading, Antialiasing::Final, 1);
    EXPECT_NE(radiosity_text(full, false).find("recursion_limit 2 "), std::string::npos);
    EXPECT_NE(radiosity_text(full, true).find("recursion_limit 3 "), std::string::npos);
}

TEST_F(PovrayRenderRadiosity, InAClosedBallEachBounceAddsAnAlbedoOfTheLast) {
    // A lamp in the middle lights all of it alike, to D; each bounce adds albedo times the last.
    constexpr double kAlbedo = 0.6;
    Builder builder;
    builder.place(builder.mesh(shapes::sphere(2, 4), {builder.matte({kAlbedo, kAlbedo, kAlbedo})}));
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.power = 4 * std::numbers::pi * std::numbers::pi * 4 * 0.2 / kAlbedo;
    builder.model.lights.push_back(lamp);
    View view = scenes::above(16, 16);
    view.camera.orthographic = false;
    view.camera.position = {0.5, 0, 0};
    const Model& model = builder.finish();
    double expected = 0.2;
    double light = expected;
    for (int bounces = 0; bounces <= 3; ++bounces) {
        EXPECT_NEAR(mean_of(scenes::render(model, view, bouncing(bounces))), expected,
                    0.02 * expected)
            << bounces;
        light *= kAlbedo;
        expected += light;
    }
}

TEST_F(PovrayRenderRadiosity, ASkyLightsAFloorAsMuchWithBouncesAsWithout) {
    Builder builder;
    builder.place(builder.mesh(shapes::cube(), {builder.matte({.5, .5, .5})}));
    const View view = scenes::above(16, 16);
    builder.model.world.color = glm::dvec3(0.4);
    const Model& model = builder.finish();
    for (const int bounces : {0, 3})
        EXPECT_NEAR(mean_of(scenes::render(model, view, bouncing(bounces))), 0.2, 0.004);
    // A picture, half of which is brighter, becomes lights and a rest: both once.
    image::Image picture;
    picture.width = 64;
    picture.height = 32;
    for (int i = 0; i < 64 * 32; ++i) {
        for (const float channel : {i < 64 * 8 ? .9f : .2f, .3f, .3f, 1.f})
            picture.pixels.push_back(channel);
    }
    builder.model.world.environment =
        image::make_picture(image::png_bytes(picture), ColorSpace::Linear, "sky");
    const double direct = mean_of(scenes::render(model, view, bouncing(0)));
    EXPECT_GT(direct, 0.1);
    EXPECT_NEAR(mean_of(scenes::render(model, view, bouncing(2))), direct, 0.02 * direct);
}

TEST_F(PovrayRenderRadiosity, AnEnvironmentIsSeenAsItIsWithBounces) {
    Builder builder;
    builder.place_at(builder.mesh(shapes::cube(), {builder.matte({.5, .5, .5})}), {0, 0, -90});
    image::Image picture;
    picture.width = 64;
    picture.height = 32;
    for (int i = 0; i < 64 * 32; ++i) {
        const bool left = i % 64 < 20;
        for (const float channel : {left ? .8f : .1f, left ? .2f : .6f, .3f, 1.f})
            picture.pixels.push_back(channel);
    }
    builder.model.world.environment =
        image::make_picture(image::png_bytes(picture), ColorSpace::Linear, "sky");
    View view = scenes::above(32, 32);
    view.camera.orthographic = false;
    view.camera.direction = {1, 0.3, 0.2};
    view.camera.right = {0.8, -2, 0};
    view.camera.up = {0, 0, 2};
    const Model& model = builder.finish();
    const scenes::Image without = scenes::render(model, view, bouncing(0));
    const scenes::Image with = scenes::render(model, view, bouncing(1));
    for (size_t i = 0; i < without.values.size(); ++i)
        EXPECT_NEAR(with.values[i], without.values[i], 0.01) << i;
}

TEST_F(PovrayRenderRadiosity, ARoomBehindAWindowIsNotBlackNorLitThroughItsWalls) {
    const auto render = [](bool window) {
        Builder builder;
        const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({.8, .8, .8})});
        add_box(builder, box, {-2, -2, -.2}, {2, 2, 0});
        add_box(builder, box, {-2, -2, 3}, {2, 2, 3.2});
        add_box(builder, box, {-2.2, -2, -.2}, {-2, 2, 3.2});
        add_box(builder, box, {-2, 2, -.2}, {2, 2.2, 3.2});
        add_box(builder, box, {-2, -2.2, -.2}, {2, -2, 3.2});
        add_box(builder, box, {2, -2, -.2}, {2.2, window ? -.5 : 2, 3.2});
        if (window)
            add_box(builder, box, {2, .8, -.2}, {2.2, 2, 3.2});
        builder.model.world.color = glm::dvec3(0.6);
        builder.model.lights.push_back(scenes::sun(3, {-1, 0.1, -0.8}));
        View view = scenes::above(12, 12);
        view.camera.orthographic = false;
        view.camera.position = {0, -1.8, 1.5};
        view.camera.direction = {-.3, 1, 0};
        view.camera.right = {1, .3, 0};
        view.camera.up = {0, 0, 1};
        ExportOptions options = bouncing(2);
        options.folder /= window ? "open" : "closed";
        return scenes::render(builder.finish(), view, options);
    };
    const scenes::Image open = render(true);
    for (int y = 0; y < open.height; ++y) {
        for (int x = 0; x < open.width; ++x)
            EXPECT_GT(open.at(x, y).x, 0.02) << x << ' ' << y;
    }
    EXPECT_LT(mean_of(render(false)), 1e-4);
}

TEST_F(PovrayRenderRadiosity, WhatTheCameraDoesNotSeeIsLitByItsOwnLampsToo) {
    // Two rows of lamps on both sides of a wall; what is seen of one side is lit by the other row's
    // light from a ceiling that no pixel shows.
    Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({.8, .8, .8})});
    add_box(builder, box, {-12, -2, -.2}, {12, 2, 0});
    add_box(builder, box, {-12, -2, 3}, {12, 2, 3.2});
    add_box(builder, box, {-12, 2, 0}, {12, 2.2, 3});
    for (int i = -6; i <= 6; ++i)
        add_box(builder, box, {2 * i - .1, -2, 0}, {2 * i + .1, 2, 3});
    for (int i = -6; i < 6; ++i) {
        // Behind a shade: it shines up only.
        add_box(builder, box, {2 * i + .7, -.3, 1.9}, {2 * i + 1.3, .3, 2.0});
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.power = 30;
        lamp.position = {2 * i + 1, 0, 2.2};
        builder.model.lights.push_back(lamp);
    }
    View view = scenes::above(96, 24);
    view.camera.position = {0, -20, 1};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {24, 0, 0};
    view.camera.up = {0, 0, 2};
    const Model& model = builder.finish();
    ExportOptions exact = bouncing(1);
    exact.light_error = 0;
    const double all = mean_of(scenes::render(model, view, exact));
    ExportOptions ours = bouncing(1);
    ours.folder = own_scratch() / "ours";
    const double found = mean_of(scenes::render(model, view, ours));
    EXPECT_NE(text_of(ours).find("light_group"), std::string::npos);
    EXPECT_NEAR(found, all, 0.03 * all);
}
