// SPDX-License-Identifier: GPL-3.0-or-later
// Guards clustering: targets kept, shape and attributes of what was joined, any input survived.
#include "base/parallel.h"
#include "base/random.h"
#include "scenes/fine_grids.h"
#include "scenes/small_meshes.h"
#include "simplify/cluster/vertex_clustering.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <set>

using namespace lodestone;
using simplify::cluster_vertices;
using namespace lodestone::shapes;

namespace {

void expect_sound(const Mesh& mesh, const Mesh& input, size_t target) {
    EXPECT_NO_THROW(check(mesh));
    EXPECT_LE(mesh.triangles.size(), target);
    EXPECT_FALSE(mesh.empty());
    EXPECT_EQ(mesh.normals.empty(), input.normals.empty());
    EXPECT_EQ(mesh.uvs.empty(), input.uvs.empty());
    EXPECT_EQ(mesh.colors.empty(), input.colors.empty());
    EXPECT_EQ(mesh.slots.empty(), input.slots.empty());
    for (const glm::vec3& p : mesh.positions)
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    for (const glm::vec3& n : mesh.normals)
        ASSERT_NEAR(glm::length(n), 1, 1e-4);
}

void expect_each_once(const Mesh& mesh) {
    const std::vector<uint32_t> welded = weld(mesh);
    std::set<std::array<uint32_t, 3>> seen;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<uint32_t, 3> corners{welded[mesh.triangles[i].x], welded[mesh.triangles[i].y],
                                        welded[mesh.triangles[i].z]};
        std::sort(corners.begin(), corners.end());
        EXPECT_TRUE(corners[0] != corners[1] && corners[1] != corners[2]);
        EXPECT_TRUE(seen.insert(corners).second) << "triangle " << i << " is there twice";
        EXPECT_GT(glm::length(area_vector(mesh, i)), 0);
    }
}

Mesh without_normals(Mesh mesh) {
    mesh.normals.clear();
    return mesh;
}

/// The mean distance of a sphere's vertices and face middles from its surface.
double off_sphere(const Mesh& mesh, double radius) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const glm::dvec3 middle =
            glm::dvec3(mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0;
        sum += std::abs(glm::length(middle) - radius);
    }
    return sum / static_cast<double>(mesh.triangles.size());
}

}  // namespace

TEST(Cluster, NothingStaysNothing) {
    EXPECT_TRUE(cluster_vertices(Mesh{}, 10).empty());
}

TEST(Cluster, ATargetOfZeroAndBadMeshesAreRefused) {
    EXPECT_THROW(cluster_vertices(cube(), 0), Error);
    Mesh bad = cube();
    bad.triangles[0].x = 1000;
    EXPECT_THROW(cluster_vertices(bad, 4), Error);
}

TEST(Cluster, ATargetNotBelowTheInputReturnsIt) {
    EXPECT_EQ(hash_of(cluster_vertices(cube(), 12)), hash_of(cube()));
}

TEST(Cluster, TwoTrianglesBecomeOne) {
    const Mesh mesh = quad(2, 1);
    expect_sound(cluster_vertices(mesh, 1), mesh, 1);
}

TEST(Cluster, EveryTargetIsKeptAndComeNearTo) {
    const Mesh mesh = without_normals(sphere(1, 5));
    ASSERT_GT(mesh.triangles.size(), 5000u);
    for (const double part : {0.9, 0.5, 0.25, 0.1, 0.05, 0.02, 0.01, 0.005}) {
        const auto target = static_cast<size_t>(part * static_cast<double>(mesh.triangles.size()));
        const Mesh level = cluster_vertices(mesh, target);
        expect_sound(level, mesh, target);
        expect_each_once(level);
        EXPECT_GE(level.triangles.size() + 8, target * 9 / 10) << target;
    }
}

TEST(Cluster, ASphereStaysASphere) {
    const Mesh mesh = without_normals(sphere(1, 5));
    EXPECT_LT(off_sphere(cluster_vertices(mesh, mesh.triangles.size() / 4), 1), 0.002);
    EXPECT_LT(off_sphere(cluster_vertices(mesh, mesh.triangles.size() / 40), 1), 0.02);
}

TEST(Cluster, ACubesEdgesStayWhereTheyAre) {
    const Mesh mesh = without_normals(fine_cube(40));
    const Mesh level = cluster_vertices(mesh, mesh.triangles.size() / 10);
    expect_sound(level, mesh, mesh.triangles.size() / 10);
    Box3 box;
    for (const glm::vec3& p : level.positions)
        box.add(glm::dvec3(p));
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(box.low[k], 0, 1e-3);
        EXPECT_NEAR(box.high[k], 1, 1e-3);
    }
    EXPECT_NEAR(surface_area(level), 6, 0.06);
}

TEST(Cluster, AnOpenSheetKeepsItsBorder) {
    const Mesh mesh = grid(60);
    const Mesh level = cluster_vertices(mesh, 200);
    expect_sound(level, mesh, 200);
    EXPECT_NEAR(surface_area(level), 1, 0.03);
}

TEST(Cluster, TheBorderBetweenSlotsStays) {
    Mesh mesh = grid(64);
    for (const Triangle& t : mesh.triangles)
        mesh.slots.push_back(
            mesh.positions[t.x].x + mesh.positions[t.y].x + mesh.positions[t.z].x < 1.5f ? 3 : 4);
    const Mesh level = cluster_vertices(mesh, 300);
    expect_sound(level, mesh, 300);
    std::array<double, 5> areas{};
    for (size_t i = 0; i < level.triangles.size(); ++i)
        areas.at(level.slot(i)) += 0.5 * glm::length(area_vector(level, i));
    EXPECT_NEAR(areas[3], 0.5, 0.03);
    EXPECT_NEAR(areas[4], 0.5, 0.03);
}

TEST(Cluster, NormalsAndTextureCoordinatesAreThoseOfTheSurface) {
    const Mesh mesh = seamed_cylinder(96, 96);
    const Mesh level = cluster_vertices(mesh, mesh.triangles.size() / 8);
    expect_sound(level, mesh, mesh.triangles.size() / 8);
    for (size_t v = 0; v < level.positions.size(); ++v) {
        const glm::vec3& p = level.positions[v];
        const glm::vec3 outward = glm::normalize(glm::vec3(p.x, p.y, 0));
        EXPECT_GT(glm::dot(level.normals[v], outward), 0.97);
        EXPECT_NEAR(level.uvs[v].y, p.z / 2, 0.05);
    }
    // The seam: no triangle may span the texture.
    for (const Triangle& t : level.triangles) {
        const auto [low, high] =
            std::minmax({level.uvs[t.x].x, level.uvs[t.y].x, level.uvs[t.z].x});
        EXPECT_LT(high - low, 0.5f);
    }
}

TEST(Cluster, SharpEdgesStaySharp) {
    const Mesh mesh = fine_cube(24);
    const Mesh level = cluster_vertices(mesh, 700);
    expect_sound(level, mesh, 700);
    size_t off = 0;
    for (const glm::vec3& n : level.normals)
        off += std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) < 0.99f ? 1 : 0;
    EXPECT_LT(off, level.normals.size() / 20);
}

TEST(Cluster, ColorsAreMixedNotInvented) {
    Mesh mesh = grid(40);
    for (const glm::vec3& p : mesh.positions)
        mesh.colors.emplace_back(p.x, p.y, 0.25f, 1.0f);
    const Mesh level = cluster_vertices(mesh, 200);
    expect_sound(level, mesh, 200);
    for (size_t v = 0; v < level.positions.size(); ++v) {
        EXPECT_NEAR(level.colors[v].x, level.positions[v].x, 0.1);
        EXPECT_NEAR(level.colors[v].y, level.positions[v].y, 0.1);
        EXPECT_EQ(level.colors[v].z, 0.25f);
    }
}

TEST(Cluster, SplitVerticesAreJoinedAsIfTheyWereOne) {
    const Mesh whole = without_normals(sphere(1, 4));
    Mesh soup;
    for (const Triangle& t : whole.triangles) {
        const auto first = static_cast<uint32_t>(soup.positions.size());
        for (int k = 0; k < 3; ++k)
            soup.positions.push_back(whole.positions[t[k]]);
        soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    const size_t target = whole.triangles.size() / 5;
    EXPECT_LT(off_sphere(cluster_vertices(soup, target), 1),
              1.1 * off_sphere(cluster_vertices(whole, target), 1));
}

TEST(Cluster, FarFromTheOriginAndTinyItIsTheSame) {
    const Mesh mesh = without_normals(sphere(1, 4));
    const size_t target = mesh.triangles.size() / 6;
    const Mesh near = cluster_vertices(mesh, target);
    for (const double scale : {1e-18, 0.25, 1e18}) {
        Mesh scaled = mesh;
        for (glm::vec3& p : scaled.positions)
            p *= static_cast<float>(scale);
        const Mesh level = cluster_vertices(scaled, target);
        ASSERT_NEAR(static_cast<double>(level.triangles.size()),
                    static_cast<double>(near.triangles.size()), 8);
        EXPECT_NEAR(surface_area(level) / (scale * scale), surface_area(near), 0.02);
    }
    const Mesh far = moved(mesh, {4096, -4096, 2048});
    EXPECT_NEAR(surface_area(cluster_vertices(far, target)), surface_area(near), 0.05);
}

TEST(Cluster, TrianglesThatAreNotNumbersAreLeftOut) {
    Mesh mesh = terrain(20);
    mesh.positions[5].x = std::numeric_limits<float>::quiet_NaN();
    mesh.positions[77].z = std::numeric_limits<float>::infinity();
    expect_sound(cluster_vertices(mesh, 100), mesh, 100);
    for (glm::vec3& p : mesh.positions)
        p.y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(cluster_vertices(mesh, 100).empty());
}

TEST(Cluster, WhatHasNoExtentOrIsAllSpecksIsNeverEmpty) {
    Mesh point = grid(10);
    for (glm::vec3& p : point.positions)
        p = {3, 4, 5};
    EXPECT_EQ(cluster_vertices(point, 7).triangles.size(), 7u);
    Mesh specks;  // each far below the grid's resolution
    for (int i = 0; i < 200; ++i) {
        Affine far;
        far.linear = glm::dmat3(1e-6);
        far.offset = {i * 1.0, i * 7 % 50, i * 3 % 20};
        append(specks, quad(1, 1), far);
    }
    expect_sound(cluster_vertices(specks, 50), specks, 50);
    Mesh line = grid(10);
    for (glm::vec3& p : line.positions)
        p = {p.x + p.y, 0, 0};
    EXPECT_FALSE(cluster_vertices(line, 20).empty());
}

TEST(Cluster, TrianglesWithoutAreaGoWithTheirVertices) {
    Mesh mesh = without_normals(grid(10));
    mesh.slots.assign(mesh.triangles.size(), 1);
    const auto add = [&](uint32_t corners, float away, float step, uint16_t slot) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (uint32_t i = 0; i < corners; ++i)
            mesh.positions.emplace_back(away + step * static_cast<float>(i), 0, 0);
        for (uint32_t i = 2; i < corners; ++i) {
            mesh.triangles.emplace_back(first + i - 2, first + i - 1, first + i);
            mesh.slots.push_back(slot);
        }
    };
    add(50, 1.1f, 0.02f, 2);   // a line, whose triangles stay between cells of their own
    add(400, 0.0f, 1e-7f, 3);  // all within one cell: nothing else needs to go
    const Mesh level = cluster_vertices(mesh, 350);
    expect_sound(level, mesh, 350);
    EXPECT_GT(level.triangles.size(), 100u);
    std::set<uint32_t> used;
    for (size_t i = 0; i < level.triangles.size(); ++i) {
        EXPECT_GT(glm::length(area_vector(level, i)), 0);
        EXPECT_EQ(level.slots[i], 1);
        for (int corner = 0; corner < 3; ++corner)
            used.insert(level.triangles[i][corner]);
    }
    EXPECT_EQ(used.size(), level.positions.size());
}

TEST(Cluster, AnyIndicesAndScalesSurvive) {
    PcgRandom random(7);
    for (int round = 0; round < 60; ++round) {
        Mesh mesh;
        const auto vertices = static_cast<uint32_t>(3 + random.next() % 400);
        const double scale = std::pow(10.0, -30.0 + static_cast<double>(random.next() % 61));
        for (uint32_t v = 0; v < vertices; ++v) {
            const auto coordinate = [&] {
                return static_cast<float>(scale * (static_cast<double>(random.next() % 64) - 32));
            };
            mesh.positions.emplace_back(coordinate(), coordinate(), coordinate());
        }
        const size_t count = random.next() % 1500 + 1;
        for (size_t i = 0; i < count; ++i) {
            const auto vertex = [&] { return static_cast<uint32_t>(random.next() % vertices); };
            mesh.triangles.emplace_back(vertex(), vertex(), vertex());
            if (round % 2 == 0)
                mesh.slots.push_back(static_cast<uint16_t>(random.next() % 5));
        }
        if (round % 3 == 0)
            mesh.uvs.assign(vertices, glm::vec2(0.5f));
        if (round % 4 == 0)
            mesh.normals.assign(vertices, glm::vec3(0, 0, 1));
        const size_t target = random.next() % count + 1;
        const Mesh level = cluster_vertices(mesh, target);
        expect_sound(level, mesh, std::max(target, size_t{1}));
    }
}

// Vertices were placed beyond what numbers hold, as a cell's planes may meet a little outside of
// it.
TEST(Cluster, WhatReachesToTheEdgeOfNumbersStaysFinite) {
    for (int i = 0; i < 12; ++i) {
        Mesh ball = sphere(1, 3);
        for (glm::vec3& p : ball.positions)
            p = glm::clamp(p * (1 + 0.02f * static_cast<float>(i)), glm::vec3(-1), glm::vec3(1)) *
                std::numeric_limits<float>::max();
        for (const size_t target : {8, 20, 60, 200})
            expect_sound(cluster_vertices(ball, target), ball, target);
    }
}

TEST(Cluster, TheSameBitsOnAnyNumberOfThreads) {
    const Mesh mesh = terrain(150);
    const Hash one = [&] {
        const ThreadLimit limit(1);
        return hash_of(cluster_vertices(mesh, 4000));
    }();
    EXPECT_EQ(one, hash_of(cluster_vertices(mesh, 4000)));
    const ThreadLimit limit(3);
    EXPECT_EQ(one, hash_of(cluster_vertices(mesh, 4000)));
}

TEST(Cluster, ACancelledJobStops) {
    const volatile int32_t cancel = 1;
    EXPECT_THROW(cluster_vertices(terrain(50), 100, Job(&cancel, nullptr, nullptr)), Error);
}

TEST(Cluster, AMillionVerticesUseTheFinerGrid) {
    const Mesh mesh = terrain(1100);  // above 2^20 vertices
    const size_t half = mesh.triangles.size() / 2;
    const Mesh level = cluster_vertices(mesh, half);
    EXPECT_LE(level.triangles.size(), half);
    EXPECT_GE(level.triangles.size(), half * 9 / 10);
    EXPECT_NEAR(surface_area(level), surface_area(mesh), 1e-3 * surface_area(mesh));
}
