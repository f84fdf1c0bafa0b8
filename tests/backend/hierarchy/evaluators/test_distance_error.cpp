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
