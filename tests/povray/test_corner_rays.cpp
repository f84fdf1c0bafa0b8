// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how many rays corners have in large scenes.
#include "povray_export/lamp/corner_rays.h"

#include <gtest/gtest.h>

using namespace lodestone::povray;

TEST(CornerRays, LargeScenesHaveFewerRaysForEachCorner) {
    EXPECT_EQ(CornerRays(128, {}).of(1'000'000), 128);
    EXPECT_EQ(CornerRays(128, {300'000}).of(300'000), 128);
    EXPECT_EQ(CornerRays(128, {600'000}).of(600'000), 64);
    EXPECT_EQ(CornerRays(128, {1'000'000'000}).of(1'000'000'000), 16);
    EXPECT_EQ(CornerRays(4, {1'000'000'000}).of(1'000'000'000), 4);
    // Small meshes keep theirs, and leave the rest to the large ones.
    const CornerRays uneven(128, {1'000'000, 1'000, 100'000, 1'000'000});
    EXPECT_EQ(uneven.of(1'000), 128);
    EXPECT_EQ(uneven.of(1'000'000), 16);
    EXPECT_EQ(uneven.of(100'000), 64);
}

// A forest far away had more rays to its sky than its picture had.
TEST(CornerRays, MoreTrianglesThanPixelsHaveFewerRays) {
    EXPECT_EQ(CornerRays(128, {50'000}, 57'600).of(50'000), 128);
    EXPECT_EQ(CornerRays(128, {230'000}, 57'600).of(230'000), 32);
    EXPECT_EQ(CornerRays(128, {230'000}, 1e9).of(230'000), 128);
    EXPECT_EQ(CornerRays(128, {600'000}, 1e9).of(600'000), 64);
    EXPECT_EQ(CornerRays(128, {230'000, 100}, 57'600).of(100), 128);
}
