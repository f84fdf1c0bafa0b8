// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which triangles count as seen from outside: none that is, none missed between others.
#include "measure/visible/seen_from_outside.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;

// A group's shell lost the boards of its roofs, and its levels had holes where tiles had gone.
TEST(SeenFromOutside, BoardBetweenTilesIsSeenThroughTheirGaps) {
    constexpr int kSide = 24;
    constexpr float kTile = 0.995f;  // of a cell's width
    Mesh mesh = shapes::quad(kSide, kSide);
    for (const double height : {-0.002, 0.002}) {
        for (int i = 0; i < kSide * kSide; ++i)
            append(mesh, shapes::quad(kTile, kTile),
                   {glm::dmat3(1.0), {i % kSide, i / kSide, height}});
    }
    const ray::MeshScene scene(mesh);
    for (const uint64_t seed : {1u, 2u, 3u}) {
        const std::vector<uint8_t> seen = measure::seen_from_outside(mesh, scene, 24, seed);
        EXPECT_EQ(seen, std::vector<uint8_t>(seen.size(), 1)) << seed;
    }
}

TEST(SeenFromOutside, InteriorTrianglesAreNotSeenAndOuterOnesAre) {
    Mesh mesh = shapes::box(glm::dvec3(0), glm::dvec3(2));
    append(mesh, shapes::sphere(0.5, 3), {glm::dmat3(1.0), glm::dvec3(1)});
    append(mesh, shapes::quad(1, 1), {glm::dmat3(1.0), {0.5, 0.5, 0.25}});
    append(mesh, shapes::quad(1, 1), {glm::dmat3(1.0), {5, 5, 5}});
    mesh.triangles.emplace_back(0, 0, 0);
    const std::vector<uint8_t> seen = measure::seen_from_outside(mesh, ray::MeshScene(mesh), 16, 1);
    const size_t sphere = 1280;
    for (size_t i = 0; i < 12; ++i)
        EXPECT_EQ(seen[i], 1) << i;
    for (size_t i = 12; i < 12 + sphere + 2; ++i)
        EXPECT_EQ(seen[i], 0) << i;
    for (size_t i = 12 + sphere + 2; i < seen.size(); ++i)
        EXPECT_EQ(seen[i], 1) << i;
}

// Chairs seen from above had holes: of triangles that see a little of the sky alone two in three
// were left out.
TEST(SeenFromOutside, ThingsInADeepBoxAreSeenFromItsOpening) {
    Mesh mesh = shapes::box({0, 0, 0}, {3, 3, 0.1});
    append(mesh, shapes::box({0, 0, 0.1}, {3, 0.1, 4}), {});
    append(mesh, shapes::box({0, 2.9, 0.1}, {3, 3, 4}), {});
    append(mesh, shapes::box({0, 0.1, 0.1}, {0.1, 2.9, 4}), {});
    append(mesh, shapes::box({2.9, 0.1, 0.1}, {3, 2.9, 4}), {});
    const size_t first = mesh.triangles.size();
    append(mesh, shapes::sphere(0.4, 3), {glm::dmat3(1.0), {1.5, 1.5, 0.6}});
    size_t up = 0;
    size_t missed = 0;
    const std::vector<uint8_t> seen = measure::seen_from_outside(mesh, ray::MeshScene(mesh), 16, 1);
    for (size_t i = first; i < seen.size(); ++i) {
        const glm::dvec3 normal = glm::normalize(area_vector(mesh, i));
        if (normal.z < 0.25)
            continue;
        ++up;
        missed += seen[i] == 0 ? 1 : 0;
    }
    EXPECT_GT(up, 400u);
    EXPECT_LE(missed, up / 50);
}
