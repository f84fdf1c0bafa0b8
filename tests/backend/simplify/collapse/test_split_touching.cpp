// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what simplification does to holes, handles and parts, with and without keeping topology.
#include "scenes/small_meshes.h"
#include "simplify/fit/edge_flips.h"
#include "simplify/simplify.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <set>

using namespace lodestone;
using simplify::simplify_mesh;
using simplify::SimplifyMode;
using simplify::SimplifyOptions;

namespace {

/// Of a mesh whose vertices are not split.
struct Topology {
    long euler = 0;  // vertices - edges + triangles
    size_t open = 0;
    size_t non_manifold = 0;
};

Topology topology_of(const Mesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    std::set<uint32_t> vertices;
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            vertices.insert(t[i]);
            const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
            ++uses[{low, high}];
        }
    }
    Topology out;
    out.euler = static_cast<long>(vertices.size()) - static_cast<long>(uses.size()) +
                static_cast<long>(mesh.triangles.size());
    for (const auto& [edge, count] : uses) {
        out.open += count == 1;
        out.non_manifold += count > 2;
    }
    return out;
}

/// A plate of cells x cells boxes, of which every other one both ways is left out: so many tunnels.
Mesh drilled_plate(uint32_t cells) {
    Mesh mesh;
    const uint32_t row = cells + 1;
    for (int side = 0; side < 2; ++side) {
        for (uint32_t y = 0; y < row; ++y) {
            for (uint32_t x = 0; x < row; ++x)
                mesh.positions.emplace_back(x, y, side == 0 ? 0.0f : 0.4f);
        }
    }
    const auto at = [&](uint32_t x, uint32_t y, uint32_t side) {
        return side * row * row + y * row + x;
    };
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(a, c, d);
    };
    const auto solid = [&](int x, int y) {
        const int count = static_cast<int>(cells);
        return x >= 0 && y >= 0 && x < count && y < count && !(x % 2 == 1 && y % 2 == 1);
    };
    for (uint32_t y = 0; y < cells; ++y) {
        for (uint32_t x = 0; x < cells; ++x) {
            const int column = static_cast<int>(x);
            const int line = static_cast<int>(y);
            if (!solid(column, line))
                continue;
            quad(at(x, y, 0), at(x, y + 1, 0), at(x + 1, y + 1, 0), at(x + 1, y, 0));
            quad(at(x, y, 1), at(x + 1, y, 1), at(x + 1, y + 1, 1), at(x, y + 1, 1));
            if (!solid(column, line - 1))
                quad(at(x, y, 0), at(x + 1, y, 0), at(x + 1, y, 1), at(x, y, 1));
            if (!solid(column, line + 1))
                quad(at(x + 1, y + 1, 0), at(x, y + 1, 0), at(x, y + 1, 1), at(x + 1, y + 1, 1));
            if (!solid(column - 1, line))
                quad(at(x, y + 1, 0), at(x, y, 0), at(x, y, 1), at(x, y + 1, 1));
            if (!solid(column + 1, line))
                quad(at(x + 1, y, 0), at(x + 1, y + 1, 0), at(x + 1, y + 1, 1), at(x + 1, y, 1));
        }
    }
    return mesh;
}

/// Vertices at one position are one.
Mesh welded(Mesh mesh) {
    const std::vector<uint32_t> first = weld(mesh);
    for (Triangle& t : mesh.triangles)
        t = Triangle(first[t.x], first[t.y], first[t.z]);
    return mesh;
}

SimplifyOptions keeping(SimplifyMode mode) {
    SimplifyOptions options;
    options.mode = mode;
    options.keep_topology = true;
    return options;
}

}  // namespace

TEST(Topology, TorusKeepsItsHandleHoweverFewTrianglesAreWanted) {
    const Mesh ring = shapes::torus(48, 24);
    for (const SimplifyMode mode : {SimplifyMode::Fast, SimplifyMode::Best}) {
        for (const size_t target : {200u, 1u}) {
            const Mesh out = simplify_mesh(ring, target, keeping(mode));
            const Topology found = topology_of(out);
            EXPECT_EQ(found.euler, 0) << target;
            EXPECT_EQ(found.open, 0u) << target;
            EXPECT_EQ(found.non_manifold, 0u) << target;
            EXPECT_GE(out.triangles.size(), 14u) << "no torus has fewer";
            EXPECT_LE(out.triangles.size(), 200u) << target;
        }
    }
}

TEST(Topology, TunnelsThatCloseMakeNoEdgeNonManifold) {
    const Mesh plate = drilled_plate(21);
    for (const SimplifyMode mode : {SimplifyMode::Fast, SimplifyMode::Best}) {
        for (const size_t target : {1000u, 600u, 300u, 100u}) {
            SimplifyOptions options;
            options.mode = mode;
            const Mesh out = simplify_mesh(plate, target, options);
            EXPECT_LE(out.triangles.size(), target);
            const Topology found = topology_of(welded(out));
            EXPECT_EQ(found.open, 0u) << target;
            EXPECT_EQ(found.non_manifold, 0u) << target;
        }
    }
}

TEST(Topology, DrilledPlateKeepsEveryTunnelOrReachesTheTarget) {
    const Mesh plate = drilled_plate(9);
    ASSERT_EQ(topology_of(plate).euler, 2 - 2 * 16);
    ASSERT_EQ(topology_of(plate).open, 0u);
    const Mesh kept = simplify_mesh(plate, 8, keeping(SimplifyMode::Fast));
    EXPECT_EQ(topology_of(kept).euler, 2 - 2 * 16);
    EXPECT_EQ(topology_of(kept).open, 0u);
    EXPECT_EQ(topology_of(kept).non_manifold, 0u);
    EXPECT_LT(kept.triangles.size(), plate.triangles.size() / 2);
    EXPECT_LE(simplify_mesh(plate, 8).triangles.size(), 8u);
}

TEST(Topology, HoleInASheetStaysAHole) {
    Mesh sheet = drilled_plate(3);
    sheet.triangles.clear();
    for (uint32_t y = 0; y < 3; ++y) {
        for (uint32_t x = 0; x < 3; ++x) {
            const uint32_t a = 4 * y + x;
            if (x == 1 && y == 1)
                continue;
            sheet.triangles.emplace_back(a, a + 1, a + 5);
            sheet.triangles.emplace_back(a, a + 5, a + 4);
        }
    }
    const Mesh out = simplify_mesh(sheet, 1, keeping(SimplifyMode::Fast));
    EXPECT_EQ(topology_of(out).euler, 0) << "a ring";
    EXPECT_EQ(topology_of(out).non_manifold, 0u);
}

TEST(Topology, PartsStayWithTheOptionAndGoWithoutIt) {
    Mesh two = shapes::torus(24, 12);
    const auto count = static_cast<uint32_t>(two.positions.size());
    const Mesh small = shapes::torus(24, 12);
    for (const glm::vec3& p : small.positions)
        two.positions.push_back(0.01f * p + glm::vec3(5, 0, 0));
    for (const Triangle& t : small.triangles)
        two.triangles.emplace_back(t.x + count, t.y + count, t.z + count);
    const auto reach = [](const Mesh& mesh) {
        float most = 0;
        for (const glm::vec3& p : mesh.positions)
            most = std::max(most, p.x);
        return most;
    };
    EXPECT_GT(reach(simplify_mesh(two, 60, keeping(SimplifyMode::Fast))), 4);
    EXPECT_LT(reach(simplify_mesh(two, 60)), 4);
}

TEST(Topology, EdgeAcrossAFoldFlipsOntoIt) {
    // A sheet folded along the diagonal of a square, of which only the corners are left.
    constexpr uint32_t kSide = 9;
    Mesh sheet;
    for (uint32_t y = 0; y < kSide; ++y) {
        for (uint32_t x = 0; x < kSide; ++x) {
            const float u = static_cast<float>(x) / (kSide - 1);
            const float v = static_cast<float>(y) / (kSide - 1);
            sheet.positions.emplace_back(u, v, -std::abs(u - v));
            const uint32_t a = y * kSide + x;
            if (x + 1 == kSide || y + 1 == kSide)
                continue;
            sheet.triangles.emplace_back(a, a + 1, a + kSide + 1);
            sheet.triangles.emplace_back(a, a + kSide + 1, a + kSide);
        }
    }
    simplify::CollapseMesh mesh = simplify::open_collapse_mesh(sheet, {});
    const std::vector<glm::dvec3> points = mesh.points;
    const uint32_t corners[4] = {0, kSide - 1, kSide * kSide - 1, kSide * (kSide - 1)};
    for (uint32_t v = 0; v < mesh.merged.size(); ++v)
        mesh.merged[v] = corners[(v % kSide > kSide / 2 ? 1 : 0) ^ (v / kSide > kSide / 2 ? 3 : 0)];
    for (const uint32_t corner : corners)
        mesh.merged[corner] = corner;
    mesh.ids.assign(corners, corners + 4);
    mesh.points = {points[corners[0]], points[corners[1]], points[corners[2]], points[corners[3]]};
    mesh.triangles = {{0, 1, 3}, {1, 2, 3}};  // cut the wrong way
    mesh.facets.clear();
    for (const Triangle& t : mesh.triangles)
        mesh.facets.emplace_back(mesh.facet_of(t));
    mesh.live = 2;
    mesh.wedges.clear();

    simplify::Adjacency adjacency;
    adjacency.build(mesh);
    simplify::FitPlaces places(mesh, sheet);
    const auto flips = [&] {
        simplify::FitSamples samples;
        simplify::sample_surface(places, adjacency, 1000, 0, {}, samples);
        EXPECT_GT(samples.size(), 100u);
        const size_t flipped = simplify::flip_edges(places, adjacency, {}, samples);
        adjacency.build(mesh);
        return flipped;
    };
    EXPECT_EQ(flips(), 1u);
    for (const Triangle& t : mesh.triangles) {
        const std::set<uint32_t> ends{t.x, t.y, t.z};
        EXPECT_TRUE(ends.count(0) == 1 && ends.count(2) == 1) << "along the fold";
        EXPECT_GT(mesh.facet_of(t).z, 0) << "as it was turned";
    }
    EXPECT_EQ(flips(), 0u) << "then it stays";
}
