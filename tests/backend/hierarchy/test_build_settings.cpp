// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that levels which were built by other settings or other costs are stale.
#include "hierarchy/build_settings.h"
#include "povray_export/scene/povray_costs.h"

#include <gtest/gtest.h>
#include <set>

using namespace lodestone;
using hierarchy::BuildSettings;

TEST(BuildSettings, EveryCostThatAStandInDependsOnIsInTheHash) {
    const BuildSettings settings;
    const CostModel known = povray::povray_costs();
    std::set<Hash> hashes{hash_of(settings, known)};
    EXPECT_EQ(hash_of(settings, povray::povray_costs()), *hashes.begin());
    CostModel other = known;
    ++other.triangle_bytes;
    hashes.insert(hash_of(settings, other));
    other = known;
    ++other.primitive_bytes;
    hashes.insert(hash_of(settings, other));
    other = known;
    ++other.occurrence_bytes;
    hashes.insert(hash_of(settings, other));
    other = known;
    ++other.crossing_bytes;
    hashes.insert(hash_of(settings, other));
    EXPECT_EQ(hashes.size(), 5u);
    // These say what is built first, not how.
    other = known;
    ++other.triangle_s;
    EXPECT_EQ(hash_of(settings, other), hash_of(settings, known));
}

TEST(BuildSettings, EverySettingThatChangesAStandInIsInTheHash) {
    const CostModel costs = povray::povray_costs();
    std::set<Hash> hashes{hash_of(BuildSettings{}, costs)};
    BuildSettings other;
    other.level_ratio = 0.5;
    hashes.insert(hash_of(other, costs));
    other = {};
    ++other.rays;
    hashes.insert(hash_of(other, costs));
    other = {};
    ++other.samples;
    hashes.insert(hash_of(other, costs));
    other = {};
    ++other.group_triangles;
    hashes.insert(hash_of(other, costs));
    other = {};
    ++other.seed;
    hashes.insert(hash_of(other, costs));
    EXPECT_EQ(hashes.size(), 6u);
    other = {};
    other.keep_every_s = 1;
    other.rebuild = true;
    EXPECT_EQ(hash_of(other, costs), hash_of(BuildSettings{}, costs));
}
