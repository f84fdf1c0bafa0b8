// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that what an eye sees of a candidate from one side counts.
#include "hierarchy/evaluators/view_error.h"
#include "scenes/furnished_models.h"
#include "scenes/with_rays.h"

using namespace lodestone;
using hierarchy::CandidateState;

namespace {

class ViewErrors : public WithRays {
protected:
    hierarchy::MeasuredFinest measured(const Mesh& mesh, bool group) {
        hierarchy::FinestOptions options;
        options.group = group;
        return hierarchy::measure_finest(mesh, materials_, texels_, {}, options, {});
    }
    static hierarchy::StandInCandidate candidate(const Mesh& mesh) {
        hierarchy::StandInCandidate out;
        out.payload = std::make_shared<const Mesh>(mesh);
        out.materials = {models::colored("a", glm::dvec3(0.5)), models::colored("b", {1, 0, 0})};
        out.error = out.max_error = 1e-3;
        return out;
    }

    std::vector<Material> materials_{models::colored("gray", glm::dvec3(0.5))};
    image::TexelCache texels_;
};

}  // namespace

TEST_F(ViewErrors, TheSameKeepsItsError) {
    const Mesh chair = models::chair();
    const hierarchy::MeasuredFinest finest = measured(chair, true);
    hierarchy::StandInCandidate same = candidate(chair);
    count_views(same, finest, {});
    EXPECT_TRUE(same.viewed);
    EXPECT_EQ(same.error, 1e-3);
}

TEST_F(ViewErrors, AMissingSeatIsAsFarOffAsWhatIsBehindIt) {
    const Mesh chair = models::chair();
    Mesh without = chair;
    // Four legs of 12 triangles, then the seat.
    without.triangles.erase(without.triangles.begin() + 48, without.triangles.begin() + 60);
    const hierarchy::MeasuredFinest finest = measured(chair, true);
    hierarchy::StandInCandidate lost = candidate(without);
    count_views(lost, finest, {});
    EXPECT_GT(lost.error, 0.1);
    EXPECT_EQ(lost.max_error, lost.error);
}

// Half of the posts of a terrace were gone at an error of 1.2 m, and the next one stood 5.6 m off:
// pictures of the whole agreed.
TEST_F(ViewErrors, PicturesDoNotHideHowFarOffThingsAre) {
    Mesh posts;
    for (int i = 0; i < 8; ++i)
        models::add_box(posts, {4.0 * i, 0, 0}, {0.3, 0.3, 3});
    Mesh half;
    for (int i = 0; i < 8; i += 2)
        models::add_box(half, {4.0 * i, 0, 0}, {0.3, 0.3, 3});
    const hierarchy::MeasuredFinest finest = measured(posts, false);
    hierarchy::StandInCandidate pruned = candidate(half);
    pruned.state = CandidateState::Pictured;
    pruned.error = pruned.max_error = 1;
    count_views(pruned, finest, {});
    EXPECT_NEAR(pruned.error, 3.7, 0.3);
    EXPECT_EQ(pruned.state, CandidateState::Pictured);
}

TEST_F(ViewErrors, ALeafWhoseFarthestPointIsNearIsNotLookedAt) {
    const Mesh chair = models::chair();
    const hierarchy::MeasuredFinest finest = measured(chair, false);
    hierarchy::StandInCandidate other = candidate(shapes::cube());
    other.state = CandidateState::Measured;
    count_views(other, finest, {});
    EXPECT_EQ(other.error, 1e-3) << "its points tell all";
    other.max_error = 1;
    count_views(other, finest, {});
    EXPECT_GT(other.error, 0.1);
}
