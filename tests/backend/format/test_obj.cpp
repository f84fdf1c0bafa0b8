// SPDX-License-Identifier: GPL-3.0-or-later
// Guards OBJ and MTL: what real exporters write, exact round trips, files that lead elsewhere.
#include "base/error.h"
#include "base/files.h"
#include "format/model_file.h"
#include "format/obj/mtl.h"
#include "format/obj/obj.h"
#include "image/texture_sampler.h"
#include "scenes/damaged_files.h"
#include "scenes/small_meshes.h"
#include "scenes/small_models.h"
#include "scratch.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace lodestone::format {
namespace {

const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::filesystem::path folder() {
    std::filesystem::path path = own_scratch();
    std::filesystem::create_directories(path / "inner");
    return path;
}

Model read(const std::string& bytes, Problems& problems) {
    return read_obj(bytes, folder() / "thing.obj", problems);
}

const Mesh& only_mesh(const Model& model) {
    EXPECT_EQ(model.objects.size(), 1u);
    return model.objects.at(model.root).representations.at(0).mesh();
}

bool has(const Problems& problems, const std::string& code) {
    for (const Problem& problem : problems) {
        if (problem.code == code)
            return true;
    }
    return false;
}

TEST(Obj, EmptyFileIsAnEmptyModelWithAProblem) {
    Problems problems;
    const Model model = read("", problems);
    EXPECT_EQ(totals(model).occurrences, 0u);
    EXPECT_TRUE(has(problems, "no_faces"));
}

TEST(Obj, PolygonsNegativeIndicesAndContinuedLines) {
    Problems problems;
    const Model model = read(kPoints + "f -4 -3 \\\r\n-2 4\r\n", problems);
    EXPECT_TRUE(problems.empty());
    EXPECT_EQ(only_mesh(model).triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(model.objects[0].name, "thing");
    EXPECT_EQ(totals(model).triangles_placed, 2u);
}

TEST(Obj, SeamsSplitVertices) {
    Problems problems;
    const Model model = read(kPoints +
                                 "vt 0 0\nvt .5 1\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n"
                                 "f 1/2/1 3/1/1 4//1\n",
                             problems);
    EXPECT_TRUE(problems.empty());
    const Mesh& mesh = only_mesh(model);
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 2, 4}}));
    EXPECT_EQ(mesh.uvs[3], glm::vec2(0.5f, 1));
    EXPECT_EQ(mesh.uvs[4], glm::vec2(0, 0));
    EXPECT_EQ(mesh.normals[4], glm::vec3(0, 0, 1));
}

TEST(Obj, EveryObjectLineStartsAnObject) {
    Problems problems;
    const Model model =
        read("o First\n" + kPoints + "f 1 2 3\no Empty\no Second thing\nf 1 3 4\n", problems);
    EXPECT_TRUE(problems.empty());
    ASSERT_EQ(model.objects.size(), 3u);
    EXPECT_EQ(model.objects[0].name, "First");
    EXPECT_EQ(model.objects[1].name, "Second thing");
    EXPECT_EQ(model.objects[1].representations[0].mesh().positions.size(), 3u);
    EXPECT_EQ(totals(model).occurrences, 2u);
    EXPECT_TRUE(model.objects[model.root].group());
}

TEST(Obj, MaterialsComeFromTheLibraryBesideTheFile) {
    write_file(folder() / "my paints.mtl",
               "newmtl red\nKd 1 0.25 0\nKe 2 0 0\nPr 0.25\nPm 1\nNs 300\nnewmtl wood\nKd 0 0 0\n"
               "map_Kd -s 2 2 1 inner\\board.png\n");
    image::Image board;
    board.width = 2;
    board.height = 1;
    board.pixels = {1, 1, 1, 1, 0, 0, 0, 1};
    image::write_png(folder() / "inner" / "board.png", board);
    Problems problems;
    const Model model = read("mtllib my paints.mtl\n" + kPoints +
                                 "usemtl red\nf 1 2 3\nusemtl wood\nf 1 3 4\nusemtl lost\nf 1 2 4\n"
                                 "usemtl red\nf 2 3 4\n",
                             problems);
    const Representation& finest = model.objects[0].representations[0];
    EXPECT_EQ(finest.mesh().slots, (std::vector<uint16_t>{0, 1, 2, 0}));
    const Material& red = model.materials[finest.materials[0]];
    EXPECT_EQ(red.name, "red");
    EXPECT_EQ(red.base_color, glm::dvec3(1, 0.25, 0));
    EXPECT_EQ(red.emission, glm::dvec3(2, 0, 0));
    EXPECT_EQ(red.roughness, 0.25);
    EXPECT_EQ(red.metallic, 1);
    const Material& wood = model.materials[finest.materials[1]];
    EXPECT_NEAR(wood.base_color.x, 0.5, 1e-6);
    ASSERT_TRUE(wood.base_color_texture);
    EXPECT_EQ(wood.base_color_texture.to_picture, (std::array<double, 6>{2, 0, 0, 0, 2, 0}));
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_TRUE(has(problems, "material_missing"));  // lost
}

/// The materials of an MTL text.
std::vector<Material> library(const std::string& text, Problems& problems) {
    return read_mtl(text, folder(), "thing", problems);
}

std::string written(const image::Image& image, const std::string& name) {
    image::write_png(folder() / name, image);
    return name;
}

image::Image two_texels(std::vector<float> pixels) {
    image::Image image;
    image.width = 2;
    image.height = 1;
    image.pixels = std::move(pixels);
    return image;
}

TEST(Obj, MapsHaveOptionsChannelsAndKinds) {
    written(two_texels({1, 1, 1, 1, 0.5f, 0, 0, 0.5f}), "leaf.png");
    written(two_texels({0.5f, 0.5f, 1, 1, 0.4f, 0.6f, 0.95f, 1}), "normals.png");
    written(two_texels({0.2f, 0.2f, 0.2f, 1, 0.8f, 0.8f, 0.8f, 1}), "my 2 heights.png");
    Problems problems;
    const std::vector<Material> m = library(
        "newmtl leaf\nmap_Kd leaf.png\nmap_d -imfchan m leaf.png\nd 0.5\n"
        "newmtl rough\nmap_Pr -clamp on -mm 0.25 0.5 -o 0.5 my 2 heights.png\n"
        "map_Pm -imfchan r -blendu on -t 1 2 3 leaf.png\nKe 2 2 2\nmap_Ke leaf.png\n"
        "newmtl bumpy\nmap_Bump -bm 0.5 my 2 heights.png\n"
        "newmtl turned\nbump -bm 2 normals.png\n"
        "newmtl named\nnorm my 2 heights.png\n"
        "newmtl mask\nmap_d leaf.png\n",
        problems);
    ASSERT_EQ(m.size(), 6u);
    EXPECT_EQ(m[0].alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(m[0].alpha_texture.channel, TextureChannel::Alpha);
    EXPECT_NEAR(m[0].alpha, 0.5 * 0.75, 0.01);
    EXPECT_EQ(m[1].roughness_texture.extension, TextureExtension::Extend);
    EXPECT_EQ(m[1].roughness_texture.channel, TextureChannel::Luma);
    EXPECT_EQ(m[1].roughness_texture.to_picture[2], 0.5);
    EXPECT_NEAR(m[1].roughness, 0.25 + 0.5 * 0.5, 0.01);
    EXPECT_EQ(m[1].metallic_texture.channel, TextureChannel::Red);
    EXPECT_EQ(m[1].emission_texture.scale, glm::dvec3(2.0));
    EXPECT_TRUE(m[2].bump_texture);
    EXPECT_DOUBLE_EQ(m[2].bump_distance, 0.005);
    EXPECT_TRUE(m[3].normal_texture);
    EXPECT_FALSE(m[3].bump_texture);
    EXPECT_EQ(m[3].normal_strength, 2);
    EXPECT_TRUE(m[4].normal_texture);
    EXPECT_EQ(m[5].alpha_texture.channel, TextureChannel::Alpha);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "bump_height_guessed");
}

TEST(Obj, DissolveIsAlphaUnlessTheLightIsRefracted) {
    Problems problems;
    const std::vector<Material> m = library(
        "newmtl thin\nKd 1 0 0\nd 0.25\nillum 9\nnewmtl inverse\nTr 0.75\n"
        "newmtl glass\nKd 0 0 0\nd 0.25\nNi 1.5\nillum 4\n"
        "newmtl filter\nKd 0 0 0\nillum 7\nNi 1.33\nTf 0.5 1 0.75\n"
        "newmtl solid\nKd 0.5 0 0\nillum 7\nNi 1.5\nTf oops\n",
        problems);
    ASSERT_EQ(m.size(), 5u);
    EXPECT_EQ(m[0].alpha, 0.25);
    EXPECT_EQ(m[0].alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(m[0].transmission, 0);
    EXPECT_EQ(m[1].alpha, 0.25);
    EXPECT_EQ(m[2].transmission, 0.75);
    EXPECT_EQ(m[2].alpha, 1);
    EXPECT_EQ(m[2].ior, 1.5);
    EXPECT_EQ(m[2].base_color, glm::dvec3(1.0));
    EXPECT_EQ(m[3].transmission, 0.75);
    EXPECT_EQ(m[3].base_color, glm::dvec3(0.5, 1, 0.75));
    EXPECT_EQ(m[4].transmission, 0);
    EXPECT_EQ(m[4].base_color.x, 0.5);
    EXPECT_TRUE(problems.empty());
}

TEST(Obj, TexturedMaterialsAreWrittenWithTheirPictures) {
    image::Image image;
    image.width = image.height = 2;
    image.pixels = {0.1f, 0.2f, 0.3f, 1, 0.9f, 0.2f, 0.6f, 1, 0, 1, 0, 0.5f, 1, 1, 0, 0};
    const PicturePtr picture =
        image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "../../evil");
    Material m;
    m.base_color_texture.picture = picture;
    m.base_color_texture.to_picture = {2, 0, 0.5, 0, 3, 0.25};
    m.base_color_texture.interpolation = TextureInterpolation::Closest;
    m.alpha_texture = m.base_color_texture;
    m.alpha_texture.channel = TextureChannel::Alpha;
    m.alpha_mode = AlphaMode::Blend;
    m.emission_texture = m.base_color_texture;
    m.emission_texture.scale = glm::dvec3(3, 1, 0.5);
    m.roughness_texture = m.base_color_texture;
    m.roughness_texture.channel = TextureChannel::Blue;
    m.clearcoat = 0.5;
    m.normal_texture = m.base_color_texture;
    m.normal_texture.to_picture[1] = 1;  // sheared: MTL has no word for it
    Model model;
    Object object;
    object.representations.emplace_back();
    Mesh mesh = shapes::quad(1, 1);
    mesh.uvs.resize(4);
    object.representations[0].payload = std::make_shared<const Mesh>(mesh);
    object.representations[0].materials = {0};
    model.materials = {m};
    model.objects.push_back(object);
    model.root = 0;
    const std::filesystem::path place = folder() / "written";
    std::filesystem::create_directories(place);
    write_model(place / "quad.obj", model);
    EXPECT_TRUE(std::filesystem::exists(place / file_name(*picture)));
    Problems problems;
    const Model back = read_model(place / "quad.obj", problems);
    EXPECT_TRUE(problems.empty());
    const Material& seen = back.materials[back.objects[0].representations[0].materials[0]];
    EXPECT_EQ(seen.base_color_texture.picture->hash, picture->hash);  // as it is, not drawn anew
    EXPECT_EQ(seen.clearcoat, 0.5);
    EXPECT_EQ(seen.alpha_mode, AlphaMode::Blend);
    EXPECT_FALSE(seen.normal_texture);
    const auto texels = [](Texture texture) {
        texture.interpolation = TextureInterpolation::Closest;  // MTL cannot say it
        std::vector<glm::dvec4> out;
        const image::TextureSampler sampler(texture, {});
        for (int i = 0; i < 30; ++i) {
            const glm::dvec2 uv(0.13 * i, 0.071 * i);
            out.emplace_back(sampler.color(uv), sampler.number(uv));
        }
        return out;
    };
    const auto compare = [&](const Texture& ours, const Texture& theirs, bool color) {
        ASSERT_TRUE(theirs);
        const auto a = texels(ours), b = texels(theirs);
        for (size_t i = 0; i < a.size(); ++i) {
            for (int c = color ? 0 : 3; c < (color ? 3 : 4); ++c)
                EXPECT_NEAR(a[i][c], b[i][c], 0.02) << i;
        }
    };
    compare(m.base_color_texture, seen.base_color_texture, true);
    compare(m.emission_texture, seen.emission_texture, true);
    compare(m.alpha_texture, seen.alpha_texture, false);
    compare(m.roughness_texture, seen.roughness_texture, false);
    EXPECT_GT(seen.emission.x, 1.0);
}

TEST(Obj, BrokenPicturesAreNamedAndTheColorStays) {
    write_file(folder() / "words.png", "no picture");
    write_file(folder() / "inner" / "hidden.png", "no picture");
    for (const std::string file :
         {"words.png", "nothing.png", "../obj/words.png", "/dev/zero", "-s 1", "", "."}) {
        Problems problems;
        const std::vector<Material> m =
            library("newmtl a\nKd 1 0 0\nmap_Kd " + file + "\n", problems);
        EXPECT_EQ(m[0].base_color, glm::dvec3(1, 0, 0)) << file;
        ASSERT_EQ(problems.size(), 1u) << file;
        EXPECT_EQ(problems[0].code, "texture_missing");
    }
}

TEST(Obj, NothingOutsideTheFolderIsOpened) {
    write_file(folder() / "secret.mtl", "newmtl red\nKd 1 0 0\n");
    std::error_code ignored;
    std::filesystem::remove(folder() / "inner" / "link.mtl", ignored);
    std::filesystem::create_symlink(folder() / "secret.mtl", folder() / "inner" / "link.mtl");
    for (const std::string& name :
         {std::string("../secret.mtl"), (folder() / "secret.mtl").string(),
          std::string("..\\secret.mtl"), std::string("./../secret.mtl"), std::string("link.mtl"),
          std::string("."), std::string("nothing.mtl")}) {
        Problems problems;
        const Model model = read_obj(text("mtllib ", name, "\n", kPoints, "usemtl red\nf 1 2 3\n"),
                                     folder() / "inner" / "thing.obj", problems);
        EXPECT_TRUE(has(problems, "material_library_missing")) << name;
        const uint32_t material = model.objects[0].representations[0].materials[0];
        EXPECT_EQ(model.materials[material].base_color, glm::dvec3(0.8)) << name;
    }
}

TEST(Obj, NamesNeverBecomeLines) {
    const std::string evil = "x\r\nmtllib ../secret.mtl\nusemtl y\\";
    std::vector<Material> materials(1);
    materials[0].name = evil;
    const std::string written = write_obj(shapes::cube(), materials, evil, evil);
    for (const char* line : {"\nmtllib ../", "\nusemtl y", "\r", "\\\n"})
        EXPECT_EQ(written.find(line), std::string::npos) << line;
}

TEST(Obj, AMaterialLibraryIsFoundAgainWhateverItsModelIsCalled) {
    Model model = models::row_of_balls(2);
    model.materials[0].base_color = {0.25, 0.5, 1};
    for (const char* name : {" leading.obj", "two\nlines.obj", "back\\slash.obj", "a #b.obj"}) {
        write_model(folder() / name, model);
        Problems problems;
        const Model back = read_model(folder() / name, problems);
        EXPECT_TRUE(problems.empty()) << name << ": " << problems[0].message;
        EXPECT_NEAR(back.materials.back().base_color.y, 0.5, 1e-6) << name;
    }
}

TEST(Obj, ThousandsOfMaterialsOfOneNameAreNamedAtOnce) {
    std::vector<Material> materials(20'000);
    for (Material& material : materials)
        material.name = "same";
    const std::vector<std::string> names = mtl_names(materials);
    EXPECT_EQ(names.front(), "same");
    EXPECT_EQ(names.back(), "same_20000");
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Obj, RoundTripIsExactInOrderAndBits) {
    Mesh mesh = shapes::sphere(0.37, 2);
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.uvs.emplace_back(mesh.positions[i].x / 3, 1e-30f * static_cast<float>(i));
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.slots.push_back(static_cast<uint16_t>(i % 2));
    std::vector<Material> materials(2);
    materials[0].name = "two words";
    materials[1].name = "two words";
    materials[1].base_color = {0.1f, 0.2f, 0.3f};
    Problems problems;
    write_file(folder() / "round.mtl", write_mtl(materials).text);
    const Model model = read(write_obj(mesh, materials, "ball", "round.mtl"), problems);
    EXPECT_TRUE(problems.empty());
    EXPECT_EQ(hash_of(only_mesh(model)), hash_of(mesh));
    const Representation& finest = model.objects[0].representations[0];
    EXPECT_EQ(hash_of(model.materials[finest.materials[1]]), hash_of(materials[1]));
}

TEST(Obj, WriteModelFlattensAllOccurrences) {
    Model model;
    model.materials.resize(2);
    model.materials[1].base_color = {1, 0, 0};
    for (const uint32_t material : {0u, 1u}) {
        Object object;
        object.name = "cube";
        object.representations.emplace_back();
        object.representations[0].materials = {material};
        object.representations[0].payload = std::make_shared<const Mesh>(shapes::cube());
        summarize(object.representations[0], model);
        model.objects.push_back(object);
    }
    Assembly assembly;
    for (const double x : {0.0, 5.0, 9.0}) {
        Affine shift;
        shift.offset.x = x;
        assembly.placements.push_back({x == 5 ? 1u : 0u, shift, "c"});
    }
    Object group;
    group.representations.emplace_back();
    group.representations[0].summary.kind = Kind::Assembly;
    group.representations[0].payload = std::make_shared<const Assembly>(assembly);
    model.objects.push_back(group);
    model.root = 2;
    write_model(folder() / "flat.obj", model);
    Problems problems;
    const Model back = read_model(folder() / "flat.obj", problems);
    EXPECT_TRUE(problems.empty());
    const Representation& finest = back.objects[back.root].representations[0];
    EXPECT_EQ(finest.mesh().triangles.size(), 36u);
    EXPECT_EQ(finest.materials.size(), 2u);
    EXPECT_EQ(finest.mesh().slots[12], 1);
    EXPECT_EQ(finest.mesh().slots[24], 0);
    EXPECT_DOUBLE_EQ(finest.summary.bound.box.high.x, 9.5);
    write_model(folder() / "flat.ply", model);
    EXPECT_EQ(totals(read_model(folder() / "flat.ply", problems)).triangles_placed, 36u);
    EXPECT_THROW(write_model(folder() / "flat.fbx", model), Error);
    EXPECT_THROW(read_model(folder() / "flat.fbx", problems), Error);
}

TEST(Obj, GarbageLinesAreOneProblemWithTheirNumber) {
    Problems problems;
    const Model model = read(kPoints +
                                 "nonsense\nf 1 2\nf 1 2 x\nf 0 1 2\nf 1/2/3/4 2 3\ng group\n"
                                 "s off\nf 1 2 3\nf 1 2 99\nf 1/77/88 2 4\n",
                             problems);
    EXPECT_EQ(only_mesh(model).triangles.size(), 2u);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].code, "bad_lines");
    EXPECT_NE(problems[0].message.find("5 lines"), std::string::npos) << problems[0].message;
    EXPECT_NE(problems[0].message.find("line 5"), std::string::npos) << problems[0].message;
    EXPECT_EQ(problems[1].code, "bad_faces");
}

TEST(Obj, BrokenVerticesKeepTheirNumbers) {
    Problems problems;
    const Model model = read(
        "v 0 0 0\nv oops\nv 1 0 0\nv 0 1 0\nv 1e99 0 0\nf 1 3 4\nf 1 2 3\n"
        "f 1 3 5\n",
        problems);
    EXPECT_EQ(only_mesh(model).positions,
              (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_TRUE(has(problems, "bad_lines"));
    EXPECT_TRUE(has(problems, "non_finite_vertices"));
}

TEST(Obj, DamagedFilesNeverCrash) {
    write_file(folder() / "round.mtl", "newmtl a\nKd 1 1 1\nmap_Kd inner/board.png\n");
    std::vector<Material> materials(2);
    Mesh mesh = shapes::sphere(1, 1);
    mesh.slots.resize(mesh.triangles.size());
    mesh.slots.back() = 1;
    hostile::survive(write_obj(mesh, materials, "ball", "round.mtl"), 400,
                     [](const std::string& bytes) {
                         Problems problems;
                         bottom_up(read(bytes, problems));
                     });
}

TEST(Obj, DamagedLibrariesNeverCrash) {
    written(two_texels({1, 1, 1, 1, 0.5f, 0, 0, 0.5f}), "leaf.png");
    const std::string good =
        "newmtl a\nKd 1 0 0\nKe 1 1 1\nmap_Kd -s 2 2 2 -o 1 1 -mm 0 1 -clamp on leaf.png\n"
        "map_d -imfchan m leaf.png\nd 0.5\nTf 1 1 1\nillum 7\nNi 1.5\nmap_Bump -bm 1 leaf.png\n";
    hostile::survive(good, 600, [](const std::string& bytes) {
        Problems problems;
        const std::vector<Material> materials = library(bytes, problems);
        for (const Material& m : materials) {
            EXPECT_TRUE(std::isfinite(m.alpha) && m.ior > 0);
            for_each_texture(m, [](const Texture& texture) {
                for (const double x : texture.to_picture)
                    EXPECT_TRUE(std::isfinite(x));
            });
        }
        write_mtl(materials);
    });
}

TEST(Obj, PizzaHasItsTriangles) {
    const std::filesystem::path file = hostile::data("models/pizza_uv.obj");
    if (file.empty())
        GTEST_SKIP() << "no real data";
    Problems problems;
    const Model model = read_model(file, problems);
    EXPECT_EQ(totals(model).triangles_placed, 49954u);
    EXPECT_FALSE(model.objects[model.root].representations[0].mesh().uvs.empty());
}

}  // namespace
}  // namespace lodestone::format
