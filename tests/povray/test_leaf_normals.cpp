// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the normals of cut leaves: those bent by neighbors come near the face, others stay.
#include "povray/mask_cards.h"
#include "povray_export/mesh/leaf_normals.h"

#include <glm/trigonometric.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// The normals of what a disk leaves of a card whose normals lean so far, on a side of the face.
std::vector<glm::vec3> cut_normals(const std::array<float, 4>& degrees, float side) {
    Mesh mesh = card();
    mesh.normals.clear();
    for (const float one : degrees) {
        const float angle = glm::radians(one);
        mesh.normals.emplace_back(std::sin(angle), 0, side * std::cos(angle));
    }
    const CutMesh found = cut(mesh, leaf(disk()));
    std::vector<glm::vec3> out;
    for (const Triangle& triangle : found.mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            out.push_back(found.mesh.normals[triangle[corner]]);
    }
    return out;
}

TEST(LeafNormals, LeavesSeenFlatWereBlack) {
    for (const float side : {1.0F, -1.0F}) {
        for (const float lean : {0.0F, 10.0F, 14.0F, 45.0F, 59.0F}) {
            const float expected = glm::radians(std::min(lean, 15.0F));
            const std::vector<glm::vec3> found = cut_normals({lean, lean, lean, lean}, side);
            ASSERT_FALSE(found.empty());
            for (const glm::vec3& normal : found) {
                EXPECT_NEAR(normal.x, std::sin(expected), 1e-5);
                EXPECT_NEAR(normal.y, 0, 1e-5);
                EXPECT_NEAR(normal.z, side * std::cos(expected), 1e-5);
            }
        }
    }
}

TEST(LeafNormals, NormalsThatWereGivenToALawnStay) {
    for (const glm::vec3& normal : cut_normals({89, 91, 89, 91}, 1)) {
        EXPECT_GT(normal.x, 0.999);
        EXPECT_LT(std::abs(normal.z), 0.02);
    }
    for (const glm::vec3& normal : cut_normals({70, 10, 70, 10}, 1))
        EXPECT_LT(normal.x, std::sin(glm::radians(70.0F)) + 1e-5F);
}

TEST(LeafNormals, NormalsOfLeavesWithoutAreaOrNumberStayAsTheyAre) {
    Mesh mesh = card();
    mesh.normals.assign(4, glm::vec3(std::numeric_limits<float>::quiet_NaN(), 0, 1));
    for (const bool flat : {false, true}) {
        if (flat)
            mesh.positions.assign(4, glm::vec3(0));
        const CutMesh found = cut(mesh, leaf(disk()));
        ASSERT_EQ(found.mesh.normals.size(), found.mesh.positions.size());
        for (size_t i = 4; i < found.mesh.normals.size(); ++i) {
            EXPECT_TRUE(std::isnan(found.mesh.normals[i].x));
            EXPECT_FALSE(std::isinf(found.mesh.normals[i].z));
        }
    }
}

TEST(LeafNormals, WholeLeavesKeptTheNormalsThatTheirNeighborsLost) {
    const float lean = glm::radians(45.0F);
    Mesh mesh = card();
    mesh.normals.assign(4, glm::vec3(std::sin(lean), 0, std::cos(lean)));
    const size_t corners = mesh.positions.size();
    for (const glm::vec2 at : {glm::vec2(0.48F, 0.48F), glm::vec2(0.52F, 0.48F),
                               glm::vec2(0.5F, 0.52F)}) {  // inside of the disk
        mesh.positions.emplace_back(at, 0);
        mesh.uvs.push_back(at);
        mesh.normals.push_back(mesh.normals.front());
    }
    mesh.triangles.emplace_back(corners, corners + 1, corners + 2);
    mesh.slots.resize(mesh.triangles.size());
    const CutMesh found = cut(mesh, leaf(disk()));
    for (const Triangle& triangle : found.mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_NEAR(found.mesh.normals[triangle[corner]].z, std::cos(glm::radians(15.0)), 1e-5);
    }
}

}  // namespace
