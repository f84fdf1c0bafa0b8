// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how fans that share an edge are told apart.
#include "approximate/pinches.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>

using namespace lodestone;
using namespace lodestone::approximate;

namespace {

std::map<int, int> edges_by_uses(const CollapseMesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            ++uses[std::minmax(uint32_t{t[i]}, uint32_t{t[(i + 1) % 3]})];
    }
    std::map<int, int> out;
    for (const auto& [edge, count] : uses)
        ++out[count];
    return out;
}

/// Closed: four triangles of four vertices.
void add_tetrahedron(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    for (const Triangle& t :
         {Triangle(a, b, c), Triangle(a, d, b), Triangle(b, d, c), Triangle(c, d, a)})
        mesh.triangles.push_back(t);
}

}  // namespace

TEST(Pinches, SolidsThatShareAnEdgeGetOneEach) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    add_tetrahedron(mesh, 0, 1, 2, 3);
    add_tetrahedron(mesh, 0, 1, 4, 5);
    CollapseMesh open_mesh = open(mesh, {});
    ASSERT_EQ(edges_by_uses(open_mesh), (std::map<int, int>{{2, 10}, {4, 1}}));
    cut_pinches(open_mesh);
    EXPECT_EQ(edges_by_uses(open_mesh), (std::map<int, int>{{2, 12}}));
    EXPECT_EQ(open_mesh.points.size(), 8u);
    EXPECT_EQ(open_mesh.ids.size(), 8u);
    EXPECT_EQ(open_mesh.parts.size(), 8u);
    EXPECT_EQ(open_mesh.merged.size(), open_mesh.sources.size());
    for (size_t v = 6; v < 8; ++v) {
        EXPECT_LT(open_mesh.sources[open_mesh.ids[v]], 2u);
        for (size_t other = 0; other < v; ++other)
            EXPECT_NE(open_mesh.points[v], open_mesh.points[other]);
    }
}

TEST(Pinches, RowsOfEdgesAreCutFromTheirEnds) {
    // Two bars of three pieces side by side share the four vertices of a row.
    Mesh mesh;
    for (uint32_t i = 0; i < 4; ++i) {
        const auto z = static_cast<float>(i);
        mesh.positions.insert(mesh.positions.end(),
                              {{0, 0, z}, {1, 0, z}, {1, 1, z}, {-1, 0, z}, {-1, -1, z}});
    }
    for (const uint32_t side : {1u, 3u}) {
        const auto at = [&](uint32_t i, uint32_t n) { return 5 * i + (n == 0 ? 0 : side + n - 1); };
        for (uint32_t i = 0; i < 3; ++i) {
            for (uint32_t n = 0; n < 3; ++n) {
                const uint32_t next = (n + 1) % 3;
                mesh.triangles.emplace_back(at(i, n), at(i, next), at(i + 1, next));
                mesh.triangles.emplace_back(at(i, n), at(i + 1, next), at(i + 1, n));
            }
        }
        mesh.triangles.emplace_back(at(0, 0), at(0, 2), at(0, 1));
        mesh.triangles.emplace_back(at(3, 0), at(3, 1), at(3, 2));
    }
    CollapseMesh open_mesh = open(mesh, {});
    ASSERT_EQ(edges_by_uses(open_mesh)[4], 3);
    cut_pinches(open_mesh);
    EXPECT_EQ(edges_by_uses(open_mesh), (std::map<int, int>{{2, 60}}));
    EXPECT_EQ(open_mesh.points.size(), 24u);
}

TEST(Pinches, WallsThatCrossStayTogether) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}};
    CollapseMesh open_mesh = open(mesh, {});
    cut_pinches(open_mesh);
    EXPECT_EQ(open_mesh.points.size(), 6u);
    EXPECT_EQ(edges_by_uses(open_mesh)[4], 1);
}
