// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the pixel filter: it spreads as far as Blender's, keeps the light, and stays in its part.
#include "base/error.h"
#include "image/pixel_filter.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace lodestone::image {
namespace {

Image plain_image(int width, int height, float value = 0) {
    Image image;
    image.width = width;
    image.height = height;
    image.linear = true;
    image.pixels.assign(4 * image.size(), value);
    return image;
}

float& red(Image& image, int x, int y) {
    return image.pixels[4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) +
                             static_cast<size_t>(x))];
}

/// The variance of the weights along x that a single bright pixel became.
double variance_along_x(Image& image) {
    double sum = 0;
    double squares = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double away = x - (image.width - 1) / 2.0;
            sum += static_cast<double>(red(image, x, y));
            squares += away * away * static_cast<double>(red(image, x, y));
        }
    }
    return squares / sum;
}

TEST(PixelFilter, NoSizeSpreadsNothing) {
    EXPECT_EQ(missing_spread(0, 3), 0);
    EXPECT_EQ(missing_spread(-1, 3), 0);
    EXPECT_EQ(missing_spread(std::numeric_limits<double>::quiet_NaN(), 3), 0);
    EXPECT_EQ(missing_spread(0.01, 3), 0);  // narrower than a pixel's square
}

TEST(PixelFilter, SamplesAndFilterTogetherSpreadAsBlackmanHarris) {
    // The filter of 1.5 pixels, sampled finely.
    double sum = 0;
    double squares = 0;
    for (int i = -15000; i <= 15000; ++i) {
        const double x = i / 10000.0;
        const double v = 2 * std::numbers::pi * (x / 3 + 0.5);
        const double weight =
            0.35875 - 0.48829 * std::cos(v) + 0.14128 * std::cos(2 * v) - 0.01168 * std::cos(3 * v);
        sum += weight;
        squares += weight * x * x;
    }
    for (const int side : {1, 2, 3, 4}) {
        double within = 0;
        for (int i = 0; i < side; ++i)
            within += std::pow((i + 0.5) / side - 0.5, 2) / side;
        EXPECT_NEAR(missing_spread(1.5, side) + within, squares / sum, 1e-6) << side;
    }
}

TEST(PixelFilter, OnePixelBecomesWhatTheVarianceSays) {
    for (const double variance : {0.09, 0.5, 0.7, 3.0}) {
        Image image = plain_image(41, 41);
        red(image, 20, 20) = 2;
        spread_pixels(image, variance, {0, 0, 41, 41});
        double sum = 0;
        for (size_t i = 0; i < image.pixels.size(); i += 4)
            sum += static_cast<double>(image.pixels[i]);
        EXPECT_NEAR(sum, 2, 1e-5);
        EXPECT_NEAR(variance_along_x(image), variance, 1e-3);
        EXPECT_FLOAT_EQ(red(image, 18, 20), red(image, 22, 20));
        EXPECT_FLOAT_EQ(red(image, 20, 18), red(image, 18, 20));
    }
}

TEST(PixelFilter, AnEvenPictureStays) {
    Image image = plain_image(7, 5, 0.3f);
    spread_pixels(image, 0.4, {0, 0, 7, 5});
    for (const float value : image.pixels)
        EXPECT_FLOAT_EQ(value, 0.3f);
    Image one = plain_image(1, 1, 0.3f);
    spread_pixels(one, 0.4, {0, 0, 1, 1});
    EXPECT_FLOAT_EQ(red(one, 0, 0), 0.3f);
}

TEST(PixelFilter, BorderRenderHadDarkEdges) {
    Image image = plain_image(8, 8);
    for (int y = 2; y < 6; ++y) {
        for (int x = 3; x < 7; ++x)
            red(image, x, y) = 1;
    }
    spread_pixels(image, 0.4, {3, 2, 4, 4});
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x)
            EXPECT_FLOAT_EQ(red(image, x, y), y >= 2 && y < 6 && x >= 3 && x < 7 ? 1.0f : 0.0f);
    }
}

TEST(PixelFilter, NumbersThatAreNoneStayAlone) {
    Image image = plain_image(5, 5, 0.5f);
    red(image, 2, 2) = std::numeric_limits<float>::quiet_NaN();
    red(image, 0, 0) = std::numeric_limits<float>::infinity();
    spread_pixels(image, 0.4, {0, 0, 5, 5});
    for (const float value : image.pixels)
        EXPECT_TRUE(value >= 0 && value <= 0.5f) << value;
}

TEST(PixelFilter, PartsThatAreNotInThePictureAreRefused) {
    Image image = plain_image(4, 4);
    const ImageRegion wrong[] = {{-1, 0, 2, 2}, {0, 0, 5, 4}, {0, 3, 1, 2}, {0, 0, 0, 4}};
    for (const ImageRegion& part : wrong)
        EXPECT_THROW(spread_pixels(image, 0.1, part), Error);
}

}  // namespace
}  // namespace lodestone::image
