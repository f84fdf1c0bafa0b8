// SPDX-License-Identifier: GPL-3.0-or-later
// Guards errors that are distances: exact where the answer is known, and larger for a group.
#include "hierarchy/evaluators/distance_error.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <cmath>
#include <limits>

using namespace lodestone;

namespace {

class StandInDistance : public WithRays {
protected:
    hierarchy::MeasuredFinest measured(const Mesh& mesh,
                                       const hierarchy::FinestOptions& options = {}) {
        return hierarchy::measure_finest(mesh, materials_, texels_, {}, options, {});
    }
    hierarchy::StandInCandidate level_of(const Mesh& mesh) const {
        hierarchy::StandInCandidate out;
        out.payload = std::make_shared<const Mesh>(mesh);
        out.materials = materials_;
        return out;
    }
    hierarchy::StandInCandidate box_of(const glm::dvec3& half_size) const {
        hierarchy::StandInCandidate out;
        out.kind = Kind::Box;
        Primitive box;
        box.half_size = half_size;
        out.payload = box;
        out.materials = materials_;
        return out;
    }

    std::vector<Material> materials_{models::colored("red", {0.5, 0.1, 0.1})};
    image::TexelCache texels_;
};

constexpr double kEver = std::numeric_limits<double>::infinity();

}  // namespace

TEST_F(StandInDistance, AMeshIsAsNearToItselfAsAnErrorCanBe) {
    const Mesh cube = shapes::box({-1, -1, -1}, {1, 1, 1});
    const hierarchy::MeasuredFinest finest = measured(cube);
    hierarchy::StandInCandidate same = level_of(cube);
    measure_mesh(same, finest, {});
    EXPECT_NEAR(same.error, finest.error_at(0), 1e-6);
    EXPECT_GT(same.error, 0) << "only the finest has none";
}

TEST_F(StandInDistance, ABoxIsOffByWhatItIsLarger) {
    const Mesh cube = shapes::box({-1, -1, -1}, {1, 1, 1});
    const hierarchy::MeasuredFinest finest = measured(cube);
    hierarchy::StandInCandidate exact = box_of(glm::dvec3(1));
    measure_primitive(exact, finest, kEver, {});
    EXPECT_LT(exact.error, 1e-5);
    hierarchy::StandInCandidate wider = box_of({1.25, 1, 1});
    measure_primitive(wider, finest, kEver, {});
    EXPECT_NEAR(wider.error, 0.25, 0.02);
    EXPECT_GE(wider.max_error, wider.error);
    EXPECT_EQ(wider.state, hierarchy::CandidateState::Measured) << "measuring proves nothing";
}

// A lamp's hollow post became a post whose ends were twice as far off as its error: 128 points all
// over it hardly met them.
TEST_F(StandInDistance, TheEndsOfALongBoxCount) {
    Mesh tube = shapes::box({-1.35, -0.21, -0.21}, {1.35, 0.21, 0.21});
    std::erase_if(tube.triangles, [&](const Triangle& t) {
        return tube.positions[t.x].x == tube.positions[t.y].x &&
               tube.positions[t.x].x == tube.positions[t.z].x;
    });
    ASSERT_EQ(tube.triangles.size(), 8u);
    for (const uint64_t seed : {1u, 2u, 3u, 4u}) {
        hierarchy::FinestOptions options;
        options.seed = seed;
        const hierarchy::MeasuredFinest finest = measured(tube, options);
        hierarchy::StandInCandidate post = box_of({1.35, 0.21, 0.21});
        measure_primitive(post, finest, kEver, {});
        EXPECT_NEAR(post.error, 0.21, 0.01) << seed;
    }
}

TEST_F(StandInDistance, ALimitTellsThatTheErrorIsAtLeastThat) {
    const Mesh cube = shapes::box({-1, -1, -1}, {1, 1, 1});
    const hierarchy::MeasuredFinest finest = measured(cube);
    hierarchy::StandInCandidate wider = box_of({1.25, 1, 2});
    measure_primitive(wider, finest, 0.1, {});
    EXPECT_TRUE(wider.at_least);
    measure_to_the_end(wider, finest, {});
    EXPECT_FALSE(wider.at_least);
    EXPECT_NEAR(wider.error, 1, 0.05);
    hierarchy::StandInCandidate level = level_of(shapes::box({-1, -1, -1}, {1, 1, 2}));
    measure_mesh(level, finest, {}, 2);
    EXPECT_FALSE(level.at_least);
    measure_to_the_end(level, finest, {});
    EXPECT_NEAR(level.error, 1, 0.05);
}

TEST_F(StandInDistance, WhatTheFinestIsOffByAddsUp) {
    const Mesh cube = shapes::box({-1, -1, -1}, {1, 1, 1});
    hierarchy::FinestOptions options;
    options.child_error = 0.5;
    hierarchy::StandInCandidate near = box_of({1.25, 1, 1});
    hierarchy::StandInCandidate far = near;
    measure_primitive(near, measured(cube), kEver, {});
    measure_primitive(far, measured(cube, options), kEver, {});
    EXPECT_NEAR(far.error, near.error + 0.5, 1e-9);
}

TEST_F(StandInDistance, WhatIsSurelyUselessIsNotMeasured) {
    const Mesh ball = shapes::sphere(1);
    const hierarchy::MeasuredFinest finest = measured(ball);
    measure::DeviationReference::RepaintResult known;
    known.surely_useless = true;
    hierarchy::StandInCandidate level = level_of(ball);
    measure_mesh(level, finest, {}, 0.01, known);
    EXPECT_TRUE(std::isinf(level.error));
    hierarchy::StandInCandidate far = box_of(glm::dvec3(3));
    measure_primitive(far, finest, 0.01, {});
    EXPECT_GT(far.error, 0.01) << "no less than that it is no use";
}
