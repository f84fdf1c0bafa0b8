// SPDX-License-Identifier: GPL-3.0-or-later
// Guards ray::MeshScene: that Embree is found, answers right at every scale, and never kills us.
#include "base/parallel.h"
#include "base/random.h"
#include "ray/mesh_scene.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_meshes.h"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

using namespace lodestone;

namespace {

Mesh moved(const Mesh& mesh, double scale, const glm::dvec3& offset) {
    Mesh out = mesh;
    for (glm::vec3& position : out.positions)
        position = glm::vec3(scale * glm::dvec3(position) + offset);
    return out;
}

glm::dvec3 random_point(PcgRandom& random) {
    const double x = random.uniform();
    const double y = random.uniform();
    const double z = random.uniform();
    return glm::dvec3(x, y, z) * 4.0 - 2.0;
}

}  // namespace

TEST(Ray, EmbreeIsFoundAndPassesItsSelfTest) {
    std::string reason = "untouched";
    EXPECT_TRUE(ray::available(&reason)) << reason;
    EXPECT_EQ(reason, "");
}

TEST(Ray, EmptyMeshIsNeverHitAndHasNoClosestPoint) {
    const ray::MeshScene scene{Mesh{}};
    EXPECT_EQ(scene.triangles(), 0u);
    EXPECT_FALSE(scene.first_hit({0, 0, 1}, {0, 0, -1}).hit);
    EXPECT_FALSE(scene.occluded({0, 0, 1}, {0, 0, -1}));
    EXPECT_EQ(scene.closest_point({0, 0, 0}).distance, kInfinity);
    EXPECT_EQ(scene.closest_point({0, 0, 0}).triangle, ray::kNoTriangle);
}

TEST(Ray, OneTriangleIsHitFromBothSidesWithItsWeights) {
    Mesh mesh = shapes::quad(2, 2);
    mesh.triangles.resize(1);
    const ray::MeshScene scene(mesh);
    for (const double side : {1.0, -1.0}) {
        const ray::RayHit hit = scene.first_hit({1, 0.5, 3 * side}, {0, 0, -2 * side});
        ASSERT_TRUE(hit.hit);
        EXPECT_EQ(hit.triangle, 0u);
        EXPECT_NEAR(hit.t, 1.5, 1e-6);
        EXPECT_NEAR(hit.u, 0.25, 1e-6);
        EXPECT_NEAR(hit.v, 0.25, 1e-6);
        EXPECT_NEAR(glm::length(hit.point - glm::dvec3(1, 0.5, 0)), 0, 1e-6);
    }
}

TEST(Ray, FarEndOfARayIsInUnitsOfItsDirection) {
    const ray::MeshScene scene(shapes::quad(2, 2));
    EXPECT_TRUE(scene.first_hit({1, 0.5, 3}, {0, 0, -2}, 1.51).hit);
    EXPECT_FALSE(scene.first_hit({1, 0.5, 3}, {0, 0, -2}, 1.49).hit);
    EXPECT_TRUE(scene.occluded({1, 0.5, 3}, {0, 0, -2}, 1.51));
    EXPECT_FALSE(scene.occluded({1, 0.5, 3}, {0, 0, -2}, 1.49));
    EXPECT_FALSE(scene.occluded({1, 0.5, 3}, {0, 0, 2}));
    EXPECT_FALSE(scene.occluded({1, 0.5, 3}, {0, 0, -2}, -1));
}

TEST(Ray, ClosestPointsOfACubeAreKnownOverFaceEdgeAndCorner) {
    const ray::MeshScene scene(shapes::cube());
    EXPECT_NEAR(scene.closest_point({0.1, 0.2, 2}).distance, 1.5, 1e-12);
    EXPECT_NEAR(scene.closest_point({1.5, 0.2, 1.5}).distance, std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(scene.closest_point({1.5, 1.5, 1.5}).distance, std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(scene.closest_point({0, 0, 0.4}).distance, 0.1, 1e-12);
    EXPECT_EQ(scene.closest_point({0, 0, 2}, 1.49).distance, kInfinity);
    EXPECT_NEAR(scene.closest_point({0, 0, 2}, 1.5).distance, 1.5, 1e-12);
    EXPECT_NEAR(scene.closest_point({0, 0, 1e9}).distance, 1e9 - 0.5, 1e-6);
    EXPECT_NEAR(scene.closest_point({0, 0, 1e18}).distance / 1e18, 1, 1e-12);
}

TEST(Ray, ClosestPointAgreesWithTheDistanceToASphere) {
    const ray::MeshScene scene(shapes::sphere(1, 5));
    PcgRandom random(7);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 point = random_point(random);
        const ray::ClosestPoint closest = scene.closest_point(point);
        EXPECT_NEAR(closest.distance, std::abs(glm::length(point) - 1), 1e-3);
        EXPECT_NEAR(glm::length(closest.point - point), closest.distance, 1e-12);
    }
}

TEST(Ray, FarAndTinyAndHugeMeshesAreHitLikeTheOneAtTheOrigin) {
    struct Place {
        double scale;
        glm::dvec3 offset;
    };
    // Cases in which the scaled and moved floats are exact.
    for (const Place& place :
         {Place{1, glm::dvec3(0x1p20)}, Place{0x1p-20, glm::dvec3(0)}, Place{0x1p20, glm::dvec3(0)},
          Place{0x1p-100, glm::dvec3(0)}, Place{0x1p100, glm::dvec3(0)}}) {
        const Mesh mesh = moved(shapes::cube(), place.scale, place.offset);
        const ray::MeshScene scene(mesh);
        const ray::MeshScene reference(shapes::cube());
        PcgRandom random(3);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 origin = random_point(random);
            const glm::dvec3 direction = random_point(random);
            const ray::RayHit a = reference.first_hit(origin, direction);
            const ray::RayHit b = scene.first_hit(place.scale * origin + place.offset, direction);
            const ray::ClosestPoint c = reference.closest_point(origin);
            const ray::ClosestPoint d = scene.closest_point(place.scale * origin + place.offset);
            ASSERT_EQ(a.hit, b.hit);
            ASSERT_NEAR(d.distance / place.scale, c.distance, 1e-8);
            if (!a.hit)
                continue;
            ++hits;
            ASSERT_EQ(a.triangle, b.triangle);
            ASSERT_NEAR(b.t / place.scale, a.t, 1e-5 * a.t);
        }
        EXPECT_GT(hits, 50);
    }
}

TEST(Ray, OriginsArbitrarilyFarAwayStillHitTheRightSpot) {
    const ray::MeshScene scene(shapes::cube());
    for (const double far : {1e3, 1e6, 1e9}) {
        const ray::RayHit hit = scene.first_hit({0.125, 0.25, far}, {0, 0, -1});
        ASSERT_TRUE(hit.hit) << far;
        EXPECT_NEAR(glm::length(hit.point - glm::dvec3(0.125, 0.25, 0.5)), 0, 1e-6) << far;
        EXPECT_NEAR(hit.t, far - 0.5, 1e-6 * far) << far;
        EXPECT_FALSE(scene.occluded({0.75, 0.25, far}, {0, 0, -1}));
    }
}

TEST(Ray, OfCoincidentTrianglesTheLowestIsHitAndClosest) {
    Mesh mesh;
    for (int copy = 0; copy < 40; ++copy)
        append(mesh, shapes::quad(1, 1), Affine{});
    const ray::MeshScene scene(mesh);
    PcgRandom random(5);
    for (int i = 0; i < 200; ++i) {
        const double x = random.uniform();
        const double y = random.uniform();
        const glm::dvec3 point(x, y, 1);
        EXPECT_LT(scene.first_hit(point, {0, 0, -1}).triangle, 2u);
        EXPECT_LT(scene.closest_point(point).triangle, 2u);
    }
}

TEST(Ray, AnswersAreTheSameBitsFromOneAndManyThreads) {
    const ray::MeshScene scene(shapes::terrain(64));
    const auto all = [&](int threads) {
        const ThreadLimit limit(threads);
        std::vector<double> out(8192);
        parallel_for(4096, [&](size_t i) {
            PcgRandom random(i, 9);
            const glm::dvec3 origin = random_point(random);
            const glm::dvec3 target = 0.25 * (random_point(random) + 2.0);
            out[2 * i] = scene.first_hit(origin, target - origin).t;
            out[2 * i + 1] = scene.closest_point(origin).distance;
        });
        return out;
    };
    EXPECT_EQ(all(1), all(0));
}

// Triangles that blocked rays lately are tried first: they may say nothing that Embree does not.
TEST(Ray, WhatBlockedRaysLatelyChangesNoAnswer) {
    PcgRandom random(5);
    Mesh slivers;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 a = random_point(random);
        const glm::dvec3 along = random_point(random);
        const double width = std::pow(0.1, 6 * random.uniform());
        for (const glm::dvec3& corner : {a, a + along, a + width * random_point(random)})
            slivers.positions.emplace_back(corner);
        slivers.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    slivers.triangles.emplace_back(0, 0, 1);
    Mesh nested = shapes::box(glm::dvec3(-2), glm::dvec3(4));
    append(nested, shapes::sphere(1.5, 3), {});
    for (const Mesh& mesh : {slivers, nested, moved(slivers, 1e-4, glm::dvec3(1000))}) {
        const ray::MeshScene scene(mesh);
        ray::RecentBlockers blockers;
        size_t blocked = 0;
        for (int i = 0; i < 100000; ++i) {
            // From a surface, as rays go that ask whether it can be seen; some along an edge.
            const auto index =
                static_cast<size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()));
            const Triangle& t = mesh.triangles[index];
            const glm::dvec3 from(mesh.positions[t.x]);
            const glm::dvec3 edge = glm::dvec3(mesh.positions[t.y]) - from;
            const glm::dvec3 way = i % 16 == 0 ? edge : random_point(random);
            const glm::dvec3 origin = from + random.uniform() * edge + 1e-5 * way;
            const bool expected = scene.occluded(origin, way);
            ASSERT_EQ(scene.occluded(origin, way, blockers), expected) << i;
            blocked += expected ? 1 : 0;
        }
        EXPECT_GT(blocked, 10000u);
    }
}

TEST(Ray, WhatBlocksIsAheadAndWellWithinItsEdges) {
    ray::RecentBlockers blockers;
    const glm::vec3 up(0, 0, 1);
    EXPECT_FALSE(blockers.block({0, 0, -0.5}, up));
    for (const bool turned : {false, true}) {
        const float sign = turned ? -1.0f : 1.0f;
        blockers.add({glm::vec3{-0.5f, -0.5f, 0}, {0.5f * sign, -0.5f * sign, 0}, {0, 0.5f, 0}});
    }
    EXPECT_TRUE(blockers.block({0, 0, -0.5f}, up));
    EXPECT_TRUE(blockers.block({0, 0, 0.5f}, -up));
    EXPECT_FALSE(blockers.block({0, 0, 0.5f}, up));
    EXPECT_FALSE(blockers.block({0, 0, 0}, up));
    EXPECT_FALSE(blockers.block({0.4f, 0.4f, -0.5f}, up));
    EXPECT_TRUE(blockers.block({0, -0.499f, -0.5f}, up));
    EXPECT_FALSE(blockers.block({0, -0.5f, -0.5f}, up));
    EXPECT_FALSE(blockers.block({0.5f, -0.5f, -0.5f}, up));
    // The latest eight.
    for (int i = 0; i < 8; ++i)
        blockers.add({glm::vec3{0.8f, 0, 0}, {0.9f, 0, 0}, {0.8f, 0.1f, 0}});
    EXPECT_FALSE(blockers.block({0, 0, -0.5f}, up));
    EXPECT_TRUE(blockers.block({0.82f, 0.02f, -0.5f}, up));
}

TEST(Ray, CastingLeavesTheCallersFloatingPointModeAlone) {
#if defined(__SSE2__)
    const ray::MeshScene scene(shapes::cube());
    const unsigned before = _mm_getcsr() & 0xffc0u;
    (void)scene.first_hit({0, 0, 2}, {0, 0, -1});
    (void)scene.closest_point({0, 0, 2});
    EXPECT_EQ(_mm_getcsr() & 0xffc0u, before);
#endif
}

TEST(Ray, DirectionsThatAreNoneHitNothing) {
    const ray::MeshScene scene(shapes::cube());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(scene.first_hit({0, 0, 2}, {0, 0, 0}).hit);
    EXPECT_FALSE(scene.first_hit({0, 0, 2}, {0, 0, nan}).hit);
    EXPECT_FALSE(scene.first_hit({0, 0, 2}, {0, 0, -kInfinity}).hit);
    EXPECT_FALSE(scene.first_hit({0, nan, 2}, {0, 0, -1}).hit);
    EXPECT_FALSE(scene.occluded({kInfinity, 0, 0}, {-1, 0, 0}));
    EXPECT_FALSE(scene.occluded({0, 0, 2}, {0, 0, -1}, nan));
    EXPECT_EQ(scene.closest_point({nan, 0, 0}).distance, kInfinity);
    EXPECT_EQ(scene.closest_point({0, 0, nan}).distance, kInfinity);
    EXPECT_EQ(scene.closest_point({0, kInfinity, 0}).distance, kInfinity);
    EXPECT_EQ(scene.closest_point({0, 0, 0}, nan).distance, kInfinity);
}

TEST(Ray, DegenerateAndNonFiniteTrianglesDoNoHarm) {
    Mesh mesh = shapes::cube();
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    mesh.normals.clear();
    mesh.positions.insert(mesh.positions.end(),
                          {{nan, 0, 0}, {infinity, 0, 0}, {0.1f, 0, 0.5f}, {3e38f, 0, 0}});
    mesh.triangles.emplace_back(0, 1, first);
    mesh.triangles.emplace_back(0, 1, first + 1);
    mesh.triangles.emplace_back(first + 2, first + 2, first + 2);
    mesh.triangles.emplace_back(0, 1, 0);
    const ray::MeshScene scene(mesh);
    EXPECT_NEAR(scene.first_hit({0.1, 0.2, 2}, {0, 0, -1}).t, 1.5, 1e-6);
    EXPECT_NEAR(scene.closest_point({0.1, 0.2, 2}).distance, 1.5, 1e-9);
    EXPECT_NEAR(scene.closest_point({0.1, 0.2, 1e16}).distance, 1e16, 1e3);
}

TEST(Ray, MeshOfOnlyPointsHasClosestPointsAndNoHits) {
    Mesh mesh;
    mesh.positions = {{1, 2, 3}, {1, 2, 4}};
    mesh.triangles = {{0, 0, 0}, {0, 1, 1}};
    const ray::MeshScene scene(mesh);
    EXPECT_FALSE(scene.first_hit({1, 2, 9}, {0, 0, -1}).hit);
    EXPECT_NEAR(scene.closest_point({1, 2, 0}).distance, 3, 1e-9);
    EXPECT_NEAR(scene.closest_point({2, 2, 3.5}).distance, 1, 1e-9);
}

TEST(Ray, IndexOutOfRangeIsRefusedByName) {
    Mesh mesh = shapes::quad(1, 1);
    mesh.positions.pop_back();
    try {
        const ray::MeshScene scene(mesh);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.status, Status::InvalidArgument);
        EXPECT_STREQ(error.what(), "triangle 1 uses vertex 3 of 3");
    }
}

TEST(Ray, FirstUseInsideAParallelLoopDoesNotWaitForItself) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";  // a new process, where nobody has cast
    const auto build = [] {
        parallel_for(64, [](size_t) {
            if (!ray::MeshScene(shapes::cube()).occluded({0.1, 0.2, 2}, {0, 0, -1}))
                std::_Exit(1);
        });
        std::_Exit(0);
    };
    EXPECT_EXIT(build(), testing::ExitedWithCode(0), "");
}

TEST(Ray, MovedScenesKeepWorkingAndManyCanBeBuiltAtOnce) {
    std::vector<ray::MeshScene> scenes;
    scenes.reserve(20);
    for (int i = 0; i < 20; ++i)
        scenes.emplace_back(moved(shapes::cube(), 1, glm::dvec3(i, 0, 0)));
    for (int i = 0; i < 20; ++i)
        EXPECT_TRUE(scenes[static_cast<size_t>(i)].occluded({i + 0.1, 0.2, 2}, {0, 0, -1}));
    std::vector<uint8_t> hits(64, 0);
    parallel_for(hits.size(), [&](size_t i) {
        const ray::MeshScene scene(shapes::terrain(8 + static_cast<uint32_t>(i % 8)));
        hits[i] = scene.occluded({0.51, 0.52, 1}, {0, 0, -1});
    });
    EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), 64);
}

namespace {

ray::SkinPtr skin_of(const std::vector<Material>& materials) {
    image::TexelCache texels;
    return std::make_shared<const ray::MeshSkin>(materials, texels);
}

/// Of `count` rays straight down on the unit square, those that hit; occluded() must agree.
int hits_from_above(const ray::MeshScene& scene, int count) {
    PcgRandom random(3);
    int hits = 0;
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform();
        const double y = random.uniform();
        const bool hit = scene.first_hit({x, y, 1}, {0, 0, -1}).hit;
        EXPECT_EQ(scene.occluded({x, y, 1}, {0, 0, -1}), hit);
        hits += hit ? 1 : 0;
    }
    return hits;
}

}  // namespace

TEST(RayAlpha, CardIsHitWhereItsLeafIs) {
    for (const AlphaMode mode : {AlphaMode::Clip, AlphaMode::Blend}) {
        const ray::SkinPtr skin = skin_of({foliage::leaf(foliage::left_half(), mode)});
        const ray::MeshScene scene(foliage::card(1, 1), skin);
        EXPECT_TRUE(scene.see_through());
        EXPECT_TRUE(scene.first_hit({0.3, 0.6, 1}, {0, 0, -1}).hit);
        EXPECT_TRUE(scene.occluded({0.3, 0.6, 1}, {0, 0, -1}));
        EXPECT_FALSE(scene.first_hit({0.7, 0.6, 1}, {0, 0, -1}).hit);
        EXPECT_FALSE(scene.occluded({0.7, 0.6, 1}, {0, 0, -1}));
        EXPECT_FALSE(scene.first_hit({0.7, 0.6, -1}, {0, 0, 1}).hit);
    }
}

TEST(RayAlpha, RayThroughAHoleHitsWhatIsBehind) {
    Mesh mesh = foliage::card(1, 1);
    append(mesh, shapes::quad(1, 1), {glm::dmat3(1.0), {0, 0, -2}}, 1);
    const ray::MeshScene scene(mesh, skin_of({foliage::leaf(foliage::left_half()), Material{}}));
    EXPECT_NEAR(scene.first_hit({0.25, 0.5, 1}, {0, 0, -1}).t, 1, 1e-6);
    EXPECT_NEAR(scene.first_hit({0.75, 0.5, 1}, {0, 0, -1}).t, 3, 1e-6);
    EXPECT_TRUE(scene.occluded({0.75, 0.5, 1}, {0, 0, -1}));
}

TEST(RayAlpha, BlendedSurfacesStopTheirShareOfRaysAndAlwaysTheSame) {
    Material glass;
    glass.alpha_mode = AlphaMode::Blend;
    glass.alpha = 0.3;
    const ray::MeshScene scene(shapes::quad(1, 1), skin_of({glass}));
    const int hits = hits_from_above(scene, 10000);
    EXPECT_NEAR(hits, 3000, 150);
    EXPECT_EQ(hits_from_above(scene, 10000), hits);
    glass.alpha_mode = AlphaMode::Clip;
    EXPECT_EQ(hits_from_above(ray::MeshScene(shapes::quad(1, 1), skin_of({glass})), 100), 0);
    glass.alpha_cutoff = 0.2;
    EXPECT_EQ(hits_from_above(ray::MeshScene(shapes::quad(1, 1), skin_of({glass})), 100), 100);
}

TEST(RayAlpha, VertexColorsAndMixturesCount) {
    Material painted;
    painted.vertex_colors = true;
    painted.alpha_mode = AlphaMode::Blend;
    Mesh mesh = shapes::quad(1, 1);
    mesh.colors.assign(4, glm::vec4(1, 1, 1, 0.25f));
    EXPECT_NEAR(hits_from_above(ray::MeshScene(mesh, skin_of({painted})), 10000), 2500, 150);
    // Half of an opaque material and half of nothing.
    Material mixed;
    auto nothing = std::make_shared<Material>();
    nothing->alpha_mode = AlphaMode::Blend;
    nothing->alpha = 0;
    mixed.other = nothing;
    mixed.mix = 0.5;
    EXPECT_NEAR(hits_from_above(ray::MeshScene(mesh, skin_of({mixed})), 10000), 5000, 200);
}

TEST(RayAlpha, OpaqueMaterialsOfAllKindsPayNothing) {
    Mesh mesh = foliage::card(1, 1);
    mesh.colors.assign(4, glm::vec4(1));
    Material opaque = foliage::leaf(foliage::left_half());
    opaque.alpha_mode = AlphaMode::Opaque;
    const PicturePtr full =
        foliage::picture(4, [](double x, double y) { return glm::dvec4(x, y, 0, 1); });
    Material painted = foliage::leaf(full, AlphaMode::Blend);
    painted.vertex_colors = true;
    for (const Material& material : {Material{}, opaque, foliage::leaf(full), painted})
        EXPECT_FALSE(ray::MeshScene(mesh, skin_of({material})).see_through());
    // A see-through material that no triangle uses.
    mesh.slots = {0, 0};
    EXPECT_FALSE(ray::MeshScene(mesh, skin_of({Material{}, foliage::leaf(foliage::left_half())}))
                     .see_through());
}

TEST(RayAlpha, WithoutCoordinatesTheMeanAlphaCounts) {
    const ray::SkinPtr skin = skin_of({foliage::leaf(foliage::left_half(), AlphaMode::Blend)});
    EXPECT_NEAR(hits_from_above(ray::MeshScene(shapes::quad(1, 1), skin), 10000), 5000, 200);
}

TEST(RayAlpha, NearestPointIsTheEdgeOfTheLeaf) {
    const ray::MeshScene scene(foliage::card(1, 1), skin_of({foliage::leaf(foliage::left_half())}));
    EXPECT_NEAR(scene.closest_point({0.3, 0.6, 0.4}).distance, 0.4, 1e-6);
    for (const double x : {0.55, 0.7, 0.95}) {
        const ray::ClosestPoint closest = scene.closest_point({x, 0.5, 0});
        EXPECT_GE(closest.distance, x - 0.5 - 1e-6) << x;
        EXPECT_LE(closest.distance, x - 0.5 + 0.05) << x;
        EXPECT_LE(closest.point.x, 0.5 + 1e-3);
    }
    // Nothing is shown at all.
    Material nothing;
    nothing.alpha_mode = AlphaMode::Blend;
    nothing.alpha = 0;
    EXPECT_EQ(
        ray::MeshScene(shapes::quad(1, 1), skin_of({nothing})).closest_point({0, 0, 1}).distance,
        kInfinity);
}

TEST(RayAlpha, HostileMaterialsAreHarmless) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Mesh mesh = foliage::card(1, 1);
    mesh.uvs[1] = glm::vec2(std::numeric_limits<float>::quiet_NaN());
    mesh.uvs[2] = glm::vec2(std::numeric_limits<float>::infinity());
    mesh.colors.assign(4, glm::vec4(std::numeric_limits<float>::quiet_NaN()));
    mesh.slots = {0, 7};  // nobody described the second
    Material odd = foliage::leaf(foliage::left_half(), AlphaMode::Blend);
    odd.vertex_colors = true;
    odd.alpha_texture.scale = glm::dvec3(nan);
    odd.alpha_texture.to_picture[0] = nan;
    odd.mix = nan;
    odd.other = std::make_shared<Material>(odd);
    const ray::MeshScene scene(mesh, skin_of({odd}));
    EXPECT_NO_THROW(hits_from_above(scene, 100));
    EXPECT_TRUE(scene.first_hit({0.3, 0.6, 1}, {0, 0, -1}).hit) << "slot 7 is opaque";
    EXPECT_NO_THROW((void)scene.closest_point({0.7, 0.2, 1}));
}
