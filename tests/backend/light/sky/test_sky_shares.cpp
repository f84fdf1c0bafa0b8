// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the numbers of the sky's light at corners: as bytes, and for no other mesh than theirs.
#include "light/sky/sky_shares.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using namespace lodestone::light;

namespace {

/// A quad whose diagonal is split.
SkyShares split_quad() {
    SkyShares shares;
    shares.mean = 0.5;
    shares.splits = {{geometry::welded_edge(0, 2)}};
    for (int i = 0; i < 12; ++i)
        shares.corners.push_back(static_cast<uint8_t>(20 * i));
    return shares;
}

}  // namespace

TEST(SkyShares, BytesAreTheNearestToShares) {
    EXPECT_EQ(share_byte(0), 0);
    EXPECT_EQ(share_byte(1), kShareSteps);
    EXPECT_EQ(share_byte(7), kShareSteps);
    EXPECT_EQ(share_byte(std::numeric_limits<double>::quiet_NaN()), 0);
    for (int byte = 0; byte <= kShareSteps; ++byte)
        EXPECT_EQ(share_byte(share_of_byte(static_cast<uint8_t>(byte))), byte);
}

TEST(SkyShares, ASplitMeshHasAShareForEachCorner) {
    const Mesh quad = shapes::quad(2, 1);
    const auto split = split_for_sky(quad, split_quad());
    ASSERT_TRUE(split);
    EXPECT_EQ(split->mesh.triangles.size(), 4u);
    EXPECT_EQ(split->sources, (std::vector<uint32_t>{0, 0, 1, 1}));
    EXPECT_FALSE(whole(quad, split_quad()));
    SkyShares plain;
    plain.corners.assign(6, 255);
    EXPECT_TRUE(whole(quad, plain));
    EXPECT_FALSE(whole(shapes::cube(), plain));
    EXPECT_EQ(split_for_sky(quad, plain)->mesh.triangles.size(), 2u);
}

TEST(SkyShares, AnotherMeshIsRefused) {
    EXPECT_FALSE(split_for_sky(shapes::cube(), split_quad()));
    SkyShares other = split_quad();
    other.splits[0] = {geometry::welded_edge(1, 3)};  // no edge
    EXPECT_FALSE(split_for_sky(shapes::quad(2, 1), other));
}

TEST(SkyShares, BytesThatCannotBeAreRefused) {
    const SkyShares good = split_quad();
    const auto back = SkyShares::of_bytes(good.bytes(), 2);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->splits, good.splits);
    EXPECT_EQ(back->corners, good.corners);
    EXPECT_EQ(back->mean, good.mean);
    EXPECT_FALSE(SkyShares::of_bytes(good.bytes(), 5));
    for (const double mean : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
        SkyShares bad = good;
        bad.mean = mean;
        EXPECT_FALSE(SkyShares::of_bytes(bad.bytes(), 2)) << mean;
    }
    SkyShares falling = good;
    falling.splits = {{9, 8}};
    EXPECT_FALSE(SkyShares::of_bytes(falling.bytes(), 2));
    SkyShares many = good;
    many.splits.assign(kMostSplitRounds + 1, {});
    EXPECT_FALSE(SkyShares::of_bytes(many.bytes(), 2));
    SkyShares odd = good;
    odd.corners.pop_back();
    EXPECT_FALSE(SkyShares::of_bytes(odd.bytes(), 2));
    SkyShares more = good;
    more.splits.clear();
    EXPECT_FALSE(SkyShares::of_bytes(more.bytes(), 2));
}

TEST(SkyShares, ASizeIsAByteOfOctaves) {
    EXPECT_EQ(size_byte(0), kSeenOfAnySize + 1);  // something is seen of it
    EXPECT_EQ(size_byte(-1), size_byte(0));
    EXPECT_EQ(size_byte(kInfinity), 255);
    for (const double pixels : {1e-6, 0.25, 1.0, 16.0, 65536.0})
        EXPECT_NEAR(pixels_of_size(size_byte(pixels)) / pixels, 1, 0.5);
    EXPECT_EQ(pixels_of_size(size_byte(16)), 16);
    EXPECT_EQ(size_byte(std::nan("")), size_byte(0));
}

TEST(SkyShares, TheyCoverWhatIsAboutAsLarge) {
    SkyShares shares;
    shares.seen = {size_byte(16), 0};
    EXPECT_TRUE(covers(shares, std::vector<uint8_t>{size_byte(1), 0}));
    EXPECT_TRUE(covers(shares, std::vector<uint8_t>{size_byte(64), 0}));
    EXPECT_FALSE(covers(shares, std::vector<uint8_t>{size_byte(128), 0}));
    EXPECT_FALSE(covers(shares, std::vector<uint8_t>{kSeenOfAnySize, 0}));
    EXPECT_FALSE(covers(shares, std::vector<uint8_t>{size_byte(1), size_byte(1)}));
    shares.seen = {kSeenOfAnySize, 0};
    EXPECT_TRUE(covers(shares, std::vector<uint8_t>{size_byte(1e9), 0}));
}

TEST(SkyShares, TheyCoverWhatHasAllItsRays) {
    SkyShares shares;
    const std::vector<uint8_t> first = {1, 0};
    const std::vector<uint8_t> all = {1, 1};
    EXPECT_TRUE(covers(shares, {}));
    EXPECT_TRUE(covers(shares, first));
    shares.seen = first;
    EXPECT_TRUE(covers(shares, first));
    EXPECT_FALSE(covers(shares, all));
    EXPECT_FALSE(covers(shares, {}));  // that is all
    EXPECT_TRUE(covers(shares, std::vector<uint8_t>{0, 0}));
    EXPECT_FALSE(covers(shares, std::vector<uint8_t>{0, 0, 0}));
    shares.corners.assign(6, 255);
    const auto back = SkyShares::of_bytes(shares.bytes(), 2);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->seen, first);
    EXPECT_FALSE(SkyShares::of_bytes(shares.bytes(), 3));
}
