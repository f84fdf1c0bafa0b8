// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is drawn within each group of lights, and that each thing throws its shadow once.
#include "povray_export/occurrence/lit_uses.h"

#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

constexpr RayMask kShadowsAlone = kAllRays & static_cast<RayMask>(~kShadowRays);

OccurrenceUse use(uint32_t node, RayMask hidden = 0) {
    return {node, 0, node, node, {}, hidden};
}

std::vector<LitUse> lit(const std::vector<OccurrenceUse>& uses,
                        const std::vector<light::LitPiece>& pieces) {
    light::LightPlan plan;
    plan.groups.resize(3);
    plan.pieces = pieces;
    return lit_uses(uses, plan);
}

}  // namespace

TEST(LitUses, NothingIsDrawnOfNothing) {
    EXPECT_TRUE(lit({}, {}).empty());
}

TEST(LitUses, AWholeThingStaysAsItIs) {
    const std::vector<LitUse> found =
        lit({use(0), use(1, kReflectionRays)}, {{1, 2, {}}, {0, 1, {}}});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].use.node, 1u);
    EXPECT_EQ(found[0].use.hidden, kReflectionRays);
    EXPECT_EQ(found[0].group, 2u);
    EXPECT_FALSE(found[0].within);
    EXPECT_EQ(found[1].use.hidden, 0);
}

// Rays to lamps looked at all parts of a ground: a night street took half as long again.
TEST(LitUses, AThingInPartsThrowsItsShadowAsAWhole) {
    const Box3 left{{-1, -1, -1}, {0, 1, 1}};
    const Box3 right{{0, -1, -1}, {1, 1, 1}};
    const std::vector<LitUse> found =
        lit({use(0), use(1)}, {{1, 0, left}, {0, 0, {}}, {1, 2, right}});
    ASSERT_EQ(found.size(), 4u);
    EXPECT_EQ(found[0].use.hidden, kShadowRays);
    EXPECT_TRUE(found[0].within);
    EXPECT_EQ(found[1].use.hidden, 0);
    EXPECT_EQ(found[2].use.hidden, kShadowRays);
    EXPECT_EQ(found[2].group, 2u);
    EXPECT_EQ(found[3].use.node, 1u);
    EXPECT_EQ(found[3].use.hidden, kShadowsAlone);
    EXPECT_FALSE(found[3].within);
    EXPECT_FALSE(found[3].group);
}

TEST(LitUses, WhatThrowsNoShadowHasNoneInParts) {
    const std::vector<LitUse> found =
        lit({use(0, kShadowRays)},
            {{0, 0, Box3{{-1, -1, -1}, {0, 1, 1}}}, {0, 1, Box3{{0, -1, -1}, {1, 1, 1}}}});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].use.hidden, kShadowRays);
    EXPECT_EQ(found[1].use.hidden, kShadowRays);
}

TEST(LitUses, LampRaysOfAThingAreTheMeanOfItsParts) {
    light::LightPlan plan;
    Light lamp;
    lamp.kind = LightKind::Point;
    plan.lights = {lamp, lamp};
    plan.groups = {{}, {{0, {}}, {1, {}}}};
    const Box3 whole{{0, 0, 0}, {4, 3, 0}};
    const Bound bound{{2, 1.5, 0}, 2.5, whole};
    EXPECT_TRUE(lamp_rays({}, plan).empty());
    plan.pieces = {{0, 1, {}}, {1, 0, {}}};
    const double both = 2 * light::shadow_rays(lamp, {});
    EXPECT_EQ(lamp_rays(std::vector<Bound>(3, bound), plan), (std::vector<double>{both, 0, 0}));
    // One part is as large as the other: a thing that is cut in two.
    plan.pieces = {{0, 1, Box3{{-9, -9, -9}, {2, 9, 9}}}, {0, 0, Box3{{2, -9, -9}, {9, 9, 9}}}};
    EXPECT_NEAR(lamp_rays(std::vector<Bound>(1, bound), plan)[0], both / 2, 1e-9);
    EXPECT_EQ(lamp_rays(std::vector<Bound>(1, Bound{}), plan)[0], 0);
}
