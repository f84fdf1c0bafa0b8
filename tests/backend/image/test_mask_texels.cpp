// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what counts as a mask: texels that are seen, means that stay, hostile numbers.
#include "image/image.h"
#include "image/mask_texels.h"
#include "image/texture_sampler.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace lodestone::image {
namespace {

Texture texture_of(int width, int height, const std::function<float(int, int)>& alpha) {
    Image image;
    image.width = width;
    image.height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            image.pixels.insert(image.pixels.end(), {0.25f, 0.5f, 0.75f, alpha(x, y)});
    }
    Texture texture;
    texture.picture = make_picture(png_bytes(image), ColorSpace::Srgb, "mask");
    texture.channel = TextureChannel::Alpha;
    return texture;
}

SeenTexels everything(const MaskTexels& texels) {
    SeenTexels seen = unseen_texels(texels.width, texels.height);
    std::fill(seen.blocks.begin(), seen.blocks.end(), uint8_t{1});
    return seen;
}

TEST(MaskTexels, NothingSeenIsNoMask) {
    const MaskTexels texels = mask_texels(texture_of(1, 1, [](int, int) { return 1.0f; }));
    EXPECT_EQ(texels.size(), 1u);
    EXPECT_FALSE(count(texels, unseen_texels(1, 1)).is_mask());
    EXPECT_TRUE(count(texels, everything(texels)).is_mask());
    EXPECT_EQ(count(texels, everything(texels)).mean, 1);
}

TEST(MaskTexels, NineteenOfTwentyTexelsDecide) {
    for (const int between : {5, 6}) {
        const MaskTexels texels = mask_texels(
            texture_of(10, 10, [&](int x, int y) { return 10 * y + x < between ? 0.5f : 0.0f; }));
        EXPECT_EQ(count(texels, everything(texels)).is_mask(), between == 5);
    }
}

TEST(MaskTexels, AFilmThatIsALittleClearBecameOpaque) {
    const auto is_mask = [](const std::function<float(int, int)>& alpha) {
        const MaskTexels texels = mask_texels(texture_of(64, 64, alpha));
        return count(texels, everything(texels)).is_mask();
    };
    for (const float film : {0.92f, 0.97f, 0.08f, 0.03f}) {
        EXPECT_FALSE(is_mask([=](int, int) { return film; })) << film;
        // A few dots that are not are no other side.
        EXPECT_FALSE(is_mask([=](int x, int y) { return x + y < 10 ? 1 - film : film; })) << film;
    }
    for (const float whole : {1.0f, 0.99f, 0.0f, 0.01f})
        EXPECT_TRUE(is_mask([=](int, int) { return whole; })) << whole;
    // Leaves that let a little light through, with antialiased edges, are a mask.
    EXPECT_TRUE(is_mask([](int x, int y) {
        const float away = std::hypot(static_cast<float>(x) - 31.5f, static_cast<float>(y) - 31.5f);
        return 0.93f * std::clamp(20.5f - away, 0.0f, 1.0f);
    }));
}

TEST(MaskTexels, BlurredEdgesAreThoseOfAMaskAndSmokeIsNot) {
    // A tenth of all texels are the blurred edge of a disk; then a soft ball; then glass in a frame.
    const auto away = [](int x, int y) {
        return std::hypot(static_cast<float>(x) - 31.5f, static_cast<float>(y) - 31.5f);
    };
    const auto is_mask = [](const std::function<float(int, int)>& alpha) {
        const MaskTexels texels = mask_texels(texture_of(64, 64, alpha));
        const MaskCount found = count(texels, everything(texels));
        EXPECT_LT(found.sure * 20, found.seen * 19);
        return found.is_mask();
    };
    EXPECT_TRUE(is_mask(
        [&](int x, int y) { return std::clamp(0.5f + (22.0f - away(x, y)) / 5.0f, 0.0f, 1.0f); }));
    EXPECT_FALSE(
        is_mask([&](int x, int y) { return std::clamp(1.0f - away(x, y) / 30.0f, 0.0f, 1.0f); }));
    EXPECT_FALSE(is_mask([&](int x, int y) { return x < 16 ? 1.0f : (y < 32 ? 0.0f : 0.5f); }));
}

TEST(MaskTexels, OnlyWhatIsSeenDecides) {
    // The left half is a blend, the right one stripes of a mask.
    const MaskTexels texels = mask_texels(texture_of(
        512, 512, [](int x, int y) { return x < 256 ? 0.5f : static_cast<float>(y % 2); }));
    SeenTexels seen = unseen_texels(512, 512);
    EXPECT_FALSE(count(texels, everything(texels)).is_mask());
    for (int row = 0; row < seen.rows; ++row) {
        for (int column = seen.columns / 2; column < seen.columns; ++column)
            seen.blocks.at(row * seen.columns + column) = 1;
    }
    const MaskCount found = count(texels, seen);
    EXPECT_TRUE(found.is_mask());
    EXPECT_EQ(found.seen, 512u * 256u);
    EXPECT_EQ(found.clear, 512u * 128u);
    EXPECT_NEAR(found.mean, 0.5, 1e-12);
}

TEST(MaskTexels, EdgesThatAreKnownCountAsThoseThatAreNot) {
    // Edges of all widths, up to the border of the picture.
    MaskTexels texels = mask_texels(texture_of(200, 90, [](int x, int y) {
        return 0.5f + 0.5f * std::sin(0.002f * static_cast<float>(x * x + y * y));
    }));
    SeenTexels seen = everything(texels);
    for (size_t i = 0; i < seen.blocks.size(); i += 3)
        seen.blocks[i] = 0;
    ASSERT_EQ(texels.edges.size(), texels.size());
    const MaskCount known = count(texels, seen);
    texels.edges.clear();
    const MaskCount found = count(texels, seen);
    EXPECT_GT(known.edge, 100u);
    EXPECT_LT(known.edge + known.sure, known.seen);
    EXPECT_EQ(known.edge, found.edge);
    EXPECT_EQ(known.mean, found.mean);
    EXPECT_EQ(known.spread, found.spread);
}

TEST(MaskTexels, HalvingKeepsTheMeanAndACutoffItsShare) {
    const auto alpha = [](int x, int y) { return (x * 7 + y * 3) % 10 < 3 ? 0.9f : 0.2f; };
    const MaskTexels texels = mask_texels(texture_of(64, 48, alpha));
    const double mean = count(texels, everything(texels)).mean;
    for (const int halvings : {0, 1, 3, 5}) {
        const auto mean_of = [&](std::optional<double> cutoff) {
            const MaskNumbers numbers = halved(texels, halvings, cutoff);
            EXPECT_EQ(numbers.width, 64 >> halvings);
            double sum = 0;
            for (const float value : numbers.alpha)
                sum += static_cast<double>(value);
            return sum / static_cast<double>(numbers.alpha.size());
        };
        // 48 rows become one, two or more of unequal height only where 48 is no multiple.
        EXPECT_NEAR(mean_of({}), mean, 0.01);
        EXPECT_NEAR(mean_of(0.5), 0.3, 0.02);
    }
}

TEST(MaskTexels, OtherChannelsScalesAndBadNumbersCount) {
    Texture texture = texture_of(4, 4, [](int, int) { return 1.0f; });
    texture.channel = TextureChannel::Green;
    texture.scale = glm::dvec3(-1.0);
    texture.offset = glm::dvec3(1.0);
    const double green = std::pow((0.5 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(mask_texels(texture).alpha[5], 255 * (1 - green), 1.5);
    texture.scale = glm::dvec3(std::nan(""));
    EXPECT_EQ(mask_texels(texture).alpha[5], 0);
}

TEST(MaskTexels, FlagsOfBlocksReachEveryTexel) {
    MaskTexels texels;
    texels.width = 1000;
    texels.height = 3;
    texels.alpha.resize(3000);
    SeenTexels seen = unseen_texels(1000, 3);
    EXPECT_LE(seen.columns, 256);
    seen.blocks.back() = 1;
    const std::vector<uint8_t> flags = seen_of(seen, texels, 500, 1);
    EXPECT_EQ(flags.front(), 0);
    EXPECT_EQ(seen_of(seen, texels, 1000, 3).back(), 1);
}

}  // namespace
}  // namespace lodestone::image
