// SPDX-License-Identifier: GPL-3.0-or-later
// Guards insertion: what is farthest from the original comes back, and nothing else changes.
#include "base/parallel.h"
#include "base/random.h"
#include "scenes/fine_grids.h"
#include "scenes/small_meshes.h"
#include "simplify/collapse/collapse_pass.h"
#include "simplify/fit/distance_outliers.h"
#include "simplify/fit/surface_fit.h"
#include "simplify/fit/vertex_insertion.h"

#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <limits>
#include <map>
#include <memory>

using namespace lodestone;
using namespace lodestone::simplify;

namespace {

/// A mesh brought to a target, fitted, with its samples.
struct Reduced {
    Mesh source;
    Adjacency adjacency;
    CollapseMesh mesh;
    FitSamples samples;
    std::unique_ptr<FitPlaces> places;

    Reduced(const Mesh& from, size_t target)
        : source(from), mesh(open_collapse_mesh(source, {}, {}, &adjacency)) {
        SimplifyOptions options;
        options.mode = SimplifyMode::Best;
        CollapseReducer(mesh, options)
            .reduce(
                target, {}, [] {}, adjacency);
        fit_surface(mesh, source, adjacency, {20, 1, 1, 1, 3, false}, {});
        refresh();
    }
    void refresh() {
        adjacency.build(mesh);
        places = std::make_unique<FitPlaces>(mesh, source);
        sample_surface(*places, adjacency, source.triangles.size(), 0, {}, samples);
    }
    double worst() const {
        const DistanceOutliers strays(*places, adjacency, samples, {});
        float most = 0;
        for (DistanceOutlier stray : strays.list_farthest(mesh.triangles.size(), {})) {
            if (strays.confirm(stray))
                most = std::max(most, stray.square);
        }
        return std::sqrt(most);
    }
};

/// Hills with ridges, bent more in some places than in others.
Mesh ridges(uint32_t n) {
    Mesh mesh = shapes::grid(n);
    for (glm::vec3& p : mesh.positions)
        p.z = 0.05f * std::sin(9 * p.x) * std::cos(7 * p.y) +
              0.03f * std::abs(std::sin(5 * p.x + 3 * p.y));
    return mesh;
}

std::map<std::pair<uint32_t, uint32_t>, int> edges_of(const CollapseMesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k)
            ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    }
    return edges;
}

}  // namespace

TEST(Insert, NothingIsInsertedOfNothing) {
    Reduced flat(shapes::grid(20), 2);
    EXPECT_EQ(insert_vertices(*flat.places, flat.adjacency, flat.samples, 0, {}), 0u);
    EXPECT_EQ(insert_vertices(*flat.places, flat.adjacency, {}, 5, {}), 0u);
}

TEST(Insert, WhatMissesMostMissesLessAfterwards) {
    // All of a torus misses about as much: few of its places cannot be told from the others.
    for (const auto& [mesh, most] : {std::pair(ridges(120), 0.9), {shapes::torus(160, 80), 1.0}}) {
        Reduced reduced(mesh, mesh.triangles.size() / 40);
        const double before = reduced.worst();
        const size_t triangles = reduced.mesh.triangles.size();
        ASSERT_GT(insert_vertices(*reduced.places, reduced.adjacency, reduced.samples, 40, {}), 5u);
        reduced.refresh();
        std::cout << before << " -> " << reduced.worst() << '\n';
        EXPECT_LE(reduced.worst(), most * before);
        EXPECT_LE(reduced.mesh.triangles.size(), triangles + 80);
        EXPECT_GT(reduced.mesh.triangles.size(), triangles);
        EXPECT_EQ(reduced.mesh.live, reduced.mesh.triangles.size());
    }
}

TEST(Insert, TheWorstAreTheSameWhenOnlyTheseAreLookedFor) {
    const Reduced reduced(ridges(120), 700);
    const DistanceOutliers strays(*reduced.places, reduced.adjacency, reduced.samples, {});
    const std::vector<DistanceOutlier> all =
        strays.list_farthest(reduced.mesh.triangles.size(), {});
    for (const size_t most : {1u, 20u, 300u}) {
        const std::vector<DistanceOutlier> some = strays.list_farthest(most, {});
        ASSERT_GE(some.size(), most);
        for (size_t i = 0; i < most; ++i) {
            EXPECT_EQ(some[i].square, all[i].square) << most << ' ' << i;
            EXPECT_EQ(some[i].triangle, all[i].triangle) << most << ' ' << i;
        }
    }
}

TEST(Insert, SurfacesStayAsConnectedAsTheyWere) {
    Reduced torus(shapes::torus(120, 60), 300);
    const size_t vertices = torus.mesh.points.size();
    ASSERT_GT(insert_vertices(*torus.places, torus.adjacency, torus.samples, 30, {}), 0u);
    const auto edges = edges_of(torus.mesh);
    for (const auto& [edge, uses] : edges)
        ASSERT_EQ(uses, 2);
    // Euler: still one torus.
    EXPECT_EQ(torus.mesh.points.size() + torus.mesh.triangles.size(), edges.size());
    EXPECT_GT(torus.mesh.points.size(), vertices);
}

TEST(Insert, TextureNormalsAndSlotsAreRightOnWhatIsInserted) {
    Mesh mesh = shapes::torus(120, 60);
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f));
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            mesh.normals[mesh.triangles[i][k]] += glm::vec3(area_vector(mesh, i));
    }
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        mesh.normals[v] = glm::normalize(mesh.normals[v]);
        mesh.uvs.emplace_back(mesh.positions[v].x, mesh.positions[v].y);
    }
    mesh.slots.assign(mesh.triangles.size(), 0);
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.slots[i] = mesh.positions[mesh.triangles[i].x].x > 0;
    Reduced torus(mesh, 360);
    const size_t vertices = torus.mesh.points.size();
    insert_vertices(*torus.places, torus.adjacency, torus.samples, 30, {});
    ASSERT_GT(torus.mesh.points.size(), vertices);
    std::vector<uint32_t> made;
    const Mesh out = extract(torus.mesh, &made);
    ASSERT_NO_THROW(check(out));
    for (size_t v = 0; v < out.positions.size(); ++v) {
        if (made[v] < vertices)
            continue;
        EXPECT_NEAR(out.uvs[v].x, out.positions[v].x, 0.1);
        EXPECT_NEAR(out.uvs[v].y, out.positions[v].y, 0.1);
        EXPECT_NEAR(glm::length(out.normals[v]), 1, 1e-4);
    }
    for (size_t i = 0; i < out.triangles.size(); ++i) {
        const Triangle& t = out.triangles[i];
        const glm::dvec3 normal = glm::normalize(area_vector(out, i));
        for (int k = 0; k < 3; ++k) {
            if (made[t[k]] >= vertices) {
                EXPECT_GT(glm::dot(normal, glm::dvec3(out.normals[t[k]])), 0.0);
            }
        }
        const float x = (out.positions[t.x].x + out.positions[t.y].x + out.positions[t.z].x) / 3;
        if (std::abs(x) > 0.25f) {
            EXPECT_EQ(out.slots[i], x > 0 ? 1 : 0);
        }
    }
}

TEST(Insert, OneThreadAndManyInsertTheSame) {
    const auto points = [](int threads) {
        const ThreadLimit limit(threads);
        Reduced reduced(ridges(100), 500);
        insert_vertices(*reduced.places, reduced.adjacency, reduced.samples, 30, {});
        return reduced.mesh.points;
    };
    EXPECT_EQ(points(1), points(4));
}

TEST(Insert, SoupOfAnythingIsSurvived) {
    PcgRandom random(11);
    Mesh mesh;
    for (int i = 0; i < 300; ++i)
        mesh.positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
    mesh.positions[7].x = std::numeric_limits<float>::quiet_NaN();
    mesh.positions[8] = mesh.positions[9];
    for (int i = 0; i < 4000; ++i)
        mesh.triangles.emplace_back(random.next() % 300, random.next() % 300, random.next() % 300);
    for (const size_t target : {2000u, 300u, 20u}) {
        Reduced reduced(mesh, target);
        const size_t before = reduced.mesh.triangles.size();
        insert_vertices(*reduced.places, reduced.adjacency, reduced.samples, 50, {});
        EXPECT_LE(reduced.mesh.triangles.size(), before + 100);
        for (const glm::dvec3& point : reduced.mesh.points)
            ASSERT_TRUE(std::isfinite(point.x + point.y + point.z));
        EXPECT_NO_THROW(check(extract(reduced.mesh)));
    }
}
