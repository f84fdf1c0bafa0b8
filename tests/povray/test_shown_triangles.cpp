// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which part of a mesh is written: what any of its uses needs, and all of it where that is
// nearly all, or little.
#include "povray_export/mesh/shown_triangles.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// The first `count` of 400 triangles.
std::vector<uint8_t> first(size_t count) {
    std::vector<uint8_t> out(400, 0);
    std::fill_n(out.begin(), count, uint8_t{2});
    return out;
}

NeededTriangles needed(const std::vector<std::vector<uint8_t>>& uses) {
    NeededTriangles out;
    for (const std::vector<uint8_t>& use : uses)
        out.add(use);
    return out;
}

}  // namespace

TEST(ShownTriangles, WithoutKnowledgeAllAreShown) {
    EXPECT_FALSE(NeededTriangles().shown());
    EXPECT_FALSE(needed({{}}).shown());
    EXPECT_FALSE(needed({first(10), {}}).shown());
    EXPECT_FALSE(needed({{}, first(10)}).shown());
}

TEST(ShownTriangles, FewTrianglesAreWrittenWhole) {
    EXPECT_FALSE(needed({std::vector<uint8_t>(20, 0)}).shown());
}

TEST(ShownTriangles, WhatAnyUseNeedsIsShown) {
    std::vector<uint8_t> last(400, 0);
    last[399] = 1;
    const ShownTrianglesPtr shown = needed({first(10), last, first(5)}).shown();
    ASSERT_TRUE(shown);
    EXPECT_EQ(std::count(shown->shown.begin(), shown->shown.end(), 1), 11);
    EXPECT_EQ(shown->shown[9], 1);
    EXPECT_EQ(shown->shown[10], 0);
    EXPECT_EQ(shown->hash, needed({last, first(10)}).shown()->hash);
    EXPECT_NE(shown->hash, needed({first(10)}).shown()->hash);
    NeededTriangles joined = needed({first(10)});
    joined.add(needed({last}));
    EXPECT_EQ(joined.shown()->hash, shown->hash);
    joined.add(NeededTriangles());  // no use
    EXPECT_EQ(joined.shown()->hash, shown->hash);
    joined.add(needed({{}}));
    EXPECT_FALSE(joined.shown());
}

TEST(ShownTriangles, WhereNearlyAllAreNeededAllAreShown) {
    EXPECT_TRUE(needed({first(290)}).shown());
    EXPECT_FALSE(needed({first(310)}).shown());
}

TEST(ShownTriangles, UsesOfOtherMeshesAreNotMixedUp) {
    EXPECT_FALSE(needed({first(10), std::vector<uint8_t>(300, 0)}).shown());
}
