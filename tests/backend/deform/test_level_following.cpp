// SPDX-License-Identifier: GPL-3.0-or-later
// Guards following: one collapse for all frames, its levels on the surface of every frame.
#include "base/clock.h"
#include "deform/level_binding.h"
#include "measure/deviation/surface_deviation.h"
#include "ray/mesh_scene.h"
#include "scenes/fine_grids.h"
#include "scenes/with_rays.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using deform::BoundLevel;
using deform::PoseSurface;

namespace {

using Bend = std::function<glm::dvec3(const glm::dvec3&)>;

PosedSurface pose_of(const Mesh& mesh, const Bend& bend = nullptr) {
    PosedSurface pose;
    pose.connectivity = 1;
    pose.triangles = mesh.triangles;
    for (const glm::vec3& p : mesh.positions)
        pose.points.emplace_back(bend ? bend(glm::dvec3(p)) : glm::dvec3(p));
    return pose;
}

/// The mesh with other positions; normals are left as they are.
Mesh posed(const Mesh& mesh, const PosedSurface& pose) {
    Mesh out = mesh;
    out.positions = pose.points;
    return out;
}

std::vector<BoundLevel> bound(const Mesh& mesh, const std::vector<size_t>& targets,
                              const std::vector<Bend>& others = {}) {
    std::vector<std::vector<glm::vec3>> positions;
    positions.reserve(others.size());
    for (const Bend& bend : others)
        positions.push_back(pose_of(mesh, bend).points);
    const PosedSurface pose = pose_of(mesh);
    const PoseSurface surface(pose);
    const deform::LevelBinder binder(mesh, surface);
    std::vector<BoundLevel> levels;
    for (simplify::TracedLevel& level : simplify::simplify_traced(mesh, positions, targets)) {
        auto made = binder.bind(std::move(level));
        EXPECT_TRUE(made);
        if (made)
            levels.push_back(std::move(*made));
    }
    return levels;
}

glm::dvec3 wave(const glm::dvec3& p) {
    return {p.x, p.y, 0.15 * std::sin(9 * p.x)};
}

/// A rod along x from 0 to 1 rolled up to a half circle.
glm::dvec3 curl(const glm::dvec3& p) {
    const double angle = 3.14159265358979 * p.x;
    const double radius = 1 / 3.14159265358979 - p.z;
    return {radius * std::sin(angle), p.y, 1 / 3.14159265358979 - radius * std::cos(angle)};
}

Mesh rod() {
    Mesh mesh = shapes::sphere(0.5, 5);
    for (glm::vec3& p : mesh.positions)
        p = {p.x + 0.5f, 0.2f * p.y, 0.2f * p.z};
    mesh.normals.clear();
    return mesh;
}

double deviation(const Mesh& finest, const Mesh& level) {
    return measure::DeviationReference(finest, {2048, 2048, 1}).of(level).error;
}

double largest_move(const Mesh& a, const Mesh& b) {
    double most = 0;
    for (size_t i = 0; i < a.positions.size(); ++i)
        most = std::max(most, glm::length(glm::dvec3(a.positions[i] - b.positions[i])));
    return most;
}

class Follow : public WithRays {};

}  // namespace

TEST_F(Follow, NothingIsMadeOfNothing) {
    const Mesh empty;
    EXPECT_TRUE(bound(empty, {}).empty());
    const PosedSurface pose;
    const PoseSurface surface(pose);
    const BoundLevel level;
    ASSERT_TRUE(deform::follow(level, surface));
    EXPECT_TRUE(deform::follow(level, surface)->empty());
}

TEST_F(Follow, TracedLevelsAreThoseOfTheOrdinaryChain) {
    const Mesh mesh = shapes::fine_cube(12);
    const std::vector<size_t> targets{800, 200, 12};
    const std::vector<Mesh> chain = simplify::simplify_chain(mesh, targets);
    const auto traced = simplify::simplify_traced(mesh, {}, targets);
    ASSERT_EQ(traced.size(), chain.size());
    for (size_t i = 0; i < chain.size(); ++i) {
        EXPECT_EQ(hash_of(traced[i].mesh), hash_of(chain[i]));
        EXPECT_EQ(traced[i].places.size(), chain[i].positions.size());
    }
}

TEST_F(Follow, EveryVertexOfAClosedMeshEndsInExactlyOnePlace) {
    const Mesh mesh = shapes::fine_cube(8);
    const std::vector<uint32_t> welded = weld(mesh);
    size_t vertices = 0;
    for (uint32_t v = 0; v < welded.size(); ++v)
        vertices += welded[v] == v;
    const std::vector<size_t> targets{400, 40};
    for (const auto& level : simplify::simplify_traced(mesh, {}, targets)) {
        std::vector<int> times(mesh.positions.size(), 0);
        for (const auto& [place, vertex] : level.origins)
            ++times[vertex];
        size_t met = 0;
        for (uint32_t v = 0; v < welded.size(); ++v) {
            // What a pair of collapses removed for good may be in no place.
            EXPECT_LE(times[v], 1);
            met += times[v];
        }
        EXPECT_EQ(met, vertices);
    }
}

TEST_F(Follow, InThePoseItWasBoundInALevelIsItself) {
    const Mesh mesh = shapes::seamed_cylinder(48, 24);
    const PosedSurface pose = pose_of(mesh);
    const PoseSurface surface(pose);
    for (const BoundLevel& level : bound(mesh, {800, 100, 20})) {
        const auto same = deform::follow(level, surface);
        ASSERT_TRUE(same);
        EXPECT_LT(largest_move(*same, level.mesh), 2e-6);
        EXPECT_EQ(same->uvs, level.mesh.uvs);
        EXPECT_EQ(same->triangles, level.mesh.triangles);
        for (size_t i = 0; i < same->normals.size(); ++i)
            EXPECT_GT(glm::dot(same->normals[i], level.mesh.normals[i]), 0.9999f);
    }
}

TEST_F(Follow, AMovedTurnedAndScaledSurfaceTakesItsLevelsAlong) {
    const Mesh mesh = shapes::sphere(1, 4);
    const glm::dmat3 turn(glm::dvec3(0, 3, 0), glm::dvec3(0, 0, 3), glm::dvec3(3, 0, 0));
    const Bend bend = [&](const glm::dvec3& p) { return turn * p + glm::dvec3(5, -7, 2); };
    const PosedSurface pose = pose_of(mesh, bend);
    const PoseSurface surface(pose);
    for (const BoundLevel& level : bound(mesh, {500, 60, 12})) {
        const auto moved = deform::follow(level, surface);
        ASSERT_TRUE(moved);
        for (size_t i = 0; i < moved->positions.size(); ++i) {
            const glm::dvec3 wanted = bend(glm::dvec3(level.mesh.positions[i]));
            EXPECT_LT(glm::length(glm::dvec3(moved->positions[i]) - wanted), 2e-5);
            if (!moved->normals.empty()) {
                EXPECT_GT(glm::dot(glm::dvec3(moved->normals[i]),
                                   turn * glm::dvec3(level.mesh.normals[i]) / 3.0),
                          0.9999);
            }
        }
    }
}

TEST_F(Follow, SeamsStayClosedAndFacesFlatWhereTheSurfaceBends) {
    const Mesh mesh = shapes::fine_cube(16);
    ASSERT_TRUE(closed(mesh));
    const PosedSurface pose = pose_of(mesh, [](const glm::dvec3& p) {
        return glm::dvec3(p.x + 0.3 * p.z * p.z, p.y, p.z * (1 + 0.2 * p.x));
    });
    const PoseSurface surface(pose);
    for (const BoundLevel& level : bound(mesh, {600, 100})) {
        const auto moved = deform::follow(level, surface);
        ASSERT_TRUE(moved);
        EXPECT_EQ(closed(*moved), closed(level.mesh));
        for (size_t i = 0; i < moved->triangles.size(); ++i) {
            const glm::dvec3 area = area_vector(*moved, i);
            for (int corner = 0; corner < 3; ++corner) {
                const glm::dvec3 normal(moved->normals[moved->triangles[i][corner]]);
                EXPECT_GT(glm::dot(normal, area), 0.9 * glm::length(area));
            }
        }
    }
}

TEST_F(Follow, ABentRodHasLevelsNotMuchWorseThanItsOwn) {
    const Mesh mesh = rod();
    const PosedSurface pose = pose_of(mesh, curl);
    const Mesh bent = posed(mesh, pose);
    const PoseSurface surface(pose);
    const std::vector<size_t> targets{4000, 1000, 250};
    const std::vector<BoundLevel> levels = bound(mesh, targets, {curl});
    const std::vector<Mesh> own = simplify::simplify_chain(bent, targets);
    ASSERT_EQ(levels.size(), own.size());
    for (size_t i = 0; i < levels.size(); ++i) {
        const auto moved = deform::follow(levels[i], surface);
        ASSERT_TRUE(moved);
        EXPECT_LT(deviation(bent, *moved), 4 * deviation(bent, own[i])) << targets[i];
    }
}

TEST_F(Follow, AFlatFlagThatWavesLaterKeepsTrianglesForItsWaves) {
    const Mesh mesh = shapes::grid(48);
    const PosedSurface pose = pose_of(mesh, wave);
    const Mesh waving = posed(mesh, pose);
    const PoseSurface surface(pose);
    const auto error = [&](const std::vector<Bend>& others) {
        const auto moved = deform::follow(bound(mesh, {600}, others).at(0), surface);
        EXPECT_TRUE(moved);
        return moved ? deviation(waving, *moved) : 1.0;
    };
    const double flat_alone = error({});
    const double both = error({wave});
    EXPECT_LT(both, 0.01);
    EXPECT_LT(both, 0.5 * flat_alone);
}

TEST_F(Follow, ALevelStaysOnItsOwnSheetThoughAnotherLiesNearer) {
    // Two curved sheets a hair apart when bound; then the upper one is lifted.
    Mesh mesh = shapes::grid(24);
    const size_t half = mesh.positions.size();
    Mesh upper = mesh;
    for (glm::vec3& p : mesh.positions)
        p.z = -0.3f * (p.x - 0.5f) * (p.x - 0.5f);
    for (glm::vec3& p : upper.positions)
        p.z = 0.0005f - 0.3f * (p.x - 0.5f) * (p.x - 0.5f);
    append(mesh, upper, Affine{});
    PosedSurface pose = pose_of(mesh);
    for (size_t i = half; i < pose.points.size(); ++i)
        pose.points[i].z += 2;
    const PoseSurface surface(pose);
    for (const BoundLevel& level : bound(mesh, {300, 60})) {
        const auto moved = deform::follow(level, surface);
        ASSERT_TRUE(moved);
        for (const glm::vec3& p : moved->positions)
            EXPECT_TRUE(p.z < 0.1f || p.z > 1.8f) << p.z;
    }
}

TEST_F(Follow, WhatIsKnownOfTheErrorIsWhatMeasuringFinds) {
    const Mesh mesh = rod();
    for (const Bend& bend : {Bend(nullptr), Bend(curl)}) {
        const PosedSurface pose = pose_of(mesh, bend);
        const Mesh bent = posed(mesh, pose);
        const PoseSurface surface(pose);
        for (const BoundLevel& level : bound(mesh, {4000, 1000, 250, 60}, {curl})) {
            const Mesh moved = *deform::follow(level, surface);
            const deform::PoseError pose_error = deform::pose_error(level, moved, surface);
            const double measured = deviation(bent, moved);
            EXPECT_GT(pose_error.error, 0.8 * measured);
            EXPECT_LT(pose_error.error, 1.5 * measured);
            EXPECT_GE(pose_error.max, pose_error.error);
        }
    }
}

TEST_F(Follow, AFoldThatOpensCountsInTheFrameWhereItIsOpen) {
    // Bound as a closed book: its leaves lie on each other; the level is one leaf's thickness off.
    Mesh book = shapes::grid(24);
    for (glm::vec3& p : book.positions) {
        if (p.x > 0.5f)
            p = {1 - p.x, p.y, 1e-4f};
    }
    const BoundLevel level = bound(book, {60}).at(0);
    const PosedSurface shut = pose_of(book);
    const PoseSurface surface(shut);
    const double before = deform::pose_error(level, level.mesh, surface).error;
    const PosedSurface open = pose_of(shapes::grid(24), [](const glm::dvec3& p) {
        return glm::dvec3(p.x, p.y, 0.2 * std::sin(12 * p.y));
    });
    const PoseSurface opened(open);
    const Mesh moved = *deform::follow(level, opened);
    EXPECT_LT(before, 0.05);
    EXPECT_GT(deform::pose_error(level, moved, opened).error, 0.1);
    EXPECT_GT(deviation(posed(book, open), moved), 0.1);
}

TEST_F(Follow, SurfacesThatSlideInThemselvesAreNotApart) {
    const Mesh mesh = shapes::grid(40);
    const PosedSurface pose = pose_of(mesh, [](const glm::dvec3& p) {
        return glm::dvec3(p.x + 0.05 * std::sin(3.14159265358979 * p.x), p.y, 0);
    });
    const PoseSurface surface(pose);
    for (const BoundLevel& level : bound(mesh, {600, 100})) {
        const Mesh moved = *deform::follow(level, surface);
        EXPECT_LT(deform::pose_error(level, moved, surface).error, 0.002);
    }
}

TEST_F(Follow, GrowthIsThatOfLengths) {
    const Mesh mesh = shapes::sphere(1, 3);
    const PosedSurface pose = pose_of(mesh, [](const glm::dvec3& p) { return 3.0 * p; });
    const PoseSurface surface(pose);
    const BoundLevel level = bound(mesh, {100}).at(0);
    EXPECT_NEAR(deform::pose_error(level, *deform::follow(level, surface), surface).growth, 3,
                1e-5);
}

TEST_F(Follow, PolygonsCutTheOtherWayInThisFrameMakeNoDifference) {
    const Mesh mesh = shapes::grid(20);
    PosedSurface pose = pose_of(mesh, wave);
    const PoseSurface before(pose);
    PosedSurface cut = pose;
    for (size_t i = 0; i + 1 < cut.triangles.size(); i += 2) {  // the cells' other diagonals
        const uint32_t a = cut.triangles[i].x;
        const uint32_t b = cut.triangles[i].y;
        const uint32_t c = cut.triangles[i].z;
        const uint32_t d = cut.triangles[i + 1].z;
        cut.triangles[i] = {a, b, d};
        cut.triangles[i + 1] = {b, c, d};
    }
    const PoseSurface after(cut);
    for (const BoundLevel& level : bound(mesh, {200})) {
        const auto a = deform::follow(level, before);
        const auto b = deform::follow(level, after);
        ASSERT_TRUE(a && b);
        EXPECT_LT(largest_move(*a, *b), 0.01);
    }
}

TEST_F(Follow, SurfacesThatCollapseToAPointOrALineStayFinite) {
    const Mesh mesh = shapes::sphere(1, 3);
    for (const Bend& bend : {Bend([](const glm::dvec3&) { return glm::dvec3(1, 2, 3); }),
                             Bend([](const glm::dvec3& p) { return glm::dvec3(p.x, 0, 0); }),
                             Bend([](const glm::dvec3& p) { return 1e30 * p; })}) {
        const PosedSurface pose = pose_of(mesh, bend);
        const PoseSurface surface(pose);
        for (const BoundLevel& level : bound(mesh, {300, 20})) {
            const auto moved = deform::follow(level, surface);
            ASSERT_TRUE(moved);
            EXPECT_NO_THROW(check(*moved));
            for (const glm::vec3& p : moved->positions)
                EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
        }
    }
}

TEST_F(Follow, DegenerateTrianglesInTheBindPoseAreBoundAllTheSame) {
    Mesh mesh = shapes::sphere(1, 3);
    for (size_t i = 0; i < mesh.positions.size(); i += 3)
        mesh.positions[i] = mesh.positions[0];
    const PosedSurface pose = pose_of(mesh);
    const PoseSurface surface(pose);
    for (const BoundLevel& level : bound(mesh, {100, 10})) {
        EXPECT_NO_THROW(check(level));
        EXPECT_TRUE(deform::follow(level, surface));
    }
}

TEST_F(Follow, WhatHangsOnPointsThatAreNoNumbersOrNotThereIsNotDrawn) {
    const Mesh mesh = shapes::sphere(1, 3);
    const std::vector<BoundLevel> levels = bound(mesh, {100});
    PosedSurface pose = pose_of(mesh);
    for (glm::vec3& p : pose.points)
        p.y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(deform::follow(levels.at(0), PoseSurface(pose)));
    pose = pose_of(mesh);
    pose.points.resize(3);
    pose.triangles = {{0, 1, 2}};
    EXPECT_FALSE(deform::follow(levels.at(0), PoseSurface(pose)));
    pose.triangles = {{0, 1, 3}};
    EXPECT_THROW(PoseSurface{pose}, Error);
    EXPECT_THROW(simplify::simplify_traced(mesh, std::vector<std::vector<glm::vec3>>(1),
                                           std::vector<size_t>{10}),
                 Error);
}

TEST_F(Follow, MeshThatThePoseIsNotOfIsNotBound) {
    const Mesh mesh = shapes::sphere(1, 3);
    const PosedSurface other = pose_of(shapes::sphere(2, 3));
    const std::vector<size_t> targets{100};
    auto traced = simplify::simplify_traced(mesh, {}, targets);
    const PoseSurface surface(other);
    EXPECT_FALSE(deform::LevelBinder(mesh, surface).bind(std::move(traced.at(0))));
}

TEST_F(Follow, AHubOfManyTrianglesTakesNoLongerThanOtherMeshes) {
    constexpr uint32_t kSpokes = 100000;
    Mesh disk;
    disk.positions.emplace_back(0, 0, 0.1f);
    for (uint32_t i = 0; i < kSpokes; ++i) {
        const double angle = 2 * 3.14159265358979 * i / kSpokes;
        disk.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        disk.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % kSpokes);
    }
    const double start = cpu_seconds();
    const PosedSurface pose = pose_of(disk, [](const glm::dvec3& p) { return 2.0 * p; });
    const PoseSurface surface(pose);
    for (const BoundLevel& level : bound(disk, {40000, 2000, 100})) {
        const auto moved = deform::follow(level, surface);
        ASSERT_TRUE(moved);
        EXPECT_LT(deform::pose_error(level, *moved, surface).error, 0.1);
    }
    EXPECT_LT(cpu_seconds() - start, 20);
}
