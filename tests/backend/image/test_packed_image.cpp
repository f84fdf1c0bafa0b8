// SPDX-License-Identifier: GPL-3.0-or-later
// Guards pictures of bytes: numbers become the bytes that formulas give, and keep what is known.
#include "base/color.h"
#include "base/random.h"
#include "image/image_reduction.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace lodestone::image {
namespace {

TEST(PackedImage, BytesOfColorsAreThoseOfTheFormula) {
    const auto expected = [](float linear) {
        return std::lround(255.0f * std::clamp(encode_srgb(linear), 0.0f, 1.0f));
    };
    PcgRandom random(3);
    for (int i = 0; i < 200000; ++i) {
        const auto value = static_cast<float>(random.uniform());
        ASSERT_EQ(srgb_byte_of(value), expected(value)) << value;
        ASSERT_EQ(byte_of(value), std::lround(255.0f * value)) << value;
    }
    // The numbers around each limit between two bytes.
    for (int byte = 0; byte < 255; ++byte) {
        float value = decode_srgb((static_cast<float>(byte) + 0.5f) / 255.0f);
        for (int i = 0; i < 50; ++i)
            value = std::nextafter(value, 0.0f);
        for (int i = 0; i < 100; ++i, value = std::nextafter(value, 2.0f))
            ASSERT_EQ(srgb_byte_of(value), expected(value)) << value;
        float number = (static_cast<float>(byte) + 0.5f) / 255.0f;
        number = std::nextafter(std::nextafter(number, 0.0f), 0.0f);
        for (int i = 0; i < 5; ++i, number = std::nextafter(number, 2.0f))
            ASSERT_EQ(byte_of(number), std::lround(255.0f * number)) << number;
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const auto& [value, byte] :
         {std::pair{nan, 0}, std::pair{-infinity, 0}, std::pair{-1.0f, 0}, std::pair{0.0f, 0},
          std::pair{1.0f, 255}, std::pair{2.0f, 255}, std::pair{infinity, 255}}) {
        EXPECT_EQ(srgb_byte_of(value), byte) << value;
        EXPECT_EQ(byte_of(value), byte) << value;
    }
}

TEST(PackedImage, APictureOfPixelsKnowsWhatDecodingItsPngTells) {
    for (const bool clear : {false, true}) {
        for (const bool linear : {false, true}) {
            Image image;
            image.width = 37;
            image.height = 23;
            image.linear = linear;
            PcgRandom random(5);
            for (size_t i = 0; i < 4 * image.size(); ++i)
                image.pixels.push_back(i % 4 == 3 && !clear ? 1.0f
                                                            : static_cast<float>(random.uniform()));
            const PicturePtr made =
                make_picture(packed(image), PngEffort::Quick, ColorSpace::Srgb, "made");
            EXPECT_EQ(made->bytes, png_bytes(image, PngEffort::Quick));
            EXPECT_GT(made->bytes.size(), image.size() * (clear ? 4 : 3)) << "nothing is packed";
            EXPECT_EQ(made->hash, make_picture(made->bytes, ColorSpace::Srgb, "again")->hash);
            EXPECT_EQ(made->width, 37);
            EXPECT_EQ(made->height, 23);
            const PackedPtr image_of_png = packed(*made);
            EXPECT_EQ(image_of_png->channels, clear ? 4 : 3);
            EXPECT_EQ(made->mean, mean_of(TexelRows(*image_of_png, ColorSpace::Srgb)));
            // The same bytes as by way of floats.
            const Image shown = encoded(image);
            const Image back = read(made->bytes, "back");
            for (size_t i = 0; i < shown.pixels.size(); ++i)
                ASSERT_EQ(std::lround(255.0f * back.pixels[i]),
                          std::lround(255.0f * std::clamp(shown.pixels[i], 0.0f, 1.0f)));
        }
    }
}

}  // namespace
}  // namespace lodestone::image
