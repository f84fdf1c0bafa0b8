// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how far off what an eye sees from all around is.
#include "base/error.h"
#include "base/parallel.h"
#include "measure/pictures/view_distances.h"
#include "scenes/small_meshes.h"
#include "scenes/with_rays.h"

using namespace lodestone;
using measure::ViewDistances;
using measure::ViewedWay;

namespace {

class ViewDistance : public WithRays {
protected:
    static double worst(const Mesh& finest, const Mesh& stand_in, ViewedWay ways = ViewedWay::Both,
                        double near = 0) {
        const ray::MeshScene scene(finest);
        return ViewDistances(finest, scene).worst(ray::MeshScene(stand_in), ways, near);
    }
};

Mesh with_box(Mesh mesh, const glm::dvec3& low, const glm::dvec3& size) {
    append(mesh, shapes::box(low, low + size), {});
    return mesh;
}

}  // namespace

TEST_F(ViewDistance, NothingIsNowhereFarOff) {
    EXPECT_EQ(worst({}, {}), 0);
    EXPECT_EQ(worst({}, shapes::cube()), 0) << "there is no picture of nothing";
    EXPECT_EQ(worst(shapes::cube(), {}), 0) << "whoever compares distances has found that out";
    const Mesh sheet = shapes::quad(1, 1);
    EXPECT_NEAR(worst(sheet, sheet), 0, 1e-6);
}

TEST_F(ViewDistance, AMeshIsWhereItIs) {
    const Mesh ball = shapes::sphere(1);
    EXPECT_NEAR(worst(ball, ball), 0, 1e-6);
    EXPECT_NEAR(worst(ball, shapes::sphere(0.9)), 0.1, 2e-3);
    EXPECT_NEAR(worst(ball, shapes::sphere(1.05)), 0.05, 2e-3);
    EXPECT_LE(worst(ball, shapes::sphere(0.9), ViewedWay::Both, 0.2), 0.2) << "that is near";
}

// Quantiles of the whole surface did not notice what is seen from one side only.
TEST_F(ViewDistance, AThingInADeepBoxCountsFromAbove) {
    Mesh box;
    const glm::dvec3 walls[][2] = {{{0, 0, 0}, {4, 4, 0.1}},
                                   {{0, 0, 0}, {0.1, 4, 3}},
                                   {{3.9, 0, 0}, {0.1, 4, 3}},
                                   {{0, 0, 0}, {4, 0.1, 3}},
                                   {{0, 3.9, 0}, {4, 0.1, 3}}};
    for (const auto& wall : walls)
        box = with_box(std::move(box), wall[0], wall[1]);
    const Mesh furnished = with_box(box, {1.7, 1.7, 0.1}, {0.6, 0.6, 0.5});
    EXPECT_NEAR(worst(furnished, box, ViewedWay::ToStandIn), 0.5, 0.05) << "to the floor";
    EXPECT_NEAR(worst(box, furnished), 0.5, 0.05) << "nor may it come from nowhere";
    EXPECT_NEAR(worst(box, furnished, ViewedWay::ToStandIn), 0, 1e-6) << "the floor is there";
}

TEST_F(ViewDistance, SpikesOfAPixelDoNotCount) {
    const Mesh plate = shapes::box({0, 0, 0}, {40, 40, 10});
    EXPECT_LT(worst(with_box(plate, {20, 20, 10}, {0.1, 0.1, 1}), plate), 0.1);
    EXPECT_NEAR(worst(with_box(plate, {20, 20, 10}, {4, 4, 1}), plate), 1, 0.1);
}

TEST_F(ViewDistance, AFewPixelsSeeWhatIsLarge) {
    const Mesh ball = shapes::sphere(1);
    // From a quarter of the radius on there are a quarter of the pixels.
    EXPECT_NEAR(worst(ball, shapes::sphere(0.6), ViewedWay::Both, 0.25), 0.4, 1e-2);
    EXPECT_NEAR(worst(ball, shapes::sphere(0.6), ViewedWay::Both, 0.24), 0.4, 1e-2);
    const Mesh chimney = with_box(shapes::box({0, 0, 0}, {4, 4, 4}), {1.6, 1.6, 4}, {0.8, 0.8, 2});
    EXPECT_NEAR(worst(chimney, shapes::box({0, 0, 0}, {4, 4, 4}), ViewedWay::Both, 1), 2, 0.2);
}

// A part was met by one ray or none, which counts for nothing.
TEST_F(ViewDistance, PartsOfWhatIsStrewnAreSeen) {
    Mesh strewn;
    for (int i = 0; i < 40; ++i)
        strewn = with_box(std::move(strewn), {7.0 * (i % 8), 90.0 * (i % 3), 11.0 * (i / 8)},
                          {1.5, 1.5, 1.5});
    const Mesh one = with_box(strewn, {20, 45, 20}, {1.5, 1.5, 1.5});
    EXPECT_GT(worst(one, strewn), 20) << "the stand-in lacks it";
    EXPECT_GT(worst(one, strewn, ViewedWay::ToStandIn), 20);
    EXPECT_NEAR(worst(one, one), 0, 1e-5);
    const Mesh wall = with_box(strewn, {0, 45, 0}, {50, 0.3, 40});
    EXPECT_GT(worst(strewn, wall), 20) << "it comes from nowhere";
    EXPECT_LT(worst(strewn, wall, ViewedWay::ToStandIn), 1e-5);
}

TEST_F(ViewDistance, WhatCountsAsNearChangesNothingFartherOff) {
    // Neighbors of a point that is near are not looked up.
    const Mesh ball = shapes::sphere(1);
    const Mesh spiked = with_box(shapes::sphere(0.97), {-0.15, -0.15, 0.9}, {0.3, 0.3, 0.4});
    for (const ViewedWay ways : {ViewedWay::ToStandIn, ViewedWay::Both}) {
        const double off = worst(spiked, ball, ways);
        EXPECT_GT(off, 0.25);
        for (const double near : {0.01, 0.05, 0.1, 0.2})
            EXPECT_EQ(worst(spiked, ball, ways, near), off) << near;
    }
}

TEST_F(ViewDistance, NothingIsFartherApartThanItsBoundSays) {
    using measure::farthest_apart;
    EXPECT_EQ(farthest_apart({}, shapes::cube()), std::numeric_limits<double>::infinity());
    EXPECT_EQ(farthest_apart(shapes::cube(), {}), std::numeric_limits<double>::infinity());
    const Mesh box = shapes::box({0, 0, 0}, {3, 4, 12});
    EXPECT_NEAR(farthest_apart(box, box), 13, 1e-6) << "from corner to corner";
    const Mesh middle = shapes::box({1.4, 1.9, 5.9}, {1.6, 2.1, 6.1});
    EXPECT_NEAR(farthest_apart(box, middle), std::sqrt(1.6 * 1.6 + 2.1 * 2.1 + 6.1 * 6.1), 1e-6);
    for (const Mesh& mesh : {box, middle, shapes::sphere(2)})
        EXPECT_LE(worst(box, mesh), std::max(farthest_apart(box, mesh), farthest_apart(mesh, box)));
}

TEST_F(ViewDistance, PlacesAndSizesDoNotMatter) {
    const Mesh ball = shapes::sphere(1, 2);
    const Mesh cube = shapes::cube();
    const double once = worst(ball, cube);
    const Affine far{glm::dmat3(1000.0), {1e6, -2e6, 5e5}};
    Mesh large_ball;
    Mesh large_cube;
    append(large_ball, ball, far);
    append(large_cube, cube, far);
    EXPECT_NEAR(worst(large_ball, large_cube) / 1000, once, 2e-3 * once);
}

TEST_F(ViewDistance, SameBitsOnOneAndManyThreads) {
    const Mesh ball = shapes::sphere(1, 3);
    const Mesh torus = shapes::torus(24, 8);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return worst(ball, torus);
    };
    EXPECT_EQ(with(1), with(0));
}

TEST_F(ViewDistance, BrokenCornersAndCancelingDoNoHarm) {
    Mesh broken = shapes::cube();
    broken.normals.clear();
    broken.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    broken.triangles.emplace_back(0, 1, static_cast<uint32_t>(broken.positions.size() - 1));
    EXPECT_NEAR(worst(broken, shapes::cube()), 0, 1e-6);
    const int32_t cancel = 1;
    const Job job(&cancel, nullptr, nullptr);
    const Mesh cube = shapes::cube();
    const ray::MeshScene scene(cube);
    const ViewDistances views(cube, scene);
    EXPECT_THROW(views.worst(scene, ViewedWay::Both, 0, job), Error);
    EXPECT_NEAR(views.worst(scene, ViewedWay::Both, 0), 0, 1e-6) << "it can be asked again";
}
