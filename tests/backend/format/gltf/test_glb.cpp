// SPDX-License-Identifier: GPL-3.0-or-later
// Guards GLB: the store's meshes come back bit for bit, foreign files lose nothing we can hold, no
// file can crash us or lead us elsewhere.
#include "base/error.h"
#include "base/files.h"
#include "format/model_file.h"
#include "image/image.h"
#include "scenes/damaged_files.h"
#include "scenes/gltf_text.h"
#include "scenes/small_meshes.h"
#include "scratch.h"

#include <cstring>
#include <gtest/gtest.h>

namespace lodestone::format {
namespace {

using namespace gltf_text;

std::filesystem::path folder() {
    std::filesystem::path path = own_scratch();
    std::filesystem::create_directories(path / "inner");
    return path;
}

/// hash_of sees every bit of every array and their lengths.
void expect_round_trip(const Mesh& mesh) {
    const Mesh back = read_glb_mesh(write_glb_mesh(mesh, {}, "mesh"));
    EXPECT_EQ(hash_of(back), hash_of(mesh));
    EXPECT_EQ(back.triangles, mesh.triangles);
    EXPECT_EQ(back.slots, mesh.slots);
}

Mesh random_mesh(uint64_t seed, size_t vertices, size_t triangles) {
    PcgRandom random(seed);
    Mesh mesh;
    for (size_t i = 0; i < vertices; ++i) {
        const auto number = [&] { return static_cast<float>(random.uniform() * 4 - 2); };
        mesh.positions.emplace_back(number(), number() * 1e-20f, -0.0f);
        mesh.normals.push_back(glm::normalize(glm::vec3(number(), number(), number())));
        mesh.uvs.emplace_back(number(), number());
    }
    const auto vertex = [&] {
        return static_cast<uint32_t>(random.uniform() * static_cast<double>(vertices));
    };
    for (size_t i = 0; i < triangles; ++i) {
        mesh.triangles.emplace_back(vertex(), vertex(), vertex());
        mesh.slots.push_back(static_cast<uint16_t>(random.next() % 5 * 1000));
    }
    return mesh;
}

TEST(Glb, EmptyMeshesComeBackEmpty) {
    expect_round_trip(Mesh{});
    Mesh points;
    points.positions = {{1, 2, 3}, {4, 5, 6}};
    expect_round_trip(points);
    EXPECT_FALSE(complaint("").empty());
    EXPECT_FALSE(complaint("{}").empty());
}

TEST(Glb, OneTriangleComesBack) {
    Mesh mesh;
    mesh.positions = {{0.1f, -0.2f, 0.3f}, {1, 0, -0.0f}, {0, 1, 0}};
    mesh.triangles = {{2, 0, 1}};
    expect_round_trip(mesh);
    mesh.slots = {7};
    expect_round_trip(mesh);
}

TEST(Glb, MeshesComeBackBitForBit) {
    expect_round_trip(shapes::cube());
    expect_round_trip(shapes::terrain(20));
    expect_round_trip(random_mesh(1, 100, 333));     // interleaved slots, v that needs its own bits
    expect_round_trip(random_mesh(2, 70000, 5000));  // indices of 32 bits
    Mesh sorted = random_mesh(3, 50, 60);
    std::sort(sorted.slots.begin(), sorted.slots.end());
    expect_round_trip(sorted);
    Mesh upper = shapes::quad(1, 1);
    upper.uvs = {{0, 0}, {1, 0.5f}, {1, 1}, {0, 0.75f}};  // 1 - v is exact
    EXPECT_EQ(write_glb_mesh(upper, {}, "").find("_LODESTONE_V"), std::string::npos);
    expect_round_trip(upper);
    upper.colors = {{1, 0.1f, 0, 1}, {0, 1, 0, 0.5f}, {2, 3, 4, 1}, {0, 0, 0, 0}};
    expect_round_trip(upper);
}

TEST(Glb, StrangersSeeYUpAndVDown) {
    Mesh mesh = shapes::quad(2, 3);
    mesh.positions[2].z = 5;
    mesh.uvs = {{0, 0.25f}, {0, 0}, {0, 0}, {0, 0}};
    const std::string bytes = write_glb_mesh(mesh, {}, "mesh");
    EXPECT_NE(bytes.find(R"("max":[2.0,5.0,-0.0])"), std::string::npos);
    EXPECT_NE(bytes.find(R"("min":[0.0,0.0,-3.0])"), std::string::npos);
    uint32_t json = 0;
    std::memcpy(&json, bytes.data() + 12, 4);
    float v = 0;
    std::memcpy(&v, bytes.data() + 28 + json + size_t{4} * 12 + 4, 4);
    EXPECT_EQ(v, 0.75f);
}

TEST(Glb, NumbersThatAreNoneAreNotWrittenAndOddNamesAre) {
    Mesh mesh = shapes::quad(1, 1);
    std::vector<Material> materials(1);
    materials[0].name = "caf\xc3\xa9 \xff\xc0\xaf";
    mesh = read_glb_mesh(write_glb_mesh(mesh, materials, std::string("a\0\x80\"b", 5)));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    mesh.positions[1].y = std::nanf("");
    EXPECT_THROW(write_glb_mesh(mesh, {}, "mesh"), Error);
    mesh.positions[1].y = 0;
    mesh.triangles[0].x = 4;
    EXPECT_THROW(write_glb_mesh(mesh, {}, "mesh"), Error);
}

TEST(Glb, FilesOfOthersAreNotTakenForOurs) {
    EXPECT_THROW(read_glb_mesh(gltf(kOneMesh + kOneNode)), Error);
    EXPECT_THROW(read_glb_mesh(gltf(kOneNode)), Error);
}

TEST(Glb, ForeignMeshIsTurnedToZUp) {
    Problems problems;
    const Model model = read(gltf(kOneMesh + kOneNode), problems);
    EXPECT_TRUE(problems.empty());
    ASSERT_EQ(model.objects.size(), 2u);
    EXPECT_EQ(model.objects[0].uid, "gltf:mesh:0");
    EXPECT_EQ(model.objects[0].name, "quad");
    const Mesh& mesh = model.objects[0].representations[0].mesh();
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, -0.0f, 1));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(totals(model).occurrences, 1u);
    EXPECT_EQ(model.objects[0].representations[0].materials.size(), 1u);
}

TEST(Glb, HierarchyAndSharingSurvive) {
    Problems problems;
    const Model model =
        read(gltf(kOneMesh + R"("nodes":[{"name":"table","children":[1,2],"translation":[0,2,0]},
            {"name":"leg","mesh":0,"scale":[2,2,2]},{"name":"top","mesh":0,
             "rotation":[0,0.70710678118654757,0,0.70710678118654757]},{"name":"lone","mesh":0},
            {"name":"lamp"}],"scene":0,"scenes":[{"name":"room","nodes":[0,3,4]}])"),
             problems);
    EXPECT_TRUE(problems.empty());
    ASSERT_EQ(model.objects.size(), 3u);
    const Object& room = model.objects[model.root];
    EXPECT_EQ(room.uid, "gltf:scene");
    EXPECT_EQ(room.name, "room");
    std::vector<std::string> paths;
    for_each_occurrence(model, [&](const Occurrence& o) {
        EXPECT_EQ(o.object, 0u);
        paths.push_back(o.path);
        if (o.path == "table/leg") {
            EXPECT_NEAR(glm::distance(o.world({1, 0, 1}), glm::dvec3(2, 0, 4)), 0, 1e-12);
        }
        if (o.path == "table/top") {  // a quarter turn about the vertical takes x to y
            EXPECT_NEAR(glm::distance(o.world({1, 0, 0}), glm::dvec3(0, 1, 2)), 0, 1e-12);
        }
    });
    EXPECT_EQ(paths, (std::vector<std::string>{"table/leg", "table/top", "lone"}));
}

TEST(Glb, ModelsRoundTrip) {
    Model model;
    model.materials.resize(2);
    model.materials[0].name = "glow";
    model.materials[0].emission = {0.1, 5.3, 0};
    model.materials[0].specular = 0.3;
    model.materials[1].base_color = {0.123456789, 0.2, 0.3};
    model.materials[1].roughness = 1;
    model.materials[1].metallic = 1;
    Object ball;
    ball.name = "ball";
    ball.representations.emplace_back();
    Mesh mesh = shapes::sphere(1, 1);
    mesh.slots.resize(mesh.triangles.size());
    mesh.slots[3] = 1;
    ball.representations[0].materials = {0, 1};
    ball.representations[0].payload = std::make_shared<const Mesh>(mesh);
    summarize(ball.representations[0], model);
    model.objects.push_back(ball);
    const auto group = [&](std::vector<Placement> placements) {
        Object object;
        object.name = "group";
        object.representations.emplace_back();
        object.representations[0].summary.kind = Kind::Assembly;
        object.representations[0].payload =
            std::make_shared<const Assembly>(Assembly{std::move(placements)});
        model.objects.push_back(object);
        return static_cast<ObjectIndex>(model.objects.size() - 1);
    };
    Affine turn;
    turn.linear = glm::dmat3(0, 0.1, 0, -0.1, 0, 0, 0, 0, 0.1);
    turn.offset = {1.0 / 3, -0.0, 7};
    Affine mirror;
    mirror.linear = glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 2);
    const ObjectIndex pair = group({{0, turn, "a"}, {0, mirror, "b"}});
    model.root = group({{pair, turn, "left"}, {pair, mirror, "right"}, {0, Affine{}, "c"}});
    summarize_assemblies(model, bottom_up(model));
    const auto worlds = [](const Model& of) {
        std::vector<std::string> out;
        for_each_occurrence(of, [&](const Occurrence& o) {
            double rows[12];
            o.world.to_rows(rows);
            out.push_back(o.path + std::string(reinterpret_cast<char*>(rows), sizeof rows));
        });
        return out;
    };
    write_model(folder() / "model.glb", model);
    Problems problems;
    const Model back = read_model(folder() / "model.glb", problems);
    EXPECT_TRUE(problems.empty());
    EXPECT_EQ(worlds(back), worlds(model));
    EXPECT_EQ(totals(back).triangles_unique, totals(model).triangles_unique);
    const Representation& finest = back.objects[0].representations[0];
    EXPECT_EQ(hash_of(finest.mesh()), hash_of(mesh));
    ASSERT_EQ(finest.materials.size(), 2u);
    for (size_t slot = 0; slot < 2; ++slot)
        EXPECT_EQ(hash_of(back.materials[finest.materials[slot]]), hash_of(model.materials[slot]));
    EXPECT_EQ(finest.summary.hash, ball.representations[0].summary.hash);
}

TEST(Glb, ShearedAndFlattenedPlacementsStayWhereTheyAre) {
    PcgRandom random(5);
    for (int round = 0; round < 50; ++round) {
        Model model;
        Object cube;
        cube.representations.emplace_back();
        cube.representations[0].payload = std::make_shared<const Mesh>(shapes::cube());
        summarize(cube.representations[0], model);
        Object group;
        Affine odd;
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k)
                odd.linear[i][k] = 2 * random.uniform() - 1;
            odd.offset[i] = random.uniform();
        }
        if (round % 5 == 3)
            odd.linear[2] = odd.linear[0] + odd.linear[1];  // flat
        if (round % 5 == 4)
            odd.linear[1] = odd.linear[2] = glm::dvec3(0.0);  // a line
        if (round == 49)
            odd.linear = glm::dmat3(0.0);
        group.representations.emplace_back();
        group.representations[0].summary.kind = Kind::Assembly;
        group.representations[0].payload =
            std::make_shared<const Assembly>(Assembly{{{0, odd, "odd"}}});
        model.objects = {cube, group};
        model.root = 1;
        Problems problems;
        const Model back = read(write_glb(model), problems);
        int seen = 0;
        for_each_occurrence(back, [&](const Occurrence& o) {
            ++seen;
            for (const glm::dvec3& p : {glm::dvec3(1, 2, 3), glm::dvec3(-1, 1, 0.5)})
                EXPECT_LT(glm::distance(o.world(p), odd(p)), 1e-6) << round;
        });
        EXPECT_EQ(seen, 1);
    }
}

TEST(Glb, PrimitivesJoinIntoSlotsAndStripsBecomeTriangles) {
    Problems problems;
    const Model model = read(gltf(R"("materials":[{"name":"m0"},{"name":"m1","pbrMetallicRoughness":
             {"baseColorFactor":[0.5,0.25,0,1],"metallicFactor":0,"roughnessFactor":0.125}}],
             "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":1},
             {"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":0},"mode":6,"material":1},
             {"attributes":{"POSITION":0},"mode":1}]}],)" +
                                  kOneNode),
                             problems);
    const Representation& finest = model.objects[0].representations[0];
    EXPECT_EQ(finest.mesh().positions.size(), 4u);  // shared, not copied
    EXPECT_EQ(
        finest.mesh().triangles,
        (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {2, 1, 3}, {1, 2, 0}, {2, 3, 0}}));
    EXPECT_EQ(finest.mesh().slots, (std::vector<uint16_t>{0, 0, 1, 1, 0, 0}));
    EXPECT_EQ(model.materials[finest.materials[0]].roughness, 0.125);
    EXPECT_EQ(model.materials[finest.materials[0]].base_color, glm::dvec3(0.5, 0.25, 0));
    EXPECT_EQ(problems.size(), 1u);
    EXPECT_TRUE(has(problems, "not_triangles"));
}

TEST(Glb, TexturesAreKeptAndTheConstantIsTheirMean) {
    image::Image board;
    board.width = 2;
    board.height = 1;
    board.pixels = {1, 1, 1, 1, 0, 0, 0, 0};  // the second pixel is not there
    image::write_png(folder() / "board.png", board);
    const std::string embedded =
        "data:image/png;base64," + base64(read_file(folder() / "board.png"));
    for (const std::string& uri :
         {embedded, std::string("board.png"), std::string("../board.png")}) {
        write_file(folder() / "textured.gltf",
                   gltf(text(R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,1],
                        "baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
                        "images":[{"uri":")",
                             uri, R"("}],
                        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)",
                             kOneNode)));
        Problems problems;
        const Model model = read_model(folder() / "textured.gltf", problems);
        const bool outside = uri[0] == '.';
        EXPECT_EQ(model.materials[0].base_color, glm::dvec3(0.5, 1, 1));
        EXPECT_EQ(static_cast<bool>(model.materials[0].base_color_texture), !outside);
        EXPECT_EQ(problems.size(), outside ? 1u : 0u);
        EXPECT_EQ(has(problems, "texture_missing"), outside);
    }
}

TEST(Glb, BuffersAreReadFromTheFolderOnly) {
    const std::string bytes =
        raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + raw<uint16_t>({0, 1, 2, 0, 2, 3});
    write_file(folder() / "inner" / "a b.bin", bytes);
    write_file(folder() / "secret.bin", bytes);
    write_file("secret_here.bin", bytes);  // in the current folder, where tinygltf looks, too
    const auto read_with = [&](const std::string& uri) {
        write_file(folder() / "inner" / "scene.gltf", gltf(kOneMesh + kOneNode, uri));
        Problems problems;
        return totals(read_model(folder() / "inner" / "scene.gltf", problems)).triangles_placed;
    };
    EXPECT_EQ(read_with("a%20b.bin"), 2u);
    EXPECT_THROW(read_with("../secret.bin"), Error);
    EXPECT_THROW(read_with("%2e%2e/secret.bin"), Error);
    EXPECT_THROW(read_with((folder() / "secret.bin").string()), Error);
    EXPECT_THROW(read_with("secret_here.bin"), Error);
    EXPECT_THROW(read_with("/dev/zero"), Error);
    std::filesystem::remove("secret_here.bin");
}

TEST(Glb, BrokenReferencesAreLeftOutWithAProblem) {
    const std::vector<std::string> primitives{
        R"({"attributes":{"POSITION":9}})",
        R"({"attributes":{"POSITION":-1}})",
        R"({"attributes":{"NORMAL":0}})",
        R"({"attributes":{"POSITION":1}})",
        R"({"attributes":{"POSITION":0,"TEXCOORD_0":0}})",
        R"({"attributes":{"POSITION":0},"indices":0})",
    };
    for (const std::string& primitive : primitives) {
        Problems problems;
        const Model model =
            read(gltf(text(R"("meshes":[{"primitives":[)", primitive,
                           R"(,{"attributes":{"POSITION":0},"indices":1}]}],)", kOneNode)),
                 problems);
        EXPECT_TRUE(has(problems, "bad_primitive")) << primitive;
        EXPECT_EQ(totals(model).triangles_placed, 2u) << primitive;
    }
}

TEST(Glb, RangesThatLeaveTheirBufferAreFound) {
    const std::string whole = gltf(kOneMesh + kOneNode);
    const std::vector<std::pair<std::string, std::string>> changes{
        {R"("count":4)", R"("count":5)"},
        {R"("count":4)", R"("count":4611686018427387904)"},
        {R"("count":6)", R"("count":7)"},
        {R"("byteLength":48)", R"("byteLength":61)"},
        {R"("byteOffset":48)", R"("byteOffset":18446744073709551615)"},
        {R"("byteOffset":48)", R"("byteOffset":50)"},
        {R"("bufferView":0)", R"("bufferView":5)"},
        {R"("bufferView":0)", R"("byteOffset":8,"bufferView":0)"},
        {R"("componentType":5123)", R"("componentType":5126)"},
        {R"("componentType":5126)", R"("componentType":5130)"},
        {R"("buffer":0,"byteLength":48)", R"("buffer":3,"byteLength":48)"},
        {R"("buffer":0,"byteLength":48)", R"("buffer":0,"byteStride":252,"byteLength":48)"},
        {R"("type":"VEC3")", R"("type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,
          "componentType":5123},"values":{"bufferView":0}})"},
    };
    for (const auto& [from, to] : changes) {
        std::string changed = whole;
        const size_t at = changed.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        changed.replace(at, from.size(), to);
        Problems problems;
        try {
            EXPECT_EQ(totals(read(changed, problems)).triangles_placed, 0u) << to;
            EXPECT_TRUE(has(problems, "bad_primitive")) << to;
        } catch (const Error&) {
        }
    }
}

TEST(Glb, LoopsDepthBombsAndUnknownExtensionsAreRefused) {
    const auto with_nodes = [](const std::string& nodes) {
        return complaint(gltf(kOneMesh + R"("nodes":)" + nodes + R"(,"scenes":[{"nodes":[0]}])"));
    };
    EXPECT_NE(with_nodes(R"([{"children":[1]},{"children":[0]}])").find("two parents"),
              std::string::npos);
    EXPECT_NE(with_nodes(R"([{"children":[0]}])").find("two parents"), std::string::npos);
    EXPECT_NE(with_nodes(R"([{"children":[1,1]},{"mesh":0}])").find("two parents"),
              std::string::npos);
    EXPECT_NE(with_nodes(R"([{"children":[7]}])").find("node 7 of 1"), std::string::npos);
    std::string chain = "[";
    for (int i = 1; i < 1000; ++i)
        chain += text(R"({"children":[)", i, "]},");
    EXPECT_NE(with_nodes(chain + R"({"mesh":0}])").find("deep"), std::string::npos);
    const std::string nest(100000, '[');
    EXPECT_NE(complaint(gltf(kOneMesh + kOneNode + R"(,"extras":)" + nest)).find("nested"),
              std::string::npos);
    EXPECT_NE(complaint(gltf(kOneMesh + kOneNode +
                             R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"))
                  .find("KHR_draco"),
              std::string::npos);
    EXPECT_NE(
        complaint(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1},{"byteLength":1}]})")
            .find("several buffers"),
        std::string::npos);
    EXPECT_FALSE(
        with_nodes(R"([{"mesh":0,"matrix":[1e999,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}])").empty());
}

TEST(Glb, SlotsThatNoTriangleHasDoNotWriteBeyondTheMaterials) {
    const auto read_with = [](const std::string& mark, const std::string& primitives) {
        const std::string mesh = R"("meshes":[{"extras":{"lodestone":{"version":1,"slots":)" +
                                 mark + R"(}},"primitives":[)" + primitives + "]}],";
        Problems problems;
        return read(gltf(mesh + kOneNode), problems);
    };
    const std::string points = R"({"attributes":{"POSITION":0},"mode":0})";
    const std::string quad = R"({"attributes":{"POSITION":0},"indices":1})";
    for (const char* slots : {"[2000000000]", "[-2000000]", "[]", "[\"a\"]"})
        EXPECT_EQ(totals(read_with(slots, points)).triangles_placed, 0u) << slots;
    // One slot of two has no triangle at all: its primitive has two corners.
    const std::string text =
        gltf(R"("meshes":[{"extras":{"lodestone":{"version":1,"slots":[0,60000]}},
        "primitives":[)" +
             quad + R"(,{"attributes":{"POSITION":0},"indices":2}]}],)" + kOneNode);
    const std::string two_corners =
        R"({"bufferView":1,"componentType":5123,"count":2,"type":"SCALAR"},)";
    std::string bytes = text;
    const size_t at = bytes.find(R"({"bufferView":0,"componentType":5126)");
    ASSERT_NE(at, std::string::npos);
    const size_t end = bytes.find("}]", at);
    bytes.insert(end + 1, "," + two_corners.substr(0, two_corners.size() - 1));
    Problems problems;
    EXPECT_EQ(totals(read(bytes, problems)).triangles_placed, 2u);
}

TEST(Glb, DataShownTooOftenIsRefused) {
    Mesh mesh = shapes::terrain(100);
    std::string bytes = write_glb_mesh(mesh, {}, "mesh");
    uint32_t json = 0;
    std::memcpy(&json, bytes.data() + 12, 4);
    std::string text(bytes.substr(20, json));
    const std::string primitive = R"({"attributes":{"POSITION":0},"indices":1,"mode":4})";
    const size_t at = text.find(primitive);
    ASSERT_NE(at, std::string::npos) << text;
    std::string many = primitive;
    for (int i = 0; i < 600; ++i)
        many += "," + primitive;
    text.replace(at, primitive.size(), many);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto size = static_cast<uint32_t>(text.size());
    const auto length = static_cast<uint32_t>(20 + size + bytes.size() - 20 - json);
    std::string bomb = bytes.substr(0, 20) + text + bytes.substr(20 + json);
    std::memcpy(bomb.data() + 8, &length, 4);
    std::memcpy(bomb.data() + 12, &size, 4);
    Problems problems;
    const Model model = read(bomb, problems);
    EXPECT_TRUE(has(problems, "bad_primitive"));
    EXPECT_LT(totals(model).triangles_placed, 7000000u);
}

TEST(Glb, DamagedFilesNeverCrash) {
    std::vector<Material> materials(3);
    materials[1].emission = {4, 4, 4};
    const std::string ours = write_glb_mesh(random_mesh(4, 12, 20), materials, "mesh");
    const auto read_both = [](const std::string& bytes) {
        Problems problems;
        const Model model = read_glb(bytes, {}, "damaged", problems);
        bottom_up(model);
        check(read_glb_mesh(bytes));
    };
    hostile::survive(ours, 500, read_both);
    const std::string foreign = gltf(kOneMesh + R"("materials":[{"pbrMetallicRoughness":{
        "baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
        "images":[{"bufferView":1,"mimeType":"image/png"}],)" +
                                     kOneNode);
    hostile::survive(foreign, 500, [](const std::string& bytes) {
        Problems problems;
        bottom_up(read_glb(bytes, {}, "damaged", problems));
    });
}

TEST(Glb, RealRoomIsRead) {
    const std::filesystem::path file = hostile::data("scenes/godot-mesh-lod-room/room.glb");
    if (file.empty())
        GTEST_SKIP() << "no real data";
    Problems problems;
    const Model model = read_model(file, problems);
    EXPECT_EQ(totals(model).triangles_placed, 63720u);
    for (const Problem& problem : problems)
        EXPECT_NE(problem.severity, Severity::Error) << problem.message;
}

}  // namespace
}  // namespace lodestone::format
