// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the lists of what rays go through: in one search what first_hit() finds one by one.
#include "base/random.h"
#include "ray/placed_scenes.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_meshes.h"
#include "scenes/with_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace lodestone;
using ray::RayCrossing;

class RayCrossingsTest : public WithRays {
protected:
    static ray::SkinPtr skin_of(const std::vector<Material>& materials) {
        image::TexelCache texels;
        return std::make_shared<const ray::MeshSkin>(materials, texels);
    }
    static Material clear(double alpha) {
        Material out;
        out.alpha_mode = AlphaMode::Blend;
        out.alpha = alpha;
        return out;
    }
    /// Squares one above the other, of materials by number; the last is the highest.
    static Mesh layers(uint16_t count) {
        Mesh out;
        for (uint16_t i = 0; i < count; ++i)
            append(out, shapes::quad(1, 1), {glm::dmat3(1.0), {0, 0, i}}, i);
        return out;
    }
    static bool is_opaque(uint32_t /*triangle*/, double alpha) { return alpha >= 1; }

    /// The crossings up to the nearest that ends the ray, near ones first.
    static std::vector<RayCrossing> crossings(const ray::MeshScene& scene, const glm::dvec3& origin,
                                              const glm::dvec3& direction, double far) {
        std::vector<RayCrossing> out;
        scene.list_crossings(origin, direction, far, 64, is_opaque, out);
        std::sort(out.begin(), out.end(),
                  [](const RayCrossing& a, const RayCrossing& b) { return a.t < b.t; });
        const auto last =
            std::find_if(out.begin(), out.end(), [](const RayCrossing& one) { return one.ends; });
        if (last != out.end())
            out.erase(last + 1, out.end());
        return out;
    }
};

TEST_F(RayCrossingsTest, NothingIsCrossed) {
    const ray::MeshScene nothing{Mesh{}};
    EXPECT_TRUE(crossings(nothing, {0, 0, 1}, {0, 0, -1}, kInfinity).empty());
    const ray::MeshScene square(shapes::quad(1, 1));
    EXPECT_TRUE(crossings(square, {2, 0.5, 1}, {0, 0, -1}, kInfinity).empty());
    EXPECT_TRUE(crossings(square, {0.25, 0.5, 1}, {0, 0, -1}, 0.5).empty());
    EXPECT_TRUE(crossings(square, {0.25, 0.5, 1}, {0, 0, 0}, kInfinity).empty());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(crossings(square, {0.25, 0.5, 1}, {0, nan, -1}, kInfinity).empty());
    EXPECT_TRUE(crossings(square, {nan, 0.5, 1}, {0, 0, -1}, kInfinity).empty());
}

TEST_F(RayCrossingsTest, AnOpaqueMeshIsMetWhereItsFirstHitIs) {
    const ray::MeshScene scene(shapes::cube());
    const std::vector<RayCrossing> met = crossings(scene, {0.1, 0.2, 9}, {0, 0, -2}, kInfinity);
    ASSERT_EQ(met.size(), 1u);
    const ray::RayHit hit = scene.first_hit({0.1, 0.2, 9}, {0, 0, -2});
    EXPECT_EQ(met[0].triangle, hit.triangle);
    EXPECT_NEAR(met[0].t, hit.t, 1e-9);
    EXPECT_NEAR(met[0].u, hit.u, 1e-9);
    EXPECT_NEAR(met[0].v, hit.v, 1e-9);
    EXPECT_TRUE(met[0].ends);
}

TEST_F(RayCrossingsTest, ClearLayersAreMetUpToTheFirstThatIsOpaque) {
    // From above: nearly opaque (twice), opaque, nearly opaque.
    const ray::MeshScene scene(
        layers(4), skin_of({clear(0.999999), Material{}, clear(0.999999), clear(0.999999)}));
    const std::vector<RayCrossing> met = crossings(scene, {0.25, 0.5, 5}, {0, 0, -1}, kInfinity);
    ASSERT_EQ(met.size(), 3u);
    EXPECT_NEAR(met[0].t, 2, 1e-6);
    EXPECT_NEAR(met[1].t, 3, 1e-6);
    EXPECT_NEAR(met[2].t, 4, 1e-6);
    EXPECT_FALSE(met[0].ends || met[1].ends);
    EXPECT_TRUE(met[2].ends);
    EXPECT_EQ(crossings(scene, {0.25, 0.5, 5}, {0, 0, -1}, 2.5).size(), 1u);
}

TEST_F(RayCrossingsTest, TheyAreWhatRaysThatGoOnMeetOneByOne) {
    std::vector<Material> materials;
    materials.reserve(12);
    for (int i = 0; i < 12; ++i)
        materials.push_back(i % 5 == 4 ? Material{} : clear(0.999999));
    materials[2] = foliage::leaf(foliage::left_half());
    const ray::MeshScene scene(layers(12), skin_of(materials));
    PcgRandom random(8);
    size_t many = 0;
    for (int i = 0; i < 500; ++i) {
        const double x = random.uniform();
        const glm::dvec3 from{x, random.uniform(), 12 * random.uniform()};
        const glm::dvec3 way{0.02 * random.uniform(), 0.01, i % 2 == 0 ? 1 : -1};
        std::vector<double> expected;
        for (double at = 0; at < 20;) {
            const ray::RayHit hit = scene.first_hit(from + at * way, way);
            if (!hit.hit)
                break;
            expected.push_back(at + hit.t);
            // The layer with a mask ends rays where its leaf is.
            if ((hit.triangle / 2) % 5 == 4 || hit.triangle / 2 == 2)
                break;
            at += hit.t + 0.5;
        }
        const std::vector<RayCrossing> met = crossings(scene, from, way, kInfinity);
        ASSERT_EQ(met.size(), expected.size());
        many += met.size() > 2 ? 1 : 0;
        for (size_t k = 0; k < met.size(); ++k)
            EXPECT_NEAR(met[k].t, expected[k], 1e-4);
    }
    EXPECT_GT(many, 100u);
}

TEST_F(RayCrossingsTest, OfVeryManyTheNearestAreListed) {
    Mesh mesh;
    for (int i = 0; i < 3000; ++i)
        append(mesh, shapes::quad(1, 1), {glm::dmat3(1.0), {0, 0, (i * 7) % 3000}});
    const ray::MeshScene scene(mesh, skin_of({clear(0.999999)}));
    std::vector<RayCrossing> out;
    scene.list_crossings({0.25, 0.5, -1}, {0, 0, 1}, kInfinity, 64, is_opaque, out);
    EXPECT_GE(out.size(), 64u);
    EXPECT_LE(out.size(), 128u);
    std::sort(out.begin(), out.end(),
              [](const RayCrossing& a, const RayCrossing& b) { return a.t < b.t; });
    for (size_t i = 0; i < 64; ++i)
        EXPECT_NEAR(out[i].t, 1.0 + static_cast<double>(i), 1e-3);
}

TEST_F(RayCrossingsTest, LayersThatAreHalfClearAreMetByHalfOfTheRays) {
    const ray::MeshScene scene(layers(1), skin_of({clear(0.5)}));
    PcgRandom random(9);
    size_t met = 0;
    for (int i = 0; i < 4000; ++i) {
        const double x = random.uniform();
        met += crossings(scene, {x, random.uniform(), 2}, {0, 0, -1}, kInfinity).size();
    }
    EXPECT_NEAR(static_cast<double>(met), 2000, 150);
}

TEST_F(RayCrossingsTest, PlacementsOnTheWayAreVisitedAndThoseBehindItsEndAreNot) {
    const Mesh cube = shapes::cube();
    const auto scene = std::make_shared<const ray::MeshScene>(cube);
    ray::PlacedScenes scenes;
    for (uint32_t i = 0; i < 64; ++i)
        scenes.add(scene, bound_of(cube.positions), {glm::dmat3(1.0), {2.0 * i, 0, 0}}, i);
    scenes.finish();
    const auto visited = [&](double far, double end) {
        std::vector<uint32_t> out;
        scenes.visit({-5, 0.1, 0.1}, {1, 0, 0}, far,
                     [&](const ray::MeshScene& mesh, uint32_t name, const glm::dvec3& origin,
                         const glm::dvec3& direction, double left) {
                         EXPECT_TRUE(mesh.first_hit(origin, direction, left).hit);
                         out.push_back(name);
                         return std::min(left, end);
                     });
        std::sort(out.begin(), out.end());
        return out;
    };
    EXPECT_EQ(visited(kInfinity, kInfinity).size(), 64u);
    EXPECT_EQ(visited(7, kInfinity), (std::vector<uint32_t>{0, 1}));
    EXPECT_EQ(visited(kInfinity, 4.6), (std::vector<uint32_t>{0}));
    EXPECT_TRUE(visited(1, kInfinity).empty());
    EXPECT_TRUE(visited(-1, kInfinity).empty());
}
