// SPDX-License-Identifier: GPL-3.0-or-later
// Guards placements that some rays do not see: inherited down the path, kept by the store, never
// covered by a stand-in that other rays see.
#include "base/files.h"
#include "choose/cut.h"
#include "hierarchy/hierarchy_build.h"
#include "ray/mesh_scene.h"
#include "scenes/small_models.h"
#include "scratch.h"
#include "segment/store_json.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

/// Two rooms of a ball and a box each; the right room and its box are hidden as told.
Model house(RayMask room, RayMask box) {
    Model model;
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(1, 2));
    const ObjectIndex crate = models::add_leaf(model, "crate", shapes::cube());
    const ObjectIndex left = models::add_group(
        model, "left", {{ball, {}, "ball"}, {crate, models::moved(3, 0, 0), "crate"}});
    const ObjectIndex right = models::add_group(
        model, "right", {{ball, {}, "ball"}, {crate, models::moved(0, 3, 0), "crate", box}});
    model.root = models::add_group(
        model, "house", {{left, {}, "left"}, {right, models::moved(9, 0, 0), "right", room}});
    summarize_assemblies(model, bottom_up(model));
    return model;
}

View view_at(double pixel_error) {
    View view;
    view.camera.position = {0, -100, 0};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 0, 1};
    view.pixel_error = pixel_error;
    return view;
}

std::vector<int> chosen(const Model& model) {
    const choose::Cut cut = choose::choose_cut(model, view_at(0));
    std::vector<int> out;
    for (const uint32_t index : cut.chosen)
        out.push_back(cut.nodes[index].hidden);
    return out;
}

}  // namespace

TEST(Hidden, NothingIsHiddenUnlessTold) {
    EXPECT_EQ(chosen(house(0, 0)), (std::vector<int>{0, 0, 0, 0}));
}

TEST(Hidden, MasksAddUpAlongThePath) {
    const Model model = house(kCameraRays, kShadowRays);
    EXPECT_EQ(chosen(model), (std::vector<int>{0, 0, kCameraRays, kCameraRays | kShadowRays}));
    std::vector<int> occurrences;
    for_each_occurrence(model, [&](const Occurrence& o) { occurrences.push_back(o.hidden); });
    EXPECT_EQ(occurrences, chosen(model));
}

TEST(Hidden, WhatNoRaySeesIsNotChosen) {
    EXPECT_EQ(chosen(house(kAllRays, 0)).size(), 2u);
    EXPECT_EQ(chosen(house(kAllRays & ~kCameraRays, kCameraRays)).size(), 3u);
    EXPECT_EQ(totals(house(kAllRays, 0)).occurrences, 4u);
}

TEST(Hidden, GroupsAboveAreMarkedAndTheirSourceDiffers) {
    const Model model = house(0, kShadowRays);
    EXPECT_EQ(with_hidden(model), (std::vector<uint8_t>{0, 0, 0, 1, 1}));
    EXPECT_EQ(with_hidden(house(kShadowRays, 0)), (std::vector<uint8_t>{0, 0, 0, 0, 1}));
    const Model other = house(0, kCameraRays);
    EXPECT_EQ(model.objects[2].source_hash, other.objects[2].source_hash);
    EXPECT_NE(model.objects[3].source_hash, other.objects[3].source_hash);
    EXPECT_NE(model.objects[3].source_hash, house(0, 0).objects[3].source_hash);
}

TEST(Hidden, OnlyGroupsWithNothingHiddenInThemHaveStandIns) {
    std::string reason;
    if (!ray::available(&reason))
        GTEST_SKIP() << reason;
    Model model = house(kReflectionRays, 0);
    Problems problems;
    const segment::Store store(scratch("build"));
    hierarchy::build_hierarchy(model, store, {}, problems, {});
    EXPECT_TRUE(problems.empty());
    for (const ObjectIndex index : {0u, 1u, 2u, 3u})
        EXPECT_GT(model.objects[index].representations.size(), 1u) << index;
    EXPECT_EQ(model.objects[model.root].representations.size(), 1u);
    // The right room's stand-in is hidden as the room is
    const choose::Cut cut = choose::choose_cut(model, view_at(1000));
    ASSERT_EQ(cut.chosen.size(), 2u);
    EXPECT_EQ(cut.nodes[cut.chosen[0]].hidden, 0);
    EXPECT_EQ(cut.nodes[cut.chosen[1]].hidden, kReflectionRays);
    Model again = house(kReflectionRays, 0);
    EXPECT_EQ(hierarchy::build_hierarchy(again, store, {}, problems, {}).built, 0u);
    Model shown = house(0, 0);
    EXPECT_EQ(hierarchy::build_hierarchy(shown, store, {}, problems, {}).built, 1u);
}

TEST(Hidden, StoreKeepsItAndTilesLeaveOutWhatNoCameraSees) {
    const segment::Store store(scratch("store"));
    store.write(house(kShadowRays, kCameraRays), {});
    const Model back = store.read();
    const auto& placements = back.objects[3].representations[0].assembly().placements;
    EXPECT_EQ(placements[0].hidden, 0);
    EXPECT_EQ(placements[1].hidden, kCameraRays);
    EXPECT_EQ(back.objects[4].representations[0].assembly().placements[1].hidden, kShadowRays);
    const std::string text = read_file(store.folder() / "tileset.json");
    auto json = nlohmann::json::parse(text);
    EXPECT_EQ(json["root"]["children"][0]["children"].size(), 2u);
    EXPECT_EQ(json["root"]["children"][1]["children"].size(), 1u);
    auto& stored = json["asset"]["extras"]["lodestone"]["objects"][3]["representations"][0]
                       ["placements"][1]["hidden"];
    for (const int bad : {16, -1}) {
        stored = bad;
        EXPECT_THROW(segment::model_of_tileset(json.dump()), Error);
    }
}
