// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that split edges leave no gaps, and that a split mesh is drawn as before.
#include "geometry/edge_split_mesh.h"
#include "scenes/small_meshes.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::geometry;

namespace {

/// Every `step`th edge of a mesh.
std::vector<WeldedEdge> some_edges(const EdgeSplitMesh& mesh, size_t step) {
    std::vector<WeldedEdge> edges;
    for (size_t i = 0; i < mesh.mesh().triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner)
            edges.push_back(mesh.edge(i, corner));
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<WeldedEdge> some;
    for (size_t i = 0; i < edges.size(); i += step)
        some.push_back(edges[i]);
    return some;
}

}  // namespace

TEST(EdgeSplitMesh, NoEdgesAndAnEmptyMeshStayAsTheyAre) {
    EdgeSplitMesh nothing{Mesh{}};
    EXPECT_TRUE(nothing.split({}).empty());
    EdgeSplitMesh cube(shapes::cube());
    EXPECT_EQ(cube.split({}).size(), 12u);
    EXPECT_EQ(hash_of(cube.mesh()), hash_of(shapes::cube()));
    const std::vector<WeldedEdge> strange{welded_edge(1000, 2000), ~WeldedEdge{0}};
    EXPECT_EQ(cube.split(strange).size(), 12u);
}

TEST(EdgeSplitMesh, OneTwoAndThreeEdgesMakeTwoThreeAndFourTriangles) {
    Mesh triangle;
    triangle.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    triangle.triangles = {{0, 1, 2}};
    const std::vector<WeldedEdge> edges{welded_edge(0, 1), welded_edge(0, 2), welded_edge(1, 2)};
    for (size_t i = 0; i < 3; ++i) {
        EdgeSplitMesh one(triangle);
        EXPECT_EQ(one.split(std::vector{edges[i]}).size(), 2u);
        EXPECT_NEAR(surface_area(one.mesh()), 2, 1e-6);
        std::vector<WeldedEdge> rest = edges;
        rest.erase(rest.begin() + static_cast<ptrdiff_t>(i));
        EdgeSplitMesh two(triangle);
        EXPECT_EQ(two.triangles_after(rest), 3u);
        EXPECT_EQ(two.split(rest).size(), 3u);
        EXPECT_NEAR(surface_area(two.mesh()), 2, 1e-6);
        for (size_t t = 0; t < 3; ++t)
            EXPECT_GT(area_vector(two.mesh(), t).z, 0);
    }
    EdgeSplitMesh all(triangle);
    EXPECT_EQ(all.split(edges), (std::vector<uint32_t>{0, 0, 0, 0}));
    EXPECT_NEAR(surface_area(all.mesh()), 2, 1e-6);
}

TEST(EdgeSplitMesh, AClosedMeshStaysClosedWhateverIsSplit) {
    for (const Mesh& mesh : {shapes::cube(), shapes::torus(12, 8), shapes::sphere(1, 2)}) {
        ASSERT_TRUE(closed(mesh));
        for (const size_t step : {1u, 2u, 3u, 7u}) {
            EdgeSplitMesh split(mesh);
            for (int round = 0; round < 3; ++round)
                split.split(some_edges(split, step));
            EXPECT_TRUE(closed(split.mesh())) << step;
            EXPECT_NEAR(surface_area(split.mesh()), surface_area(mesh), 1e-4 * surface_area(mesh));
            EXPECT_GT(split.mesh().triangles.size(), mesh.triangles.size());
        }
    }
}

TEST(EdgeSplitMesh, UvsColorsNormalsAndSlotsGoOn) {
    Mesh mesh = shapes::quad(2, 2);
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.colors.assign(4, glm::vec4(0.25f, 0.5f, 0.75f, 1));
    mesh.normals.assign(4, glm::vec3(0, 0, 1));
    mesh.slots = {3, 5};
    EdgeSplitMesh split(mesh);
    const std::vector<uint32_t> parents = split.split(some_edges(split, 1));
    ASSERT_EQ(parents.size(), 8u);
    check(split.mesh());
    for (size_t i = 0; i < parents.size(); ++i)
        EXPECT_EQ(split.mesh().slot(i), parents[i] == 0 ? 3 : 5);
    for (size_t i = 0; i < split.mesh().positions.size(); ++i) {
        const glm::vec3 at = split.mesh().positions[i] - split.mesh().positions[0];
        EXPECT_NEAR(split.mesh().uvs[i].x, at.x / 2, 1e-6);
        EXPECT_NEAR(split.mesh().uvs[i].y, at.y / 2, 1e-6);
        EXPECT_EQ(split.mesh().normals[i], glm::vec3(0, 0, 1));
    }
}
