// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the fit: what it measures a simplified mesh against is all of the original.
#include "scenes/fine_grids.h"
#include "scenes/small_meshes.h"
#include "simplify/collapse/collapse_pass.h"
#include "simplify/fit/fit_samples.h"
#include "simplify/fit/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <iostream>

using namespace lodestone;
using namespace lodestone::simplify;

namespace {

Mesh hills(uint32_t n) {
    Mesh mesh = shapes::grid(n);
    for (glm::vec3& p : mesh.positions)
        p.z = 0.05f * std::sin(9 * p.x) * std::cos(7 * p.y);
    return mesh;
}

/// Every triangle has vertices of its own, as flat-shaded models and soups of triangles do.
Mesh separate(const Mesh& mesh) {
    Mesh out;
    for (const Triangle& t : mesh.triangles) {
        const auto first = static_cast<uint32_t>(out.positions.size());
        for (int k = 0; k < 3; ++k) {
            out.positions.push_back(mesh.positions[t[k]]);
            if (!mesh.uvs.empty())
                out.uvs.push_back(mesh.uvs[t[k]]);
        }
        out.triangles.emplace_back(first, first + 1, first + 2);
    }
    return out;
}

std::vector<glm::vec3> corners_of(const Mesh& mesh) {
    std::vector<glm::vec3> corners;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k)
            corners.push_back(mesh.positions[t[k]]);
    }
    return corners;
}

/// Mean distance of samples of the original from a mesh brought to a target and fitted.
double mean_after(const Mesh& source, size_t target, const FitOptions& options) {
    Adjacency adjacency;
    CollapseMesh mesh = open_collapse_mesh(source, {}, {}, &adjacency);
    CollapseReducer(mesh, {}).reduce(
        target, {}, [] {}, adjacency);
    fit_surface(mesh, source, adjacency, options, {});
    adjacency.build(mesh);
    const FitPlaces places(mesh, source);
    FitSamples samples;
    sample_surface(places, adjacency, source.triangles.size(), 0, {}, samples);
    double sum = 0;
    double area = 0;
    for (const FitSample& sample : samples) {
        sum += double{sample.area} * std::abs(sample.miss);
        area += sample.area;
    }
    return sum / area;
}

}  // namespace

// They were met by no sample, so what was fitted was drawn to a third of the surface.
TEST(Fit, TrianglesWithVerticesOfTheirOwnAreFittedLikeWeldedOnes) {
    const Mesh welded = hills(80);
    for (const SimplifyMode mode : {SimplifyMode::Fast, SimplifyMode::Best}) {
        SimplifyOptions options;
        options.mode = mode;
        const Mesh one = simplify_mesh(welded, 1200, options);
        const Mesh other = simplify_mesh(separate(welded), 1200, options);
        EXPECT_EQ(corners_of(one), corners_of(other)) << static_cast<int>(mode);
    }
}

TEST(Fit, BothSidesOfATextureSeamHaveTheirPlace) {
    const Mesh mesh = shapes::seamed_cylinder(64, 40);
    Adjacency adjacency;
    CollapseMesh working = open_collapse_mesh(mesh, {}, {}, &adjacency);
    CollapseReducer(working, {})
        .reduce(
            800, {}, [] {}, adjacency);
    const FitPlaces places(working, mesh);
    const std::vector<uint32_t> welded = weld(mesh);
    size_t copies = 0;
    for (uint32_t v = 0; v < welded.size(); ++v) {
        ASSERT_NE(places.place(v), kNone) << v;
        EXPECT_EQ(places.place(v), places.place(welded[v])) << v;
        copies += welded[v] != v;
    }
    EXPECT_EQ(copies, 41u);
    adjacency.build(working);
    FitSamples samples;
    sample_surface(places, adjacency, mesh.triangles.size(), 0, {}, samples);
    std::vector<uint8_t> sampled(mesh.triangles.size(), 0);
    for (const FitSample& sample : samples)
        sampled[sample.source] = 1;
    EXPECT_GE(std::count(sampled.begin(), sampled.end(), 1),
              static_cast<std::ptrdiff_t>(mesh.triangles.size() * 99 / 100));
}

TEST(Fit, ACoarseLevelIsNearerAfterMoreSweeps) {
    const Mesh mesh = hills(160);
    const double few = mean_after(mesh, 512, {20, 1, 2, 2, 5, true});
    const double many = mean_after(mesh, 512, {20, 1, 2, 8, 5, true});
    std::cout << few << " -> " << many << '\n';
    EXPECT_LT(many, 0.99 * few);
}

TEST(Fit, CreasesDoNotDrawWhatLiesBesideThemAway) {
    Mesh mesh = shapes::grid(160);
    for (glm::vec3& p : mesh.positions)
        p.z = 0.1f * std::abs(std::sin(7 * p.x + 3 * p.y)) + 0.02f * std::sin(4 * p.y);
    const double squares = mean_after(mesh, 1200, {20, 1, 1, 1, 5, false});
    const double distances = mean_after(mesh, 1200, {20, 1, 1, 1, 5, true});
    std::cout << squares << " -> " << distances << '\n';
    EXPECT_LT(distances, 0.98 * squares);
}

// Corners stuck out of a ball too far for how far the middles of sides lay inside: 3.4, 2.1, 1.6
// and .65 times.
TEST(Fit, RoundThingsAreNotSeenLarger) {
    const Mesh ball = shapes::sphere(1, 5);
    SimplifyOptions options;
    options.mode = SimplifyMode::Best;
    constexpr std::pair<size_t, double> kMost[] = {
        {128, 3.0}, {2000, 2.0}, {4000, 1.5}, {10000, 0.58}};
    for (const auto& [target, most] : kMost) {
        const Mesh level = simplify_mesh(ball, target, options);
        double out = 0;
        for (const glm::vec3& p : level.positions)
            out += glm::length(p) - 1;
        out /= static_cast<double>(level.positions.size());
        double in = 0;
        for (const Triangle& t : level.triangles) {
            const glm::vec3 sum =
                level.positions[t.x] + level.positions[t.y] + level.positions[t.z];
            in += 1 - glm::length(sum) / 3;
        }
        in /= static_cast<double>(level.triangles.size());
        std::cout << target << ": " << out << " out, " << in << " in\n";
        EXPECT_LT(out, most * in) << target;
    }
}

// Bricks of four triangles became tetrahedra: from the side half of a wall showed the mortar
// behind.
TEST(Fit, BricksOfFewTrianglesStayFlat) {
    Mesh wall;
    for (int i = 0; i < 30; ++i) {
        const Mesh brick = shapes::box({0.3 * i, 0, 0}, {0.3 * i + 0.27, 0.022, 0.09});
        const auto first = static_cast<uint32_t>(wall.positions.size());
        wall.positions.insert(wall.positions.end(), brick.positions.begin(), brick.positions.end());
        for (const Triangle& t : brick.triangles)
            wall.triangles.push_back({t.x + first, t.y + first, t.z + first});
    }
    const Mesh coarse = simplify_mesh(separate(wall), 150, {});
    ASSERT_GE(coarse.triangles.size(), 100u);
    double seen = 0;
    double tilted = 0;
    for (const Triangle& t : coarse.triangles) {
        const glm::vec3 facet =
            glm::normalize(glm::cross(coarse.positions[t.y] - coarse.positions[t.x],
                                      coarse.positions[t.z] - coarse.positions[t.x]));
        (std::max({std::abs(facet.x), std::abs(facet.y), std::abs(facet.z)}) > 0.99f ? seen
                                                                                     : tilted) += 1;
    }
    std::cout << seen << " along axes, " << tilted << " tilted\n";
    EXPECT_LT(tilted, 0.1 * seen);
}
