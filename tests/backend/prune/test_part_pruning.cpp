// SPDX-License-Identifier: GPL-3.0-or-later
// Guards pruning: which parts are a crowd, nested orders, survivors that show as much.
#include "prune/part_pruning.h"
#include "scenes/leaf_cards.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <set>

using namespace lodestone;
using namespace lodestone::prune;

namespace {

constexpr size_t kTrunk = size_t{2} * 8 * 8;  // triangles of foliage::tree's stem

double area_of(const Crowd& crowd, const std::vector<uint32_t>& order, size_t keep) {
    double sum = 0;
    for (size_t i = 0; i < keep; ++i)
        sum += crowd.parts[order[i]].area;
    return sum;
}

std::vector<uint32_t> random_order(const Crowd& crowd, uint64_t seed = 1) {
    return prune_order(crowd, PruneOrder::Random, seed);
}

}  // namespace

TEST(Crowd, NothingAndFewPartsAreNone) {
    EXPECT_TRUE(find_crowd(Mesh{}).empty());
    EXPECT_TRUE(find_crowd(foliage::tree(20)).empty());
    EXPECT_TRUE(find_crowd(shapes::terrain(30)).empty()) << "one part";
}

TEST(Crowd, LeavesAreOneAndTheTrunkIsTheRest) {
    const Mesh tree = foliage::tree(300);
    const Crowd crowd = find_crowd(tree);
    ASSERT_EQ(crowd.parts.size(), 300u);
    EXPECT_EQ(crowd.slots, std::vector<uint16_t>{1});
    EXPECT_EQ(crowd.triangles, 600u);
    for (size_t i = 0; i < kTrunk; ++i)
        EXPECT_EQ(crowd.part_of[i], kNoPart);
    for (const Crowd::CrowdPart& part : crowd.parts)
        EXPECT_NEAR(part.area, 0.06, 1e-6);
    EXPECT_FALSE(crowd.sizes_differ());
}

TEST(Crowd, LeavesThatTouchAtACornerArePartsOfTheirOwn) {
    Mesh mesh;
    for (int i = 0; i < 40; ++i) {
        Affine place;
        place.offset = {static_cast<double>(i), static_cast<double>(i), 0};
        append(mesh, shapes::quad(1, 1), place);
    }
    EXPECT_EQ(find_crowd(mesh).parts.size(), 40u);
}

TEST(Crowd, GivenPartsAreTaken) {
    const Mesh tree = foliage::tree(320);
    std::vector<uint32_t> given(tree.triangles.size(), 7000);
    for (size_t i = 0; i < 640; ++i)
        given[kTrunk + i] = static_cast<uint32_t>(i / 16);
    EXPECT_EQ(find_crowd(tree, given).parts.size(), 40u) << "eight leaves each";
}

TEST(Crowd, OrdersAreNestedFixedAndOfEverybody) {
    const Mesh tree = foliage::tree(300);
    const Crowd crowd = find_crowd(tree);
    const std::vector<uint32_t> order = random_order(crowd);
    EXPECT_EQ(std::set<uint32_t>(order.begin(), order.end()).size(), 300u);
    EXPECT_EQ(order, random_order(find_crowd(tree)));
    EXPECT_NE(order, random_order(crowd, 2));
    // Kept triangles of a coarser level are those of a finer one, before they grow.
    const std::vector<double> same{1.0};
    const auto corners = [&](size_t keep) {
        std::set<std::tuple<float, float, float>> out;
        for (const glm::vec3& p : prune_crowd(tree, crowd, order, keep, same).mesh.positions)
            out.emplace(p.x, p.y, p.z);
        return out;
    };
    const auto coarse = corners(40);
    const auto fine = corners(120);
    EXPECT_EQ(coarse.size(), 160u);
    EXPECT_TRUE(std::includes(fine.begin(), fine.end(), coarse.begin(), coarse.end()));
}

TEST(Crowd, EveryBeginningOfTheOrderIsSpreadOverSpace) {
    const Mesh tree = foliage::tree(1024);
    const Crowd crowd = find_crowd(tree);
    const std::vector<uint32_t> order = random_order(crowd);
    for (const size_t keep : {64u, 128u, 256u}) {
        size_t left = 0;
        size_t high = 0;
        size_t all_left = 0;
        size_t all_high = 0;
        for (size_t i = 0; i < order.size(); ++i) {
            const glm::dvec3& center = crowd.parts[order[i]].center;
            all_left += center.x < 0 ? 1 : 0;
            all_high += center.z > 2.5 ? 1 : 0;
            left += i < keep && center.x < 0 ? 1 : 0;
            high += i < keep && center.z > 2.5 ? 1 : 0;
        }
        const double share = static_cast<double>(keep) / 1024;
        // By chance it would be off by 4 to 8 (standard deviation), this one by less than that.
        EXPECT_NEAR(static_cast<double>(left), share * static_cast<double>(all_left), 6) << keep;
        EXPECT_NEAR(static_cast<double>(high), share * static_cast<double>(all_high), 6) << keep;
    }
}

TEST(Crowd, LargestComeFirstWhereTheyDiffer) {
    Mesh mesh;
    for (int i = 0; i < 64; ++i) {
        Affine place;
        place.linear = glm::dmat3(i % 4 == 0 ? 2.5 : 1.0);
        const int row = i / 8;
        place.offset = {5.0 * (i % 8), 5.0 * row, 0};
        append(mesh, shapes::quad(1, 1), place);
    }
    const Crowd crowd = find_crowd(mesh);
    ASSERT_EQ(crowd.parts.size(), 64u);
    EXPECT_TRUE(crowd.sizes_differ());
    const std::vector<uint32_t> order = prune_order(crowd, PruneOrder::Largest, 1);
    EXPECT_NEAR(area_of(crowd, order, 16), 16 * 6.25, 1e-4);
}

TEST(Crowd, SurvivorsGrowAboutTheirMiddleAndKeepWhatTheyShow) {
    const Mesh tree = foliage::tree(300);
    const Crowd crowd = find_crowd(tree);
    const std::vector<uint32_t> order = random_order(crowd);
    const std::vector<double> growth{4.0};
    const PrunedMesh level = prune_crowd(tree, crowd, order, 75, growth);
    EXPECT_EQ(level.mesh.triangles.size(), 150u);
    EXPECT_NEAR(surface_area(level.mesh), 300 * 0.06, 1e-3);
    EXPECT_NEAR(level.variance, 4, 1e-5) << "a quarter of the parts, four times as large";
    EXPECT_EQ(level.mesh.slots, std::vector<uint16_t>(150, 1));
    for (const glm::vec2& uv : level.mesh.uvs)
        EXPECT_TRUE((uv.x == 0 || uv.x == 1) && (uv.y == 0 || uv.y == 1));
    EXPECT_NO_THROW(check(level.mesh));
}

TEST(Crowd, PicketsGrowInWidthOnly) {
    Mesh fence;
    for (int i = 0; i < 50; ++i)
        append(fence, shapes::box({0.1 * i, 0, 0}, {0.1 * i + 0.05, 0.02, 1.2}), {});
    const Crowd crowd = find_crowd(fence);
    ASSERT_EQ(crowd.parts.size(), 50u);
    const std::vector<double> growth{2.0};
    const PrunedMesh level = prune_crowd(fence, crowd, random_order(crowd), 25, growth);
    const Bound bound = bound_of(level.mesh.positions);
    EXPECT_NEAR(bound.box.low.z, 0, 1e-5);
    EXPECT_NEAR(bound.box.high.z, 1.2, 1e-5);
    EXPECT_NEAR(surface_area(level.mesh) / surface_area(fence), 1, 0.05);
}

TEST(Crowd, ColorsAreDrawnTogetherSoThatPixelsVaryAsBefore) {
    Mesh mesh;
    PcgRandom random(3);
    for (int i = 0; i < 400; ++i) {
        Mesh leaf = shapes::quad(0.2f, 0.2f);
        const auto shade = static_cast<float>(random.uniform());
        leaf.colors.assign(4, glm::vec4(shade, shade, shade, 1));
        Affine place;
        place.offset = {random.uniform() * 10, random.uniform() * 10, random.uniform() * 10};
        append(mesh, leaf, place);
    }
    const Crowd crowd = find_crowd(mesh);
    const std::vector<uint32_t> order = random_order(crowd);
    const PrunedMesh level = prune_crowd(mesh, crowd, order, 100, std::vector<double>{4.0});
    const auto variance = [](const Mesh& m) {
        double mean = 0;
        double square = 0;
        for (const glm::vec4& color : m.colors) {
            mean += color.x / static_cast<double>(m.colors.size());
            square += color.x * color.x / static_cast<double>(m.colors.size());
        }
        return square - mean * mean;
    };
    // A pixel sees a quarter as many, so each may vary a quarter as much.
    EXPECT_NEAR(variance(level.mesh) / variance(mesh), 0.25, 0.06);
    for (const glm::vec4& color : level.mesh.colors)
        EXPECT_TRUE(color.x >= 0 && color.x <= 1 && color.w == 1);
}

TEST(Crowd, EveryKindKeepsOneAndBrokenTrianglesAreNobodys) {
    Mesh mesh = foliage::tree(200);
    for (size_t i = 200; i < mesh.slots.size(); ++i)
        mesh.slots[i] = i % 4 < 2 ? 2 : 1;
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
    mesh.uvs.emplace_back(0);
    mesh.triangles.emplace_back(0u, 1u, static_cast<uint32_t>(mesh.positions.size() - 1));
    mesh.slots.push_back(1);
    const Crowd crowd = find_crowd(mesh);
    ASSERT_EQ(crowd.slots.size(), 2u);
    const std::vector<double> growth{1.0, 1.0};
    const PrunedMesh level = prune_crowd(mesh, crowd, random_order(crowd), 1, growth);
    EXPECT_EQ(std::set<uint16_t>(level.mesh.slots.begin(), level.mesh.slots.end()).size(), 2u);
}
