// SPDX-License-Identifier: GPL-3.0-or-later
// Guards OBJ and MTL: what real exporters write, exact round trips, files that lead elsewhere.
#include "base/error.h"
#include "base/files.h"
#include "format/format.h"
#include "format/mtl.h"
#include "format/obj.h"
#include "image/image.h"
#include "mutate.h"
#include "shapes.h"

#include <gtest/gtest.h>

namespace lodestone::format {
namespace {

const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::filesystem::path folder() {
    std::filesystem::path path = std::filesystem::path(LODESTONE_TEST_SCRATCH) / "obj";
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
    EXPECT_NEAR(model.materials[finest.materials[1]].base_color.x, 0.5, 1e-6);
    EXPECT_TRUE(has(problems, "texture_averaged"));
    EXPECT_TRUE(has(problems, "material_missing"));  // lost
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
    write_file(folder() / "round.mtl", write_mtl(materials));
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
