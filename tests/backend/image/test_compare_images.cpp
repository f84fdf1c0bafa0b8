// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the numbers every quality claim is made of: differences and SSIM over the covered pixels.
#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/compare_images.h"

#include <cmath>
#include <gtest/gtest.h>
#include <utility>

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

Image noise(int width, int height, uint64_t seed) {
    Image image = gray(width, height, 0);
    PcgRandom random(seed);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        if (i % 4 != 3)
            image.pixels[i] = static_cast<float>(random.uniform());
    }
    return image;
}

TEST(Compare, NoPixelsCoveredIsNoDifference) {
    const ImageDifference d = compare(gray(3, 3, 0.5f, 0), gray(3, 3, 0.9f, 0));
    EXPECT_EQ(d.pixels, 0u);
    EXPECT_EQ(d.mean, 0);
    EXPECT_EQ(d.ssim, 1);
}

TEST(Compare, OnePixelPictures) {
    const ImageDifference d = compare(gray(1, 1, 0.25f), gray(1, 1, 0.75f));
    EXPECT_EQ(d.pixels, 1u);
    EXPECT_DOUBLE_EQ(d.mean, 0.5);
    EXPECT_DOUBLE_EQ(d.p999, 0.5);
    EXPECT_DOUBLE_EQ(d.max, 0.5);
}

TEST(Compare, IdenticalPicturesDifferByNothing) {
    const Image picture = noise(40, 30, 1);
    const ImageDifference d = compare(picture, picture);
    EXPECT_EQ(d.pixels, 1200u);
    EXPECT_EQ(d.mean, 0);
    EXPECT_EQ(d.max, 0);
    EXPECT_NEAR(d.ssim, 1, 1e-12);
}

TEST(Compare, ConstantPicturesHaveTheClosedFormOfSsim) {
    const ImageDifference d = compare(gray(30, 20, 0.25f), gray(30, 20, 0.5f));
    const double c1 = 0.0001;
    EXPECT_NEAR(d.ssim, (2 * 0.25 * 0.5 + c1) / (0.0625 + 0.25 + c1), 1e-9);
    EXPECT_NEAR(d.mean, 0.25, 1e-12);
    EXPECT_NEAR(d.p999, 0.25, 1e-12);
}

TEST(Compare, ScaledContrastHasTheClosedFormOfSsim) {
    // Columns alternate mean +- amplitude; far from the border every window has the same weights.
    const auto stripes = [](float amplitude) {
        Image image = gray(60, 60, 0);
        for (size_t i = 0; i < image.size(); ++i) {
            for (size_t c = 0; c < 3; ++c)
                image.pixels[4 * i + c] = 0.5f + (i % 2 == 0 ? amplitude : -amplitude);
        }
        return image;
    };
    Image middle = gray(60, 60, 0, 0);
    for (size_t y = 20; y < 40; ++y) {
        for (size_t x = 20; x < 40; ++x)
            middle.pixels[4 * (y * 60 + x) + 3] = 1;
    }
    double even = 0;
    double all = 0;
    for (int i = -5; i <= 5; ++i) {
        const double weight = std::exp(-i * i / 4.5);
        all += weight;
        even += i % 2 == 0 ? weight : -weight;
    }
    const double shift = even / all;  // of the window's mean, in amplitudes; its sign alternates
    const double a = 0.25;
    const double b = 0.125;
    double expected = 0;
    for (const double sign : {1.0, -1.0}) {
        const double ma = 0.5 + sign * a * shift;
        const double mb = 0.5 + sign * b * shift;
        const double spread = 1 - shift * shift;
        expected += 0.5 * (2 * ma * mb + 1e-4) * (2 * a * b * spread + 9e-4) /
                    ((ma * ma + mb * mb + 1e-4) * ((a * a + b * b) * spread + 9e-4));
    }
    const ImageDifference d = compare(stripes(0.25f), stripes(0.125f), &middle);
    EXPECT_EQ(d.pixels, 400u);
    EXPECT_NEAR(d.ssim, expected, 1e-9);
    EXPECT_LT(d.ssim, 0.9);
}

TEST(Compare, MeanTakesAllChannelsAndMaxTheWorst) {
    Image a = gray(10, 10, 0.5f);
    Image b = a;
    for (size_t i = 0; i < b.size(); ++i)
        b.pixels[4 * i + 1] = 0.8f;  // green only
    const ImageDifference d = compare(a, b);
    EXPECT_NEAR(d.mean, 0.1, 1e-7);
    EXPECT_NEAR(d.p999, 0.3, 1e-7);
    EXPECT_NEAR(d.max, 0.3, 1e-7);
}

TEST(Compare, HalfBlackHasHalfTheMean) {
    const Image a = gray(20, 20, 1);
    Image b = a;
    for (size_t i = 0; i < b.size() / 2; ++i) {
        for (size_t c = 0; c < 3; ++c)
            b.pixels[4 * i + c] = 0;
    }
    const ImageDifference d = compare(a, b);
    EXPECT_DOUBLE_EQ(d.mean, 0.5);
    EXPECT_DOUBLE_EQ(d.max, 1);
    EXPECT_LT(d.ssim, 0.6);
}

TEST(Compare, QuantileLeavesOutOneInAThousand) {
    const Image a = gray(100, 20, 0);
    Image b = a;
    for (const size_t i : {size_t{0}, size_t{777}})  // 2 of 2000: exactly what may be ignored
        b.pixels[4 * i] = 1;
    EXPECT_EQ(compare(a, b).p999, 0);
    EXPECT_EQ(compare(a, b).max, 1);
    b.pixels[size_t{4} * 5] = 1;
    EXPECT_EQ(compare(a, b).p999, 1);
}

TEST(Compare, MaskSelectsPixelsAndAnOpaqueMaskSelectsAll) {
    const Image a = gray(16, 16, 0.5f);
    Image b = a;
    b.pixels[0] = b.pixels[1] = b.pixels[2] = 1;
    Image mask = gray(16, 16, 0, 0);
    mask.pixels[4 * 17 + 3] = 1;
    EXPECT_EQ(compare(a, b, &mask).pixels, 1u);
    EXPECT_EQ(compare(a, b, &mask).max, 0);
    mask.pixels[3] = 0.5f;
    EXPECT_EQ(compare(a, b, &mask).pixels, 2u);
    EXPECT_EQ(compare(a, b, &mask).max, 0.5);
    mask.pixels[3] = 1.0f / 255.0f;  // not above the threshold
    EXPECT_EQ(compare(a, b, &mask).pixels, 1u);
    const Image opaque = gray(16, 16, 0);
    EXPECT_EQ(compare(a, b, &opaque).pixels, 256u);
}

TEST(Compare, WithoutMaskEitherAlphaCoversAndSilhouettesCount) {
    Image a = gray(8, 1, 1, 0);
    Image b = a;
    a.pixels[3] = 1;      // only in a
    b.pixels[4 + 3] = 1;  // only in b
    const ImageDifference d = compare(a, b);
    EXPECT_EQ(d.pixels, 2u);
    EXPECT_DOUBLE_EQ(d.mean, 1);  // white against nothing, although both colors are white
}

TEST(Compare, LinearPicturesAreEncodedFirst) {
    Image linear = gray(4, 4, 0.21404114f);
    linear.linear = true;
    const ImageDifference d = compare(linear, gray(4, 4, 0.5f));
    EXPECT_LT(d.max, 1e-6);
}

TEST(Compare, IsSymmetricAndTheSameOnOneThread) {
    const Image a = noise(64, 48, 2);
    const Image b = noise(64, 48, 3);
    const ImageDifference many = compare(a, b);
    const ImageDifference swapped = compare(b, a);
    EXPECT_DOUBLE_EQ(many.mean, swapped.mean);
    EXPECT_NEAR(many.ssim, swapped.ssim, 1e-15);
    EXPECT_LT(many.ssim, 0.2);
    const ThreadLimit one(1);
    const ImageDifference single = compare(a, b);
    EXPECT_EQ(single.mean, many.mean);
    EXPECT_EQ(single.ssim, many.ssim);
}

TEST(Compare, RefusesDifferentSizes) {
    EXPECT_THROW(compare(gray(2, 3, 0), gray(3, 2, 0)), Error);
    const Image mask = gray(1, 1, 0);
    EXPECT_THROW(compare(gray(2, 3, 0), gray(2, 3, 0), &mask), Error);
    Image torn = gray(2, 3, 0);
    torn.pixels.pop_back();
    EXPECT_THROW(compare(torn, torn), Error);
}

TEST(Compare, NumbersThatAreNoneCountAsBlack) {
    Image a = gray(4, 4, 0);
    a.linear = true;
    a.pixels[0] = std::nanf("");
    a.pixels[1] = -INFINITY;
    EXPECT_EQ(compare(a, gray(4, 4, 0)).max, 0);
    a.pixels[2] = INFINITY;
    EXPECT_EQ(compare(a, gray(4, 4, 0)).max, 1);
}

}  // namespace
}  // namespace lodestone::image
