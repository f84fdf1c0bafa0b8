// SPDX-License-Identifier: GPL-3.0-or-later
// Guards ray::ParallelRays: that drawing triangles finds what searching a tree finds.
#include "base/random.h"
#include "ray/parallel_rays.h"
#include "scenes/small_meshes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;

namespace {

glm::dvec3 random_point(PcgRandom& random) {
    const double x = random.uniform();
    const double y = random.uniform();
    const double z = random.uniform();
    return {x, y, z};
}

/// Boxes that lie in each other, of all sizes.
Mesh crowd_of_boxes(size_t count, uint64_t seed) {
    PcgRandom random(seed, 1);
    Mesh out;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 low = random_point(random);
        append(out, shapes::box(low, low + 0.5 * random_point(random)), {}, 0);
    }
    return out;
}

/// Rays towards the unit cube from around it, and some from inside of it.
std::vector<glm::dvec3> origins_before(const glm::dvec3& direction, size_t count, uint64_t seed) {
    PcgRandom random(seed, 2);
    std::vector<glm::dvec3> out;
    for (size_t i = 0; i < count; ++i) {
        const double back = i % 4 == 0 ? 0.0 : 5.0;
        out.push_back(1.5 * random_point(random) - back * direction);
    }
    return out;
}

}  // namespace

TEST(ParallelRays, NoRaysAndNoMeshHitNothing) {
    const ray::ParallelRays none({0, 0, -1}, {});
    EXPECT_TRUE(none.first_hits(shapes::quad(1, 1)).empty());
    EXPECT_TRUE(none.blocked(shapes::quad(1, 1)).empty());
    const std::vector<glm::dvec3> one{{0, 0, 1}};
    const ray::ParallelRays rays({0, 0, -1}, one);
    ASSERT_EQ(rays.first_hits(Mesh{}).size(), 1u);
    EXPECT_FALSE(rays.first_hits(Mesh{})[0].hit);
    EXPECT_EQ(rays.blocked(Mesh{}), std::vector<uint8_t>{0});
}

TEST(ParallelRays, OneTriangleIsHitFromBothSidesWithItsWeights) {
    Mesh mesh = shapes::quad(2, 2);
    mesh.triangles.resize(1);
    for (const double side : {1.0, -1.0}) {
        const std::vector<glm::dvec3> origin{{1, 0.5, 3 * side}};
        const ray::RayHit hit = ray::ParallelRays({0, 0, -side}, origin).first_hits(mesh)[0];
        const ray::RayHit known = ray::MeshScene(mesh).first_hit(origin[0], {0, 0, -side});
        ASSERT_TRUE(hit.hit);
        EXPECT_EQ(hit.triangle, 0u);
        EXPECT_NEAR(hit.t, 3, 1e-6);
        EXPECT_NEAR(hit.u, known.u, 1e-6);
        EXPECT_NEAR(hit.v, known.v, 1e-6);
        EXPECT_NEAR(glm::length(hit.point - glm::dvec3(1, 0.5, 0)), 0, 1e-6);
    }
}

TEST(ParallelRays, NothingBehindTheOriginIsHit) {
    const std::vector<glm::dvec3> origins{{0.5, 0.5, -1}, {0.5, 0.5, 1}};
    const ray::ParallelRays rays({0, 0, -1}, origins);
    const Mesh mesh = shapes::box({0, 0, -0.5}, {1, 1, 0.5});
    EXPECT_EQ(rays.blocked(mesh), (std::vector<uint8_t>{0, 1}));
    EXPECT_FALSE(rays.first_hits(mesh)[0].hit);
    EXPECT_NEAR(rays.first_hits(mesh)[1].t, 0.5, 1e-6);
}

TEST(ParallelRays, TreesFindTheSame) {
    const Mesh mesh = crowd_of_boxes(40, 7);
    const ray::MeshScene scene(mesh);
    PcgRandom random(3, 1);
    size_t hits = 0;
    for (int view = 0; view < 20; ++view) {
        const glm::dvec3 along = glm::normalize(random_point(random) - 0.4);
        const std::vector<glm::dvec3> origins = origins_before(along, 500, view);
        const ray::ParallelRays rays(along, origins);
        const std::vector<ray::RayHit> drawn = rays.first_hits(mesh);
        const std::vector<uint8_t> blocked = rays.blocked(mesh);
        size_t others = 0;  // rays along an edge may meet either side
        for (size_t i = 0; i < origins.size(); ++i) {
            const ray::RayHit searched = scene.first_hit(origins[i], along);
            EXPECT_EQ(drawn[i].hit, blocked[i] != 0);
            hits += searched.hit ? 1 : 0;
            if (drawn[i].hit != searched.hit || drawn[i].triangle != searched.triangle) {
                ++others;
                continue;
            }
            if (!searched.hit)
                continue;
            EXPECT_NEAR(drawn[i].t, searched.t, 1e-5);
            EXPECT_LT(glm::length(drawn[i].point - searched.point), 1e-5);
            EXPECT_LT(glm::length(drawn[i].point - (origins[i] + drawn[i].t * along)), 1e-5);
        }
        EXPECT_LE(others, 2u) << view;
    }
    EXPECT_GT(hits, 2000u);
}

TEST(ParallelRays, TheLowestOfTwoEqualTrianglesIsHit) {
    Mesh mesh = shapes::quad(1, 1);
    append(mesh, shapes::quad(1, 1), {}, 0);
    const std::vector<glm::dvec3> origins{{0.3, 0.2, 1}, {0.2, 0.3, 1}, {0.9, 0.8, 1}};
    for (const ray::RayHit& hit : ray::ParallelRays({0, 0, -1}, origins).first_hits(mesh))
        EXPECT_LT(hit.triangle, 2u);
}

TEST(ParallelRays, NoRayPassesBetweenNeighbors) {
    // Every ray crosses an edge or a vertex of a plane of many triangles, far from the middle of
    // the world, whose corners are not shared.
    constexpr int kSide = 12;
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.3, -0.2, -1));
    Mesh mesh;
    const Affine far{glm::dmat3(1.0), {1000, -2000, 500}};
    const Mesh plane = shapes::terrain(kSide);
    for (const Triangle& t : plane.triangles) {
        Mesh one;
        one.positions = {plane.positions[t.x], plane.positions[t.y], plane.positions[t.z]};
        one.triangles = {{0, 1, 2}};
        append(mesh, one, far, 0);
    }
    std::vector<glm::dvec3> origins;
    Box3 box;
    for (const glm::vec3& position : mesh.positions)
        box.add(glm::dvec3(position));
    for (const Triangle& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 a(mesh.positions[t[corner]]);
            const glm::dvec3 b(mesh.positions[t[(corner + 1) % 3]]);
            for (const double share : {0.0, 0.25, 1.0 / 3, 0.7}) {
                const glm::dvec3 at = a + share * (b - a);
                const double edge = std::min(std::min(at.x - box.low.x, box.high.x - at.x),
                                             std::min(at.y - box.low.y, box.high.y - at.y));
                if (edge > 0.01)  // not the border of the plane
                    origins.push_back(at - 3.0 * along);
            }
        }
    }
    ASSERT_GT(origins.size(), 1000u);
    const std::vector<uint8_t> blocked = ray::ParallelRays(along, origins).blocked(mesh);
    EXPECT_EQ(std::count(blocked.begin(), blocked.end(), 0), 0);
}

TEST(ParallelRays, WhatIsNotFiniteHitsNothing) {
    Mesh mesh = shapes::quad(1, 1);
    mesh.positions.emplace_back(std::nanf(""));
    mesh.triangles.push_back({0, 1, static_cast<uint32_t>(mesh.positions.size() - 1)});
    mesh.triangles.push_back({0, 0, 1});
    const std::vector<glm::dvec3> origins{
        {0.3, 0.2, 1}, glm::dvec3(kInfinity), glm::dvec3(std::nan("")), {0.2, 0.3, 1}};
    const std::vector<ray::RayHit> hits = ray::ParallelRays({0, 0, -1}, origins).first_hits(mesh);
    EXPECT_TRUE(hits[0].hit);
    EXPECT_FALSE(hits[1].hit);
    EXPECT_FALSE(hits[2].hit);
    EXPECT_TRUE(hits[3].hit);
    const std::vector<glm::dvec3> none{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
    EXPECT_EQ(ray::ParallelRays({0, 0, -1}, none).blocked(mesh), (std::vector<uint8_t>{0, 0}));
}
