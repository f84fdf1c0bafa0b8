// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which sides of a mesh count as visible: closed parts one, open ones both; and when nothing
// can hide anything.
#include "measure/visible/outside_sides.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;
using measure::OutsideSides;
using measure::VisibleSide;

namespace {

OutsideSides sides_of(const Mesh& mesh) {
    return measure::sides_of(mesh, ray::MeshScene(mesh));
}

Affine at(double x, double y, double z) {
    return {glm::dmat3(1.0), {x, y, z}};
}

std::vector<VisibleSide> all(const Mesh& mesh, VisibleSide side) {
    std::vector<VisibleSide> out(mesh.triangles.size(), side);
    return out;
}

/// A square ring, as a picture frame: closed, with a hole through it.
Mesh frame() {
    Mesh mesh;
    const float radii[2] = {2, 1};
    for (const float z : {0.0f, 1.0f}) {
        for (const float r : radii) {
            for (int corner = 0; corner < 4; ++corner)
                mesh.positions.emplace_back(corner == 1 || corner == 2 ? r : -r,
                                            corner >= 2 ? r : -r, z);
        }
    }
    const auto wall = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(a, c, d);
    };
    for (uint32_t i = 0; i < 4; ++i) {
        const uint32_t j = (i + 1) % 4;
        wall(i, j, 8 + j, 8 + i);            // outer
        wall(4 + j, 4 + i, 12 + i, 12 + j);  // inner
        wall(8 + i, 8 + j, 12 + j, 12 + i);  // top
        wall(j, i, 4 + i, 4 + j);            // bottom
    }
    return mesh;
}

}  // namespace

TEST(OutsideSides, EmptyMeshHasNone) {
    const OutsideSides none = sides_of(Mesh{});
    EXPECT_TRUE(none.of.empty());
    EXPECT_EQ(none.parts, 0u);
    EXPECT_FALSE(none.hides_nothing);
}

TEST(OutsideSides, OfAClosedBodyIsTheOuterOne) {
    Mesh cube = shapes::cube();
    EXPECT_EQ(sides_of(cube).of, all(cube, VisibleSide::Front));
    for (Triangle& t : cube.triangles)
        std::swap(t.y, t.z);
    const OutsideSides turned = sides_of(cube);
    EXPECT_EQ(turned.of, all(cube, VisibleSide::Back));
    EXPECT_TRUE(turned.hides_nothing);
    EXPECT_EQ(turned.parts, 1u);
    EXPECT_FALSE(turned.may_coincide);
}

TEST(OutsideSides, OfAnOpenSheetAreBoth) {
    const Mesh quad = shapes::quad(2, 1);
    EXPECT_EQ(sides_of(quad).of, all(quad, VisibleSide::Both));
    EXPECT_TRUE(sides_of(quad).hides_nothing);
    EXPECT_FALSE(sides_of(shapes::terrain(8)).hides_nothing) << "not flat";
    EXPECT_TRUE(sides_of(shapes::fan()).may_coincide) << "not manifold";
}

TEST(OutsideSides, AreFoundPartByPart) {
    Mesh mesh = shapes::cube();
    append(mesh, shapes::quad(1, 1), at(5, 0, 0));
    const OutsideSides sides = sides_of(mesh);
    EXPECT_EQ(sides.parts, 2u);
    EXPECT_TRUE(sides.may_coincide);
    EXPECT_FALSE(sides.hides_nothing);
    for (size_t i = 0; i < 12; ++i)
        EXPECT_EQ(sides.of[i], VisibleSide::Front) << i;
    EXPECT_EQ(sides.of[12], VisibleSide::Both);
}

TEST(OutsideSides, OnlyConvexBodiesHideNothing) {
    EXPECT_TRUE(sides_of(shapes::sphere(1, 5)).hides_nothing);
    EXPECT_TRUE(sides_of(shapes::ellipsoid({3, 1, 0.2}, 4)).hides_nothing);
    const OutsideSides ring = sides_of(frame());
    EXPECT_EQ(ring.of, all(frame(), VisibleSide::Front));
    EXPECT_FALSE(ring.hides_nothing);
    Mesh dented = shapes::sphere(1, 3);
    dented.positions[7] *= 0.8f;
    EXPECT_FALSE(sides_of(dented).hides_nothing);
}

TEST(OutsideSides, TinyAndFarBodiesAreJudgedAlike) {
    for (const double scale : {1e-12, 1e12}) {
        Mesh mesh;
        append(mesh, shapes::sphere(1, 3), {glm::dmat3(scale), {}});
        EXPECT_TRUE(sides_of(mesh).hides_nothing) << scale;
    }
    Mesh far;
    append(far, shapes::cube(), at(0x1p20, 0x1p20, 0));
    EXPECT_TRUE(sides_of(far).hides_nothing);
}

// The tips of turned shapes were holes of a nanometre, and both sides of all of it counted.
TEST(OutsideSides, TipWithAHoleOfNoSizeIsClosed) {
    Mesh cone;
    for (int i = 0; i < 16; ++i) {
        const float x = std::cos(0.3926991f * static_cast<float>(i));
        const float y = std::sin(0.3926991f * static_cast<float>(i));
        cone.positions.emplace_back(1e-9f * x, 1e-9f * y, 2.0f);
        cone.positions.emplace_back(x, y, 0.0f);
        cone.positions.emplace_back(1e-9f * x, 1e-9f * y, 0.0f);
    }
    for (uint32_t i = 0; i < 16; ++i) {
        const uint32_t a = 3 * i;
        const uint32_t b = 3 * ((i + 1) % 16);
        for (const uint32_t ring : {0u, 1u}) {
            cone.triangles.emplace_back(a + ring, a + ring + 1, b + ring + 1);
            cone.triangles.emplace_back(a + ring, b + ring + 1, b + ring);
        }
    }
    const OutsideSides sides = sides_of(cone);
    EXPECT_TRUE(sides.hides_nothing);
    EXPECT_EQ(sides.of[0], VisibleSide::Front);
}

TEST(OutsideSides, OfWhatRaysPassThroughAreBoth) {
    const Mesh cube = shapes::cube();
    Material veil;
    veil.alpha_mode = AlphaMode::Blend;
    veil.alpha = 0.5;
    image::TexelCache texels;
    const std::vector<Material> materials{veil};
    const ray::MeshScene scene(cube, std::make_shared<const ray::MeshSkin>(materials, texels));
    const OutsideSides sides = measure::sides_of(cube, scene);
    EXPECT_EQ(sides.of, all(cube, VisibleSide::Both));
    EXPECT_FALSE(sides.hides_nothing);
}

TEST(OutsideSides, BrokenTrianglesDoNoHarm) {
    Mesh mesh = shapes::cube();
    mesh.normals.clear();
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
    const auto last = static_cast<uint32_t>(mesh.positions.size() - 1);
    mesh.triangles.emplace_back(0, 1, last);
    mesh.triangles.emplace_back(0, 0, 1);
    EXPECT_EQ(sides_of(mesh).of[0], VisibleSide::Front) << "they are not there";
    Mesh nothing;
    nothing.positions.assign(3, mesh.positions[last]);
    nothing.triangles = {{0, 1, 2}};
    EXPECT_EQ(sides_of(nothing).of.size(), 1u);
}
