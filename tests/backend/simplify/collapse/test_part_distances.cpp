// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how far parts of a mesh are said to lie from what is left without them.
#include "geometry/closest_on_triangle.h"
#include "simplify/collapse/part_distances.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

using namespace lodestone;
using namespace lodestone::simplify;

namespace {

/// A right triangle at a place, with legs along x and y; a part of its own.
void add_triangle(Mesh& mesh, const glm::vec3& at, float legs = 10) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::vec3& corner : {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)})
        mesh.positions.push_back(at + legs * corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
}

/// The distances in metres of triangles that share no corner, ranked as they come.
std::vector<double> distances_of(const Mesh& mesh) {
    const CollapseMesh opened = open_collapse_mesh(mesh, Job());
    std::vector<uint32_t> ranks(opened.part_count, 0);
    for (const Triangle& t : opened.triangles)
        ranks[opened.parts[t.x]] = opened.sources[opened.ids[t.x]] / 3;
    const PartDistances distances(opened, ranks);
    std::vector<double> out;
    for (uint32_t rank = 0; rank + 1 < mesh.triangles.size(); ++rank)
        out.push_back(opened.scale * std::sqrt(distances.farthest(rank, 0)));
    return out;
}

}  // namespace

TEST(PartDistances, APartIsAsFarAsItsFarthestCorner) {
    Mesh mesh;
    add_triangle(mesh, {0, 0, 0});
    add_triangle(mesh, {0, 0, 3});
    EXPECT_NEAR(distances_of(mesh).at(0), 3, 1e-6);
    Mesh beside;
    add_triangle(beside, {0, 0, 0});
    add_triangle(beside, {4, -3, 0});
    // From the corner at 0 10 0 to that at 4 7 0.
    EXPECT_NEAR(distances_of(beside).at(0), 5, 1e-6);
}

TEST(PartDistances, WhatIsCheaperDoesNotCountAsLeft) {
    Mesh mesh;
    add_triangle(mesh, {0, 0, 0});
    add_triangle(mesh, {0, 0, 1});
    add_triangle(mesh, {0, 0, 5});
    const std::vector<double> found = distances_of(mesh);
    EXPECT_NEAR(found.at(0), 1, 1e-6);
    EXPECT_NEAR(found.at(1), 4, 1e-6);
}

TEST(PartDistances, APartIsNoFartherThanItIsLarge) {
    Mesh mesh;
    add_triangle(mesh, {0, 0, 0}, 1);
    add_triangle(mesh, {0, 0, 1000});
    EXPECT_NEAR(distances_of(mesh).at(0), std::sqrt(2.0), 1e-6);
}

TEST(PartDistances, TheTipOfAMastOnARoofIsLookedAt) {
    Mesh mesh;
    add_triangle(mesh, {-5, -5, 0}, 100);  // the roof
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    constexpr uint32_t kSteps = 100;
    for (uint32_t i = 0; i <= kSteps; ++i) {
        mesh.positions.emplace_back(0, 0, 0.1F * static_cast<float>(i));
        mesh.positions.emplace_back(0.1F, 0, 0.1F * static_cast<float>(i));
    }
    for (uint32_t i = 0; i < kSteps; ++i)
        mesh.triangles.emplace_back(first + 2 * i, first + 2 * i + 1, first + 2 * i + 2);
    for (uint32_t i = 0; i < kSteps; ++i)
        mesh.triangles.emplace_back(first + 2 * i + 1, first + 2 * i + 3, first + 2 * i + 2);
    const CollapseMesh opened = open_collapse_mesh(mesh, Job());
    ASSERT_EQ(opened.part_count, 2U);
    std::vector<uint32_t> ranks(2, 0);
    for (const Triangle& t : opened.triangles) {
        if (opened.sources[opened.ids[t.x]] < 3)
            ranks[opened.parts[t.x]] = 1;
    }
    EXPECT_NEAR(opened.scale * std::sqrt(PartDistances(opened, ranks).farthest(0, 0)), 10, 1e-4);
}

TEST(PartDistances, AtLeastWhatIsGiven) {
    Mesh mesh;
    add_triangle(mesh, {0, 0, 0});
    add_triangle(mesh, {0, 0, 1});
    const CollapseMesh opened = open_collapse_mesh(mesh, Job());
    const std::vector<uint32_t> ranks{0, 1};
    EXPECT_EQ(PartDistances(opened, ranks).farthest(0, 9.0), 9.0);
}

TEST(PartDistances, AreThoseOfASearchThroughAllTriangles) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-30, 30);
    Mesh mesh;
    for (int i = 0; i < 300; ++i)
        add_triangle(mesh, {place(random), place(random), place(random)});
    const std::vector<double> found = distances_of(mesh);
    for (size_t rank = 0; rank < found.size(); ++rank) {
        double farthest = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 from(mesh.positions[mesh.triangles[rank][corner]]);
            double nearest = 1e30;
            for (size_t i = rank + 1; i < mesh.triangles.size(); ++i) {
                const Triangle& t = mesh.triangles[i];
                const glm::dvec3 there =
                    geometry::closest_on_triangle(from, glm::dvec3(mesh.positions[t.x]),
                                                  glm::dvec3(mesh.positions[t.y]),
                                                  glm::dvec3(mesh.positions[t.z]))
                        .point;
                nearest = std::min(nearest, glm::length(there - from));
            }
            farthest = std::max(farthest, nearest);
        }
        EXPECT_NEAR(found[rank], std::min(farthest, 10 * std::sqrt(2.0)), 1e-4) << rank;
    }
}
