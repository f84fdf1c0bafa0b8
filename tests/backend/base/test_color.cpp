// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the color formulas: sRGB's transfer function both ways in both precisions, luminance.
#include "base/color.h"

#include <gtest/gtest.h>

using namespace lodestone;

TEST(Color, SrgbHasItsKnownValues) {
    EXPECT_EQ(encode_srgb(0.0), 0);
    EXPECT_EQ(decode_srgb(0.0), 0);
    EXPECT_NEAR(encode_srgb(1.0), 1, 1e-12);
    EXPECT_EQ(decode_srgb(1.0), 1);
    EXPECT_NEAR(encode_srgb(0.21404114048223255), 0.5, 1e-12);
    EXPECT_NEAR(decode_srgb(0.5), 0.21404114048223255, 1e-15);
    EXPECT_NEAR(encode_srgb(0.18), 0.46135612950044164, 1e-12);  // the middle gray of photographers
    EXPECT_DOUBLE_EQ(encode_srgb(0.001), 0.01292);
    EXPECT_EQ(decode_srgb(0.04), 0.04 / 12.92);
}

TEST(Color, SrgbComesBackInBothPrecisions) {
    for (int i = 0; i <= 255; ++i) {
        const double value = i / 255.0;
        // The places where the standard's two parts end differ by 3e-8 of linear light.
        EXPECT_NEAR(encode_srgb(decode_srgb(value)), value, 1e-12) << i;
        EXPECT_NEAR(encode_srgb(decode_srgb(static_cast<float>(value))), value, 1e-6) << i;
        EXPECT_NEAR(decode_srgb(static_cast<float>(value)), decode_srgb(value), 2e-7) << i;
    }
}

TEST(Color, SrgbRisesAndGoesOnOutsideOfZeroToOne) {
    double last = encode_srgb(-1.0);
    EXPECT_DOUBLE_EQ(last, -12.92);
    EXPECT_DOUBLE_EQ(decode_srgb(last), -1);
    for (double x = 0; x < 0.01; x += 1e-5) {  // over the place where the two parts meet
        EXPECT_GT(encode_srgb(x), last) << x;
        last = encode_srgb(x);
    }
    EXPECT_NEAR(encode_srgb(4.0), 1.055 * std::pow(4.0, 1 / 2.4) - 0.055, 1e-12);
    EXPECT_NEAR(decode_srgb(encode_srgb(4.0)), 4, 1e-12);
}

TEST(Color, LuminanceOfWhiteIsOneAndGreenIsTheBrightest) {
    EXPECT_NEAR(luminance({1, 1, 1}), 1, 1e-15);
    EXPECT_DOUBLE_EQ(luminance({1, 0, 0}), 0.2126);
    EXPECT_DOUBLE_EQ(luminance({0, 1, 0}), 0.7152);
    EXPECT_DOUBLE_EQ(luminance({0, 0, 1}), 0.0722);
    EXPECT_DOUBLE_EQ(luminance({0, 0, 0}), 0);
    EXPECT_NEAR(luminance({2, 4, 6}), 2 * luminance({1, 2, 3}), 1e-15);
}
