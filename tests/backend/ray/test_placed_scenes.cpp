// SPDX-License-Identifier: GPL-3.0-or-later
// Guards rays through many placements: the same answers as through each of them.
#include "base/clock.h"
#include "base/random.h"
#include "ray/placed_scenes.h"
#include "scenes/small_meshes.h"
#include "scenes/with_rays.h"

#include <cmath>
#include <limits>

using namespace lodestone;
using ray::PlacedScenes;

class PlacedScenesTest : public WithRays {
protected:
    struct Cube {
        std::shared_ptr<const ray::MeshScene> scene;
        Bound bound;
    };
    static Cube cube() {
        const Mesh mesh = shapes::cube();
        return {std::make_shared<const ray::MeshScene>(mesh), bound_of(mesh.positions)};
    }
    static Affine at(double x, double y, double z, double size = 1) {
        return {glm::dmat3(size), {x, y, z}};
    }
};

TEST_F(PlacedScenesTest, NothingIsNeverHit) {
    PlacedScenes scenes;
    scenes.finish();
    EXPECT_FALSE(scenes.first_hit({0, 0, 0}, {1, 0, 0}).hit);
    EXPECT_FALSE(scenes.occluded({0, 0, 0}, {1, 0, 0}, 9));
}

TEST_F(PlacedScenesTest, TheNearestOfARowIsHit) {
    PlacedScenes scenes;
    const Cube one = cube();
    for (uint32_t i = 0; i < 9; ++i)
        scenes.add(one.scene, one.bound, at(2.0 * i, 0, 0), i);
    scenes.finish();
    const PlacedScenes::PlacedHit right = scenes.first_hit({-5, 0.1, 0.1}, {2, 0, 0});
    ASSERT_TRUE(right.hit);
    EXPECT_EQ(right.name, 0u);
    EXPECT_NEAR(right.t, 2.25, 1e-6);
    EXPECT_EQ(scenes.first_hit({99, 0.1, 0.1}, {-1, 0, 0}).name, 8u);
    EXPECT_EQ(scenes.first_hit({3, 0.1, 0.1}, {1, 0, 0}).name, 2u);
    EXPECT_FALSE(scenes.first_hit({3, 0.1, 0.1}, {0, 1, 0}).hit);
    EXPECT_TRUE(scenes.occluded({2.9, 0.1, 0.1}, {1, 0, 0}, 0.7));
    EXPECT_FALSE(scenes.occluded({2.9, 0.1, 0.1}, {1, 0, 0}, 0.5));
}

TEST_F(PlacedScenesTest, AnswersAreThoseOfEachPlacement) {
    PcgRandom random(4);
    const Cube one = cube();
    PlacedScenes scenes;
    std::vector<Affine> places;
    for (uint32_t i = 0; i < 60; ++i) {
        glm::dmat3 linear(0.0);
        for (int k = 0; k < 9; ++k)
            linear[k / 3][k % 3] = random.uniform() - 0.5;
        places.push_back({linear, {9 * random.uniform(), 9 * random.uniform(), random.uniform()}});
        scenes.add(one.scene, one.bound, places.back(), i);
    }
    scenes.finish();
    size_t hits = 0;
    uint32_t blocker = PlacedScenes::kNothing;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 from{9 * random.uniform(), 9 * random.uniform(), 5};
        const glm::dvec3 way{random.uniform() - 0.5, random.uniform() - 0.5, -1};
        double nearest = std::numeric_limits<double>::infinity();
        for (const Affine& place : places) {
            const glm::dmat3 back = glm::inverse(place.linear);
            nearest =
                std::min(nearest, one.scene->first_hit(back * (from - place.offset), back * way).t);
        }
        const PlacedScenes::PlacedHit found = scenes.first_hit(from, way);
        EXPECT_EQ(found.hit, std::isfinite(nearest));
        if (found.hit) {
            EXPECT_NEAR(found.t, nearest, 1e-9);
        }
        EXPECT_EQ(scenes.occluded(from, way, 100), found.hit);
        // What blocked the ray before, or no number at all, changes nothing.
        EXPECT_EQ(scenes.occluded(from, way, 100, blocker), found.hit);
        if (i % 50 == 0)
            blocker = 1000;
        hits += found.hit ? 1 : 0;
    }
    EXPECT_GT(hits, 50u);
}

// Rays to the sky and through pixels met every placement: 25 times the time in a street.
TEST_F(PlacedScenesTest, RaysWithoutAnEndMeetOnlyBoxesOnTheirWay) {
    const Cube one = cube();
    PlacedScenes scenes;
    for (uint32_t i = 0; i < 4096; ++i)
        scenes.add(one.scene, one.bound, at(3.0 * (i % 64), 3.0 * std::floor(i / 64.0), 0), i);
    scenes.finish();
    const auto seconds = [&](double far) {
        PcgRandom random(7);
        int hits = 0;
        const double start = thread_cpu_seconds();
        for (int i = 0; i < 20'000; ++i) {
            const glm::dvec3 from{190 * random.uniform(), 190 * random.uniform(), 1};
            hits += scenes.occluded(from, {0, 0.1, 1}, far) ? 1 : 0;
            hits += scenes.first_hit(from, {0.1, 0, 1}, far).hit ? 1 : 0;
        }
        EXPECT_EQ(hits, 0);
        return thread_cpu_seconds() - start;
    };
    const double ending = seconds(1e3);
    EXPECT_LT(seconds(std::numeric_limits<double>::infinity()), 4 * ending + 0.01);
}

TEST_F(PlacedScenesTest, WhatHasNoSizeOrPlaceIsNeverHit) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Cube one = cube();
    PlacedScenes scenes;
    scenes.add(one.scene, one.bound, {glm::dmat3(0.0), {0, 0, 0}}, 0);
    scenes.add(one.scene, one.bound, at(nan, 0, 0), 1);
    scenes.add(one.scene, Bound{}, at(0, 0, 0), 2);
    scenes.add(nullptr, one.bound, at(0, 0, 0), 3);
    scenes.add(one.scene, one.bound, at(0, 0, 0), 4);
    scenes.finish();
    EXPECT_EQ(scenes.first_hit({0.1, 0.2, 9}, {0, 0, -1}).name, 4u);
    EXPECT_FALSE(scenes.first_hit({0.1, 0.2, 9}, {nan, 0, -1}).hit);
    EXPECT_FALSE(scenes.first_hit({0.1, 0.2, 9}, {0, 0, 0}).hit);
}
