// SPDX-License-Identifier: GPL-3.0-or-later
// Guards mode best: no error of a level is larger than mode fast leaves, whatever the fit does.
#include "base/parallel.h"
#include "ray/mesh_scene.h"
#include "scenes/small_meshes.h"
#include "simplify/collapse/collapse_pass.h"
#include "simplify/fit/better_fit.h"
#include "simplify/fit/level_fitter.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::simplify;

namespace {

/// A block with a round hole through it: planes, a cylinder and sharp edges between them.
Mesh drilled_block(uint32_t around, uint32_t rows) {
    Mesh mesh;
    const auto ring = [&](bool outer, float z) {
        for (uint32_t i = 0; i < around; ++i) {
            const double turn = 2 * kPi * i / around;
            const double c = std::cos(turn);
            const double s = std::sin(turn);
            const double far = outer ? 1 / std::max(std::abs(c), std::abs(s)) : 0.5;
            mesh.positions.emplace_back(glm::dvec3(far * c, far * s, static_cast<double>(z)));
        }
    };
    for (const bool outer : {true, false}) {
        for (uint32_t row = 0; row <= rows; ++row)
            ring(outer, static_cast<float>(row) / static_cast<float>(rows));
    }
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(a, c, d);
    };
    const uint32_t inner = (rows + 1) * around;
    for (uint32_t i = 0; i < around; ++i) {
        const uint32_t next = (i + 1) % around;
        for (uint32_t row = 0; row < rows; ++row) {
            const uint32_t low = row * around;
            const uint32_t high = low + around;
            quad(low + i, low + next, high + next, high + i);
            quad(inner + low + next, inner + low + i, inner + high + i, inner + high + next);
        }
        const uint32_t top = rows * around;
        quad(next, i, inner + i, inner + next);
        quad(top + i, top + next, inner + top + next, inner + top + i);
    }
    return mesh;
}

/// A level of a mesh as it is before any fit.
struct OpenedLevel {
    OpenedLevel(const Mesh& source, size_t target)
        : opened(open_collapse_mesh(source, {}, {}, &adjacency)), meter(source, opened) {
        if (target < opened.live)
            CollapseReducer(opened, {})
                .reduce(
                    target, {}, [] {}, adjacency);
    }
    Adjacency adjacency;
    CollapseMesh opened;
    LevelMeter meter;
};

/// Mean, root mean square and largest distance both ways, from other points than best decides by.
glm::dvec3 distances(const Mesh& source, const Mesh& level) {
    constexpr size_t kPoints = 7001;
    glm::dvec3 out(0.0);
    for (const bool forth : {true, false}) {
        const Mesh& from = forth ? source : level;
        const ray::MeshScene to(forth ? level : source);
        const AreaPoints area(from.positions, from.triangles);
        for (size_t n = 0; n < kPoints; ++n) {
            const double d = to.closest_point(glm::dvec3(area.at(n, kPoints).place)).distance;
            out += glm::dvec3(d, d * d, 0) / (2.0 * kPoints);
            out.z = std::max(out.z, d);
        }
        for (const glm::vec3& corner : from.positions)
            out.z = std::max(out.z, to.closest_point(glm::dvec3(corner)).distance);
    }
    out.y = std::sqrt(out.y);
    return out;
}

TEST(AreaPoints, TrianglesWithoutAreaHaveNone) {
    EXPECT_TRUE(AreaPoints({}, {}).empty());
    const std::vector<glm::vec3> places{
        {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, std::nanf(""), 0}};
    const std::vector<Triangle> none{{0, 1, 2}, {0, 1, 4}};
    EXPECT_TRUE(AreaPoints(places, none).empty());
    const std::vector<Triangle> one{{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    const AreaPoints area(places, one);
    ASSERT_FALSE(area.empty());
    for (size_t n = 0; n < 100; ++n)
        EXPECT_EQ(area.at(n, 100).triangle, 1u);
}

TEST(AreaPoints, LargerTrianglesHaveMore) {
    const std::vector<glm::vec3> places{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
    const AreaPoints area(places, triangles);
    size_t on_first = 0;
    glm::dvec3 sum(0.0);
    for (size_t n = 0; n < 4000; ++n) {
        const AreaPoints::AreaPoint point = area.at(n, 4000);
        on_first += point.triangle == 0;
        sum += glm::dvec3(point.place) / 4000.0;
        EXPECT_GE(std::min({point.weights.x, point.weights.y, point.weights.z}), 0);
    }
    EXPECT_NEAR(static_cast<double>(on_first), 3000, 2);
    EXPECT_NEAR(sum.x, 2.0 / 3, 0.01);  // the centroid
    EXPECT_NEAR(sum.y, 1.0 / 3, 0.01);
}

TEST(OutlineViews, OnlyWhatIsMissingOrTooMuchIsOdd) {
    const Mesh sphere = shapes::sphere(0.5);
    const OutlineViews views(sphere.positions, sphere.triangles);
    EXPECT_TRUE(views.odd_pixels(sphere.positions, sphere.triangles).empty());
    const double side = 0.47 * OutlineViews::kSide;  // pixels of the sphere's radius
    const double disk = kPi * side * side * OutlineViews::kViews;
    const auto missing = views.odd_pixels(sphere.positions, {});
    EXPECT_NEAR(static_cast<double>(missing.size()) / disk, 1, 0.02);
    for (const OutlineViews::OddPixel& pixel : missing) {
        EXPECT_NE(pixel.source, kNone);
        EXPECT_EQ(pixel.triangle, kNone);
    }
    Mesh larger = sphere;
    for (glm::vec3& position : larger.positions)
        position *= 1.05f;
    const auto more = views.odd_pixels(larger.positions, larger.triangles);
    EXPECT_NEAR(static_cast<double>(more.size()) / disk, 1.05 * 1.05 - 1, 0.02);
    for (const OutlineViews::OddPixel& pixel : more)
        EXPECT_EQ(pixel.source, kNone);
    larger.positions[0].x = std::nanf("");
    larger.positions[9] = glm::vec3(1e30f);
    EXPECT_FALSE(views.odd_pixels(larger.positions, larger.triangles).empty());
}

TEST(LevelMeter, TheOriginalHasNoErrors) {
    const Mesh torus = shapes::torus(24, 12);
    OpenedLevel level(torus, torus.triangles.size());
    const LevelErrors errors = level.meter.measure(FitPlaces(level.opened, torus), 2000, {});
    EXPECT_LT(errors.all.worst, 1e-6);
    EXPECT_EQ(errors.all.outline, 0);
}

TEST(LevelMeter, VerticesShareTheErrorsOfTheWhole) {
    const Mesh sphere = shapes::sphere(2);
    OpenedLevel level(sphere, 200);
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        const LevelErrors errors = level.meter.measure(FitPlaces(level.opened, sphere), 4000, {});
        LevelError sum;
        for (const LevelError& of : errors.vertices) {
            sum.mean += of.mean;
            sum.square += of.square;
            sum.outline += of.outline;
            sum.worst = std::max(sum.worst, of.worst);
        }
        EXPECT_GT(errors.all.mean, 1e-4);
        EXPECT_NEAR(sum.mean / errors.all.mean, 1, 1e-6);
        EXPECT_NEAR(sum.square / errors.all.square, 1, 1e-6);
        EXPECT_NEAR(sum.outline, errors.all.outline, 1e-6);
        EXPECT_EQ(sum.worst, errors.all.worst);
    }
}

TEST(BetterFit, DraggedVerticesMoveBackAndOthersStay) {
    const Mesh block = drilled_block(64, 12);
    OpenedLevel level(block, 300);
    CollapseMesh before = level.opened;
    CollapseMesh after = before;
    for (const size_t v : {size_t{3}, size_t{50}, size_t{90}})
        after.points[v] += glm::dvec3(0.01, 0.02, 0.03);
    ASSERT_TRUE(keep_better(before, after, block, level.meter, {}));
    EXPECT_EQ(after.points, before.points);
    // All of it is worse, and moving back is not possible without turning triangles over.
    CollapseMesh turned = before;
    for (glm::dvec3& point : turned.points)
        point = {-point.x, point.y, point.z + 0.1};
    for (size_t t = 0; t < turned.triangles.size(); ++t)
        turned.facets[t] = glm::vec3(turned.facet_of(turned.triangles[t]));
    EXPECT_FALSE(keep_better(before, turned, block, level.meter, {}));
}

TEST(BetterFit, AFitThatIsBetterStays) {
    const Mesh sphere = shapes::sphere(1);
    OpenedLevel level(sphere, 400);
    CollapseMesh before = level.opened;
    for (glm::dvec3& point : before.points)
        point *= 0.97;  // far inside
    CollapseMesh after = level.opened;
    ASSERT_TRUE(keep_better(before, after, sphere, level.meter, {}));
    EXPECT_EQ(after.points, level.opened.points);
}

TEST(LevelFitter, CadPartsWereWorseInBestThanInFast) {
    const std::vector<Mesh> parts{drilled_block(96, 24), drilled_block(40, 40),
                                  shapes::torus(64, 32), shapes::terrain(40), shapes::book(6)};
    for (size_t part = 0; part < parts.size(); ++part) {
        const Mesh& mesh = parts[part];
        for (const double share : {0.5, 0.1, 0.03, 0.01}) {
            const size_t target = std::max<size_t>(
                4, static_cast<size_t>(share * static_cast<double>(mesh.triangles.size())));
            SimplifyOptions options;
            const Mesh fast = simplify_mesh(mesh, target, options);
            options.mode = SimplifyMode::Best;
            const Mesh best = simplify_mesh(mesh, target, options);
            EXPECT_LE(best.triangles.size(), std::max(target, fast.triangles.size()));
            const glm::dvec3 of_fast = distances(mesh, fast);
            const glm::dvec3 of_best = distances(mesh, best);
            for (int k = 0; k < 3; ++k)  // other points of the same surfaces
                EXPECT_LE(of_best[k], 1.03 * of_fast[k] + 1e-6)
                    << part << " at " << share << ", " << k;
        }
    }
}

}  // namespace
