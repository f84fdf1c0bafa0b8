// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is handed out of a picture while it is drawn: every pixel once, in its place.
#include "base/error.h"
#include "povray_export/run/live_picture.h"

#include <algorithm>
#include <climits>
#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// A color that tells where a pixel lies in the whole picture.
LivePixel color_at(int x, int y) {
    return {static_cast<float>(x), static_cast<float>(y), 0.5f, 1.0f};
}

void finish(LivePicture& picture, const PixelRectangle& where) {
    std::vector<LivePixel> pixels;
    for (int y = 0; y < where.height; ++y) {
        for (int x = 0; x < where.width; ++x)
            pixels.push_back(color_at(where.left + x, where.top + y));
    }
    picture.finish(where, pixels);
}

/// A rectangle that was handed out, with its pixels.
struct Taken {
    PixelRectangle where;
    std::vector<LivePixel> pixels;
};

std::vector<Taken> take_all(LivePicture& picture, size_t room, bool bottom_up = false) {
    std::vector<Taken> out;
    std::vector<LivePixel> pixels(room);
    while (const auto where = picture.take(bottom_up, pixels)) {
        const auto count = static_cast<std::ptrdiff_t>(where->width) * where->height;
        out.push_back({*where, {pixels.begin(), pixels.begin() + count}});
    }
    return out;
}

bool same(const PixelRectangle& a, const PixelRectangle& b) {
    return a.left == b.left && a.top == b.top && a.width == b.width && a.height == b.height;
}

}  // namespace

TEST(LivePicture, APartWithoutPixelsIsRefused) {
    for (const PixelRectangle& part :
         {PixelRectangle{0, 0, 0, 5}, PixelRectangle{0, 0, 5, -1}, PixelRectangle{0, 0, 65537, 1},
          PixelRectangle{0, 0, 1, INT_MAX}}) {
        try {
            const LivePicture picture(part);
            FAIL() << part.width << " x " << part.height;
        } catch (const Error& error) {
            EXPECT_EQ(error.status, Status::InvalidArgument);
        }
    }
    LivePicture one({0, 0, 1, 1});
    EXPECT_EQ(one.pixels(), 1u);
    EXPECT_TRUE(take_all(one, 4).empty());
}

TEST(LivePicture, WhatIsFinishedIsHandedOutOnceInItsPlace) {
    LivePicture picture({10, 20, 100, 70});
    finish(picture, {42, 52, 32, 32});
    EXPECT_EQ(picture.finished(), 1024u);
    const auto taken = take_all(picture, 4096);
    ASSERT_EQ(taken.size(), 1u);
    EXPECT_TRUE(same(taken[0].where, {32, 32, 32, 32}));
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x)
            EXPECT_EQ(taken[0].pixels[static_cast<size_t>(y * 32 + x)], color_at(42 + x, 52 + y));
    }
    EXPECT_TRUE(take_all(picture, 4096).empty());
    finish(picture, {106, 84, 4, 6});  // the last corner of the picture
    const auto corner = take_all(picture, 4096, true);
    ASSERT_EQ(corner.size(), 1u);
    EXPECT_TRUE(same(corner[0].where, {96, 64, 4, 6}));
    EXPECT_EQ(corner[0].pixels.front(), color_at(106, 89));  // the lowest row first
    EXPECT_EQ(corner[0].pixels.back(), color_at(109, 84));
}

TEST(LivePicture, TilesThatTouchComeTogetherAsFarAsThereIsRoom) {
    LivePicture picture({0, 0, 100, 70});
    finish(picture, {0, 0, 100, 70});
    EXPECT_EQ(picture.finished(), picture.pixels());
    auto taken = take_all(picture, 7000);
    ASSERT_EQ(taken.size(), 1u);
    EXPECT_TRUE(same(taken[0].where, {0, 0, 100, 70}));
    EXPECT_EQ(taken[0].pixels[101], color_at(1, 1));

    // With room for less, every pixel comes once all the same.
    for (const size_t room : {size_t{1024}, size_t{1500}, size_t{3300}, size_t{6999}}) {
        finish(picture, {0, 0, 100, 70});
        std::vector<int> seen(7000);
        for (const Taken& part : take_all(picture, room)) {
            EXPECT_LE(part.pixels.size(), room);
            for (size_t i = 0; i < part.pixels.size(); ++i) {
                const int x = part.where.left + static_cast<int>(i) % part.where.width;
                const int y = part.where.top + static_cast<int>(i) / part.where.width;
                EXPECT_EQ(part.pixels[i], color_at(x, y));
                ++seen[static_cast<size_t>(y * 100 + x)];
            }
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 7000);
    }

    // An L of three tiles is two rectangles.
    finish(picture, {0, 0, 32, 64});
    finish(picture, {32, 0, 32, 32});
    EXPECT_EQ(take_all(picture, 7000).size(), 2u);

    finish(picture, {0, 0, 32, 32});
    std::vector<LivePixel> little(1023);
    EXPECT_THROW(static_cast<void>(picture.take(false, little)), Error);
}

TEST(LivePicture, AMosaicIsPaintedOverByWhatIsFiner) {
    LivePicture picture({0, 0, 40, 40});
    EXPECT_EQ(picture.paint({0, 0, 32, 32}, {1, 1, 1, 1}), 1024u);
    EXPECT_EQ(picture.paint({32, 32, 32, 32}, {2, 2, 2, 1}), 64u);  // as far as the picture goes
    EXPECT_EQ(picture.paint({16, 16, 16, 16}, {3, 3, 3, 1}), 256u);
    EXPECT_EQ(picture.finished(), 0u);
    const auto taken = take_all(picture, 1600);
    ASSERT_EQ(taken.size(), 2u);
    EXPECT_EQ(taken[0].pixels[0][0], 1);
    EXPECT_EQ(taken[0].pixels[16 * 32 + 16][0], 3);
    EXPECT_TRUE(same(taken[1].where, {32, 32, 8, 8}));
    EXPECT_EQ(taken[1].pixels[63][0], 2);
    finish(picture, {0, 0, 32, 32});
    EXPECT_EQ(take_all(picture, 1600).at(0).pixels[16 * 32 + 16], color_at(16, 16));
}

TEST(LivePicture, WhatLiesOutsideIsLeftOut) {
    LivePicture picture({10, 10, 40, 40});
    EXPECT_EQ(picture.paint({INT_MIN, INT_MIN, INT_MAX, INT_MAX}, {}), 0u);
    EXPECT_EQ(picture.paint({INT_MAX, INT_MAX, INT_MAX, INT_MAX}, {}), 0u);
    EXPECT_EQ(picture.paint({-5, -5, INT_MAX, INT_MAX}, {7, 7, 7, 1}), 1600u);
    EXPECT_EQ(picture.paint({20, 20, -4, 5}, {}), 0u);
    finish(picture, {0, 0, 20, 20});
    EXPECT_EQ(picture.finished(), 100u);
    finish(picture, {60, 60, 5, 5});
    EXPECT_EQ(picture.finished(), 100u);
    const auto taken = take_all(picture, 1600);
    ASSERT_EQ(taken.size(), 1u);
    EXPECT_EQ(taken[0].pixels[0], color_at(10, 10));
    EXPECT_EQ(taken[0].pixels[10 * 40 + 10][0], 7);
    for (int i = 0; i < 40; ++i)  // drawn again and again, more is not finished than there is
        finish(picture, {10, 10, 40, 40});
    EXPECT_EQ(picture.finished(), 1600u);
    EXPECT_THROW(picture.finish({0, 0, 2, 2}, std::vector<LivePixel>(3)), Error);
    EXPECT_THROW(picture.finish({0, 0, -2, -2}, std::vector<LivePixel>(4)), Error);
}
