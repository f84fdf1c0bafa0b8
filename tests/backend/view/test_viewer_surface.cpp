// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what viewers show of a cut: all of it, within the triangles they can draw.
#include "base/parallel.h"
#include "scenes/small_models.h"
#include "view/viewer_surface.h"

#include <gtest/gtest.h>

using namespace lodestone;
using models::add_level;
using models::view_from;

namespace {

/// 8 balls of 1280 triangles, with levels of 80 and 20.
Model balls() {
    Model model = models::row_of_balls(8);
    add_level(model, 0, 0.01, shapes::sphere(1, 1));
    add_level(model, 0, 0.1, shapes::sphere(1, 0));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

view::ViewerSurface all_of(const Model& model, const choose::Cut& cut, uint64_t most) {
    return view::surface_of(model, cut, view::surface_levels(model, cut, most));
}

Box3 box_of(const view::ViewerSurface& surface) {
    Box3 box;
    for (const glm::vec3& corner : surface.corners)
        box.add(glm::dvec3(corner));
    return box;
}

}  // namespace

TEST(ViewerSurface, EmptyCutHasNone) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    const view::ViewerSurface surface = all_of(model, choose::choose_cut(model, View{}), 1000);
    EXPECT_TRUE(surface.corners.empty());
    EXPECT_TRUE(surface.owners.empty());
}

TEST(ViewerSurface, EnoughTrianglesShowTheChosenLevels) {
    const Model model = balls();
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    const view::ViewerSurface surface = all_of(model, cut, uint64_t{8} * 1280);
    EXPECT_EQ(surface.owners.size(), uint64_t{8} * 1280);
    EXPECT_EQ(surface.corners.size(), 3 * surface.owners.size());
    EXPECT_EQ(surface.owners.front(), 0u);
    EXPECT_EQ(surface.owners.back(), 7u);
    // Balls of radius 1 at 0, 3, ... 21 m.
    EXPECT_NEAR(box_of(surface).low.x, -1, 1e-5);
    EXPECT_NEAR(box_of(surface).high.x, 22, 1e-5);
}

TEST(ViewerSurface, FewerTrianglesShowCoarserLevelsAndThenBoxes) {
    const Model model = balls();
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    EXPECT_EQ(all_of(model, cut, uint64_t{8} * 1280 - 1).owners.size(), uint64_t{8} * 80);
    EXPECT_EQ(all_of(model, cut, uint64_t{8} * 79).owners.size(), uint64_t{8} * 20);
    const view::ViewerSurface boxes = all_of(model, cut, 1);
    EXPECT_EQ(boxes.owners.size(), uint64_t{8} * 12);
    EXPECT_NEAR(box_of(boxes).high.x, 22, 1e-5);
}

TEST(ViewerSurface, WhatCamerasDoNotSeeIsLeftOut) {
    Model model = balls();
    Assembly row = model.objects[model.root].representations[0].assembly();
    row.placements[0].hidden = kCameraRays;
    model.objects[model.root].representations[0].payload =
        std::make_shared<const Assembly>(std::move(row));
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    EXPECT_EQ(cut.chosen.size(), 8u);
    const view::ViewerSurface surface = all_of(model, cut, uint64_t{8} * 80);
    EXPECT_EQ(surface.owners.size(), uint64_t{6} * 80);
    EXPECT_EQ(surface.owners.front(), 2u);
}

TEST(ViewerSurface, OneThreadAndManyGiveTheSame) {
    const Model model = balls();
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    const view::ViewerSurface many = all_of(model, cut, 4000);
    const ThreadLimit limit(1);
    const view::ViewerSurface one = all_of(model, cut, 4000);
    EXPECT_EQ(one.corners, many.corners);
    EXPECT_EQ(one.owners, many.owners);
}

TEST(ViewerSurface, ShadesTellSidesApartAndAreTheSameOnBoth) {
    const glm::vec3 floor[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const glm::vec3 turned[] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    const glm::vec3 wall[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    const glm::vec3 line[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    EXPECT_DOUBLE_EQ(view::shade_of(floor), view::shade_of(turned));
    EXPECT_GT(view::shade_of(floor), 0.9);
    EXPECT_LT(view::shade_of(wall), 0.7);
    EXPECT_GE(view::shade_of(wall), 0.55);
    EXPECT_EQ(view::shade_of(line), 1);
}
