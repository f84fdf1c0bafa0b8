// SPDX-License-Identifier: GPL-3.0-or-later
// Guards Mesh: checks, repair, joining, welding, closedness.
#include "model/mesh.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;

TEST(Mesh, EmptyMeshHasNoAreaAndIsNotClosed) {
    const Mesh mesh;
    EXPECT_EQ(surface_area(mesh), 0);
    EXPECT_FALSE(closed(mesh));
    EXPECT_NO_THROW(check(mesh));
}

TEST(Mesh, CubeHasAreaSixAndIsClosed) {
    EXPECT_NEAR(surface_area(shapes::cube()), 6, 1e-6);
    EXPECT_TRUE(closed(shapes::cube()));
    EXPECT_FALSE(closed(shapes::quad(1, 1)));
    EXPECT_FALSE(closed(shapes::fan()));
}

TEST(Mesh, IndexOutOfRangeIsNamed) {
    Mesh mesh = shapes::quad(1, 1);
    mesh.positions.resize(3);
    try {
        check(mesh);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.status, Status::InvalidArgument);
        EXPECT_STREQ(error.what(), "triangle 1 uses vertex 3 of 3");
    }
}

TEST(Mesh, IndicesFarOutOfRangeAreFoundAtAnyCorner) {
    for (const uint32_t index : {4u, 5u, 0x7fffffffu, 0x80000000u, 0x80000003u, 0xffffffffu}) {
        for (int corner = 0; corner < 3; ++corner) {
            Mesh mesh = shapes::quad(1, 1);
            mesh.triangles[0][corner] = index;
            EXPECT_THROW(check(mesh), Error) << index;
        }
    }
    Mesh nothing;
    EXPECT_NO_THROW(check(nothing));
    nothing.triangles = {{0, 0, 0}};
    EXPECT_THROW(check(nothing), Error);
}

TEST(Mesh, RepairDropsTrianglesWithNanVerticesAndSaysSo) {
    Mesh mesh = shapes::quad(1, 1);
    mesh.positions[1].x = std::numeric_limits<float>::quiet_NaN();
    Problems problems;
    repair(mesh, "Plane", problems);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions.size(), 3u);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].object, "Plane");
    EXPECT_EQ(problems[0].code, "non_finite_vertices");
}

TEST(Mesh, MirroredPartKeepsItsOutsideOutside) {
    Affine mirror;
    mirror.linear[0][0] = -1;
    Mesh mesh;
    append(mesh, shapes::cube(), mirror);
    EXPECT_TRUE(closed(mesh));
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::dvec3 normal(mesh.normals[mesh.triangles[i].x]);
        EXPECT_GT(glm::dot(area_vector(mesh, i), normal), 0);
        EXPECT_GT(glm::dot(area_vector(mesh, i), glm::dvec3(mesh.positions[mesh.triangles[i].x])),
                  0);
    }
}

TEST(Mesh, JoiningFlatAndSmoothPartsKeepsBothLooks) {
    Mesh mesh = shapes::quad(1, 1);
    append(mesh, shapes::sphere(1, 1), Affine{}, 1);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.slots.size(), mesh.triangles.size());
    EXPECT_EQ(mesh.slot(0), 0);
    EXPECT_EQ(mesh.slot(2), 1);
    EXPECT_NEAR(mesh.normals[mesh.triangles[0].x].z, 1, 1e-6);
    EXPECT_NO_THROW(check(mesh));
}

TEST(Mesh, JoiningPartsWithAndWithoutColorsLeavesTheOthersWhite) {
    Mesh plain = shapes::cube();
    Mesh red = shapes::cube();
    red.colors.assign(red.positions.size(), {1, 0, 0, 1});
    Mesh both = plain;
    append(both, red, Affine{});
    append(both, plain, Affine{});
    ASSERT_NO_THROW(check(both));
    ASSERT_EQ(both.colors.size(), both.positions.size());
    EXPECT_EQ(both.colors.front(), glm::vec4(1));
    EXPECT_EQ(both.colors[plain.positions.size()], glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(both.colors.back(), glm::vec4(1));
}

TEST(Mesh, WeldJoinsNegativeZero) {
    Mesh mesh;
    mesh.positions = {{0.0f, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}};
    mesh.triangles = {{0, 1, 2}};
    EXPECT_EQ(weld(mesh), (std::vector<uint32_t>{0, 0, 2}));
}

TEST(Mesh, HashChangesWithEveryArray) {
    const Mesh mesh = shapes::cube();
    Mesh moved = mesh;
    moved.positions[0].x += 1e-6f;
    Mesh slotted = mesh;
    slotted.slots.assign(mesh.triangles.size(), 0);
    EXPECT_EQ(hash_of(mesh), hash_of(shapes::cube()));
    EXPECT_NE(hash_of(mesh), hash_of(moved));
    Mesh colored = mesh;
    colored.colors.assign(mesh.positions.size(), glm::vec4(1));
    EXPECT_NE(hash_of(mesh), hash_of(slotted));
    EXPECT_NE(hash_of(mesh), hash_of(colored));
}
