// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how fans that share an edge are told apart.
#include "simplify/collapse/mesh_tunnels.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <map>

using namespace lodestone;
using namespace lodestone::simplify;

namespace {

/// Of a mesh of either kind.
template <typename AnyMesh>
std::map<int, int> edges_by_uses(const AnyMesh& mesh) {
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
    CollapseMesh open_mesh = open_collapse_mesh(mesh, {});
    ASSERT_EQ(edges_by_uses(open_mesh), (std::map<int, int>{{2, 10}, {4, 1}}));
    cut_tunnels(open_mesh, false);
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
    CollapseMesh open_mesh = open_collapse_mesh(mesh, {});
    ASSERT_EQ(edges_by_uses(open_mesh)[4], 3);
    cut_tunnels(open_mesh, false);
    EXPECT_EQ(edges_by_uses(open_mesh), (std::map<int, int>{{2, 60}}));
    EXPECT_EQ(open_mesh.points.size(), 24u);
}

TEST(Pinches, WallsThatCrossStayTogether) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}};
    CollapseMesh open_mesh = open_collapse_mesh(mesh, {});
    cut_tunnels(open_mesh, false);
    EXPECT_EQ(open_mesh.points.size(), 6u);
    EXPECT_EQ(edges_by_uses(open_mesh)[4], 1);
}

TEST(Pinches, ShellsThatTouchAlongALoopPartIntoSolids) {
    // A double pyramid within a larger one of the same waist, turned inside out.
    Mesh mesh;
    mesh.positions = {{1, 0, 0},  {-1, 1, 0}, {-1, -1, 0}, {0, 0, 2},
                      {0, 0, -2}, {0, 0, 1},  {0, 0, -1}};
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t next = (i + 1) % 3;
        for (const Triangle& t : {Triangle(i, next, 3), Triangle(next, i, 4), Triangle(next, i, 5),
                                  Triangle(i, next, 6)})
            mesh.triangles.push_back(t);
    }
    CollapseMesh open_mesh = open_collapse_mesh(mesh, {});
    ASSERT_EQ(edges_by_uses(open_mesh), (std::map<int, int>{{2, 12}, {4, 3}}));
    Adjacency adjacency;
    adjacency.build(open_mesh);
    EXPECT_TRUE(has_tunnels(open_mesh, adjacency));
    cut_tunnels(open_mesh, false);
    EXPECT_EQ(edges_by_uses(open_mesh)[4], 3);
    cut_tunnels(open_mesh, true);
    EXPECT_EQ(edges_by_uses(open_mesh), (std::map<int, int>{{2, 18}}));
    EXPECT_EQ(open_mesh.points.size(), 10u);
    adjacency.build(open_mesh);
    EXPECT_FALSE(has_tunnels(open_mesh, adjacency));
    // The upper shell has the upper apexes of both.
    for (const Triangle& t : open_mesh.triangles) {
        for (const Triangle& other : open_mesh.triangles) {
            bool shares = false;
            for (int i = 0; i < 9; ++i)
                shares |= t[i / 3] == other[i % 3];
            const auto height = [&](const Triangle& of) {
                return open_mesh.points[of.x].z + open_mesh.points[of.y].z +
                       open_mesh.points[of.z].z;
            };
            EXPECT_TRUE(!shares || height(t) * height(other) > 0);
        }
    }
}

TEST(Pinches, PlatesFullOfHolesGetNoEdgesOfMoreThanTwoTriangles) {
    // Square holes, and slots through the thickness that cross them.
    constexpr int kSide = 61;
    constexpr int kHigh = 5;
    const auto solid = [](int x, int y, int z) {
        const bool inside = x >= 0 && y >= 0 && z >= 0 && x < kSide && y < kSide && z < kHigh;
        return inside && !(x % 4 == 2 && y % 4 == 2) && !(y % 4 == 2 && z == 2) &&
               !(x % 4 == 2 && z == 2);
    };
    Mesh mesh;
    std::map<std::array<int, 3>, uint32_t> vertices;
    const auto corner = [&](const std::array<int, 3>& at) {
        const auto next = static_cast<uint32_t>(mesh.positions.size());
        const auto [entry, fresh] = vertices.try_emplace(at, next);
        if (fresh)
            mesh.positions.emplace_back(at[0], at[1], at[2]);
        return entry->second;
    };
    for (int i = 0; i < kSide * kSide * kHigh; ++i) {
        const std::array<int, 3> cell{i % kSide, i / kSide % kSide, i / kSide / kSide};
        for (size_t axis = 0; axis < 3 && solid(cell[0], cell[1], cell[2]); ++axis) {
            for (const int side : {0, 1}) {
                std::array<int, 3> other = cell;
                other[axis] += 2 * side - 1;
                if (solid(other[0], other[1], other[2]))
                    continue;
                std::array<uint32_t, 4> quad{};
                for (size_t n = 0; n < 4; ++n) {
                    std::array<int, 3> at = cell;
                    at[axis] += side;
                    at[(axis + 1) % 3] += n == 1 || n == 2;
                    at[(axis + 2) % 3] += n >= 2;
                    quad[n] = corner(at);
                }
                if (side == 0)
                    std::swap(quad[1], quad[3]);
                mesh.triangles.emplace_back(quad[0], quad[1], quad[2]);
                mesh.triangles.emplace_back(quad[0], quad[2], quad[3]);
            }
        }
    }
    ASSERT_EQ(edges_by_uses(open_collapse_mesh(mesh, {})).size(), 1u);
    for (const size_t part : {10, 20, 50}) {
        const Mesh level = simplify_mesh(mesh, mesh.triangles.size() / part);
        for (const auto& [uses, count] : edges_by_uses(level))
            EXPECT_EQ(uses, 2) << count << " edges at " << level.triangles.size();
    }
}
