// SPDX-License-Identifier: GPL-3.0-or-later
// Guards pictures on surfaces: what POV-Ray shows is what the texture's own sampler says.
#include "povray/povray_scenes.h"
#include "povray_export/scene/representation_writer.h"
#include "povray_export/texture/pigment_picture.h"

#include <limits>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::above;
using scenes::Builder;
using scenes::checker;
using scenes::render;

namespace {

/// A square with uv -1.25...2.25 that fills a picture of 28 x 28 pixels, an eighth each.
Mesh patch(double low = -1.25, double high = 2.25) {
    Mesh mesh = shapes::quad(0.875F, 0.875F);
    for (const glm::vec3& at : mesh.positions)
        mesh.uvs.emplace_back(low + (high - low) * at.x / 0.875, low + (high - low) * at.y / 0.875);
    return mesh;
}

/// Under a sun that makes a matte surface as bright as its base color: one patch for every
/// material, from left to right.
scenes::Image shown(const std::vector<Material>& materials, const Mesh& mesh,
                    const std::string& name, const glm::dvec3& world = glm::dvec3(0.0)) {
    Builder builder;
    builder.model.world.color = world;
    builder.model.lights.push_back(scenes::sun(kPi));
    const auto count = static_cast<int>(materials.size());
    for (int i = 0; i < count; ++i)
        builder.place_at(builder.mesh(mesh, {builder.material(materials[static_cast<size_t>(i)])}),
                         {0.875 * (i - 0.5 * count), -0.4375, 0});
    ExportOptions options;
    options.folder = scratch(name);
    options.antialiasing = Antialiasing::Off;
    return render(builder.finish(), above(28 * count, 28), options);
}

glm::dvec2 uv_of(int x, int y, double low = -1.25, double high = 2.25) {
    return {low + (high - low) * (x + 0.5) / 28, high - (high - low) * (y + 0.5) / 28};
}

/// The largest difference of each texture to what its sampler says, in one picture.
std::vector<double> differences(const std::vector<Texture>& textures, double low = -1.25,
                                double high = 2.25) {
    std::vector<Material> materials;
    materials.reserve(textures.size());
    for (const Texture& texture : textures)
        materials.push_back(scenes::textured(texture));
    const scenes::Image image = shown(materials, patch(low, high), "scene");
    std::vector<double> worst;
    for (const Texture& texture : textures) {
        const image::TextureSampler sampler(texture, glm::dvec3(0.0));
        const int left = 28 * static_cast<int>(worst.size());
        worst.push_back(0);
        for (int y = 0; y < 28; ++y) {
            for (int x = 0; x < 28; ++x) {
                const glm::dvec3 expected = sampler.color(uv_of(x, y, low, high));
                for (int i = 0; i < 3; ++i)
                    worst.back() =
                        std::max(worst.back(), std::abs(image.at(left + x, y)[i] - expected[i]));
            }
        }
    }
    return worst;
}

std::vector<std::string> pictures(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "i"))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

TEST(PovrayTextures, EveryExtensionAndInterpolationShowsWhatTheSamplerSays) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    std::vector<Texture> textures;
    for (const TextureExtension extension : {TextureExtension::Repeat, TextureExtension::Extend,
                                             TextureExtension::Clip, TextureExtension::Mirror}) {
        for (const TextureInterpolation interpolation :
             {TextureInterpolation::Linear, TextureInterpolation::Closest}) {
            // The border of a clipped picture is not interpolated with the black around it.
            if (extension == TextureExtension::Clip &&
                interpolation == TextureInterpolation::Linear)
                continue;
            textures.push_back(checker());
            textures.back().extension = extension;
            textures.back().interpolation = interpolation;
        }
    }
    for (const double difference : differences(textures))
        EXPECT_LE(difference, 0.004);
    for (const double difference : differences(textures, 0.02, 0.98))
        EXPECT_LE(difference, 0.004);
}

TEST(PovrayTextures, AMappedPictureLiesWhereTheMappingSays) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    std::vector<Texture> textures(5, checker(ColorSpace::Srgb));
    textures[0].to_picture = {0.8, -0.6, 0.3, 1.2, 1.6, -0.7};
    textures[1].to_picture = textures[0].to_picture;
    textures[1].extension = TextureExtension::Extend;
    textures[2].to_picture = {-1, 0, 0.3, 0, 1, 0.1};  // mirrored
    textures[3].to_picture = {0, 0, 0.3, 0, 0, 0.1};   // one texel everywhere
    textures[4].to_picture = {1, 0, 0.3, 2, 0, 0.1};   // a line
    for (const double difference : differences(textures))
        EXPECT_LE(difference, 0.005);
}

TEST(PovrayTextures, ChangedValuesAndTransparentPicturesAreBaked) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    std::vector<Texture> textures(3, checker(ColorSpace::Srgb));
    textures[0].scale = {0.5, 0.25, -1};
    textures[0].offset = {0.1, 0.2, 1};
    textures[1].channel = TextureChannel::Green;
    // What is behind transparent texels is color all the same.
    textures[2].picture = scenes::picture(2, {{.8, 0, 0, 0}, {0, .6, 0, 1}});
    for (const double difference : differences(textures))
        EXPECT_LE(difference, 0.006);
    EXPECT_EQ(pictures(own_scratch() / "scene").size(), 3u);
}

TEST(PovrayTextures, PlainPicturesAreWrittenAsTheyAreOnce) {
    Builder builder;
    const Texture texture = checker();
    Material both = scenes::textured(texture);
    both.emission_texture = texture;
    const uint32_t first = builder.material(both);
    const uint32_t second = builder.material(scenes::textured(texture));
    builder.place(builder.mesh(patch(), {first}));
    builder.place(builder.mesh(patch(0, 1), {second}));
    ExportOptions options;
    options.folder = scratch("as_is");
    Problems problems;
    const Model& model = builder.finish();
    const ExportReport report = scenes::write(model, above(), options, problems);
    ASSERT_EQ(pictures(options.folder).size(), 1u);
    const auto file = options.folder / "i" / pictures(options.folder)[0];
    EXPECT_EQ(read_file(file), texture.picture->bytes);
    EXPECT_EQ(report.files, 5u);
    EXPECT_EQ(report.written, 5u);
    EXPECT_GT(report.bytes, texture.picture->bytes.size());
    const ExportReport again = scenes::write(model, above(), options, problems);
    EXPECT_EQ(again.files, 5u);
    EXPECT_EQ(again.written, 2u);
    EXPECT_EQ(again.bytes, report.bytes);
    std::filesystem::remove(file);  // what is missing comes back
    EXPECT_EQ(scenes::write(model, above(), options, problems).files, 5u);
    EXPECT_EQ(read_file(file), texture.picture->bytes);
}

TEST(PovrayTextures, WithoutTextureCoordinatesThereIsTheMean) {
    Builder builder;
    const uint32_t material = builder.material(scenes::textured(checker()));
    Mesh mesh = shapes::cube();
    builder.place(builder.mesh(mesh, {material}));
    builder.place(builder.primitive(Kind::Box, {}, {material}));
    ExportOptions options;
    options.folder = scratch("mean");
    Problems problems;
    scenes::write(builder.finish(), above(), options, problems);
    EXPECT_FALSE(std::filesystem::exists(options.folder / "i"));
}

TEST(PovrayTextures, AlphaLetsThatShareOfTheSkyThrough) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Material invisible;
    invisible.specular = 1;
    invisible.roughness = 0.1;
    invisible.alpha_mode = AlphaMode::Blend;
    invisible.alpha = 0;
    Material plain = scenes::textured({});
    plain.base_color = glm::dvec3(0.5);
    plain.alpha_mode = AlphaMode::Blend;
    plain.alpha = 0.25;
    Material blend = plain;
    blend.alpha_texture.picture = scenes::picture(2, {{1, 1, 1, 0.25F}, {1, 1, 1, 1}});
    blend.alpha_texture.channel = TextureChannel::Alpha;
    blend.alpha_texture.interpolation = TextureInterpolation::Closest;
    Material clip = blend;
    clip.alpha_mode = AlphaMode::Clip;
    Material opaque = blend;
    opaque.alpha_mode = AlphaMode::Opaque;
    const scenes::Image image =
        shown({invisible, plain, blend, clip, opaque}, patch(0, 1), "alpha", glm::dvec3(0.2));
    const double sky = 0.2;
    const double solid = 0.5 + 0.1;
    const double half = 0.25 * solid + 0.75 * sky;
    EXPECT_NEAR(image.at(14, 14).y, sky, 0.002);  // not even a highlight is left
    EXPECT_NEAR(image.at(42, 14).y, half, 0.003);
    EXPECT_NEAR(image.at(63, 14).y, half, 0.004);
    EXPECT_NEAR(image.at(77, 14).y, solid, 0.003);
    EXPECT_NEAR(image.at(91, 14).y, sky, 0.002);
    EXPECT_NEAR(image.at(105, 14).y, solid, 0.003);
    EXPECT_NEAR(image.at(119, 14).y, solid, 0.003);
}

TEST(PovrayTextures, ALeafsShadowHasItsHoles) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    builder.model.lights.push_back(scenes::sun(kPi, {1, 0, -1}));
    Material leaf = scenes::textured({});
    leaf.alpha_mode = AlphaMode::Clip;
    leaf.alpha_texture.picture = scenes::picture(2, {{0, 0, 0, 1}, {1, 1, 1, 1}});
    leaf.alpha_texture.interpolation = TextureInterpolation::Closest;
    builder.place_at(builder.mesh(patch(0, 1), {builder.material(leaf)}), {-1.4375, -0.4375, 1});
    builder.place_at(builder.mesh(shapes::quad(0.875F, 0.875F), {builder.matte(glm::dvec3(1.0))}),
                     {-0.4375, -0.4375, 0});
    ExportOptions options;
    options.folder = scratch("holes");
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(28, 28), options);
    EXPECT_NEAR(image.at(7, 14).y, std::sqrt(0.5), 0.01);
    EXPECT_NEAR(image.at(21, 14).y, 0, 0.001);
}

TEST(PovrayTextures, EmissionAndBaseColorAddUp) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Material plain = scenes::textured(checker());
    plain.base_color_texture.interpolation = TextureInterpolation::Closest;
    plain.emission = {0.05, 0.1, 0.02};
    Material both = plain;
    both.emission_texture.picture = scenes::picture(1, {{0, .2, 0, 1}, {.1, .3, 1, 1}});
    both.emission_texture.interpolation = TextureInterpolation::Closest;
    both.emission_texture.scale = {2, 1, 0.5};
    Material lamp = both;
    lamp.base_color_texture = {};
    lamp.base_color = glm::dvec3(0.0);
    const scenes::Image image = shown({plain, both, lamp}, patch(0, 1), "emission");
    EXPECT_NEAR(image.at(7, 7).x, 0.85, 0.004);
    EXPECT_NEAR(image.at(7, 7).y, 0.1, 0.004);
    EXPECT_NEAR(image.at(35, 7).x, 0.8, 0.006);
    EXPECT_NEAR(image.at(35, 7).y, 0.2, 0.006);
    EXPECT_NEAR(image.at(49, 21).x, 0.9, 0.01);
    EXPECT_NEAR(image.at(49, 21).y, 0.8, 0.01);
    EXPECT_NEAR(image.at(49, 21).z, 0.5, 0.01);
    EXPECT_NEAR(image.at(77, 21).y, 0.3, 0.006);
    EXPECT_NEAR(image.at(77, 21).z, 0.5, 0.006);
}

TEST(PovrayTextures, APictureBrighterThanWhiteLightsAsMuch) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Material lamp = scenes::textured({});
    lamp.base_color = glm::dvec3(0.0);
    lamp.emission = {3, 0.5, 0};
    shown({lamp}, patch(), "exr");
    RunOptions how;
    how.folder = own_scratch() / "exr";
    how.output = OutputFormat::Exr;
    Texture texture;
    texture.picture =
        image::make_picture(read_file(render_scene(how).picture), ColorSpace::Linear, "lamp");
    ASSERT_EQ(texture.picture->format, PictureFormat::Exr);
    EXPECT_NEAR(brightest_of(*texture.picture), 3, 0.01);
    texture.scale = glm::dvec3(0.25);
    lamp.emission_texture = texture;
    const scenes::Image image = shown({lamp}, patch(0, 1), "exr");
    EXPECT_NEAR(image.at(14, 14).x, 0.75, 0.01);
    EXPECT_NEAR(image.at(14, 14).y, 0.125, 0.005);
}

TEST(PovrayTextures, ConstantMapsLookLikeTheirNumbers) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Material plain;
    plain.base_color = {0.7, 0.4, 0.2};
    plain.roughness = 0.5;
    plain.metallic = 0.4;
    Material mapped = plain;
    mapped.roughness = mapped.metallic = 0.9;
    mapped.roughness_texture.picture = scenes::picture(1, {{0, 127.5F / 255, 0, 1}});
    mapped.roughness_texture.channel = TextureChannel::Green;
    mapped.metallic_texture.picture = scenes::picture(1, {{0.8F, 0.8F, 0.8F, 1}});
    mapped.metallic_texture.scale.x = 0.5;
    const scenes::Image image = shown({plain, mapped}, patch(), "maps", glm::dvec3(0.3));
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(image.at(14, 14)[i], image.at(42, 14)[i], 0.02);
}

TEST(PovrayTextures, MixedMaterialsAreWeightedMeans) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    auto blue = std::make_shared<Material>(scenes::textured({}));
    blue->base_color = {0, 0, 0.8};
    Material red = scenes::textured({});
    red.base_color = {0.4, 0, 0};
    red.other = blue;
    red.mix = 0.25;
    Material halves = red;
    halves.mix_texture.picture = scenes::picture(2, {{0, 0, 0, 1}, {1, 1, 1, 1}});
    halves.mix_texture.interpolation = TextureInterpolation::Closest;
    const scenes::Image image = shown({red, halves}, patch(0, 1), "mix");
    EXPECT_NEAR(image.at(14, 14).x, 0.3, 0.003);
    EXPECT_NEAR(image.at(14, 14).z, 0.2, 0.003);
    EXPECT_NEAR(image.at(35, 14).x, 0.4, 0.003);
    EXPECT_NEAR(image.at(49, 14).z, 0.8, 0.003);
}

TEST(PovrayTextures, BumpsFollowTheTextureCoordinatesHoweverTheSurfaceIsTurned) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    std::vector<glm::vec4> ramp;
    ramp.reserve(256);
    for (int i = 0; i < 256; ++i)
        ramp.emplace_back(glm::vec3(static_cast<float>(i) / 255.0F), 1);
    Material material = scenes::textured({});
    material.base_color = glm::dvec3(0.5);
    material.bump_texture.picture = scenes::picture(256, ramp);
    material.bump_distance = 0.0875;  // on a picture .875 m wide: a slope of .1
    Builder builder;
    builder.model.lights.push_back(scenes::sun(kPi, {-1, 0, -1}));
    const ObjectIndex square = builder.mesh(patch(0, 1), {builder.material(material)});
    const double turns[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int i = 0; i < 4; ++i) {
        const double c = turns[i][0];
        const double s = turns[i][1];
        const glm::dmat3 turn(c, s, 0, -s, c, 0, 0, 0, 1);
        builder.place(square,
                      {turn, glm::dvec3(i - 1.5, 0, 0) - turn * glm::dvec3(0.4375, 0.4375, 0)});
    }
    ExportOptions options;
    options.folder = scratch("bump");
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(128, 32), options);
    const double flat = 0.5 * std::sqrt(0.5);
    const double root = std::sqrt(1.01);
    EXPECT_NEAR(image.at(16, 16).x, flat * 0.9 / root, 0.005);  // turned away from the sun
    EXPECT_NEAR(image.at(48, 16).x, flat / root, 0.005);
    EXPECT_NEAR(image.at(80, 16).x, flat * 1.1 / root, 0.005);
    EXPECT_NEAR(image.at(112, 16).x, flat / root, 0.005);
}

TEST(PovrayTextures, BumpsOnACurvedSurfaceAreLeftOutAndNamed) {
    Builder builder;
    Mesh ball = shapes::sphere(1, 3);
    for (const glm::vec3& at : ball.positions)
        ball.uvs.emplace_back(at.x, at.y * at.z);
    Material material = scenes::textured({});
    material.bump_texture = checker();
    material.bump_distance = 0.1;
    const uint32_t index = builder.material(material);
    const uint32_t round = builder.mesh(ball, {index});
    builder.place(round, {}, "ball");
    Mesh cube = shapes::cube();
    for (size_t i = 0; i < cube.positions.size(); ++i)
        cube.uvs.emplace_back((i % 4) % 3 != 0, (i % 4) / 2);
    builder.place(builder.mesh(cube, {index}), {}, "cube");
    ExportOptions options;
    options.folder = scratch("curved");
    for (int frame = 0; frame < 2; ++frame) {  // the second finds its files
        Problems problems;
        scenes::write(builder.finish(), above(), options, problems);
        ASSERT_EQ(problems.size(), 1u) << frame;
        EXPECT_EQ(problems[0].object, "ball");
        EXPECT_EQ(problems[0].code, "bump_not_flat");
    }
    // A model of one mesh was told about without a name.
    builder.model.objects[round].name = "lonely";
    builder.model.root = round;
    Problems problems;
    scenes::write(builder.model, above(), options, problems);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].object, "lonely");
}

TEST(PovrayTextures, GlassBendsWhatIsBehindItAndTintsItTwice) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    Material glass;
    glass.base_color = {1, 0.5, 0.8};
    glass.transmission = 1;
    glass.ior = 1.5;
    glass.roughness = 0;
    Material lamp = scenes::textured({});
    lamp.base_color = glm::dvec3(0.0);
    lamp.emission = glm::dvec3(0.5);
    builder.place(builder.mesh(shapes::sphere(0.8, 5), {builder.material(glass)}));
    builder.place_at(builder.mesh(shapes::quad(2, 4), {builder.material(lamp)}), {-2, -2, -2});
    ExportOptions options;
    options.folder = scratch("glass");
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(64, 64), options);
    EXPECT_NEAR(image.at(24, 32).x, 0, 0.01);  // left and right change places
    EXPECT_NEAR(image.at(40, 32).x, 0.5 * 0.96 * 0.96, 0.02);
    EXPECT_NEAR(image.at(40, 32).y, 0.5 * 0.25 * 0.96 * 0.96, 0.01);
    EXPECT_NEAR(image.at(40, 32).z, 0.5 * 0.64 * 0.96 * 0.96, 0.015);
    EXPECT_NEAR(image.at(2, 32).x, 0.5, 0.002);
}

TEST(PovrayTextures, WhatIsClearBesideGlassInOneMeshBendsNothing) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    Material glass;
    glass.transmission = 1;
    glass.roughness = 0;
    Material clear = scenes::textured({});
    clear.base_color = glm::dvec3(0.0);
    clear.alpha_mode = AlphaMode::Blend;
    clear.alpha = 0.5;
    Material lamp = clear;
    lamp.alpha = 1;
    lamp.emission = glm::dvec3(0.5);
    Mesh balls = shapes::sphere(0.8, 5);
    balls.slots.assign(balls.triangles.size(), 0);
    Mesh other = balls;
    other.slots.assign(other.triangles.size(), 1);
    append(balls, other, {glm::dmat3(1.0), {9, 0, 0}});  // outside of the picture
    builder.place(builder.mesh(balls, {builder.material(clear), builder.material(glass)}));
    builder.place_at(builder.mesh(shapes::quad(2, 4), {builder.material(lamp)}), {-2, -2, -2});
    ExportOptions options;
    options.folder = scratch("clear_beside_glass");
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = render(builder.finish(), above(64, 64), options);
    EXPECT_NEAR(image.at(24, 32).x, 0.5 * 0.25, 0.002);
    EXPECT_NEAR(image.at(40, 32).x, 0, 0.002);
}

TEST(PovrayTextures, VertexColorsRunBetweenVerticesAndMultiplyThePicture) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Mesh mesh = patch(0, 1);
    for (const glm::vec2& uv : mesh.uvs)
        mesh.colors.emplace_back(uv.x, 0.25F, 1 - uv.x, 1);
    Material material = scenes::textured({});
    material.base_color = {1, 1, 0.5};
    material.vertex_colors = true;
    scenes::Image image = shown({material}, mesh, "colors");
    for (const int x : {0, 7, 21, 27}) {
        const double u = (x + 0.5) / 28;
        EXPECT_NEAR(image.at(x, 14).x, u, 0.006);
        EXPECT_NEAR(image.at(x, 14).y, 0.25, 0.003);
        EXPECT_NEAR(image.at(x, 14).z, 0.5 * (1 - u), 0.006);
    }
    material.vertex_colors = false;
    EXPECT_NEAR(shown({material}, mesh, "colors").at(7, 14).x, 1, 0.01);

    material = scenes::textured(checker());
    material.base_color_texture.interpolation = TextureInterpolation::Closest;
    material.vertex_colors = true;
    image = shown({material}, mesh, "colors");
    EXPECT_NEAR(image.at(7, 7).x, 0.8 * 7.5 / 28, 0.006);
    EXPECT_NEAR(image.at(21, 7).y, 0.6 * 0.25, 0.006);
    EXPECT_NEAR(image.at(7, 21).z, 0.9 * (1 - 7.5 / 28), 0.01);
}

TEST(PovrayTextures, HostileTexturesGiveTextThatPovrayReads) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Texture texture = checker();
    texture.to_picture = {1e300, 0, -1e300, 0, 1e-300, 5};
    texture.scale = {1e300, -1e300, 0};
    texture.extension = TextureExtension::Extend;
    Material material = scenes::textured(texture);
    material.emission_texture = texture;
    material.alpha_mode = AlphaMode::Clip;
    material.alpha_texture = texture;
    material.roughness_texture = material.metallic_texture = material.mix_texture = texture;
    material.other = std::make_shared<Material>(material);
    Mesh mesh = patch();
    mesh.uvs[0] = {1e30F, -1e30F};
    Builder builder;
    builder.place(builder.mesh(mesh, {builder.material(material)}));
    ExportOptions options;
    options.folder = scratch("hostile");
    RunReport report;
    render(builder.finish(), above(16, 16), options, &report);
    EXPECT_EQ(report.messages, "");
}
