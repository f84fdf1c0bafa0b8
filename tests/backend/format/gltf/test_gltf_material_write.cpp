// SPDX-License-Identifier: GPL-3.0-or-later
// Guards materials in our own glTF files: they come back bit for bit, strangers see the same
// surface, pictures are there once.
#include "base/error.h"
#include "format/model_file.h"
#include "scenes/damaged_files.h"
#include "scenes/gltf_textured.h"
#include "scratch.h"
#include "simplify/simplify.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lodestone::format {
namespace {

using namespace gltf_text;
using image::TextureSampler;

std::filesystem::path folder() {
    std::filesystem::path path = own_scratch();
    std::filesystem::create_directories(path);
    return path;
}

/// Everything a material can say, at random.
Material any_material(PcgRandom& random, int depth = 0) {
    static const std::vector<PicturePtr> kPictures{
        many_texels(4, 4, ColorSpace::Srgb),       many_texels(4, 4, ColorSpace::Srgb, true),
        many_texels(4, 4, ColorSpace::Linear),     many_texels(6, 3, ColorSpace::Linear, true),
        many_texels(8, 8, ColorSpace::Srgb, true), many_texels(8, 8, ColorSpace::Linear)};
    const auto below = [&](int count) { return static_cast<int>(random.uniform() * count); };
    const auto some = [&](double usual) { return below(2) == 0 ? usual : random.uniform(); };
    Texture last;
    const auto texture = [&] {
        Texture out;
        if (below(3) != 0)
            return out;
        if (last && below(2) == 0) {  // the same layout, another channel
            out = last;
        } else {
            out.picture = kPictures[static_cast<size_t>(below(6))];
            out.extension = static_cast<TextureExtension>(below(4));
            out.interpolation = static_cast<TextureInterpolation>(below(2));
            if (below(2) == 0)
                out.to_picture = {random.uniform(), 0, random.uniform(), 0, -random.uniform(), 1};
            if (below(4) == 0)
                out.to_picture = {random.uniform(), 0.3, 0, 0.1, random.uniform(), 0.1};  // shears
        }
        out.channel = static_cast<TextureChannel>(below(6));
        if (below(2) == 0)
            out.scale = {random.uniform(), 2 * random.uniform(), random.uniform()};
        if (below(3) == 0)
            out.offset = glm::dvec3(random.uniform());
        last = out;
        return out;
    };
    Material m;
    m.base_color = {random.uniform(), random.uniform(), some(0)};
    m.emission = {some(0), 0, 4 * some(0)};
    m.roughness = some(0.5);
    m.metallic = some(0);
    m.specular = some(0.5);
    m.alpha = some(1);
    m.alpha_mode = static_cast<AlphaMode>(below(3));
    m.alpha_cutoff = some(0.5);
    m.transmission = some(0);
    m.ior = some(1.45) + 1;
    m.clearcoat = some(0);
    m.clearcoat_roughness = some(0.03);
    m.normal_strength = some(1);
    m.bump_distance = some(0) - 0.5;
    m.vertex_colors = below(2) == 0;
    for (Texture Material::*field :
         {&Material::base_color_texture, &Material::alpha_texture, &Material::roughness_texture,
          &Material::metallic_texture, &Material::emission_texture, &Material::normal_texture,
          &Material::bump_texture})
        m.*field = texture();
    if (below(3) == 0 && depth < 3) {
        m.other = std::make_shared<Material>(any_material(random, depth + 1));
        m.mix = random.uniform();
        m.mix_texture = texture();
    }
    return m;
}

TEST(GltfMaterialWritten, EveryMaterialComesBackBitForBit) {
    EXPECT_EQ(hash_of(back_of(write_glb(model_of(Material{})))), hash_of(Material{}));
    for (uint64_t seed = 0; seed < 200; ++seed) {
        PcgRandom random(seed, 11);
        const Material m = any_material(random);
        const std::string glb = write_glb(model_of(m));
        EXPECT_EQ(hash_of(back_of(glb)), hash_of(m)) << seed;
        EXPECT_EQ(hash_of(back_of(write_glb(model_of(m, false)))), hash_of(m)) << seed;
    }
}

TEST(GltfMaterialWritten, NearDefaultsAndExrPicturesComeBackToo) {
    Material m;
    m.metallic = 1 - 1e-13;
    m.roughness = 1 - 1e-15;
    m.base_color = {1 - 1e-13, 1, 1};
    m.emission = {1e-14, 0, -0.0};
    m.alpha_mode = AlphaMode::Clip;
    m.alpha_cutoff = 0.5 + 1e-14;
    m.normal_strength = 1 + 1e-14;
    m.normal_texture.picture = many_texels(4, 4, ColorSpace::Linear);
    EXPECT_EQ(hash_of(back_of(write_glb(model_of(m)))), hash_of(m));
    auto exr = std::make_shared<Picture>(*many_texels(4, 4, ColorSpace::Linear));
    exr->format = PictureFormat::Exr;  // glTF cannot hold it as an image, whatever is in it
    m.emission_texture.picture = exr;
    m.emission_texture.scale = glm::dvec3(3.0);
    const std::string glb = write_glb(model_of(m));
    EXPECT_EQ(hash_of(back_of(glb)), hash_of(m));
}

TEST(GltfMaterialWritten, StrangersSeeTheSameSurface) {
    const auto compare = [](const Texture& ours, const glm::dvec3& our_color, const Texture& theirs,
                            const glm::dvec3& their_color, const glm::dvec3& limit) {
        const TextureSampler a(ours, our_color);
        const TextureSampler b(theirs, their_color);
        PcgRandom random(5);
        for (int i = 0; i < 40; ++i) {
            const glm::dvec2 uv(4 * random.uniform() - 2, 4 * random.uniform() - 2);
            const glm::dvec3 wanted = glm::min(a.color(uv), limit);
            expect_near(b.color(uv), wanted, 0.012);  // 8 bits of sRGB, in linear light
        }
    };
    const PicturePtr srgb = many_texels(6, 4, ColorSpace::Srgb);
    const PicturePtr linear = many_texels(6, 4, ColorSpace::Linear);
    for (int round = 0; round < 24; ++round) {
        Texture texture;
        texture.picture = round % 2 == 0 ? srgb : linear;
        texture.channel = static_cast<TextureChannel>(round % 6);
        texture.extension = static_cast<TextureExtension>(round % 4);
        texture.interpolation = TextureInterpolation::Closest;
        const double c = std::cos(0.1 * round), s = std::sin(0.1 * round);
        texture.to_picture = {1.5 * c, -0.7 * s, 0.2, 1.5 * s, 0.7 * c, -0.1};
        if (round % 3 != 0) {
            texture.scale = {0.5, 1.25, 0.75};
            texture.offset = glm::dvec3(0.125);
        }
        Material m;
        m.base_color_texture = m.emission_texture = texture;
        m.emission_texture.scale *= 3.0;
        m.normal_texture = texture;
        m.roughness_texture = texture;
        m.roughness_texture.scale = glm::dvec3(0.5);
        const Material seen = back_of(for_strangers(write_glb(model_of(m))));
        ASSERT_TRUE(seen.base_color_texture && seen.emission_texture && seen.normal_texture &&
                    seen.roughness_texture)
            << round;
        EXPECT_FALSE(seen.metallic_texture && seen.metallic > 0) << round;
        compare(m.base_color_texture, {}, seen.base_color_texture, {}, glm::dvec3(1.0));
        compare(m.normal_texture, {}, seen.normal_texture, {}, glm::dvec3(1.0));
        const TextureSampler ours(m.roughness_texture, {});
        const TextureSampler theirs(seen.roughness_texture, {});
        const TextureSampler our_glow(m.emission_texture, {});
        const TextureSampler their_glow(seen.emission_texture, {});
        PcgRandom random(9);
        for (int i = 0; i < 40; ++i) {
            const glm::dvec2 uv(2 * random.uniform(), 2 * random.uniform());
            EXPECT_NEAR(theirs.number(uv), std::min(ours.number(uv), 1.0), 0.004) << round;
            expect_near(their_glow.color(uv), our_glow.color(uv), 0.05);  // up to 8
        }
    }
}

TEST(GltfMaterialWritten, LevelsMadeBrighterHadNoPictureForStrangers) {
    Material m;
    m.base_color_texture.picture = many_texels(4, 4, ColorSpace::Srgb);
    const Mesh mesh = model_of(m).objects[0].representations[0].mesh();
    const auto written = [&](const glm::dvec3& scale) {
        m.base_color_texture.scale = scale;
        return write_glb_mesh(mesh, std::vector<Material>{m}, "level");
    };
    for (const glm::dvec3& scale : {glm::dvec3(0.5, 0.25, 1), glm::dvec3(0.5, 0.25, 1.25)}) {
        const std::string glb = written(scale);
        EXPECT_NE(glb.find("\"baseColorTexture\""), std::string::npos) << scale.z;
        EXPECT_NE(glb.find("\"baseColorFactor\":[0.5,0.25,1.0,1.0]"), std::string::npos) << scale.z;
    }
}

TEST(GltfMaterialWritten, StrangersSeeTheHolesOfOtherPictures) {
    Material m;
    m.base_color_texture.picture = many_texels(4, 4, ColorSpace::Srgb);
    m.alpha_texture.picture = many_texels(8, 4, ColorSpace::Linear);
    m.alpha_texture.channel = TextureChannel::Red;
    m.base_color_texture.interpolation = m.alpha_texture.interpolation =
        TextureInterpolation::Closest;
    m.alpha_mode = AlphaMode::Clip;
    m.alpha_cutoff = 0.25;
    const Material seen = back_of(for_strangers(write_glb(model_of(m))));
    EXPECT_EQ(seen.alpha_mode, AlphaMode::Clip);
    EXPECT_EQ(seen.alpha_cutoff, 0.25);
    ASSERT_TRUE(seen.alpha_texture && seen.base_color_texture);
    const TextureSampler ours(m.alpha_texture, {}), theirs(seen.alpha_texture, {});
    const TextureSampler our_color(m.base_color_texture, {}),
        their_color(seen.base_color_texture, {});
    for (double u = 0.01; u < 1; u += 0.03) {
        EXPECT_NEAR(theirs.number({u, 0.3}), ours.number({u, 0.3}), 0.003);
        expect_near(their_color.color({u, 0.3}), our_color.color({u, 0.3}), 0.003);
    }
}

size_t count_of(const std::string& bytes, const std::string& words) {
    size_t count = 0;
    for (size_t at = bytes.find(words); at != std::string::npos; at = bytes.find(words, at + 1))
        ++count;
    return count;
}

TEST(GltfMaterialWritten, PicturesAreInTheFileOnce) {
    const PicturePtr srgb = many_texels(64, 64, ColorSpace::Srgb);
    const PicturePtr linear = image::make_picture(srgb->bytes, ColorSpace::Linear, "the same");
    Model model = model_of(Material{});
    for (int i = 0; i < 10; ++i) {
        Material m;
        m.base_color_texture.picture = srgb;
        m.roughness_texture.picture = m.metallic_texture.picture = linear;
        m.roughness_texture.channel = TextureChannel::Green;
        m.metallic_texture.channel = TextureChannel::Blue;
        m.bump_texture.picture = linear;
        m.roughness = i / 10.0;
        Mesh mesh = shapes::quad(1, 1);
        mesh.uvs.resize(4);
        models::add_leaf(model, text("quad ", i), mesh, m);
    }
    std::vector<Placement> placements;
    for (ObjectIndex i = 1; i <= 10; ++i)
        placements.push_back({i, Affine{}, ""});
    model.root = models::add_group(model, "all", placements);
    const std::string glb = write_glb(model);
    EXPECT_EQ(count_of(glb, srgb->bytes), 1u);
    EXPECT_LT(glb.size(), srgb->bytes.size() + 12000);
    EXPECT_EQ(count_of(glb, "\"mimeType\""), 1u);
}

TEST(GltfMaterialWritten, EditedFilesAreBelievedNotOurExtras) {
    Material m;
    m.base_color = {0.25, 0.5, 0.75};
    m.bump_texture.picture = models::checker();
    m.bump_distance = 0.5;
    std::string glb = write_glb(model_of(m));
    EXPECT_EQ(hash_of(back_of(glb)), hash_of(m));
    const std::string factor = "[0.25,0.5,0.75,1.0]";
    ASSERT_NE(glb.find(factor), std::string::npos);
    glb.replace(glb.find(factor), factor.size(), "[0.75,0.5,0.25,1.0]");
    const Material edited = back_of(glb);
    EXPECT_EQ(edited.base_color, glm::dvec3(0.75, 0.5, 0.25));
    EXPECT_FALSE(edited.bump_texture);
}

TEST(GltfMaterialWritten, UnusedVertexColorsAreHiddenFromStrangers) {
    Model model;
    Mesh mesh = shapes::quad(1, 1);
    mesh.colors.assign(4, glm::vec4(1, 0, 0, 1));
    mesh.slots = {0, 1};
    model.root = models::add_leaf(model, "quad", mesh);
    Material colored;
    colored.vertex_colors = true;
    model.materials.push_back(colored);
    model.objects[0].representations[0].materials = {0, 1};
    summarize(model.objects[0].representations[0], model);
    const std::string glb = write_glb(model);
    Problems problems;
    const Model back = read(glb, problems);
    const Representation& finest = back.objects[0].representations[0];
    EXPECT_EQ(hash_of(finest.mesh()), hash_of(mesh));
    EXPECT_FALSE(back.materials[finest.materials[0]].vertex_colors);
    EXPECT_TRUE(back.materials[finest.materials[1]].vertex_colors);
    EXPECT_EQ(count_of(glb, "\"COLOR_0\""), 1u);
    const Model stranger = read(for_strangers(glb), problems);
    const Mesh& seen = stranger.objects[0].representations[0].mesh();
    for (size_t i = 0; i < seen.triangles.size(); ++i)
        EXPECT_EQ(seen.colors[seen.triangles[i].x],
                  seen.slot(i) == 0 ? glm::vec4(1.0f) : glm::vec4(1, 0, 0, 1));
}

TEST(GltfMaterialWritten, StoredMeshesNameTheStoresPictures) {
    Material m;
    m.base_color_texture.picture = models::checker();
    m.emission_texture.picture = models::checker();
    m.emission_texture.channel = TextureChannel::Luma;  // glTF cannot say it
    Mesh mesh = shapes::quad(1, 1);
    const std::string bare = write_glb_mesh(mesh, {&m, 1}, "quad");
    EXPECT_EQ(bare.find("\"images\""), std::string::npos);  // no uvs: nothing to show it by
    mesh.uvs.resize(4);
    const std::string glb = write_glb_mesh(mesh, {&m, 1}, "quad");
    EXPECT_NE(glb.find("\"uri\":\"../i/" + file_name(*models::checker()) + "\""),
              std::string::npos);
    EXPECT_EQ(count_of(glb, "\"texCoord\"") + count_of(glb, "\"emissiveTexture\""), 0u);
    EXPECT_EQ(glb.find(models::checker()->bytes), std::string::npos);
    EXPECT_EQ(hash_of(read_glb_mesh(glb)), hash_of(mesh));
    auto gone = std::make_shared<Picture>(*models::checker());
    gone->bytes.clear();  // not resident: the name is enough
    m.base_color_texture.picture = gone;
    m.emission_texture = Texture{};
    EXPECT_NE(write_glb_mesh(mesh, {&m, 1}, "quad").find("../i/"), std::string::npos);
}

TEST(GltfMaterialWritten, SimplifiedModelsKeepTheirPictures) {
    const PicturePtr picture = many_texels(16, 16, ColorSpace::Srgb);
    Material m;
    m.base_color_texture.picture = picture;
    Mesh ball = shapes::sphere(1, 4);
    for (const glm::vec3& p : ball.positions)
        ball.uvs.emplace_back(0.5f + 0.5f * p.x, 0.5f + 0.5f * p.y);
    Model model;
    model.root = models::add_leaf(model, "ball", ball, m);
    write_model(folder() / "ball.glb", model);
    Problems problems;
    Model read_back = read_model(folder() / "ball.glb", problems);
    Representation& finest = read_back.objects[0].representations[0];
    finest.payload = std::make_shared<const Mesh>(simplify::simplify_mesh(finest.mesh(), 200));
    summarize(finest, read_back);
    write_model(folder() / "small.glb", read_back);
    const Model small = read_model(folder() / "small.glb", problems);
    EXPECT_TRUE(problems.empty());
    const Representation& level = small.objects[0].representations[0];
    EXPECT_LE(level.mesh().triangles.size(), 200u);
    EXPECT_EQ(hash_of(small.materials[level.materials[0]]), hash_of(m));
    ASSERT_EQ(level.mesh().uvs.size(), level.mesh().positions.size());
    double worst = 0;
    for (size_t i = 0; i < level.mesh().uvs.size(); ++i) {
        const glm::vec3& p = level.mesh().positions[i];
        worst = std::max(
            worst, static_cast<double>(glm::distance(
                       level.mesh().uvs[i], glm::vec2(0.5f + 0.5f * p.x, 0.5f + 0.5f * p.y))));
    }
    EXPECT_LT(worst, 0.03);  // half a texel
}

TEST(GltfMaterialWritten, DamagedTexturedFilesNeverCrash) {
    PcgRandom random(4, 11);
    Material m = any_material(random);
    m.base_color_texture.picture = models::checker();
    m.other = std::make_shared<Material>(m);
    m.mix_texture = m.bump_texture = m.base_color_texture;
    const std::string ours = write_glb(model_of(m));
    const auto read_it = [](const std::string& bytes) {
        Problems problems;
        const Model model = read_glb(bytes, {}, "damaged", problems);
        bottom_up(model);
        for (const Material& material : model.materials) {
            EXPECT_TRUE(std::isfinite(material.base_color.x));
            for_each_texture(material, [](const Texture& texture) {
                EXPECT_TRUE(std::isfinite(TextureSampler(texture, {}).color({0.3, 0.4}).x));
            });
        }
        write_glb(model);
    };
    EXPECT_GT(hostile::survive(ours, 400, read_it), 20);
    hostile::survive(
        with_material(R"({"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorTexture":{"index":0,
                      "extensions":{"KHR_texture_transform":{"scale":[2,2],"offset":[0,1]}}}},
                      "normalTexture":{"index":0,"scale":2},"extensions":{"KHR_materials_specular":
                      {"specularColorFactor":[1,1,1],"specularTexture":{"index":0}}}})",
                      data_uri(*models::checker())),
        400, read_it);
}

}  // namespace
}  // namespace lodestone::format
