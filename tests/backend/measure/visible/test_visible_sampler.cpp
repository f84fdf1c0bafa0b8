// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the estimator of what is visible: both kinds of rays find the same, errors are as large as
// they are said to be, and what hides nothing is exact.
#include "base/parallel.h"
#include "measure/visible/stratified_points.h"
#include "measure/visible/surface_inertia.h"
#include "measure/visible/visible_attributes.h"
#include "scenes/closed_forms.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;
using measure::CastMethod;
using measure::StratifiedPoints;
using measure::VisibleAttributes;
using measure::VisibleOptions;

namespace {

void add_box(Mesh& mesh, const glm::dvec3& low, const glm::dvec3& high) {
    append(mesh, shapes::box(low, high), Affine{});
}

/// Four legs, two of them through the seat, whose sides they share; and a back.
Mesh chair() {
    Mesh mesh;
    for (int i = 0; i < 4; ++i) {
        const double x = (i & 1) != 0 ? 0.9 : 0;
        const double y = (i & 2) != 0 ? 0.9 : 0;
        add_box(mesh, {x, y, 0}, {x + 0.1, y + 0.1, y > 0 ? 2 : 1});
    }
    add_box(mesh, {0, 0, 1}, {1, 1, 1.1});
    for (int i = 0; i < 3; ++i)
        add_box(mesh, {0.1, 0.92, 1.25 + 0.25 * i}, {0.9, 0.98, 1.4 + 0.25 * i});
    return mesh;
}

Mesh fence() {
    Mesh mesh;
    for (int i = 0; i < 12; ++i)
        add_box(mesh, {0.5 * i, 0, 0}, {0.5 * i + 0.06, 0.06, 1.2});
    add_box(mesh, {0, 0.02, 0.3}, {5.6, 0.05, 0.38});
    add_box(mesh, {0, 0.02, 0.9}, {5.6, 0.05, 0.98});
    return mesh;
}

/// Small sheets in a ball.
Mesh leaves() {
    Mesh mesh;
    for (int i = 0; i < 200; ++i) {
        const double turn = 2.4 * i;
        const double z = 1 - (i + 0.5) / 100;
        const double r = std::sqrt(1 - z * z) * (0.4 + 0.6 * std::abs(std::sin(1.3 * i)));
        const glm::dvec3 x = glm::normalize(glm::dvec3(std::sin(turn), std::cos(3 * turn), 0.3));
        const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(0.2, 0.1 * i, 1)));
        append(mesh, shapes::quad(0.25f, 0.2f),
               {{x, y, glm::cross(x, y)}, {r * std::cos(turn), r * std::sin(turn), z}});
    }
    return mesh;
}

Attributes attributes_of(const Mesh& mesh, VisibleOptions options) {
    return measure::measure_visible(mesh, {}, options).attributes;
}

double area_by(const Mesh& mesh, CastMethod casting, double error = 0.005) {
    VisibleOptions options;
    options.casting = casting;
    options.relative_error = error;
    return attributes_of(mesh, options).visible_area;
}

}  // namespace

TEST(StratifiedPoints, PairsShareACellAndCellsFillTheSpace) {
    const uint32_t count = 256;
    const StratifiedPoints strata(7, count);
    std::vector<int> cells(count / 2, 0);
    for (uint32_t i = 0; i < count; ++i) {
        const std::array<double, 4> u = strata.point(i);
        size_t cell = 0;
        const int counts[4] = {4, 4, 2, 4};
        for (size_t d = 0; d < 4; ++d) {
            ASSERT_GE(u[d], 0);
            ASSERT_LT(u[d], 1);
            cell = cell * static_cast<size_t>(counts[d]) + static_cast<size_t>(u[d] * counts[d]);
        }
        ++cells[cell];
    }
    EXPECT_EQ(cells, std::vector<int>(count / 2, 2));
    EXPECT_NE(StratifiedPoints(8, count).point(0), strata.point(0));
    EXPECT_EQ(StratifiedPoints(7, count).point(9), strata.point(9));
}

TEST(VisibleSampler, BothKindsOfRaysFindTheSameArea) {
    for (const Mesh& mesh : {chair(), fence(), leaves()}) {
        const double lines = area_by(mesh, CastMethod::FromBound);
        EXPECT_NEAR(area_by(mesh, CastMethod::FromSurface) / lines, 1, 0.01);
        EXPECT_NEAR(area_by(mesh, CastMethod::Best) / lines, 1, 0.01);
    }
}

// Legs flush with the seat had two surfaces in one place, and rays from the surface counted both.
TEST(VisibleSampler, SurfacesInOnePlaceCountOnce) {
    Mesh twice = shapes::cube();
    add_box(twice, glm::dvec3(-0.5), {0.5, 0.5, 0});
    EXPECT_NEAR(area_by(twice, CastMethod::FromSurface), 6, 0.05);
    Mesh sheets = shapes::quad(1, 1);
    append(sheets, shapes::quad(1, 1), Affine{});
    append(sheets, shapes::quad(1, 1), {glm::dmat3(1.0), {0, 0, 3}});
    EXPECT_NEAR(area_by(sheets, CastMethod::FromSurface) / area_by(sheets, CastMethod::FromBound),
                1, 0.01);
    // Faces that touch, back to back, are both inside.
    Mesh stack = shapes::cube();
    append(stack, shapes::cube(), {glm::dmat3(1.0), {0, 0, 1}});
    EXPECT_NEAR(area_by(stack, CastMethod::FromSurface), 10, 0.1);
}

TEST(VisibleSampler, WhatHidesNothingIsExact) {
    VisibleOptions options;
    options.relative_error = 0.01;
    std::vector<uint32_t> tags(12, 0);
    tags[0] = tags[1] = 1;
    const VisibleAttributes box =
        measure::measure_visible(shapes::box({0, 0, 0}, {3, 2, 1}), {}, options, tags);
    const measure::SurfaceInertia exact = closed_forms::of_box(3, 2, 1);
    EXPECT_NEAR(box.attributes.visible_area, 22, 1e-5);
    EXPECT_EQ(box.attributes.rays, 0u);
    EXPECT_GT(box.pilot_rays, 0u);
    EXPECT_EQ(box.attributes.relative_error, 0);
    EXPECT_NEAR(glm::length(box.attributes.centroid - glm::dvec3(1.5, 1, 0.5)), 0, 1e-6);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(box.attributes.moments[i][i] / exact.moments[i][i], 1, 1e-6);
    EXPECT_NEAR(box.attributes.normal_moment, 1, 1e-9);
    ASSERT_EQ(box.share_by_tag.size(), 2u);
    EXPECT_NEAR(box.share_by_tag[0] + box.share_by_tag[1], 1, 1e-12);
    EXPECT_NEAR(static_cast<double>(box.hits_by_tag[1]) /
                    static_cast<double>(box.hits_by_tag[0] + box.hits_by_tag[1]),
                box.share_by_tag[1], 1e-5);
    EXPECT_NEAR(attributes_of(shapes::quad(2, 1), options).visible_area, 4, 1e-6);
}

TEST(VisibleSampler, ClosedPartsAmongSheetsCountOneSide) {
    Mesh mesh = shapes::cube();
    append(mesh, shapes::quad(1, 1), {glm::dmat3(1.0), {40, 0, 0}});
    const Attributes out = attributes_of(mesh, {});
    EXPECT_NEAR(out.surface_area, 8, 1e-5);
    EXPECT_NEAR(out.visible_area, 8, 0.05);
}

TEST(VisibleSampler, AreasAreWithinTheStatedErrorAsOftenAsPromised) {
    constexpr int kSeeds = 30;
    int inside = 0;
    for (const Mesh& mesh : {chair(), fence(), leaves()}) {
        const double truth = area_by(mesh, CastMethod::Best, 0.003);
        const ray::MeshScene scene(mesh);
        int here = 0;
        for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
            VisibleOptions options;
            options.relative_error = 0.04;
            options.seed = seed;
            const Attributes out =
                measure::measure_visible(mesh, scene, nullptr, options).attributes;
            EXPECT_LE(out.relative_error, 0.04);
            here += std::abs(out.visible_area / truth - 1) <= 0.04 ? 1 : 0;
        }
        EXPECT_GE(here, 0.85 * kSeeds);
        inside += here;
    }
    EXPECT_GE(inside, 0.92 * 3 * kSeeds);
}

TEST(VisibleSampler, SameBitsOnOneAndManyThreads) {
    const Mesh mesh = leaves();
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        VisibleOptions options;
        options.relative_error = 0.01;
        const Attributes out = attributes_of(mesh, options);
        return std::tuple(out.visible_area, out.centroid, out.moments, out.rays);
    };
    EXPECT_EQ(run(1), run(0));
}

TEST(VisibleSampler, MostRaysAreNeverExceeded) {
    VisibleOptions options;
    options.relative_error = 1e-6;
    for (const uint64_t most : {0u, 63u, 64u, 5000u}) {
        options.most_rays = most;
        const Attributes out = attributes_of(chair(), options);
        EXPECT_LE(out.rays, most);
        EXPECT_EQ(out.empty(), most < StratifiedPoints::kStep);
    }
}
