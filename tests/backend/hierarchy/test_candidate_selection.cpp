// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which of an object's candidates stay.
#include "hierarchy/candidate_selection.h"
#include "povray_export/scene/povray_costs.h"
#include "scenes/small_models.h"

#include <gtest/gtest.h>

using namespace lodestone;

TEST(KeepUseful, OfNothingNothingStays) {
    std::vector<hierarchy::StandInCandidate> candidates;
    hierarchy::keep_pareto_front(candidates, 1000, povray::povray_costs());
    EXPECT_TRUE(candidates.empty());
}

TEST(KeepUseful, DropsWhatIsNoBetterThanSomethingCheaper) {
    const CostModel costs = povray::povray_costs();
    std::vector<hierarchy::StandInCandidate> candidates;
    const auto add = [&](uint32_t side, double error) {
        hierarchy::StandInCandidate candidate;
        candidate.payload = std::make_shared<const Mesh>(shapes::terrain(side));
        candidate.error = error;
        candidates.push_back(candidate);
    };
    add(10, 0.3);
    add(20, 0.2);
    add(30, 0.25);  // worse than the cheaper one of 20
    add(40, 0.1);
    add(90, 0.01);  // no cheaper than the finest
    hierarchy::keep_pareto_front(candidates, uint64_t{2} * 90 * 90 * costs.triangle_bytes, costs);
    ASSERT_EQ(candidates.size(), 3u);
    EXPECT_EQ(candidates[0].error, 0.1);
    EXPECT_EQ(candidates[1].error, 0.2);
    EXPECT_EQ(candidates[2].error, 0.3);
}
