// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what the controls of shading become where they say nothing, or nonsense.
#include "povray_export/scene/shading.h"

#include <gtest/gtest.h>

using namespace lodestone::povray;

TEST(PovrayShading, NothingSaidIsWhatAntialiasingStandsFor) {
    const Shading final = filled_up({}, Antialiasing::Final, 2);
    EXPECT_EQ(final.threshold, 0.1);
    EXPECT_EQ(final.depth, 3);
    EXPECT_EQ(final.trace_depth, 5);
    EXPECT_EQ(final.area_samples, 17);
    EXPECT_EQ(final.sky_lights, 24);
    EXPECT_EQ(final.shadow_error, 2);
    EXPECT_EQ(final.reflection_error, 1);
    EXPECT_EQ(final.bounces, 0);
    EXPECT_EQ(final.bounce_rays, 200);
    EXPECT_EQ(final.bounce_error, 0.6);
    EXPECT_EQ(filled_up({}, Antialiasing::Off, 1).bounce_rays, 60);
    EXPECT_EQ(filled_up({}, Antialiasing::Reference, 1).bounce_rays, 800);
    EXPECT_EQ(filled_up({}, Antialiasing::Off, 1).area_samples, 1);
    EXPECT_EQ(filled_up({}, Antialiasing::Off, 1).sky_lights, 12);
    EXPECT_EQ(filled_up({}, Antialiasing::Reference, 1).sky_lights, 64);
}

TEST(PovrayShading, WhatIsSaidWinsOverAntialiasing) {
    Shading said;
    said.area_samples = 9;
    said.sky_lights = -1;
    said.shadow_error = 0.5;
    const Shading draft = filled_up(said, Antialiasing::Off, 8);
    EXPECT_EQ(draft.area_samples, 9);
    EXPECT_EQ(draft.sky_lights, 0);
    EXPECT_EQ(draft.shadow_error, 0.5);
}

TEST(PovrayShading, AreaSamplesAreHalvings) {
    Shading said;
    for (const auto& [asked, given] : {std::pair{1, 1},
                                       {2, 3},
                                       {3, 3},
                                       {4, 5},
                                       {9, 9},
                                       {10, 17},
                                       {17, 17},
                                       {18, 33},
                                       {1 << 30, 129}}) {
        said.area_samples = asked;
        EXPECT_EQ(filled_up(said, Antialiasing::Final, 1).area_samples, given) << asked;
    }
}

TEST(PovrayShading, NonsenseStaysWithinWhatPovrayTakes) {
    Shading said;
    said.depth = said.trace_depth = said.sky_lights = 1 << 30;
    said.bounces = said.bounce_rays = 1 << 30;
    said.bounce_error = 1e30;
    said.threshold = said.reflection_error = 1e30;
    const Shading out = filled_up(said, Antialiasing::Final, 1);
    EXPECT_LE(out.depth, 9);
    EXPECT_LE(out.trace_depth, 256);
    EXPECT_LE(out.sky_lights, 1024);
    EXPECT_LE(out.threshold, 3);
    EXPECT_EQ(out.bounces, 8);
    EXPECT_EQ(out.bounce_rays, 1600);
    EXPECT_EQ(out.bounce_error, 1);
    said.bounces = said.bounce_rays = -5;
    EXPECT_EQ(filled_up(said, Antialiasing::Final, 1).bounces, 0);
    EXPECT_EQ(filled_up(said, Antialiasing::Final, 1).bounce_rays, 200);
    EXPECT_LE(out.reflection_error, 255);
}
