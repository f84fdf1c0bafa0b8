// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which meshes are written without a tree over their triangles.
#include "povray_export/mesh/mesh_writer.h"
#include "scenes/fine_grids.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

bool has_tree(const Mesh& mesh) {
    const std::string text = povray::mesh_text(mesh, nullptr, "M", {});
    EXPECT_NE(text.find("face_indices"), std::string::npos);
    return text.find("hierarchy off") == std::string::npos;
}

/// A cone without a bottom.
Mesh cone(uint32_t sides, double height = 1.5) {
    Mesh mesh;
    for (uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * kPi * i / sides;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
        mesh.triangles.push_back({i, (i + 1) % sides, sides});
    }
    mesh.positions.emplace_back(0, 0, height);
    return mesh;
}

}  // namespace

TEST(MeshWriter, NothingIsWrittenOfAMeshWithoutArea) {
    EXPECT_EQ(povray::mesh_text({}, nullptr, "M", {}), "");
    Mesh line = cone(3);
    for (glm::vec3& at : line.positions)
        at.y = at.z = 0;
    EXPECT_EQ(povray::mesh_text(line, nullptr, "M", {}), "");
}

TEST(MeshWriter, FewTrianglesHaveNoTree) {
    EXPECT_FALSE(has_tree(shapes::cube()));
    EXPECT_FALSE(has_tree(shapes::quad(1, 1)));
    EXPECT_TRUE(has_tree(shapes::grid(3)));
}

// Rays to the lamps of a Christmas tree took a quarter longer through the trees of its cones.
TEST(MeshWriter, SteepConesHaveNoTree) {
    for (const uint32_t sides : {12u, 24u, 96u}) {
        EXPECT_FALSE(has_tree(cone(sides))) << sides;
        EXPECT_FALSE(has_tree(shapes::moved(cone(sides), {300, -20, 7}))) << sides;
    }
    EXPECT_TRUE(has_tree(cone(97)));
    EXPECT_TRUE(has_tree(cone(24, 0)));
    Mesh closed = cone(24);
    append(closed, cone(24, 0), Affine{});
    EXPECT_TRUE(has_tree(closed));
    EXPECT_TRUE(has_tree(shapes::seamed_cylinder(16, 1)));
    EXPECT_TRUE(has_tree(shapes::sphere(1, 1)));  // 80 triangles
    EXPECT_TRUE(has_tree(shapes::boxes(8)));      // 96, far from each other
}
