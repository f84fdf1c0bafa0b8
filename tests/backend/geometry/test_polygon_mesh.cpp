// SPDX-License-Identifier: GPL-3.0-or-later
// Guards PolygonMesh: the triangles, vertices and normals that polygons become.
#include "geometry/polygon_mesh.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>

using namespace lodestone;

namespace {

/// Owns what a PolygonMesh looks at.
struct Polygons {
    std::vector<float> positions;
    std::vector<uint32_t> vertices;
    std::vector<uint32_t> starts;
    std::vector<uint32_t> triangles;
    std::vector<uint8_t> smooth;
    std::vector<int32_t> slots;
    std::vector<float> normals;
    std::vector<float> uvs;

    void add(std::initializer_list<uint32_t> face) {
        starts.push_back(static_cast<uint32_t>(vertices.size()));
        vertices.insert(vertices.end(), face);
    }
    PolygonMesh view() const {
        PolygonMesh out;
        out.positions = positions.data();
        out.vertex_count = positions.size() / 3;
        out.vertices = vertices;
        out.starts = starts;
        out.triangles = triangles;
        out.smooth = smooth;
        out.slots = slots;
        out.normals = normals.empty() ? nullptr : normals.data();
        out.uvs = uvs.empty() ? nullptr : uvs.data();
        return out;
    }
};

Polygons cube(uint8_t smooth) {
    Polygons out;
    out.positions = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                     -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    out.add({0, 3, 2, 1});
    out.add({4, 5, 6, 7});
    out.add({0, 1, 5, 4});
    out.add({1, 2, 6, 5});
    out.add({2, 3, 7, 6});
    out.add({3, 0, 4, 7});
    out.smooth.assign(6, smooth);
    return out;
}

std::string refusal(const Polygons& polygons) {
    try {
        check(polygons.view());
    } catch (const Error& error) {
        EXPECT_EQ(error.status, Status::InvalidArgument);
        return error.what();
    }
    return "";
}

}  // namespace

TEST(PolygonMesh, ATriangleOfAFaceOfOneCornerReadsNothingBeyondIt) {
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::vector<uint32_t> vertices{0, 1, 2, 0, 0xfffffff0u};  // the last is not given
    const std::vector<uint32_t> starts{0, 3};
    const std::vector<uint32_t> triangles{0, 1, 2, 3, 0, 1};
    const std::vector<float> normals(12, 1.0f);
    PolygonMesh faces;
    faces.positions = positions.data();
    faces.vertex_count = 3;
    faces.vertices = {vertices.data(), 4};
    faces.starts = starts;
    faces.triangles = triangles;
    faces.normals = normals.data();
    check(faces);
    const Mesh mesh = mesh_of(faces, 1);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    check(mesh);
}

TEST(PolygonMesh, APoleOfManyLooksKeepsThemAll) {
    Polygons fan;
    constexpr uint32_t kSides = 2000;
    fan.positions = {0, 0, 1};
    for (uint32_t i = 0; i < kSides; ++i) {
        const double turn = 6.283185307179586 * i / kSides;
        fan.positions.insert(fan.positions.end(), {static_cast<float>(std::cos(turn)),
                                                   static_cast<float>(std::sin(turn)), 0.0f});
    }
    for (uint32_t i = 0; i < kSides; ++i) {
        fan.add({0, 1 + i, 1 + (i + 1) % kSides});
        for (uint32_t corner = 0; corner < 3; ++corner)
            fan.uvs.insert(fan.uvs.end(), {static_cast<float>(i), static_cast<float>(corner)});
    }
    const Mesh mesh = mesh_of(fan.view(), 1);
    check(mesh);
    ASSERT_EQ(mesh.triangles.size(), size_t{kSides});
    for (uint32_t i = 0; i < kSides; ++i) {
        EXPECT_EQ(mesh.uvs[mesh.triangles[i].x], glm::vec2(i, 0));
        EXPECT_EQ(mesh.uvs[mesh.triangles[i].z], glm::vec2(i, 2));
    }
}

TEST(PolygonMesh, NothingBecomesNothing) {
    const Polygons none;
    EXPECT_EQ(refusal(none), "");
    EXPECT_TRUE(mesh_of(none.view(), 1).empty());
}

TEST(PolygonMesh, TrianglesNeedNoStarts) {
    Polygons one;
    one.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    one.vertices = {2, 0, 1};
    const Mesh mesh = mesh_of(one.view(), 1);
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.triangles[0], Triangle(2, 0, 1));
    EXPECT_TRUE(mesh.normals.empty());
    one.vertices = {2, 0, 1, 0};
    EXPECT_EQ(refusal(one), "4 corners are not those of triangles");
}

TEST(PolygonMesh, FlatCubeKeepsItsEightVertices) {
    const Mesh mesh = mesh_of(cube(0).view(), 1);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(surface_area(mesh), 24, 1e-6);
}

TEST(PolygonMesh, SmoothCubeHasTheNormalsOfItsDiagonals) {
    const Mesh mesh = mesh_of(cube(1).view(), 1);
    ASSERT_EQ(mesh.normals.size(), 8u);
    for (size_t i = 0; i < 8; ++i)
        EXPECT_LT(glm::length(mesh.normals[i] - mesh.positions[i] / std::sqrt(3.0f)), 1e-6f);
}

TEST(PolygonMesh, AnglesWeighNotTheNumberOfFaces) {
    // A corner of a cube whose top is two triangles there: still the diagonal.
    Polygons corner;
    corner.positions = {0, 0, 0, -1, 0, 0, -1, -1, 0, 0, -1, 0, 0, -1, -1, 0, 0, -1, -1, 0, -1};
    corner.add({0, 1, 2});
    corner.add({0, 2, 3});
    corner.add({0, 3, 4, 5});
    corner.add({0, 5, 6, 1});
    corner.smooth.assign(4, 1);
    const Mesh mesh = mesh_of(corner.view(), 1);
    EXPECT_LT(glm::length(mesh.normals[0] - glm::vec3(1, 1, 1) / std::sqrt(3.0f)), 1e-6f);
}

TEST(PolygonMesh, FlatAndSmoothFacesSplitTheVerticesBetweenThem) {
    Polygons mixed = cube(1);
    mixed.smooth[1] = 0;
    const Mesh mesh = mesh_of(mixed.view(), 1);
    EXPECT_EQ(mesh.positions.size(), 12u);
    size_t up = 0;
    for (const glm::vec3& normal : mesh.normals)
        up += normal == glm::vec3(0, 0, 1) ? 1 : 0;
    EXPECT_EQ(up, 4u);
}

TEST(PolygonMesh, FacesOfFourAreSplitInsideThemselves) {
    Polygons arrow;
    arrow.positions = {0, 0, 0, 4, -1, 0, 1, 0, 0, 4, 1, 0};
    arrow.add({0, 1, 2, 3});  // its third corner looks inward
    arrow.add({1, 2, 3, 0});
    const Mesh mesh = mesh_of(arrow.view(), 1);
    ASSERT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.triangles[0], Triangle(0, 1, 2));
    EXPECT_EQ(mesh.triangles[1], Triangle(0, 2, 3));
    EXPECT_EQ(mesh.triangles[2], Triangle(1, 2, 0));
    EXPECT_EQ(mesh.triangles[3], Triangle(2, 3, 0));
    for (size_t i = 0; i < 4; ++i)
        EXPECT_LT(std::abs(area_vector(mesh, i).z), 4);
}

TEST(PolygonMesh, LargerFacesComeWithTheirTriangles) {
    Polygons five;
    five.positions = {0, 0, 0, 2, 0, 0, 3, 1, 0, 1, 2, 0, -1, 1, 0};
    five.add({0, 1, 2});
    five.add({0, 1, 2, 3, 4});
    EXPECT_EQ(largest_face(five.starts, five.vertices.size()), 5u);
    EXPECT_EQ(refusal(five), "face 1 of 5 corners comes without triangles");
    five.triangles = {0, 1, 2, 3, 4, 5, 3, 5, 6, 3, 6, 7};
    five.slots = {0, 1};
    EXPECT_EQ(refusal(five), "");
    const Mesh mesh = mesh_of(five.view(), 2);
    EXPECT_EQ(mesh.triangles[3], Triangle(0, 3, 4));
    EXPECT_EQ(mesh.slots, (std::vector<uint16_t>{0, 1, 1, 1}));
    five.triangles[4] = 8;
    EXPECT_EQ(refusal(five), "triangle 1 uses corner 8 of 8");
}

TEST(PolygonMesh, SlotsOutsideAreTheNearest) {
    Polygons slots = cube(0);
    slots.slots = {-3, 0, 1, 2, 9, 1};
    const Mesh mesh = mesh_of(slots.view(), 3);
    EXPECT_EQ(mesh.slots, (std::vector<uint16_t>{0, 0, 0, 0, 1, 1, 2, 2, 2, 2, 1, 1}));
    EXPECT_TRUE(mesh_of(slots.view(), 1).slots.empty());
}

TEST(PolygonMesh, SeamsOfTextureCoordinatesSplitVertices) {
    Polygons seam;
    seam.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    seam.add({0, 1, 2});
    seam.add({0, 2, 3});
    seam.uvs = {0, 0, 1, 0, 1, 1, 0, 0, .5, .5, 0, 1};
    const Mesh mesh = mesh_of(seam.view(), 1);
    EXPECT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.uvs[mesh.triangles[1].y], glm::vec2(.5, .5));
}

TEST(PolygonMesh, ColorsOfVerticesGoWithThem) {
    Polygons seam;
    seam.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    seam.add({0, 1, 2});
    seam.add({0, 2, 3});
    PolygonMesh faces = seam.view();
    const std::vector<float> colors = {1, 0, 0, 1, 0, 1, 0, 1, .2f, .4f, .6f, .8f, 0, 0, 0, 0};
    faces.vertex_colors = colors.data();
    const glm::vec4 third(.2f, .4f, .6f, .8f);
    Mesh mesh = mesh_of(faces, 1);
    ASSERT_EQ(mesh.colors.size(), 4u);
    EXPECT_EQ(mesh.colors[2], third);
    const std::vector<float> uvs = {0, 0, 1, 0, 1, 1, 0, 0, .5, .5, 0, 1};
    faces.uvs = uvs.data();  // splits the third vertex
    mesh = mesh_of(faces, 1);
    ASSERT_EQ(mesh.colors.size(), 5u);
    EXPECT_EQ(mesh.colors[2], third);
    EXPECT_EQ(mesh.colors[4], third);
}

TEST(PolygonMesh, LastDigitsOfGivenNormalsDoNotChangeTheMesh) {
    const Hash made = hash_of(mesh_of(cube(1).view(), 1));
    Polygons given = cube(1);
    for (const uint32_t vertex : given.vertices) {
        for (size_t i = 0; i < 3; ++i) {
            const float exact = given.positions[3 * size_t{vertex} + i] * 0.57735027f;
            given.normals.push_back(exact * (1 + 3e-7f * static_cast<float>(vertex % 3)));
        }
    }
    EXPECT_EQ(hash_of(mesh_of(given.view(), 1)), made);
    Polygons turned = given;
    turned.normals[0] += 0.01f;  // a normal of its own is kept
    EXPECT_EQ(mesh_of(turned.view(), 1).positions.size(), 9u);
    Polygons other = given;
    for (float& value : other.normals)
        value *= 1 - 2e-7f;
    EXPECT_EQ(hash_of(mesh_of(other.view(), 1)), made);
}

TEST(PolygonMesh, FacesThatDoNotFollowEachOtherAreNamed) {
    Polygons torn = cube(0);
    torn.starts[2] = 3;
    EXPECT_EQ(refusal(torn), "face 1 has the corners 4 to 3 of 24");
    EXPECT_EQ(largest_face(torn.starts, torn.vertices.size()), 0u);
    torn = cube(0);
    torn.starts[0] = 1;
    EXPECT_EQ(refusal(torn), "face 0 has the corners 1 to 4 of 24");
    torn = cube(0);
    torn.starts[5] = 90;
    EXPECT_NE(refusal(torn), "");
    torn = cube(0);
    torn.vertices[7] = 8;
    EXPECT_EQ(refusal(torn), "corner 7 uses vertex 8 of 8");
    torn = cube(0);
    torn.smooth.pop_back();
    EXPECT_EQ(refusal(torn), "5 flags for 6 faces");
    torn = cube(0);
    torn.slots.assign(7, 0);
    EXPECT_EQ(refusal(torn), "7 material slots for 6 faces");
}

TEST(PolygonMesh, FacesWithoutAreaAndNumbersThatAreNoneDoNoHarm) {
    Polygons bad = cube(1);
    bad.add({0, 0, 0, 0});
    bad.add({1, 2});
    bad.add({});
    bad.add({5});
    bad.smooth.resize(10, 1);
    EXPECT_EQ(refusal(bad), "");
    Mesh mesh = mesh_of(bad.view(), 1);
    EXPECT_EQ(mesh.triangles.size(), 14u);
    bad.positions[0] = std::numeric_limits<float>::quiet_NaN();
    bad.positions[4] = std::numeric_limits<float>::infinity();
    mesh = mesh_of(bad.view(), 1);
    Problems problems;
    repair(mesh, "Bad", problems);
    ASSERT_EQ(problems.size(), 1u);
    for (const glm::vec3& normal : mesh.normals)
        EXPECT_NEAR(glm::length(normal), 1, 1e-3);
}
