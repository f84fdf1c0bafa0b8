// SPDX-License-Identifier: GPL-3.0-or-later
// Guards PLY: all encodings and number types, exact round trips, counts that lie.
#include "base/files.h"
#include "format/model_file.h"
#include "format/ply.h"
#include "scenes/damaged_files.h"
#include "scenes/small_meshes.h"
#include "scratch.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace lodestone::format {
namespace {

std::string ascii(const std::string& vertices, const std::string& faces, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + vertices + faces + "end_header\n" + body;
}

const std::string kXyz = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kQuad = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

Mesh read(const std::string& bytes) {
    Problems problems;
    Mesh mesh = read_ply(bytes, "thing", problems);
    EXPECT_TRUE(problems.empty()) << problems[0].message;
    return mesh;
}

void expect_same(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(hash_of(a), hash_of(b));
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
}

TEST(Ply, EmptyFilesAreRefusedAndNoFacesAreAProblem) {
    Problems problems;
    EXPECT_THROW(read_ply("", "thing", problems), Error);
    EXPECT_THROW(read_ply("ply\nend_header\n", "thing", problems), Error);
    const Mesh mesh = read_ply(ascii(kXyz, "", "0 0 0 1 0 0 1 1 0 0 1 0"), "thing", problems);
    EXPECT_TRUE(mesh.empty());
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "no_faces");
}

TEST(Ply, PolygonsAreFansFromTheFirstCorner) {
    const Mesh mesh = read(ascii(kXyz, kFaces, kQuad));
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Ply, UnknownElementsPropertiesAndCommentsAreSkipped) {
    const std::string bytes =
        "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement material 1\r\nproperty list "
        "uchar float weights\r\nproperty int id\r\nelement vertex 3\r\nproperty uchar red\r\n"
        "property double z\r\nproperty double y\r\nproperty double x\r\nproperty float u\r\n"
        "property float v\r\nelement face 1\r\nproperty int group\r\nproperty list uint ushort "
        "vertex_index\r\nproperty list uchar float texcoord\r\nend_header\r\n"
        "2 .5 .5 7\r\n9 3 2 1 .25 .5\r\n9 0 0 0 0 0\r\n9 0 1 0 1 1\r\n5 3 0 1 2 2 .1 .2\r\n";
    const Mesh mesh = read(bytes);
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(mesh.uvs[0], glm::vec2(0.25f, 0.5f));
}

TEST(Ply, BigEndianAndSmallIntegersAreRead) {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty char y\n"
        "property double z\nelement face 1\nproperty list ushort uint vertex_indices\nend_header\n";
    const auto big = [&](auto value) {
        std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
        std::reverse(raw.begin(), raw.end());
        bytes += raw;
    };
    for (const int i : {0, 1, 2}) {
        big(static_cast<int16_t>(-300 * i));
        big(static_cast<int8_t>(i == 2 ? -5 : 0));
        big(0.5 * i);
    }
    big(uint16_t{3});
    for (const uint32_t i : {0u, 1u, 2u})
        big(i);
    const Mesh mesh = read(bytes);
    EXPECT_EQ(mesh.positions[1], glm::vec3(-300, 0, 0.5f));
    EXPECT_EQ(mesh.positions[2], glm::vec3(-600, -5, 1));
}

TEST(Ply, RoundTripIsExact) {
    Mesh mesh = shapes::terrain(7);
    expect_same(read(write_ply(mesh)), mesh);
    mesh = shapes::sphere(0.1, 1);
    for (const glm::vec3& p : mesh.positions)
        mesh.uvs.emplace_back(p.x / 3, -p.y);
    expect_same(read(write_ply(mesh)), mesh);
}

TEST(Ply, IntegerColorsAreDecodedAndFloatsAreLinear) {
    const auto with_colors = [](const std::string& type, const std::string& red,
                                const std::string& alpha) {
        std::string header = kXyz;
        for (const char* name : {"red", "green", "blue"})
            header += "property " + type + " " + name + "\n";
        if (!alpha.empty())
            header += "property " + type + " alpha\n";
        std::string body;
        for (const char* at : {"0 0 0 ", "1 0 0 ", "1 1 0 ", "0 1 0 "})
            body += text(at, red, " 0 0 ", alpha, '\n');
        return read(ascii(header, kFaces, body + "4 0 1 2 3\n"));
    };
    EXPECT_NEAR(with_colors("uchar", "188", "").colors.at(0).x, 0.503f, 0.001f);
    EXPECT_EQ(with_colors("uchar", "255", "").colors.at(3), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(with_colors("uchar", "255", "51").colors.at(0).w, 0.2f);
    EXPECT_NEAR(with_colors("ushort", "48316", "65535").colors.at(0).x, 0.503f, 0.001f);
    EXPECT_EQ(with_colors("float", "0.25", "0.5").colors.at(0), glm::vec4(0.25f, 0, 0, 0.5f));
    const Mesh half = read(ascii(kXyz + "property uchar red\n", kFaces,
                                 "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n"));
    EXPECT_TRUE(half.colors.empty());  // no green, no blue
}

TEST(Ply, ColorsComeBackAsBytesOrFloats) {
    Mesh mesh = shapes::quad(1, 1);
    mesh.colors = {{1, 0, 1, 1}, {0, 1, 0, 0}, {0, 0, 1, 1}, {1, 1, 1, 1}};
    EXPECT_NE(write_ply(mesh).find("property uchar red"), std::string::npos);
    expect_same(read(write_ply(mesh)), mesh);
    mesh = read(write_ply(mesh));
    mesh.colors[2] = {0.1f, 2, 1e-9f, 0.5f};  // no bytes say this
    EXPECT_NE(write_ply(mesh).find("property float red"), std::string::npos);
    expect_same(read(write_ply(mesh)), mesh);
    const Mesh byte = read(ascii(kXyz + "property uchar red\nproperty uchar green\nproperty uchar "
                                        "blue\n",
                                 kFaces,
                                 "0 0 0 1 2 3\n1 0 0 128 129 130\n1 1 0 77 9 5\n0 1 0 9 8 7\n"
                                 "4 0 1 2 3\n"));
    EXPECT_NE(write_ply(byte).find("property uchar red"), std::string::npos);
    expect_same(read(write_ply(byte)), byte);
}

TEST(Ply, ModelsUseTheirColors) {
    const std::filesystem::path path = own_scratch() / "colored.ply";
    Mesh mesh = shapes::quad(1, 1);
    mesh.colors = {{1, 0, 1, 1}, {0, 1, 0, 0}, {0, 0, 1, 1}, {1, 1, 1, 1}};
    write_file(path, write_ply(mesh));
    Problems problems;
    Model model = read_model(path, problems);
    EXPECT_TRUE(model.materials[0].vertex_colors);
    EXPECT_EQ(model.materials[0].base_color, glm::dvec3(1.0));
    write_model(path, model);
    EXPECT_TRUE(read_model(path, problems).materials[0].vertex_colors);
    model.materials[0].vertex_colors = false;  // nobody sees them
    write_model(path, model);
    EXPECT_FALSE(read_model(path, problems).materials[0].vertex_colors);
}

TEST(Ply, FacesThatMakeNoSenseAreLeftOutWithAProblem) {
    Problems problems;
    const Mesh mesh =
        read_ply(ascii(kXyz, "element face 4\nproperty list uchar int vertex_index\n",
                       "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n2 0 1\n3 0 1 9\n3 0 1 -1\n"),
                 "thing", problems);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].message.substr(0, 2), "3 ");
}

TEST(Ply, CountsThatLieAreRefusedBeforeMemoryIsSpent) {
    Problems problems;
    for (const std::string count :
         {"18446744073709551615", "4000000000", "99999999999999999999", "-1", "1e3"})
        EXPECT_THROW(read_ply("ply\nformat binary_little_endian 1.0\nelement vertex " + count +
                                  "\nproperty float x\nproperty float y\nproperty float "
                                  "z\nend_header\n",
                              "thing", problems),
                     Error)
            << count;
    EXPECT_THROW(read_ply(ascii(kXyz, kFaces, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n1000000 0 1 2\n"),
                          "thing", problems),
                 Error);
    // Elements without properties take no bytes: any number of them is skipped at once.
    EXPECT_TRUE(
        read_ply("ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n",
                 "thing", problems)
            .empty());
}

TEST(Ply, DamagedFilesNeverCrash) {
    Mesh mesh = shapes::sphere(1, 1);
    const auto read_it = [](const std::string& bytes) {
        Problems problems;
        check(read_ply(bytes, "damaged", problems));
    };
    const int accepted = hostile::survive(write_ply(mesh), 400, read_it);
    EXPECT_GT(accepted, 20);
    EXPECT_LT(accepted, 400);
    mesh.colors.assign(mesh.positions.size(), glm::vec4(0.5f));
    hostile::survive(write_ply(mesh), 200, read_it);
    hostile::survive(ascii(kXyz, kFaces, kQuad), 400, read_it);
}

TEST(Ply, BunnyHasItsTriangles) {
    const std::filesystem::path file = hostile::data("models/bunny.ply");
    if (file.empty())
        GTEST_SKIP() << "no real data";
    Problems problems;
    const Model model = read_model(file, problems);
    EXPECT_EQ(totals(model).triangles_placed, 69451u);
    EXPECT_EQ(model.objects[model.root].name, "bunny");
}

}  // namespace
}  // namespace lodestone::format
