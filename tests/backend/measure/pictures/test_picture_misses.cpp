// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how pictures are compared: what shows nothing is not looked at, and nothing else is left
// out.
#include "base/random.h"
#include "measure/pictures/picture_misses.h"

#include <gtest/gtest.h>

using namespace lodestone;
using measure::PictureRect;
using measure::PixelMisses;

namespace {

constexpr int kSide = 30;
constexpr size_t kViews = 3;

using Pictures = std::vector<glm::vec4>;

/// Random light in the columns and rows from `low` to below `high`, nothing elsewhere.
Pictures shown(const glm::ivec2& low, const glm::ivec2& high, uint64_t seed) {
    Pictures out(kViews * kSide * kSide, glm::vec4(0.0f));
    PcgRandom random(seed, 0);
    for (size_t view = 0; view < kViews; ++view) {
        for (int row = low.y; row < high.y; ++row) {
            for (int column = low.x; column < high.x; ++column) {
                const auto line = static_cast<size_t>(row);
                const size_t at = (view * kSide + line) * kSide + static_cast<size_t>(column);
                const auto value = [&] { return static_cast<float>(random.uniform()); };
                if (random.uniform() < 0.7)
                    out[at] = glm::vec4(value(), value(), value(), 1);
            }
        }
    }
    return out;
}

void expect_same(const PixelMisses& a, const PixelMisses& b) {
    EXPECT_EQ(a.covered, b.covered);
    EXPECT_EQ(a.coverage.sum, b.coverage.sum);
    EXPECT_EQ(a.coverage.products, b.coverage.products);
    EXPECT_EQ(a.light.sum, b.light.sum);
    EXPECT_EQ(a.light.squares, b.light.squares);
    EXPECT_EQ(a.finest_light, b.finest_light);
}

}  // namespace

TEST(PixelMisses, PartsHoldAllThatEitherPictureShows) {
    Pictures a(kViews * kSide * kSide, glm::vec4(0.0f));
    Pictures b = a;
    a[7 * kSide + 12].w = 1;
    b[9 * kSide + 3].w = 0.01f;
    b[size_t{2} * kSide * kSide].w = 1;
    const std::vector<PictureRect> parts = measure::picture_rects(a, b, kViews, kSide);
    ASSERT_EQ(parts.size(), kViews);
    EXPECT_EQ(parts[0].low, glm::ivec2(3, 7));
    EXPECT_EQ(parts[0].high, glm::ivec2(13, 10));
    EXPECT_GE(parts[1].low.x, parts[1].high.x);  // nothing
    EXPECT_EQ(parts[2].low, glm::ivec2(0, 0));
    EXPECT_EQ(parts[2].high, glm::ivec2(1, 1));
}

TEST(PixelMisses, WhatShowsNothingMayBeLeftOut) {
    const std::vector<PictureRect> whole(kViews, {glm::ivec2(0), glm::ivec2(kSide)});
    const glm::ivec2 low(4, 11);
    const glm::ivec2 high(9, 26);
    const Pictures a = shown(low, high, 1);
    for (const Pictures& b :
         {shown(low, high, 2), shown({1, 2}, {6, 13}, 3), Pictures(a.size(), glm::vec4(0.0f))}) {
        const std::vector<PictureRect> parts = measure::picture_rects(a, b, kViews, kSide);
        for (const int pixel : {2, 3, 5, 6, 10, 15, 30}) {
            const PixelMisses all = measure::pixel_misses(a, b, whole, kSide, pixel);
            EXPECT_GT(all.covered, 0u);
            expect_same(measure::pixel_misses(a, b, parts, kSide, pixel), all);
        }
    }
}

TEST(PixelMisses, EmptyPicturesAgree) {
    const Pictures none(kViews * kSide * kSide, glm::vec4(0.0f));
    const std::vector<PictureRect> parts = measure::picture_rects(none, none, kViews, kSide);
    EXPECT_EQ(measure::pixel_misses(none, none, parts, kSide, 2).covered, 0u);
    EXPECT_EQ(measure::pixel_misses(none, none, parts, kSide, 2).worst(), 0);
}
