// SPDX-License-Identifier: GPL-3.0-or-later
// Guards opaque image textures: POV-Ray knows that they are opaque, and they look as before.
#include "povray/povray_scenes.h"
#include "povray_export/texture/texture_writer.h"

using namespace lodestone;
using namespace lodestone::povray;
using scenes::checker;

TEST(PovrayLayers, AnOpaquePictureLetsPovrayStopShadowRays) {
    // POV-Ray asks for the color of textures that are maps, or texture{uv_mapping ...}, wherever a
    // shadow ray meets them: only pigment{uv_mapping ...} and layers over it are opaque.
    for (const bool glowing : {false, true}) {
        Material material = scenes::textured(checker());
        material.specular = 0.5;  // a white answer to the sky comes on top of the picture
        material.emission = glm::dvec3(glowing ? 0.2 : 0.0);
        TexturedSurface surface;
        surface.uvs = true;
        PictureWriter pictures;
        std::string all = texture_text(material, surface, pictures);
        all += pictures.declarations();
        EXPECT_NE(all.find("pigment{uv_mapping "), std::string::npos);
        EXPECT_EQ(all.find("texture_map"), std::string::npos);
        EXPECT_EQ(all.find("texture{uv_mapping"), std::string::npos);
    }
}

// Heights were read as colors: bumps of normal maps were steeper in the dark than in the bright.
TEST(PovrayLayers, ANormalMapIsHeightsOnEachLayer) {
    Material material;
    material.specular = 0.5;
    material.roughness = 0.5;
    material.normal_texture = checker(ColorSpace::Linear);
    TexturedSurface surface;
    surface.uvs = surface.flat = true;
    PictureWriter pictures;
    std::string all = texture_text(material, surface, pictures);
    all = pictures.declarations() + all;
    EXPECT_EQ(all.find("gamma srgb"), std::string::npos) << all;
    EXPECT_NE(all.find("gamma 1.0"), std::string::npos) << all;
    // The gloss has the bumps of what is below it.
    const size_t first = all.find("normal{");
    ASSERT_NE(first, std::string::npos);
    EXPECT_NE(all.find("normal{", first + 1), std::string::npos) << all;
    EXPECT_NE(all.find("aoi"), std::string::npos) << all;
    // So has that over a picture of something half clear, which is no layer.
    material.base_color_texture = checker();
    material.alpha_mode = AlphaMode::Blend;
    material.alpha = 0.5;
    PictureWriter others;
    const std::string half = texture_text(material, surface, others);
    const size_t gloss = half.find("aoi");
    ASSERT_NE(gloss, std::string::npos) << half;
    const size_t bumps = half.find("normal{", gloss);
    ASSERT_NE(bumps, std::string::npos) << half;
    EXPECT_LT(bumps, half.find("finish{", gloss)) << half;
}

TEST(PovrayRenderLayers, LayersLookAsAveragesDo) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // A picture of one color beside that color, under sun and sky, glossy and glowing.
    Texture even;
    even.picture = scenes::picture(2, std::vector<glm::vec4>(4, {0.2, 0.4, 0.6, 1}));
    Mesh square = shapes::quad(1, 1);
    for (const glm::vec3& at : square.positions)
        square.uvs.emplace_back(at.x, at.y);
    scenes::Builder builder;
    builder.model.world.color = glm::dvec3(0.7);
    builder.model.lights.push_back(scenes::sun(kPi));
    for (int i = 0; i < 4; ++i) {
        Material material = i % 2 == 1 ? scenes::textured(even) : Material{};
        material.base_color = image::color_of(even, even.picture->mean);
        material.specular = 0.8;
        material.roughness = i < 2 ? 0.2 : 0.7;
        material.emission = {0.05, 0.1, 0};
        builder.place_at(builder.mesh(square, {builder.material(material)}), {i - 2.0, -0.5, 0});
    }
    ExportOptions options;
    options.folder = own_scratch() / "layers";
    options.antialiasing = Antialiasing::Off;
    const scenes::Image image = scenes::render(builder.finish(), scenes::above(128, 32), options);
    for (int pair = 0; pair < 2; ++pair) {
        const glm::dvec3 plain = image.at(64 * pair + 16, 16);
        const glm::dvec3 layered = image.at(64 * pair + 48, 16);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(plain[i], layered[i], 0.003) << pair << ' ' << i;
    }
}
