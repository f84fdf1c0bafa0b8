// SPDX-License-Identifier: GPL-3.0-or-later
// Guards into which boxes things are cut: where the light of lamps ends, as far as points stand for
// what is seen, and first where most is spared.
#include "base/parallel.h"
#include "light/region/region_cut.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

using namespace lodestone;
using namespace lodestone::light;

namespace {

/// A strip of points, one for each metre along x; a lamp lights each stretch.
struct Strip {
    std::vector<LitPoint> points;
    LightShares shares;
    std::vector<Box3> spoken;
    std::vector<double> weights;
    CutBox whole;

    Strip(size_t length, std::vector<std::pair<size_t, size_t>> lit)
        : points(length), spoken(length), weights(lit.size(), 27) {
        for (size_t i = 0; i < length; ++i) {
            points[i].position = {static_cast<double>(i), 0, 0};
            shares.emplace_back(lit.size(), 0.0f);
            for (size_t lamp = 0; lamp < lit.size(); ++lamp)
                shares[i][lamp] = i >= lit[lamp].first && i < lit[lamp].second ? 1.0f : 0.0f;
            whole.points.push_back(static_cast<uint32_t>(i));
            whole.box.add(points[i].position + glm::dvec3(1));
            whole.box.add(points[i].position - glm::dvec3(1));
        }
    }

    std::vector<CutBox> cut() const {
        return cut_things({&whole, 1}, weights, shares, spoken, points).at(0);
    }
    /// The rays to the lamps of all boxes, by point: those of places that a point stands for count.
    double rays_each(const std::vector<CutBox>& boxes) const {
        double sum = 0;
        for (const CutBox& box : boxes) {
            for (size_t lamp = 0; lamp < weights.size(); ++lamp) {
                bool lights = false;
                for (size_t i = 0; i < points.size() && !lights; ++i) {
                    Box3 here = spoken[i];
                    here.add(points[i].position);
                    lights = shares[i][lamp] > 0 && here.low.x < box.box.high.x &&
                             here.high.x > box.box.low.x;
                }
                sum += lights ? weights[lamp] * static_cast<double>(box.points.size()) : 0;
            }
        }
        return sum / static_cast<double>(points.size());
    }
};

}  // namespace

TEST(RegionCut, WithoutThingsOrLampsNothingIsCut) {
    EXPECT_TRUE(cut_things({}, {}, {}, {}, {}).empty());
    EXPECT_EQ(Strip(100, {}).cut().size(), 1u);
    EXPECT_EQ(Strip(100, {{0, 100}}).cut().size(), 1u);
}

TEST(RegionCut, EveryPointIsInOneBoxThatHoldsIt) {
    const Strip strip(400, {{0, 100}, {90, 130}, {250, 260}, {300, 400}});
    const std::vector<CutBox> boxes = strip.cut();
    EXPECT_GT(boxes.size(), 2u);
    std::vector<int> found(strip.points.size());
    for (const CutBox& box : boxes) {
        EXPECT_GE(box.points.size(), 8u);
        for (const uint32_t point : box.points) {
            ++found[point];
            EXPECT_TRUE(box.box.contains(strip.points[point].position));
        }
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), 400);
}

TEST(RegionCut, LampsOfStretchesLightTheirStretchesAlone) {
    const Strip strip(400, {{0, 100}, {100, 200}, {200, 300}, {300, 400}});
    EXPECT_LT(strip.rays_each(strip.cut()), 1.2 * 27);
}

// The half of a forest's ground was lit by a lamp whose light ended just behind the cut.
TEST(RegionCut, LightThatPointsStandForBehindACutIsCutOffToo) {
    Strip strip(1000, {{0, 20}});
    for (size_t i = 0; i < 20; ++i) {  // what is seen beside a point has it as its own
        strip.spoken[i].add(strip.points[i].position - glm::dvec3(5, 0, 0));
        strip.spoken[i].add(strip.points[i].position + glm::dvec3(5, 0, 0));
    }
    EXPECT_LT(strip.rays_each(strip.cut()), 0.05 * 27);
}

TEST(RegionCut, PointsBesideLightKeepCutsAway) {
    Strip strip(1000, {{0, 20}});
    for (uint32_t i = 0; i + 1 < 1000; ++i) {
        strip.points[i].beside.push_back(i + 1);
        strip.points[i + 1].beside.push_back(i);
    }
    // The 21st point may be lit: no box begins between it and the light.
    for (const CutBox& box : strip.cut()) {
        EXPECT_TRUE(box.box.low.x <= 0 || box.box.low.x > 20);
    }
}

// Where a wall has more windows than it may have boxes, the last of it were not cut at all.
TEST(RegionCut, WhatSparesMostIsCutFirst) {
    std::vector<std::pair<size_t, size_t>> lit;
    for (size_t i = 0; i < 400; ++i)
        lit.emplace_back(20 * i, 20 * i + 20);
    const Strip strip(8000, lit);
    const std::vector<CutBox> boxes = strip.cut();
    EXPECT_EQ(boxes.size(), 128u);
    size_t largest = 0;
    for (const CutBox& box : boxes)
        largest = std::max(largest, box.points.size());
    EXPECT_LE(largest, 250u);  // 62 in the mean
}

TEST(RegionCut, AnyNumberOfThreadsCutsAlike) {
    const Strip strip(600, {{0, 100}, {90, 130}, {250, 260}, {300, 400}, {420, 600}});
    const std::vector<CutBox> many = strip.cut();
    const ThreadLimit limit(1);
    const std::vector<CutBox> one = strip.cut();
    ASSERT_EQ(one.size(), many.size());
    for (size_t i = 0; i < one.size(); ++i)
        EXPECT_EQ(one[i].points, many[i].points);
}
