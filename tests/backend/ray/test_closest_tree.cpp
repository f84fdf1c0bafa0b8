// SPDX-License-Identifier: GPL-3.0-or-later
// Guards closest points against looking at every triangle: same triangle, same bits.
#include "base/random.h"
#include "ray/closest_search.h"
#include "ray/closest_tree.h"
#include "ray/mesh_scene.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

glm::dvec3 point_in(PcgRandom& random, double size) {
    return size * (2.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0);
}

/// Triangles of all sizes, needles, points and the same ones twice.
Mesh soup(int count, uint64_t seed) {
    PcgRandom random(seed);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 a = point_in(random, 1);
        const double size = std::pow(10.0, -4 * random.uniform());
        glm::dvec3 b = a + point_in(random, size);
        glm::dvec3 c = a + point_in(random, size);
        if (i % 5 == 1)
            c = 0.5 * (a + b) + point_in(random, 1e-6 * size);  // a needle
        if (i % 5 == 3)
            c = b + point_in(random, size * std::pow(10.0, -1 - 6 * random.uniform()));  // another
        if (i % 11 == 2)
            b = c = a;
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const glm::dvec3& corner : {a, b, c})
            mesh.positions.emplace_back(corner);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        if (i % 7 == 3)
            mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

/// The nearest point by looking at all triangles, of whatever mesh the scene was made from.
ray::ClosestPoint by_all(const Mesh& mesh, const glm::dvec3& point) {
    ray::ClosestSearch search{mesh.positions, mesh.triangles, point};
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
        search.visit(i);
    return {std::sqrt(search.square), search.triangle, search.where.point, search.where.u,
            search.where.v};
}

void expect_same(const Mesh& mesh, const std::vector<glm::dvec3>& points) {
    const ray::MeshScene scene(mesh, nullptr, ray::SceneUse::ClosestPoints);
    const double size = bound_of(mesh.positions).radius;
    for (const glm::dvec3& point : points) {
        const ray::ClosestPoint found = scene.closest_point(point);
        const ray::ClosestPoint right = by_all(mesh, point);
        // The scene looks from its own frame, which rounds positions to 2^-24 of its size.
        ASSERT_NEAR(found.distance, right.distance, 2e-7 * (size + right.distance));
        ASSERT_EQ(scene.closest_point(point, kInfinity, 3).triangle, found.triangle);
        ASSERT_EQ(scene.closest_point(point, found.distance * (1 + 1e-9)).triangle, found.triangle);
        ASSERT_EQ(scene.closest_point(point, found.distance * 0.999 - 1e-9).triangle,
                  ray::kNoTriangle);
        for (const double enough : {0.5 * found.distance, 2 * found.distance}) {
            const double far = scene.closest_point(point, kInfinity, 3, enough).distance;
            ASSERT_LE(far, std::max(enough, found.distance));
            ASSERT_GE(far, found.distance);
            ASSERT_EQ(
                scene.closest_point(point, found.distance * 0.999 - 1e-9, ray::kNoTriangle, enough)
                    .triangle,
                ray::kNoTriangle);
        }
    }
}

}  // namespace

TEST(ClosestTree, FindsTheSameAsLookingAtEveryTriangle) {
    for (const uint64_t seed : {1u, 2u, 3u}) {
        const Mesh mesh = soup(600, seed);
        PcgRandom random(seed + 10);
        std::vector<glm::dvec3> points;
        points.reserve(500);
        for (const double size : {1.0, 3.0, 1e3, 1e9})
            for (int i = 0; i < 100; ++i)
                points.push_back(point_in(random, size));
        for (size_t i = 0; i < 100; ++i)  // on and beside the surface
            points.push_back(glm::dvec3(mesh.positions[i]) + point_in(random, 1e-6));
        expect_same(mesh, points);
    }
}

TEST(ClosestTree, OfWhatWasModelledStraightAndStandsAskewHasTheSameAnswers) {
    PcgRandom random(5);
    const glm::dvec3 x = glm::normalize(glm::dvec3(3, 1, 2));
    const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(0, 1, 0)));
    const glm::dmat3 askew(x, y, glm::cross(x, y));
    Mesh mesh;  // thin sheets, one above the other
    for (int i = 0; i < 100; ++i) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const glm::dvec2 corner : {glm::dvec2(0, 0), {2, 0}, {2, 1}, {0, 1}})
            mesh.positions.emplace_back(askew * glm::dvec3(corner, 0.003 * i) + 7.0);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
    std::vector<glm::dvec3> points;
    points.reserve(400);
    for (const double size : {0.1, 1.0, 10.0, 1e8})
        for (int i = 0; i < 100; ++i)
            points.push_back(7.0 + point_in(random, size));
    expect_same(mesh, points);
}

TEST(ClosestTree, OfFewTrianglesHasTheSameAnswers) {
    PcgRandom random(5);
    for (const int count : {1, 2, 4, 5, 9, 17}) {
        std::vector<glm::dvec3> points;
        points.reserve(50);
        for (int i = 0; i < 50; ++i)
            points.push_back(point_in(random, 2));
        expect_same(soup(count, static_cast<uint64_t>(count)), points);
    }
}

TEST(ClosestTree, AmongEquallyNearTrianglesTheLowestWins) {
    Mesh mesh = shapes::quad(1, 1);
    for (int i = 0; i < 40; ++i)
        append(mesh, shapes::quad(1, 1), Affine{});
    const ray::MeshScene scene(mesh, nullptr, ray::SceneUse::ClosestPoints);
    EXPECT_EQ(scene.closest_point({0.75, 0.25, 1}).triangle, 0u);
    EXPECT_EQ(scene.closest_point({0.75, 0.25, 1}, kInfinity, 64).triangle, 0u);
    EXPECT_EQ(scene.closest_point({0.25, 0.75, -2}).triangle, 1u);
}

TEST(ClosestTree, TrianglesInOnePlaceAndInALineDoNotRunDeep) {
    // Middles that coincide, and such that each split leaves almost all on one side.
    Mesh mesh;
    for (int i = 0; i < 3000; ++i) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        const float x = i < 1000 ? 0.5f : std::ldexp(1.0f, -i % 120);
        mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x, 1e-3f, 0}, {x, 0, 1e-3f}});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    expect_same(mesh, {{0.3, 0.1, 0.2}, {0, 0, 0}, {2, 2, 2}, {1e-9, 0, 0}});
}

TEST(ClosestTree, BuildingLevelsOfThousandsOfTrianglesInOnePlaceTookMinutes) {
    // Every search looked at all of them, as none is nearer than the others.
    const glm::vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0.25}};
    const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    Mesh mesh;
    mesh.positions = {{0.9, 0.1, 0}, {0.9, 0.1, 0.2}, {0.9, 0.3, 0}};
    mesh.triangles = {{0, 1, 2}};
    for (const int count : {1, 6}) {
        for (int i = 0; i < 3000; ++i) {
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            for (const int corner : orders[i % count])
                mesh.positions.push_back(corners[corner]);
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
        const ray::ClosestTree tree(mesh.positions, mesh.triangles, false);
        EXPECT_LE(tree.leaves(), 4u);
        EXPECT_GE(ray::ClosestTree(mesh.positions, mesh.triangles, true).leaves(), 700u);
        expect_same(mesh, {{0.3, 0.1, 0.2}, {0, 0, 0}, {2, 2, 2}, {0.9, 0.2, 0.1}, {0.2, 0.1, 0}});
    }
    const ray::MeshScene scene(mesh, nullptr, ray::SceneUse::ClosestPoints);
    EXPECT_EQ(scene.closest_point({0.3, 0.1, 0.2}, kInfinity, 2000).triangle,
              scene.closest_point({0.3, 0.1, 0.2}).triangle);
}

TEST(ClosestTree, OneCornerAtTheEdgeOfWhatFloatsHoldCrashedIt) {
    // Beside it all else is one place, but for differences whose inverse is infinite.
    Mesh mesh = shapes::sphere(1);
    mesh.positions[57].y = -1.7014118e38f;
    const ray::MeshScene scene(mesh, nullptr, ray::SceneUse::ClosestPoints);
    const ray::ClosestPoint found = scene.closest_point({0, -1.7014118e38, 0});
    EXPECT_LT(found.distance, 1e31);  // rounding, in the scene's own frame
    const Triangle& triangle = mesh.triangles[found.triangle];
    EXPECT_TRUE(triangle.x == 57 || triangle.y == 57 || triangle.z == 57);
}

TEST(ClosestTree, WhatIsNearEnoughEndsTheSearchAndNothingElseDoes) {
    const Mesh mesh = soup(600, 4);
    const ray::MeshScene scene(mesh, nullptr, ray::SceneUse::ClosestPoints);
    PcgRandom random(14);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 point = point_in(random, 2);
        const double right = scene.closest_point(point).distance;
        const ray::ClosestPoint some = scene.closest_point(point, kInfinity, 3, 2 * right);
        EXPECT_GE(some.distance, right);
        EXPECT_LE(some.distance, 2 * right * (1 + 1e-9));
        EXPECT_EQ(scene.closest_point(point, kInfinity, 3, 0.999 * right).distance, right);
    }
}

TEST(ClosestTree, ScenesForClosestPointsRefuseRaysByName) {
    const ray::MeshScene scene(shapes::cube(), nullptr, ray::SceneUse::ClosestPoints);
    EXPECT_NEAR(scene.closest_point({0, 0, 2}).distance, 1.5, 1e-6);
    EXPECT_THROW(scene.first_hit({0, 0, 2}, {0, 0, -1}), Error);
    EXPECT_THROW(scene.occluded({0, 0, 2}, {0, 0, -1}), Error);
    EXPECT_EQ(
        ray::MeshScene(Mesh{}, nullptr, ray::SceneUse::ClosestPoints).closest_point({}).distance,
        kInfinity);
}

// The front of a thin board is the place of what faces as it does, though its back is nearer.
TEST(ClosestTree, OfWhatFacesOneWayTheNearestIsFound) {
    std::string reason;
    if (!ray::available(&reason))
        GTEST_SKIP() << reason;
    const ray::MeshScene board(shapes::box({0, 0, 0}, {1, 1, 0.01}));
    const glm::dvec3 below(0.5, 0.5, -1);
    EXPECT_NEAR(board.closest_facing(below, {0, 0, 1}, kInfinity).distance, 1.01, 1e-6);
    EXPECT_NEAR(board.closest_facing(below, {0, 0, -1}, kInfinity).distance, 1, 1e-6);
    EXPECT_EQ(board.closest_facing(below, {0, 0, 1}, 1.005).triangle, ray::kNoTriangle);
    const Mesh ball = shapes::sphere(1, 4);
    const ray::MeshScene scene(ball);
    PcgRandom random(3);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 point = point_in(random, 2);
        const glm::dvec3 facing = point_in(random, 1);
        const ray::ClosestPoint found = scene.closest_facing(point, facing, kInfinity);
        double right = kInfinity;
        for (size_t k = 0; k < ball.triangles.size(); ++k) {
            const Triangle& t = ball.triangles[k];
            const geometry::OnTriangle there = geometry::closest_on_triangle(
                point, glm::dvec3(ball.positions[t.x]), glm::dvec3(ball.positions[t.y]),
                glm::dvec3(ball.positions[t.z]));
            if (glm::dot(area_vector(ball, k), facing) > 0)
                right = std::min(right, glm::length(there.point - point));
        }
        ASSERT_NEAR(found.distance, right, 1e-6);
        const uint32_t perhaps = static_cast<uint32_t>(i);
        ASSERT_EQ(scene.closest_facing(point, facing, kInfinity, perhaps).triangle, found.triangle);
    }
}
