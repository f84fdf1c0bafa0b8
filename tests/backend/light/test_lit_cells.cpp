// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which parts of a picture are looked through: all where lamps may matter, none by day.
#include "base/parallel.h"
#include "light/lit_cells.h"

#include <gtest/gtest.h>
#include <numeric>

using namespace lodestone;
using namespace lodestone::light;

namespace {

/// From 10 m above a floor of which it sees 40 m by 20 m.
View from_above() {
    View view;
    view.width = 40;
    view.height = 20;
    view.camera.position = {0, 0, 10};
    view.camera.direction = {0, 0, -1};
    view.camera.right = {4, 0, 0};
    view.camera.up = {0, 2, 0};
    return view;
}

LitGrid floor_grid(double others) {
    LitGrid grid;
    grid.rows = 20;
    grid.columns = 40;
    for (uint32_t i = 0; i < 800; ++i) {
        grid.first.push_back(i);
        LitPoint point;
        point.position = {i % 40 - 19.5, 9.5 - i / 40, 0};
        point.other_light = glm::dvec3(others);
        grid.points.push_back(point);
    }
    grid.first.push_back(800);
    return grid;
}

Light lamp_at(const glm::dvec3& position, double power) {
    Light light;
    light.kind = LightKind::Point;
    light.position = position;
    light.power = power;
    return light;
}

std::vector<uint8_t> cells(const Light& lamp, const LitGrid& grid, double sky) {
    return cells_with_lamps({&lamp, 1}, from_above(), grid, glm::dvec3(sky), 0, {});
}

int count(const std::vector<uint8_t>& cells) {
    return std::accumulate(cells.begin(), cells.end(), 0);
}

}  // namespace

TEST(LitCells, ByNightAllAreLookedThrough) {
    EXPECT_EQ(count(cells(lamp_at({0, 0, 1}, 10), floor_grid(0), 0)), 800);
}

TEST(LitCells, ByDayOnlyWhatIsNearALamp) {
    const std::vector<uint8_t> found = cells(lamp_at({15, 0, 1}, 1), floor_grid(1), 1);
    EXPECT_GT(count(found), 0);
    EXPECT_LT(count(found), 200);
    EXPECT_EQ(found[10 * 40 + 35], 1);
    EXPECT_EQ(found[10 * 40 + 5], 0);
    // The cells that the lamp itself is before.
    EXPECT_LE(count(cells(lamp_at({15, 0, 1}, 1e-6), floor_grid(1000), 1000)), 4);
}

TEST(LitCells, ACellWithoutPointsIsLookedThroughWithThoseBesideIt) {
    LitGrid grid = floor_grid(1000);
    const uint32_t hole = 5 * 40 + 7;
    grid.points.erase(grid.points.begin() + hole);
    for (uint32_t i = hole + 1; i < grid.first.size(); ++i)
        --grid.first[i];
    const std::vector<uint8_t> found = cells(lamp_at({0, 0, 60}, 1e-6), grid, 1000);
    EXPECT_EQ(count(found), 9);
    EXPECT_EQ(found[hole], 1);
}

// A lantern lights a post that no point lies on, before ground that is too far to be lit.
TEST(LitCells, WhereThingsNearALampMayBeIsLookedThrough) {
    LitGrid grid = floor_grid(1);
    for (LitPoint& point : grid.points)
        point.position.z = -1000;
    const std::vector<uint8_t> found = cells(lamp_at({2.5, 2.5, 5}, 1), grid, 1);
    EXPECT_EQ(found[5 * 40 + 25], 1);
    EXPECT_LT(count(found), 400);
    // Behind the eye nothing is seen; around the eye all may be near.
    EXPECT_EQ(count(cells(lamp_at({0, 0, 60}, 1), grid, 1)), 0);
    EXPECT_EQ(count(cells(lamp_at({0, 0, 10}, 1), grid, 1)), 800);
}
