// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that the sky's light is found where it is seen, and is the same when more of it is.
#include "backend/light/sky/sky_places.h"
#include "scenes/fine_grids.h"

#include <array>
#include <map>

using namespace lodestone;
using namespace lodestone::light;

using SeenShares = SkyPlaces;

TEST_F(SeenShares, WhatIsNotSeenHasFewRaysAndIsNotSplit) {
    // A ground in 8 x 8 parts, of which the half beside a wall and the other half are seen in turn.
    const Mesh mesh = shapes::terrain(8);
    const ObjectIndex ground = builder.mesh(mesh);
    const ObjectIndex walls = builder.mesh(shapes::boxes(30));
    const Affine small{glm::dmat3(0.04), {0.1, 0.4, 0}};
    const SkyPlace place(*this, {{ground, {}}, {walls, small}});
    std::vector<uint8_t> half;
    for (const Triangle& t : mesh.triangles)
        half.push_back(mesh.positions[t.x].x < 0.5f * mesh.positions.back().x ? 1 : 0);
    const auto shares = [&](const std::vector<uint8_t>& seen, const SkyShares* known) {
        SkyRequest request{place.surfaces.of(finest(ground)), {}, &*place.scene, 0, 64, 400};
        request.seen = seen;
        request.known = known;
        return sky_shares(request, {});
    };
    const SkyShares first = shares(half, nullptr);
    EXPECT_EQ(first.seen, half);
    EXPECT_TRUE(covers(first, half));
    const SkyShares all = shares({}, &first);
    EXPECT_TRUE(all.seen.empty());
    // What was split stays so, and what is seen keeps its shares but where neighbors are split now.
    ASSERT_GE(all.splits.size(), first.splits.size());
    EXPECT_TRUE(std::equal(first.splits.begin(), first.splits.end(), all.splits.begin()));
    const auto before = split_for_sky(mesh, first);
    const auto after = split_for_sky(mesh, all);
    ASSERT_TRUE(before && after);
    std::map<std::array<float, 9>, std::array<uint8_t, 3>> known;
    const auto corners = [](const Mesh& split, const SkyShares& of, size_t i) {
        std::array<float, 9> at{};
        std::array<uint8_t, 3> bytes{};
        for (size_t corner = 0; corner < 3; ++corner) {
            const glm::vec3& p = split.positions[split.triangles[i][static_cast<int>(corner)]];
            std::copy(&p.x, &p.x + 3, at.begin() + static_cast<ptrdiff_t>(3 * corner));
            bytes[corner] = of.corners[3 * i + corner];
        }
        return std::pair(at, bytes);
    };
    for (size_t i = 0; i < before->mesh.triangles.size(); ++i) {
        if (half[before->sources[i]] != 0)
            known.insert(corners(before->mesh, first, i));
    }
    size_t same = 0;
    for (size_t i = 0; i < after->mesh.triangles.size(); ++i) {
        const auto [at, bytes] = corners(after->mesh, all, i);
        const auto found = known.find(at);
        same += found != known.end() && found->second == bytes ? 1 : 0;
    }
    EXPECT_GT(10 * same, 9 * known.size());
    EXPECT_NEAR(first.mean, shares({}, nullptr).mean, 0.05);
}

// Facets of twenty pixels were as noisy as those of one.
TEST_F(SeenShares, WhatIsLargeInThePictureHasLessNoise) {
    const Mesh mesh = shapes::terrain(8);
    const ObjectIndex ground = builder.mesh(mesh);
    const ObjectIndex walls = builder.mesh(shapes::boxes(30));
    const SkyPlace place(*this, {{ground, {}}, {walls, {glm::dmat3(0.04), {0.1, 0.4, 0}}}});
    const auto shares = [&](std::span<const uint8_t> seen, int rays) {
        SkyRequest request{
            place.surfaces.of(finest(ground)), {}, &*place.scene, 0, rays, 0, 2 * rays};
        request.seen = seen;
        return sky_shares(request, {}).corners;
    };
    const std::vector<uint8_t> truth = shares({}, 4096);
    const auto noise = [&](double pixels) {
        const std::vector<uint8_t> seen(mesh.triangles.size(), size_byte(pixels));
        const std::vector<uint8_t> found = shares(seen, 64);
        double sum = 0;
        for (size_t i = 0; i < found.size(); ++i)
            sum += std::pow(share_of_byte(found[i]) - share_of_byte(truth[i]), 2);
        return std::sqrt(sum / static_cast<double>(found.size()));
    };
    const double large = noise(1e4);
    EXPECT_GT(noise(1e-3), 2 * large);
    EXPECT_GT(noise(1), 1.2 * large);
    EXPECT_LT(large, 0.06);
}

TEST_F(SeenShares, SomeTrianglesThatAreNotSeenTellTheMeanOfAll) {
    // Half of a ground lies below a roof, in triangles of a hundredth of the area of the others.
    Mesh mesh;
    shapes::add_face(mesh, 60, {-10, -1, 0}, {1, 0, 0}, {0, 2, 0});
    shapes::add_face(mesh, 6, {0, -1, 0}, {1, 0, 0}, {0, 2, 0});
    const ObjectIndex ground = builder.mesh(mesh);
    const ObjectIndex roof = builder.mesh(shapes::box({-11, -2, 0.1}, {-8, 2, 0.2}));
    const SkyPlace place(*this, {{ground, {}}, {roof, {}}});
    SkyRequest request{place.surfaces.of(finest(ground)), {}, &*place.scene, 0, 64, 0};
    const double all = sky_shares(request, {}).mean;
    std::vector<uint8_t> seen(mesh.triangles.size(), 0);
    seen.back() = kSeenOfAnySize;
    request.seen = seen;
    EXPECT_NEAR(all, 0.53, 0.05);
    EXPECT_NEAR(sky_shares(request, {}).mean, all, 0.05);
}

TEST(SeenSizes, AnotherPictureCountsAllAsSeen) {
    std::vector<uint8_t> seen = {0, size_byte(4), size_byte(0.1)};
    see_all(seen, std::vector<uint8_t>{size_byte(64), size_byte(1), 0});
    EXPECT_EQ(seen, (std::vector<uint8_t>{size_byte(64), size_byte(4), size_byte(1)}));
    see_all(seen, {});
    EXPECT_EQ(seen[2], size_byte(1));
    see_all({}, {});
}
