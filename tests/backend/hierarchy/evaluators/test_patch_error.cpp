// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the look at a candidate that was measured by distance alone.
#include "base/error.h"
#include "hierarchy/evaluators/patch_error.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <limits>
#include <optional>

using namespace lodestone;
using hierarchy::CandidateState;

namespace {

constexpr double kAlways = std::numeric_limits<double>::infinity();

class StandInPatches : public WithRays {
protected:
    void SetUp() override {
        WithRays::SetUp();
        if (!IsSkipped())
            finest_.emplace(hierarchy::measure_finest(ball_, materials_, texels_, {}, {}, {}));
    }
    hierarchy::StandInCandidate unproven(const Mesh& mesh, const glm::dvec3& color) const {
        hierarchy::StandInCandidate out;
        out.state = CandidateState::Unproven;
        out.payload = std::make_shared<const Mesh>(mesh);
        // More slots than the finest has: else the level would be drawn in the finest's skin.
        out.materials = {models::colored("a", color), models::colored("b", color)};
        out.error = out.max_error = 1e-3;
        return out;
    }

    const Mesh ball_ = shapes::sphere(1);
    std::vector<Material> materials_{models::colored("gray", glm::dvec3(0.5))};
    image::TexelCache texels_;
    std::optional<hierarchy::MeasuredFinest> finest_;
};

}  // namespace

TEST_F(StandInPatches, ABallShowsAsMuchAsOneOfItsSize) {
    EXPECT_TRUE(shows_as_much(ball_, *finest_, {}));
    EXPECT_TRUE(shows_as_much(shapes::sphere(1, 2), *finest_, {}));
    EXPECT_FALSE(shows_as_much(shapes::sphere(0.5), *finest_, {}));
    EXPECT_FALSE(shows_as_much(shapes::sphere(1.5), *finest_, {}));
}

TEST_F(StandInPatches, WhatShowsTooLittleIsNotProven) {
    hierarchy::StandInCandidate small = unproven(shapes::sphere(0.5), glm::dvec3(0.5));
    EXPECT_FALSE(prove(small, *finest_, kAlways, {}));
    hierarchy::StandInCandidate same = unproven(ball_, glm::dvec3(0.5));
    EXPECT_TRUE(prove(same, *finest_, kAlways, {}));
    EXPECT_EQ(same.state, CandidateState::Measured);
    EXPECT_EQ(same.error, 1e-3) << "it looks alike";
}

TEST_F(StandInPatches, AnotherColorIsAsFarOffAsItIsLarge) {
    hierarchy::StandInCandidate red = unproven(ball_, {0.8, 0.05, 0.05});
    EXPECT_TRUE(prove(red, *finest_, kAlways, {}));
    EXPECT_GT(red.error, 0.1);
    EXPECT_GE(red.max_error, red.error);
}

TEST_F(StandInPatches, NobodyLooksTwice) {
    hierarchy::StandInCandidate once = unproven(ball_, glm::dvec3(0.5));
    EXPECT_TRUE(prove(once, *finest_, kAlways, {}));
    EXPECT_THROW(prove(once, *finest_, kAlways, {}), Error);
}
