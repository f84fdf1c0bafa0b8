// SPDX-License-Identifier: GPL-3.0-or-later
// Guards materials of foreign glTF files: what they say of textures, alpha, glass and vertex
// colors, and that no picture crashes us or comes from elsewhere.
#include "base/error.h"
#include "base/files.h"
#include "format/model_file.h"
#include "scenes/damaged_files.h"
#include "scenes/gltf_textured.h"
#include "scratch.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lodestone::format {
namespace {

using namespace gltf_text;
using image::TextureSampler;

std::filesystem::path folder() {
    std::filesystem::path path = own_scratch();
    std::filesystem::create_directories(path / "inner");
    return path;
}

TEST(GltfMaterial, TexturesKeepTheirFactorsChannelsAndLayout) {
    const PicturePtr picture = many_texels(4, 4, ColorSpace::Srgb, true);
    const Material m = only_material(
        gltf(R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0.25,0.75],
             "baseColorTexture":{"index":0},"metallicFactor":0.5,"roughnessFactor":0.25,
             "metallicRoughnessTexture":{"index":1}},"emissiveFactor":[1,0.5,0],
             "emissiveTexture":{"index":0},"normalTexture":{"index":1,"scale":0.5},
             "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":8}}}],
             "textures":[{"source":0,"sampler":0},{"source":0}],
             "samplers":[{"wrapS":33071,"wrapT":33071,"magFilter":9728}],"images":[{"uri":")" +
             data_uri(*picture) +
             R"("}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)" +
             kOneNode));
    const glm::dvec4 linear = many_texels(4, 4, ColorSpace::Linear, true)->mean;
    const Texture& base = m.base_color_texture;
    ASSERT_TRUE(base && m.roughness_texture && m.metallic_texture && m.emission_texture &&
                m.normal_texture);
    EXPECT_EQ(base.picture->hash, picture->hash);
    EXPECT_EQ(base.scale, glm::dvec3(0.5, 1, 0.25));
    EXPECT_EQ(base.extension, TextureExtension::Extend);
    EXPECT_EQ(base.interpolation, TextureInterpolation::Closest);
    expect_near(m.base_color, glm::dvec3(0.5, 1, 0.25) * glm::dvec3(picture->mean), 1e-12);
    EXPECT_EQ(m.alpha, 1);  // opaque
    EXPECT_FALSE(m.alpha_texture);
    EXPECT_EQ(m.roughness_texture.channel, TextureChannel::Green);
    EXPECT_EQ(m.roughness_texture.scale.x, 0.25);
    EXPECT_EQ(m.roughness_texture.picture->space, ColorSpace::Linear);
    EXPECT_EQ(m.roughness_texture.extension, TextureExtension::Repeat);
    EXPECT_NEAR(m.roughness, 0.25 * linear.y, 1e-12);
    EXPECT_EQ(m.metallic_texture.channel, TextureChannel::Blue);
    EXPECT_NEAR(m.metallic, 0.5 * linear.z, 1e-12);
    EXPECT_EQ(m.emission_texture.scale, glm::dvec3(8, 4, 0));
    expect_near(m.emission, glm::dvec3(8, 4, 0) * glm::dvec3(picture->mean), 1e-12);
    EXPECT_EQ(m.normal_texture.picture, m.roughness_texture.picture);  // shared, not copied
    EXPECT_EQ(m.normal_strength, 0.5);
}

TEST(GltfMaterial, EveryTexelIsWhereGltfPutsIt) {
    const PicturePtr picture = many_texels(8, 4, ColorSpace::Srgb);
    const image::Image texels = image::decoded(*picture);
    PcgRandom random(3);
    for (int round = 0; round < 20; ++round) {
        const double ox = random.uniform() - 0.5, oy = random.uniform() - 0.5;
        const double turn = 7 * random.uniform();
        const double sx = 3 * random.uniform(), sy = round % 2 == 0 ? -1.5 : 2 * random.uniform();
        const Material m = only_material(with_material(
            text(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":
                 {"KHR_texture_transform":{"offset":[)",
                 ox, ",", oy, R"(],"rotation":)", turn, R"(,"scale":[)", sx, ",", sy, "]}}}}}"),
            data_uri(*picture)));
        // What was written has six digits.
        const auto six = [](double x) { return std::stod(text(x)); };
        Texture closest = m.base_color_texture;
        closest.interpolation = TextureInterpolation::Closest;
        const TextureSampler sampler(closest, {});
        for (int i = 0; i < 50; ++i) {
            const double u = 2 * random.uniform(), v = 2 * random.uniform();  // glTF's, v down
            // KHR_texture_transform: turned against the clock as one looks at the picture.
            const double c = std::cos(six(turn)), s = std::sin(six(turn));
            const double x = c * six(sx) * u + s * six(sy) * v + six(ox);
            const double y = -s * six(sx) * u + c * six(sy) * v + six(oy);
            const auto texel = [](double at, int size) {
                return static_cast<size_t>(std::floor((at - std::floor(at)) * size));
            };
            const double edge =
                std::min(std::abs(8 * x - std::round(8 * x)), std::abs(4 * y - std::round(4 * y)));
            if (edge < 1e-6)
                continue;
            const float* wanted = texels.pixels.data() + 4 * (8 * texel(y, 4) + texel(x, 8));
            expect_near(sampler.color({u, 1 - v}), {wanted[0], wanted[1], wanted[2]}, 1e-6);
        }
    }
}

TEST(GltfMaterial, AlphaIsTheFactorTimesThePictures) {
    const PicturePtr picture = many_texels(4, 4, ColorSpace::Srgb, true);
    const PicturePtr whole = many_texels(4, 4, ColorSpace::Srgb);
    const std::string pbr = R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5],
                            "baseColorTexture":{"index":0}})";
    const auto read_with = [&](const std::string& mode, const PicturePtr& from) {
        return only_material(with_material("{" + mode + pbr + "}", data_uri(*from)));
    };
    const Material blend = read_with(R"("alphaMode":"BLEND",)", picture);
    EXPECT_EQ(blend.alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(blend.alpha_texture.channel, TextureChannel::Alpha);
    EXPECT_EQ(blend.alpha_texture.scale.x, 0.5);
    EXPECT_NEAR(blend.alpha, 0.5 * picture->mean.w, 1e-12);
    const Material mask = read_with(R"("alphaMode":"MASK","alphaCutoff":0.25,)", picture);
    EXPECT_EQ(mask.alpha_mode, AlphaMode::Clip);
    EXPECT_EQ(mask.alpha_cutoff, 0.25);
    EXPECT_TRUE(mask.alpha_texture);
    const Material opaque = read_with("", picture);
    EXPECT_EQ(opaque.alpha_mode, AlphaMode::Opaque);
    EXPECT_EQ(opaque.alpha, 1);
    const Material covered = read_with(R"("alphaMode":"BLEND",)", whole);
    EXPECT_EQ(covered.alpha, 0.5);
    EXPECT_FALSE(covered.alpha_texture);  // it is 1 everywhere
}

TEST(GltfMaterial, ExtensionsBecomeGlassCoatAndShine) {
    const Material glass = only_material(
        with_material(R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.75},
                      "KHR_materials_ior":{"ior":1.33},"KHR_materials_clearcoat":{
                      "clearcoatFactor":0.5,"clearcoatRoughnessFactor":0.125}}})",
                      data_uri(*models::checker())));
    EXPECT_EQ(glass.transmission, 0.75);
    EXPECT_EQ(glass.ior, 1.33);
    EXPECT_EQ(glass.specular, 0.5);
    EXPECT_EQ(glass.clearcoat, 0.5);
    EXPECT_EQ(glass.clearcoat_roughness, 0.125);
    const auto specular = [](const std::string& extensions) {
        return only_material(with_material(R"({"extensions":{)" + extensions + "}}",
                                           data_uri(*models::checker())))
            .specular;
    };
    EXPECT_EQ(specular(R"("KHR_materials_specular":{"specularFactor":0.5})"), 0.25);
    EXPECT_EQ(specular(R"("KHR_materials_specular":{"specularColorFactor":[2,2,2]})"), 1);
    EXPECT_NEAR(specular(R"("KHR_materials_ior":{"ior":1.5})"), 0.5, 1e-12);
    EXPECT_NEAR(specular(R"("KHR_materials_ior":{"ior":1.33})"), 0.25, 0.01);
    const Material lamp =
        only_material(with_material(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1],
                      "baseColorTexture":{"index":0}},"extensions":{"KHR_materials_unlit":{}}})",
                                    data_uri(*models::checker())));
    EXPECT_EQ(lamp.base_color, glm::dvec3(0.0));
    EXPECT_FALSE(lamp.base_color_texture);
    EXPECT_EQ(lamp.emission_texture.scale, glm::dvec3(1, 0.5, 0));
    EXPECT_EQ(lamp.specular, 0);
    Problems problems;
    const Material old = only_material(
        with_material(R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":
                      [0.5,0.5,0.5,1],"diffuseTexture":{"index":0},"glossinessFactor":0.75},
                      "KHR_materials_sheen":{}}})",
                      data_uri(*models::checker())),
        problems);
    EXPECT_EQ(old.base_color_texture.scale, glm::dvec3(0.5));
    EXPECT_EQ(old.roughness, 0.25);
    EXPECT_EQ(old.metallic, 0);
    EXPECT_EQ(problems.size(), 2u);
    EXPECT_TRUE(has(problems, "material_simplified"));
}

TEST(GltfMaterial, VertexColorsOfEveryTypeMultiply) {
    const auto colors = [](const std::string& bytes, const std::string& accessor,
                           Problems& problems) {
        std::string file =
            gltf(R"("materials":[{},{}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,
                 "COLOR_0":2},"indices":1,"material":0}]},{"primitives":[{"attributes":
                 {"POSITION":0},"material":1}]},{"primitives":[{"attributes":{"POSITION":0,
                 "COLOR_0":2}}]}],"nodes":[{"mesh":0},{"mesh":1},{"mesh":2}],
                 "scenes":[{"nodes":[0,1,2]}])");
        const auto insert = [&file](const std::string& before, const std::string& words) {
            file.insert(file.find(before), words);
        };
        insert(R"(}],"bufferViews")", R"(},{"byteLength":)" + text(bytes.size()) +
                                          R"(,"uri":"data:application/octet-stream;base64,)" +
                                          base64(bytes) + "\"");
        insert(R"(],"accessors")", R"(,{"buffer":1,"byteLength":)" + text(bytes.size()) + "}");
        insert(R"(],"materials")", R"(,{"bufferView":2,"count":4,)" + accessor + "}");
        return read(file, problems);
    };
    Problems problems;
    const std::vector<Model> models{
        colors(raw<uint8_t>({255, 0, 51, 255, 0, 0, 0, 102, 0, 0, 0, 0, 1, 1, 1, 1}),
               R"("componentType":5121,"normalized":true,"type":"VEC4")", problems),
        colors(raw<uint16_t>({65535, 0, 13107, 65535, 0, 0, 0, 26214, 0, 0, 0, 0, 1, 1, 1, 1}),
               R"("componentType":5123,"normalized":true,"type":"VEC4")", problems),
        colors(raw<float>({1, 0, 0.2f, 1, 0, 0, 0, 0.4f, 0, 0, 0, 0, 1, 1, 1, 1}),
               R"("componentType":5126,"type":"VEC4")", problems)};
    EXPECT_TRUE(problems.empty());
    for (const Model& model : models) {
        const Representation& finest = model.objects[0].representations[0];
        ASSERT_EQ(finest.mesh().colors.size(), 4u);
        EXPECT_EQ(finest.mesh().colors[0], glm::vec4(1, 0, 0.2f, 1));
        EXPECT_EQ(finest.mesh().colors[1], glm::vec4(0, 0, 0, 0.4f));
        EXPECT_TRUE(model.materials[finest.materials[0]].vertex_colors);
        const Representation& plain = model.objects[1].representations[0];
        EXPECT_TRUE(plain.mesh().colors.empty());
        EXPECT_FALSE(model.materials[plain.materials[0]].vertex_colors);
        const Material& standard =
            model.materials[model.objects[2].representations[0].materials[0]];
        EXPECT_TRUE(standard.vertex_colors);
        EXPECT_EQ(standard.base_color, glm::dvec3(1.0));
    }
    const Model three = colors(raw<float>({1, 0, 0.2f, 0, 0, 0, 0, 0, 0, 1, 1, 1}),
                               R"("componentType":5126,"type":"VEC3")", problems);
    EXPECT_EQ(three.objects[0].representations[0].mesh().colors[3], glm::vec4(1, 1, 1, 1));
    colors(raw<float>({1, 0, 0.2f, 0}), R"("componentType":5126,"type":"SCALAR")", problems);
    EXPECT_TRUE(has(problems, "bad_primitive"));
}

TEST(GltfMaterial, PicturesComeFromDataViewsAndTheFolderOnly) {
    write_file(folder() / "a b.png", models::checker()->bytes);
    write_file(folder() / "inner" / "a b.png", models::checker()->bytes);
    write_file(folder() / "empty.png", "");
    write_file(folder() / "inner" / "empty.png", "");
    write_file(folder() / "inner" / "words.png", "these are words, not a picture");
    std::string huge = models::checker()->bytes;
    huge.replace(16, 8, std::string("\x7f\xff\xff\xff\x7f\xff\xff\xff", 8));  // its width, height
    write_file(folder() / "inner" / "huge.png", huge);
    const auto read_with = [](const std::string& uri) {
        write_file(folder() / "inner" / "scene.gltf",
                   with_material(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,1],
                                 "baseColorTexture":{"index":0}}})",
                                 uri));
        Problems problems;
        const Material m = read_model(folder() / "inner" / "scene.gltf", problems).materials[0];
        if (!m.base_color_texture) {
            EXPECT_EQ(m.base_color, glm::dvec3(0.5, 1, 1)) << uri;
            EXPECT_EQ(problems.size(), 1u) << uri;
            EXPECT_TRUE(has(problems, "texture_missing")) << uri;
        }
        return m.base_color_texture ? m.base_color_texture.picture->name : "";
    };
    EXPECT_EQ(read_with("a%20b.png"), "board");
    EXPECT_EQ(read_with("a b.png"), "board");
    EXPECT_EQ(read_with(data_uri(*models::checker())), "board");
    for (const std::string uri :
         {"../a%20b.png", "%2e%2e/a b.png", "nothing.png", "empty.png", "words.png", "huge.png",
          ".", "data:image/webp;base64,AAAA", "http://example.com/a.png", "/dev/zero"})
        EXPECT_EQ(read_with(uri), "") << uri;
    EXPECT_EQ(read_with((folder() / "a b.png").string()), "");
}

TEST(GltfMaterial, BrokenReferencesLeaveTheConstant) {
    const std::string good = with_material(
        R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,1],"baseColorTexture":{"index":0}}})",
        data_uri(*models::checker()));
    const std::vector<std::pair<std::string, std::string>> changes{
        {R"("baseColorTexture":{"index":0})", R"("baseColorTexture":{"index":7})"},
        {R"("source":0)", R"("source":-9)"},
        {R"("source":0)", R"("source":2147483647)"},
        {R"("source":0,)", ""},
        {R"("uri":"data:image/png)", R"("bufferView":1,"xri":"data:image/png)"},
    };
    for (const auto& [from, to] : changes) {
        std::string changed = good;
        ASSERT_NE(changed.find(from), std::string::npos) << from;
        changed.replace(changed.find(from), from.size(), to);
        Problems problems;
        const Material m = only_material(changed, problems);
        EXPECT_FALSE(m.base_color_texture) << to;
        EXPECT_EQ(m.base_color, glm::dvec3(0.5, 1, 1)) << to;
        EXPECT_TRUE(has(problems, "texture_missing")) << to;
    }
    // tinygltf refuses these files.
    for (const std::string view : {"77", "-3", "2147483647"}) {
        std::string changed = good;
        changed.replace(changed.find(R"("uri":"data:image/png)"), 6,
                        R"("bufferView":)" + view + R"(,"xri":)");
        EXPECT_NE(complaint(changed).find("bufferView"), std::string::npos) << view;
    }
    // Broken layouts are the usual one.
    for (const std::string words : {R"("rotation":"x")", R"("scale":[1])", R"("offset":[1,"a"])",
                                    R"("scale":[1e300,1e300])"}) {
        std::string changed = good;
        const std::string from = R"("baseColorTexture":{"index":0)";
        changed.insert(changed.find(from) + from.size(),
                       R"(,"extensions":{"KHR_texture_transform":{)" + words + "}}");
        const Material m = only_material(changed);
        for (const double x : m.base_color_texture.to_picture)
            EXPECT_TRUE(std::isfinite(x)) << words;
    }
}

TEST(GltfMaterial, WhatIsSimplifiedIsNamed) {
    const std::string picture = data_uri(*models::checker());
    Problems problems;
    Material m = only_material(
        with_material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}})",
                      picture),
        problems);
    EXPECT_FALSE(m.base_color_texture);
    expect_near(m.base_color, glm::dvec3(models::checker()->mean), 1e-12);
    EXPECT_TRUE(has(problems, "texture_averaged"));
    // The transform's texCoord goes before the texture's.
    m = only_material(with_material(
        R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1,
        "extensions":{"KHR_texture_transform":{"texCoord":0}}}}})",
        picture));
    EXPECT_TRUE(m.base_color_texture);
    problems.clear();
    std::string striped =
        with_material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})", picture);
    striped.replace(striped.find(R"("samplers":[{})"), 14, R"("samplers":[{"wrapT":33071})");
    EXPECT_EQ(only_material(striped, problems).base_color_texture.extension,
              TextureExtension::Repeat);
    EXPECT_TRUE(has(problems, "texture_simplified"));
    problems.clear();
    m = only_material(with_material(R"({"extensions":{"KHR_materials_transmission":{
        "transmissionFactor":1,"transmissionTexture":{"index":0}}}})",
                                    picture),
                      problems);
    EXPECT_GT(m.transmission, 0.2);
    EXPECT_LT(m.transmission, 0.8);
    EXPECT_TRUE(has(problems, "texture_averaged"));
}

TEST(GltfMaterial, PicturesShownTooOftenAreRefused) {
    image::Image image;
    image.width = image.height = 256;
    PcgRandom random(1);
    for (size_t i = 0; i < 4 * image.size(); ++i)
        image.pixels.push_back(static_cast<float>(random.uniform()));
    const std::string bytes = image::png_bytes(image);  // 256 KiB
    std::string images, views, textures, materials;
    for (int i = 0; i < 400; ++i) {
        const std::string comma = i > 0 ? "," : "";
        images += comma + text(R"({"bufferView":)", i + 2, R"(,"mimeType":"image/png"})");
        views += text(R"(,{"buffer":1,"byteLength":)", bytes.size(), "}");
        textures += comma + text(R"({"source":)", i, "}");
        materials +=
            comma + text(R"({"emissiveFactor":[1,1,1],"emissiveTexture":{"index":)", i,
                         R"(},"pbrMetallicRoughness":{"baseColorTexture":{"index":)", i, "}}}");
    }
    std::string file = gltf(R"("materials":[)" + materials + R"(],"textures":[)" + textures +
                            R"(],"images":[)" + images + "]," + kOneMesh + kOneNode);
    file.insert(file.find(R"(}],"bufferViews")"),
                R"(},{"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
                    R"(","byteLength":)" + text(bytes.size()));
    file.insert(file.find(R"(],"accessors")"), views);
    Problems problems;
    const Model model = read(file, problems);
    EXPECT_TRUE(model.materials[0].base_color_texture);
    EXPECT_FALSE(model.materials[399].base_color_texture);
    EXPECT_TRUE(has(problems, "texture_missing"));
}

TEST(GltfMaterial, RealPartsKeepTheirPalette) {
    const std::filesystem::path file = hostile::data("scenes/kaykit-city-bits/bench.gltf");
    if (file.empty())
        GTEST_SKIP() << "no real data";
    Problems problems;
    const Model model = read_model(file, problems);
    EXPECT_TRUE(problems.empty());
    const Texture& texture = model.materials[0].base_color_texture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture.picture->width, 1024);
    EXPECT_EQ(texture.picture->name, "citybits_texture");
}

}  // namespace
}  // namespace lodestone::format
