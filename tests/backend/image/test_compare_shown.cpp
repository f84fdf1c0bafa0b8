// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that a difference is blamed on what shows it, and colored by its size.
#include "base/error.h"
#include "image/compare_shown.h"

#include <gtest/gtest.h>

namespace lodestone::image {
namespace {

Image gray(int width, int height, float value, float alpha = 1) {
    Image image;
    image.width = width;
    image.height = height;
    for (size_t i = 0; i < image.size(); ++i)
        image.pixels.insert(image.pixels.end(), {value, value, value, alpha});
    return image;
}

Image marked(const std::vector<uint32_t>& things) {
    Image image = gray(static_cast<int>(things.size()), 1, 0, 1);
    image.linear = true;
    for (size_t i = 0; i < things.size(); ++i) {
        const std::array<double, 3> color = identity_color(things[i]);
        for (size_t channel = 0; channel < 3; ++channel)
            image.pixels[4 * i + channel] = static_cast<float>(color[channel]);
    }
    return image;
}

TEST(CompareShown, NothingIsShownWhereAlphaIsLow) {
    Image image = marked({5, 6});
    image.pixels[3] = 0;
    EXPECT_EQ(identities(image), (std::vector<uint32_t>{kNothing, 7}));
}

TEST(CompareShown, IdentitiesAreReadBackExactly) {
    const std::vector<uint32_t> things = {0, 1, 254, 255, 256, 65534, 65535, 65536, 16777214};
    std::vector<uint32_t> expected;
    expected.reserve(things.size());
    for (const uint32_t thing : things)
        expected.push_back(thing + 1);
    EXPECT_EQ(identities(marked(things)), expected);
}

TEST(CompareShown, IdentitiesSurviveHalfFloats) {
    // A half has 11 bits: the next one above .99609375 is .0005 away.
    Image image = marked({255 * 256 + 254});
    for (float& value : image.pixels)
        value += 0.0004f;
    EXPECT_EQ(identities(image), std::vector<uint32_t>{255 * 256 + 255});
}

TEST(CompareShown, ADisplayEncodedPictureOfIdentitiesIsRefused) {
    Image image = marked({1});
    image.linear = false;
    EXPECT_THROW(identities(image), Error);
}

TEST(CompareShown, DifferencesAreSummedByWhatIsShown) {
    Image a = gray(3, 1, 0.5f);
    Image b = a;
    b.pixels[0] = 0.8f;                 // .3 in one of three channels
    b.pixels[8] = b.pixels[9] = 0.25f;  // .25 in two
    std::vector<double> sums(2, 0.0);
    add_differences(a, b, {1, 2, 2}, sums);
    EXPECT_NEAR(sums[0], 0.1, 1e-6);
    EXPECT_NEAR(sums[1], 0.5 / 3, 1e-6);
}

TEST(CompareShown, PixelsOfUnknownThingsAddToNothing) {
    std::vector<double> sums(1, 0.0);
    add_differences(gray(2, 1, 0), gray(2, 1, 1), {kNothing, 2}, sums);
    EXPECT_EQ(sums[0], 0);
}

TEST(CompareShown, AWrongSilhouetteCountsByItsAlpha) {
    std::vector<double> sums(1, 0.0);
    add_differences(gray(1, 1, 1, 1), gray(1, 1, 1, 0), {1}, sums);
    EXPECT_NEAR(sums[0], 1, 1e-6);
}

TEST(CompareShown, PicturesOfOtherSizesAreRefused) {
    std::vector<double> sums(1, 0.0);
    EXPECT_THROW(add_differences(gray(2, 1, 0), gray(1, 2, 0), {1, 1}, sums), Error);
    EXPECT_THROW(add_differences(gray(2, 1, 0), gray(2, 1, 0), {1}, sums), Error);
    EXPECT_THROW(difference_picture(gray(2, 1, 0), gray(1, 1, 0)), Error);
}

TEST(CompareShown, ColorsStandAtTheirStopsAndBetween) {
    EXPECT_EQ(difference_color(0), (std::array<float, 3>{0, 0, 0}));
    EXPECT_NEAR(difference_color(0.01f)[2], 0.3f, 1e-6);
    EXPECT_EQ(difference_color(0.1f), (std::array<float, 3>{0.9f, 0.8f, 0.05f}));
    EXPECT_EQ(difference_color(0.25f), difference_color(1));
    EXPECT_EQ(difference_color(std::numeric_limits<float>::quiet_NaN()), difference_color(1));
}

TEST(CompareShown, ThePictureIsOpaqueAndColoredByTheLargestDifference) {
    Image b = gray(2, 1, 0.5f);
    b.pixels[1] = 0.4f;
    const Image picture = difference_picture(gray(2, 1, 0.5f), b);
    EXPECT_TRUE(picture.linear);
    EXPECT_EQ(picture.pixels[3], 1);
    EXPECT_NEAR(picture.pixels[0], difference_color(0.1f)[0], 1e-4);
    EXPECT_EQ(picture.pixels[4], 0);
    EXPECT_EQ(picture.pixels[7], 1);
}

}  // namespace
}  // namespace lodestone::image
