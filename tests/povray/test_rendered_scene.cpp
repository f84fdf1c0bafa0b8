// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what POV-Ray makes of the exported text: light, finish, camera, primitives, false colors.
#include "povray/povray_scenes.h"
#include "povray_export/texture/surface_finish.h"

#include <fstream>
#include <limits>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::above;
using scenes::Builder;
using scenes::render;
using scenes::rich_sphere;

TEST(PovrayRender, PovrayReadsEverythingWithoutAWarning) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    Material metal;
    metal.metallic = 1;
    metal.roughness = 0.1;
    metal.emission = {0, 1, 0};
    metal.base_color = {1, 0, 0.2};
    const uint32_t shiny = builder.material(metal);
    const uint32_t red = builder.matte({1, 0, 0});
    Mesh cube = shapes::cube();
    for (size_t i = 0; i < cube.positions.size(); ++i)
        cube.uvs.emplace_back((i % 4) % 3 != 0, (i % 4) / 2);
    builder.place_at(builder.mesh(rich_sphere(2), {shiny, red}), {0, 0, 0});
    builder.place_at(builder.mesh(cube, {red}), {0.6, 0, 0});
    builder.place_at(builder.mesh(shapes::terrain(8)), {-0.6, 0, 0});
    builder.place_at(builder.primitive(Kind::Ellipsoid, {{}, glm::dmat3(1.0), {.1, .2, .3}}),
                     {0, 0.6, 0});
    builder.place_at(builder.primitive(Kind::Box, {}, {shiny}), {0, -0.6, 0});
    builder.place(1, Affine{glm::dmat3(2, 0, 0, 0, 0, 0, 0, 0, 1), {}}, "\"*/\n}#error");
    for (const float size : {1e-20f, 1e20f})  // as text, whatever is seen of it
        builder.place(builder.mesh(shapes::quad(size, size)));
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.position = {1, 1, 3};
    lamp.shadow = false;
    builder.model.lights = {scenes::sun(2), lamp};
    for (const bool false_color : {false, true}) {
        ExportOptions options;
        options.folder = scratch("warnings");
        options.false_color = false_color;
        RunReport report;
        const scenes::Image image = render(builder.finish(), above(), options, &report);
        EXPECT_EQ(report.messages, "");
        EXPECT_GT(report.peak_bytes, 4u << 20u);
        EXPECT_EQ(image.width, 64);
    }
}

TEST(PovrayRender, SunAndSkyLightAMatteSurfaceByTheirFormulas) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    ExportOptions options;
    options.folder = scratch("light");
    options.antialiasing = Antialiasing::Off;
    const auto center = [&](const glm::dvec3& albedo, const glm::dvec3& sky, const Light& light) {
        Builder builder;
        builder.model.world.color = sky;
        builder.model.lights.push_back(light);
        builder.place_at(builder.mesh(shapes::quad(4, 4), {builder.matte(albedo)}), {-2, -2, 0});
        return render(builder.finish(), above(8, 8), options).at(4, 4);
    };
    EXPECT_NEAR(center(glm::dvec3(1.0), {}, scenes::sun(kPi)).x, 1, 0.01);
    const glm::dvec3 sunny = center({0.9, 0.5, 0.1}, {}, scenes::sun(kPi));
    EXPECT_NEAR(sunny.x, 0.9, 0.009);
    EXPECT_NEAR(sunny.y, 0.5, 0.005);
    EXPECT_NEAR(sunny.z, 0.1, 0.001);
    const double slant = center(glm::dvec3(0.8), {}, scenes::sun(kPi, {1, 0, -1})).x;
    EXPECT_NEAR(slant, 0.8 * std::sqrt(0.5), 0.006);
    const glm::dvec3 sky = center(glm::dvec3(1.0), {0.25, 0.5, 0.75}, scenes::sun(0));
    EXPECT_NEAR(sky.x, 0.25, 0.0025);
    EXPECT_NEAR(sky.z, 0.75, 0.0075);
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.power = 100;
    lamp.position = {0.0625, -0.0625, 4};
    // Radiant intensity P / (4 pi^2) in Blender's units times albedo over distance squared.
    EXPECT_NEAR(center(glm::dvec3(0.8), {}, lamp).x, 0.8 * 100 / (4 * kPi * kPi) / 16, 0.0013);
}

TEST(PovrayRender, AUniformSkyShowsWhatAPathTracerShows) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    struct Case {
        double metallic, roughness;
        glm::dvec3 shown;  // under a sky of 1, by tests/bench/peers/fit_finish.py's Cycles
    };
    const Case cases[] = {{0, 0.05, {1.019, .530, .285}},
                          {0, 1.0, {1.051, .532, .272}},
                          {1, 0.05, {1.0, .50, .25}},
                          {1, 0.6, {.80, .40, .20}}};
    Builder builder;
    builder.model.world.color = glm::dvec3(0.5);
    for (int i = 0; i < 4; ++i) {
        Material material;
        material.base_color = {1, 0.5, 0.25};
        material.metallic = cases[i].metallic;
        material.roughness = cases[i].roughness;
        const ObjectIndex ball = builder.mesh(shapes::sphere(0.2, 3), {builder.material(material)});
        builder.place_at(ball, {-0.75 + 0.5 * i, 0, 0});
    }
    ExportOptions options;
    options.folder = scratch("furnace");
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(64, 16), options);
    for (int i = 0; i < 4; ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.at(8 + 16 * i, 8)[c], 0.5 * cases[i].shown[c], 0.015)
                << i << ' ' << c;
    }
}

TEST(PovrayRender, TheSkyWasGoneFromBlackPlasticsAndTintedBySaturatedOnes) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const glm::dvec3 white(0.041);  // Cycles, under a sky of 1, at roughness .4, whatever the color
    Material black;
    black.base_color = glm::dvec3(0.0);
    black.roughness = 0.4;
    Material red = black;
    red.base_color = {0.8, 0, 0};
    Material pictured = black;  // black over all of the patch, its mean is not
    pictured.base_color_texture.picture =
        scenes::picture(2, {{0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {.8, 0, 0, 1}});
    pictured.base_color_texture.interpolation = TextureInterpolation::Closest;
    pictured.base_color = {0.2, 0, 0};
    Material glowing = black;
    glowing.emission = {0, 0.3, 0};
    Material pictured_glowing = pictured;
    pictured_glowing.emission = glowing.emission;
    Material lamp = pictured;  // a picture of its light, too
    lamp.emission_texture.picture = scenes::picture(1, {{0, 0.3, 0, 1}});
    Material lamp_on_black = black;
    lamp_on_black.emission_texture = lamp.emission_texture;
    Material coated = black;
    coated.specular = 0;
    coated.clearcoat = 1;
    coated.clearcoat_roughness = 0.4;
    const glm::dvec3 glow(0, 0.3, 0);
    const struct {
        Material material;
        glm::dvec3 shown;
    } cases[] = {{black, white},
                 {red, white + glm::dvec3(0.79, 0, 0)},
                 {pictured, white},
                 {glowing, white + glow},
                 {pictured_glowing, white + glow},
                 {lamp, white + glow},
                 {lamp_on_black, white + glow},
                 {coated, glm::dvec3(0.011)}};
    constexpr int kCount = static_cast<int>(std::size(cases));
    Mesh mesh = shapes::quad(0.5F, 0.5F);
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.uvs.emplace_back(0.1, 0.2);
    Builder builder;
    builder.model.world.color = glm::dvec3(1.0);
    for (int i = 0; i < kCount; ++i)
        builder.place_at(builder.mesh(mesh, {builder.material(cases[i].material)}),
                         {0.5 * i - 0.25 * kCount, -0.25, 0});
    ExportOptions options;
    options.folder = scratch("plastics");
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(16 * kCount, 16), options);
    for (int i = 0; i < kCount; ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.at(8 + 16 * i, 8)[c], cases[i].shown[c], 0.006) << i << ' ' << c;
    }
}

TEST(PovrayRender, TheCameraProjectsWhereItShould) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    struct Case {
        const char* name;
        bool orthographic;
        int width, height;
        glm::dvec3 direction, right, up;
    };
    // Axes turned so that no coordinate is special.
    const glm::dvec3 x = glm::normalize(glm::dvec3(1, 0.3, -0.2));
    const glm::dvec3 z = glm::normalize(glm::cross(x, glm::dvec3(0.1, 1, 0.2)));
    const glm::dvec3 y = glm::cross(z, x);
    const Case cases[] = {
        {"landscape", false, 96, 54, -z, x, y * 0.5625},
        {"shifted", false, 96, 54, -z + 0.2 * x - 0.15 * y, x, y * 0.5625},
        {"portrait", false, 54, 96, -z, x * 0.5625, y},
        {"orthographic", true, 96, 54, -z, 4.0 * x, 2.25 * y},
    };
    for (const Case& test : cases) {
        View view;
        view.width = test.width;
        view.height = test.height;
        view.camera = {"", test.orthographic, {3, -2, 5}, test.direction, test.right, test.up};
        Builder builder;
        Material glow;
        glow.emission = glm::dvec3(1.0);
        glow.base_color = glm::dvec3(0.0);
        glow.specular = 0;
        const ObjectIndex ball = builder.primitive(
            Kind::Ellipsoid, {{}, glm::dmat3(1.0), glm::dvec3(0.06)}, {builder.material(glow)});
        std::vector<glm::dvec2> expected;
        for (const double v : {-0.3, 0.3}) {
            for (const double u : {-0.35, 0.05, 0.4}) {
                const double depth = 4 + 0.5 * u;
                const glm::dvec3 across = u * test.right + v * test.up;
                builder.place_at(ball, view.camera.position +
                                           (test.orthographic ? across + 4.0 * test.direction
                                                              : depth * (test.direction + across)));
                expected.emplace_back((u + 0.5) * test.width, (0.5 - v) * test.height);
            }
        }
        ExportOptions options;
        options.folder = scratch("camera");
        options.antialiasing = Antialiasing::Reference;
        const scenes::Image image = render(builder.finish(), view, options);
        for (const glm::dvec2& point : expected) {
            glm::dvec2 sum(0.0);
            double weight = 0;
            for (int py = 0; py < image.height; ++py) {
                for (int px = 0; px < image.width; ++px) {
                    const glm::dvec2 pixel(px + 0.5, py + 0.5);
                    if (glm::length(pixel - point) > 7)
                        continue;
                    sum += image.at(px, py).x * pixel;
                    weight += image.at(px, py).x;
                }
            }
            ASSERT_GT(weight, 1) << test.name;
            EXPECT_NEAR(sum.x / weight, point.x, 0.05) << test.name;
            EXPECT_NEAR(sum.y / weight, point.y, 0.05) << test.name;
        }
    }
}

TEST(PovrayRender, ABoxLooksLikeItsMesh) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Primitive box{{0.05, 0.1, 0}, glm::dmat3(1.0), {0.7, 0.4, 0.2}};
    box.axes = glm::dmat3(0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1);
    scenes::Image images[2];
    for (const bool mesh : {false, true}) {
        Builder builder;
        builder.model.world.color = {0.1, 0.2, 0.3};
        builder.model.lights.push_back(scenes::sun(2.5, {0.3, 0.5, -0.8}));
        const uint32_t plain = builder.material(Material{});
        builder.place(mesh ? builder.mesh(tessellate_box(box), {plain})
                           : builder.primitive(Kind::Box, box, {plain}));
        builder.place_at(builder.mesh(shapes::quad(4, 4), {plain}), {-2, -2, -0.5});
        View view = above(96, 96);
        view.camera.direction = {0.3, 0.2, -1};
        view.camera.position = {-3, -2, 10};
        ExportOptions options;
        options.folder = scratch("box");
        options.antialiasing = Antialiasing::Reference;
        options.shading.sky_rays =
            -1;  // a box has one share of the sky, its mesh one at each corner
        images[mesh] = render(builder.finish(), view, options);
    }
    double worst = 0;
    for (size_t i = 0; i < images[0].values.size(); ++i)
        worst = std::max(worst, std::abs(images[0].values[i] - images[1].values[i]));
    EXPECT_LE(worst, 2.0 / 255);
    EXPECT_GT(*std::max_element(images[0].values.begin(), images[0].values.end()), 0.3);
}

TEST(PovrayRender, EachRayClassSeesWhatItMay) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // A slanting sun over a white floor: what stands at x casts its shadow at x + 0.5. One red
    // thing a row, from the top down.
    struct Row {
        Kind kind;
        RayMask hidden;
        bool object;
        bool shadow;
    };
    std::vector<Row> rows;
    for (const Kind kind : {Kind::Mesh, Kind::Ellipsoid}) {
        rows.push_back({kind, 0, true, true});
        rows.push_back({kind, kCameraRays, false, true});
        rows.push_back({kind, kShadowRays, true, false});
        rows.push_back({kind, kReflectionRays | kRadiosityRays, true, true});
        rows.push_back({kind, kAllRays, false, false});
    }
    Builder builder;
    const uint32_t red = builder.matte({1, 0, 0});
    builder.place_at(builder.mesh(shapes::quad(20, 20), {builder.matte({1, 1, 1})}), {-10, -10, 0});
    for (size_t i = 0; i < rows.size(); ++i)
        builder.place(rows[i].kind == Kind::Mesh ? builder.mesh(shapes::cube(), {red})
                                                 : builder.primitive(rows[i].kind, {}, {red}),
                      Affine{glm::dmat3(0.2), {-0.3, 4.5 - static_cast<double>(i), 0.5}}, "it",
                      rows[i].hidden);
    builder.model.lights.push_back(scenes::sun(std::numbers::pi, {1, 0, -1}));
    ExportOptions options;
    options.folder = scratch("hidden");
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(64, 320), options);
    for (size_t i = 0; i < rows.size(); ++i) {
        const int y = 16 + 32 * static_cast<int>(i);
        EXPECT_EQ(image.at(32 - 10, y).y < 0.1, rows[i].object) << i;
        EXPECT_EQ(image.at(32 + 7, y).y < 0.1, rows[i].shadow) << i;
    }
}

TEST(PovrayRender, FalseColorsAreThoseOfTheLegend) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    const uint32_t red = builder.matte({1, 0, 0});
    const uint32_t blue = builder.matte({0, 0, 1});
    builder.place_at(builder.mesh(rich_sphere(2), {red, blue}), {0, 0, 0});
    builder.place_at(builder.primitive(Kind::Box, {}, {red}), {2.5, 0, 0});
    ExportOptions options;
    options.folder = scratch("false_color");
    options.false_color = true;
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(192, 16), options);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(image.at(96, 8)[i], color_of(Kind::Mesh, 0)[i], 0.002);
        EXPECT_NEAR(image.at(96 + 90, 8)[i], color_of(Kind::Box, 0)[i], 0.002);
    }
}

// Single sunlit pixels stood along the edge of a wall and the ceiling over it: POV-Ray forgot the
// ceiling where its underside was within its tolerance of where the ray to the sun began.
TEST(PovrayRender, TheSunDoesNotShineThroughACeilingAtItsEdge) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({.8, .8, .8})});
    builder.place(box, {glm::dmat3(2, 0, 0, 0, .2, 0, 0, 0, 3), {0, 1.1, 1.5}}, "wall");
    builder.place(box, {glm::dmat3(2, 0, 0, 0, 2.1, 0, 0, 0, .2), {0, .05, 2.1}}, "ceiling");
    Light sun = scenes::sun(3);
    sun.direction = glm::normalize(glm::dvec3(0, 1, -1));
    builder.model.lights = {sun};
    View view = above(16, 8);
    view.pixel_error = 0;
    view.camera.orthographic = true;
    // The middle of the first row is .00005 below the ceiling.
    view.camera.position = {0, -.9, 1.96495};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {.16, 0, 0};
    view.camera.up = {0, 0, .08};
    ExportOptions options;
    options.folder = scratch("edge");
    const scenes::Image image = render(builder.finish(), view, options);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x)
            ASSERT_LT(image.at(x, y).x, 1e-3) << x << " " << y;
    }
}
