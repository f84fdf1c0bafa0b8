// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what a lamp beside the eye does not tell: slopes that are gone from a surface.
#include "measure/pictures/patch_shading.h"
#include "scenes/fine_grids.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <cmath>
#include <numbers>

using namespace lodestone;

namespace {

class ShadedPatches : public WithRays {};

constexpr uint64_t kSeed = 3;
constexpr double kLeast = 0.05;

double unlike(const Mesh& finest, const Mesh& stand_in, double least = kLeast, size_t rays = 2048) {
    const ray::MeshScene scene(finest);
    const measure::VisibleSampler sampler(finest, scene, kSeed);
    std::vector<measure::CastPoints> cast(rays);
    for (uint32_t i = 0; i < cast.size() && !sampler.empty(); ++i)
        cast[i].count = sampler.cast(i, cast[i].points);
    const measure::ShadedPatches patches(finest, sampler, cast, surface_area(finest));
    return patches.largest_unlike_patch(stand_in, ray::MeshScene(stand_in), least);
}

/// A square of 4 x 4 m in 200 x 200 squares, as high at each x as that says.
template <typename Height>
Mesh sheet(const Height& height) {
    Mesh mesh = shapes::grid(200);
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(4 * position.x, 4 * position.y, height(4.0 * position.x));
    return mesh;
}

/// Waves of that length along x, in metres.
Mesh waves(double length, double height) {
    return sheet([=](double x) { return height * std::sin(2 * std::numbers::pi * x / length); });
}

}  // namespace

TEST_F(ShadedPatches, NothingIsUnlikeNothing) {
    EXPECT_EQ(unlike(Mesh{}, Mesh{}), 0);
}

TEST_F(ShadedPatches, AMeshIsShadedLikeItself) {
    const Mesh mesh = waves(1, 0.05);
    EXPECT_EQ(unlike(mesh, mesh), 0);
}

// Fewer samples than a coarse patch asks for: what lay behind them in memory was looked at, too, so
// that levels of simple things came out otherwise in each run.
TEST_F(ShadedPatches, AFewSamplesAreAllThereIs) {
    const Mesh cube = shapes::cube();
    Mesh turned = cube;
    for (glm::vec3& position : turned.positions)
        position = glm::vec3(position.x, position.y, position.z + 0.5f * position.x);
    const double found = unlike(cube, turned, 0.3, 300);
    for (int i = 0; i < 16; ++i)
        EXPECT_EQ(unlike(cube, turned, 0.3, 300), found);
}

TEST_F(ShadedPatches, APlainWithoutItsWavesIsUnlikeUpToHalfAWave) {
    // The steepest slope is .31: 17 degrees, near enough for any distance.
    for (const double length : {2.0, 1.0, 0.5}) {
        SCOPED_TRACE(length);
        const double found = unlike(waves(length, 0.05 * length), waves(length, 0), 0.06);
        EXPECT_GE(found, length / 4);
        EXPECT_LE(found, 1.5 * length);  // a cube of a wave and a half leans
    }
}

TEST_F(ShadedPatches, WavesThatNobodySeesAreAlike) {
    EXPECT_EQ(unlike(waves(1, 0.005), waves(1, 0)), 0);
}

TEST_F(ShadedPatches, ASlopeThatIsGoneIsUnlikeAsAWhole) {
    const auto roof = [](double height) {
        return sheet([=](double x) { return height * (1 - std::abs(x / 2 - 1)); });
    };
    EXPECT_GE(unlike(roof(0.4), roof(0), 0.5), 1);
}

TEST_F(ShadedPatches, ABoxIsNotShadedLikeABall) {
    // Far stones became boxes: the mean normals of a box's sides are those of a ball's.
    Mesh ball = shapes::sphere(1, 4);
    ball.normals = ball.positions;
    const Mesh box = shapes::box({-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8});
    const Mesh coarse = shapes::sphere(1, 1);
    EXPECT_GT(unlike(ball, box, 0.5), 2);  // the width of the bound
    EXPECT_LT(unlike(ball, coarse, 0.5), 0.6 * unlike(ball, box, 0.5));
}

TEST_F(ShadedPatches, WhatLiesFartherOffIsNotCompared) {
    Mesh below = waves(1, 0);
    for (glm::vec3& position : below.positions)
        position.z -= 1;
    EXPECT_EQ(unlike(waves(1, 0.05), below), 0);
}

TEST_F(ShadedPatches, SmallWavesOfAFineMeshAreResolved) {
    // 80,000 triangles have more samples than the rays that were cast before.
    const double found = unlike(waves(0.16, 0.008), waves(0.16, 0), 0.02);
    EXPECT_GT(found, 0.03);
    EXPECT_LT(found, 0.3);
}

TEST_F(ShadedPatches, EachPartHasThePatchesThatAreInIt) {
    const Mesh finest = sheet([](double x) {
        return x < 2 ? 0.05 * std::sin(2 * std::numbers::pi * x) : 0;  // waves of a metre
    });
    const Mesh plain = waves(1, 0);
    const ray::MeshScene scene(finest);
    const measure::VisibleSampler sampler(finest, scene, kSeed);
    const measure::ShadedPatches patches(finest, sampler, {}, surface_area(finest));
    const auto part_of = [&](uint32_t triangle) {
        return finest.positions[finest.triangles[triangle].x].x < 2 ? 0u : 1u;
    };
    const std::vector<double> least{0.06, 0.06, 0.06};
    const std::vector<double> found =
        patches.largest_unlike_patches(plain, ray::MeshScene(plain), part_of, least);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_GE(found[0], 0.25);
    EXPECT_LE(found[0], 2);
    EXPECT_EQ(found[1], 0);
    EXPECT_EQ(found[2], 0) << "nothing is in it";
    EXPECT_EQ(patches.largest_unlike_patches(finest, scene, part_of, least),
              std::vector<double>(3, 0));
}

TEST_F(ShadedPatches, AThinThingCountsByWhatItCovers) {
    // A post of a hundredth of its patches' width, shaded otherwise.
    Mesh post = shapes::box({0, 0, 0}, {0.04, 0.04, 4});
    Mesh turned = post;
    const double turn = 0.4;
    for (glm::vec3& p : turned.positions) {
        const glm::vec3 at = p - glm::vec3(0.02f, 0.02f, 0);
        p = glm::vec3(std::cos(turn) * at.x - std::sin(turn) * at.y + 0.02,
                      std::sin(turn) * at.x + std::cos(turn) * at.y + 0.02, at.z);
    }
    EXPECT_LT(unlike(post, turned, 0.03), 0.6);
}

TEST_F(ShadedPatches, LeavesThatFaceAnywhereHaveNoSurface) {
    Mesh leaves;
    Mesh fewer;
    uint32_t bits = 1;
    const auto next = [&] {
        bits = 1664525 * bits + 1013904223;
        return static_cast<float>(bits >> 8) / 16777216.0f;
    };
    for (uint32_t i = 0; i < 3000; ++i) {
        const glm::vec3 at(4 * next(), 4 * next(), 4 * next());
        Mesh leaf;
        for (int k = 0; k < 3; ++k)
            leaf.positions.push_back(at + 0.1f * glm::vec3(next(), next(), next()));
        leaf.triangles.emplace_back(0, 1, 2);
        append(leaves, leaf, {}, 0);
        if (i % 4 == 0)
            append(fewer, leaf, {}, 0);
    }
    EXPECT_EQ(unlike(leaves, fewer), 0);
}
