// SPDX-License-Identifier: GPL-3.0-or-later
// Guards decisions on placements: importance draws finer, limits open the groups around them.
#include "base/files.h"
#include "choose/criterion.h"
#include "choose/cut.h"
#include "hierarchy/hierarchy_build.h"
#include "ray/mesh_scene.h"
#include "scenes/small_models.h"
#include "scratch.h"
#include "segment/store.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using models::add_level;
using models::view_from;
namespace fs = std::filesystem;

namespace {

constexpr ObjectIndex kBall = 0;
constexpr ObjectIndex kPair = 1;

/// Four balls of radius 1 in two pairs; LOD 1 of a ball is off by .1 m, LOD 2 by .2, a pair's by
/// .4.
Model pairs() {
    Model model = models::row_of_balls(4);
    add_level(model, kBall, 0.1, shapes::sphere(1, 1));
    add_level(model, kBall, 0.2, shapes::sphere(1, 0));
    add_level(model, kPair, 0.4, shapes::cube());
    return model;
}

Placement& placement(Model& model, ObjectIndex group, size_t position) {
    Representation& finest = model.objects[group].representations[0];
    auto changed = std::make_shared<Assembly>(finest.assembly());
    finest.payload = std::shared_ptr<const Assembly>(changed);
    return changed->placements[position];
}

choose::Cut cut_of(Model& model, const View& view) {
    summarize_assemblies(model, bottom_up(model));
    return choose::choose_cut(model, view);
}

/// Path and level of everything drawn, e.g. "pair 0/left 2, pair 1 1".
std::string drawn(Model& model, const View& view) {
    const choose::Cut cut = cut_of(model, view);
    std::string out;
    for (const uint32_t index : cut.chosen) {
        out += out.empty() ? "" : ", ";
        out += choose::path_of(model, cut, index) + ' ' + std::to_string(cut.nodes[index].lod);
    }
    return out;
}

}  // namespace

TEST(Importance, FactorsAreKeptWithinTheirRange) {
    EXPECT_EQ(choose::total_refinement(1), 1);
    EXPECT_EQ(choose::total_refinement(3.5), 3.5);
    EXPECT_EQ(choose::total_refinement(1e9), 64);
    EXPECT_EQ(choose::total_refinement(1e-9), 1.0 / 64);
    EXPECT_EQ(choose::total_refinement(0), 1.0 / 64);
    EXPECT_TRUE(std::isinf(choose::total_refinement(std::numeric_limits<double>::infinity())));
}

TEST(Importance, ErrorCountsSoManyTimes) {
    // .1 m is one pixel at 64 m; with importance 2 it is one and no more at 128 m.
    const View view = view_from(0);
    EXPECT_TRUE(choose::good_enough(view, 0.1, 1, 64));
    EXPECT_FALSE(choose::good_enough(view, 0.1, 1, 64, 1.001));
    EXPECT_TRUE(choose::good_enough(view, 0.1, 1, 128, 2));
    EXPECT_FALSE(choose::good_enough(view, 0.1, 1, 127.9, 2));
    EXPECT_TRUE(choose::good_enough(view, 0.1, 1, 32, 0.5));
    EXPECT_FALSE(choose::good_enough(view, 0, 1, 1e9, std::numeric_limits<double>::infinity()));
}

TEST(Importance, WithoutDecisionsPairsAreDrawnAsOne) {
    Model model = pairs();
    EXPECT_EQ(drawn(model, view_from(300)), "pair 0 1, pair 1 1");
    EXPECT_EQ(model.objects[kPair].demand, 1);
}

TEST(Importance, WhatIsTwiceAsImportantIsDrawnAsFromHalfTheDistance) {
    Model model = pairs();
    placement(model, model.root, 0).importance = 2;
    // A pair's .4 m are one pixel at 256 m, the important one's at 512.
    EXPECT_EQ(drawn(model, view_from(300)), "pair 0/left 2, pair 0/right 2, pair 1 1");
    EXPECT_EQ(drawn(model, view_from(520)), "pair 0 1, pair 1 1");
}

TEST(Importance, AGroupIsGoodEnoughForTheMostImportantThingInIt) {
    Model model = pairs();
    placement(model, kPair, 1).importance = 4;  // right, in both pairs
    EXPECT_EQ(drawn(model, view_from(300)),
              "pair 0/left 2, pair 0/right 1, pair 1/left 2, pair 1/right 1");
    EXPECT_EQ(model.objects[kPair].demand, 4);
    EXPECT_EQ(drawn(model, view_from(1100)), "pair 0 1, pair 1 1");
}

TEST(Importance, FactorsAlongAPathMultiply) {
    Model model = pairs();
    placement(model, model.root, 0).importance = 0.25;
    placement(model, kPair, 1).importance = 4;
    const choose::Cut cut = cut_of(model, view_from(300));
    // In the first pair they cancel out.
    EXPECT_EQ(drawn(model, view_from(300)), "pair 0 1, pair 1/left 2, pair 1/right 1");
    for (const uint32_t index : cut.chosen) {
        const std::string path = choose::path_of(model, cut, index);
        const double wanted = path == "pair 0" ? 0.25 : path == "pair 1/left" ? 1 : 4;
        EXPECT_EQ(cut.nodes[index].importance, wanted) << path;
    }
}

TEST(Importance, OfEverythingIsTheSameAsLessPixelError) {
    Model plain = pairs();
    Model important = pairs();
    for (const size_t pair : {0u, 1u})
        placement(important, important.root, pair).importance = 2;
    for (const double distance : {20.0, 90.0, 200.0, 300.0, 600.0})
        EXPECT_EQ(drawn(important, view_from(distance, 1)), drawn(plain, view_from(distance, 0.5)));
}

TEST(Importance, MoreIsNeverCoarser) {
    for (const double distance : {10.0, 80.0, 150.0, 300.0, 900.0}) {
        uint64_t last = 0;
        for (const double importance : {1.0 / 64, 0.25, 0.5, 1.0, 2.0, 8.0, 64.0}) {
            Model model = pairs();
            placement(model, kPair, 0).importance = importance;
            const uint64_t triangles = cut_of(model, view_from(distance)).triangles;
            EXPECT_GE(triangles, last) << importance << " at " << distance;
            last = triangles;
        }
    }
}

TEST(Limits, OriginalIsDrawnFromAnywhereAndItsNeighborsAreNot) {
    Model model = pairs();
    placement(model, kPair, 0).coarsest = 0;
    EXPECT_EQ(drawn(model, view_from(1e6)),
              "pair 0/left 0, pair 0/right 2, pair 1/left 0, pair 1/right 2");
    EXPECT_TRUE(std::isinf(model.objects[model.root].demand));
}

TEST(Limits, OriginalGroupMeansAllThatIsInIt) {
    Model model = pairs();
    placement(model, model.root, 1).coarsest = 0;
    EXPECT_EQ(drawn(model, view_from(1e6)), "pair 0 1, pair 1/left 0, pair 1/right 0");
}

TEST(Limits, NeverCoarserThanALevel) {
    Model model = pairs();
    placement(model, kPair, 1).coarsest = 1;
    EXPECT_EQ(drawn(model, view_from(1e6)),
              "pair 0/left 2, pair 0/right 1, pair 1/left 2, pair 1/right 1");
    EXPECT_EQ(drawn(model, view_from(2, 0.01)).find(" 2"), std::string::npos);
    placement(model, kPair, 1).coarsest = 7;  // it has no such level
    EXPECT_EQ(drawn(model, view_from(1e6)),
              "pair 0/left 2, pair 0/right 2, pair 1/left 2, pair 1/right 2");
}

TEST(Limits, LevelThatTheViewCannotDrawGivesWayToAFinerOne) {
    Model model = pairs();
    Representation& level = model.objects[kBall].representations[1];
    level.payload = Primitive{};
    level.summary.kind = Kind::Box;
    placement(model, kPair, 0).coarsest = 1;
    View view = view_from(1e6);
    view.kinds = mask_of(Kind::Mesh);
    EXPECT_EQ(drawn(model, view).substr(0, 13), "pair 0/left 0");
}

TEST(Pins, AreDrawnAtTheirLevelFromAnywhere) {
    Model model = pairs();
    Placement& pinned = placement(model, kPair, 1);
    pinned.coarsest = pinned.finest = 1;
    for (const double distance : {2.0, 1e6})
        EXPECT_NE(drawn(model, view_from(distance, 0.01)).find("pair 0/right 1"), std::string::npos)
            << distance;
    EXPECT_EQ(drawn(model, view_from(1e6)),
              "pair 0/left 2, pair 0/right 1, pair 1/left 2, pair 1/right 1");
}

TEST(Pins, ALevelThatIsNotThereIsTheCoarsest) {
    Model model = pairs();
    Placement& pinned = placement(model, kPair, 1);
    pinned.coarsest = pinned.finest = 7;
    EXPECT_NE(drawn(model, view_from(2, 0.01)).find("pair 0/right 2"), std::string::npos);
}

TEST(Pins, AGroupAtItsStandInIsNeverOpened) {
    Model model = pairs();
    Placement& pinned = placement(model, model.root, 1);
    pinned.coarsest = pinned.finest = 1;
    EXPECT_NE(drawn(model, view_from(2, 0.01)).find("pair 1 1"), std::string::npos);
    pinned.coarsest = pinned.finest = 0;  // its originals
    EXPECT_NE(drawn(model, view_from(1e6)).find("pair 1/left 0, pair 1/right 0"),
              std::string::npos);
}

TEST(Decisions, StoreKeepsThemAndRefusesWhatIsOutOfRange) {
    Model model = pairs();
    placement(model, kPair, 0).importance = 1.0 / 3;
    placement(model, kPair, 1).coarsest = 2;
    placement(model, kPair, 1).finest = 2;
    summarize_assemblies(model, bottom_up(model));
    const segment::Store store(scratch("decisions"));
    store.write(model, {});
    const Model back = store.read();
    const auto& placements = back.objects[kPair].representations[0].assembly().placements;
    EXPECT_EQ(placements[0].importance, 1.0 / 3);
    EXPECT_EQ(placements[0].coarsest, kAnyLevel);
    EXPECT_EQ(placements[1].importance, 1);
    EXPECT_EQ(placements[1].coarsest, 2u);
    EXPECT_EQ(placements[0].finest, 0u);
    EXPECT_EQ(placements[1].finest, 2u);
    EXPECT_TRUE(std::isinf(back.objects[back.root].demand));

    const fs::path file = store.folder() / "tileset.json";
    const std::string text = read_file(file);
    const size_t at = text.find("\"importance\":");
    ASSERT_NE(at, std::string::npos);
    const size_t end = text.find_first_of(",}", at);
    for (const char* value : {"1e9", "-1", "0", "\"much\"", "null"}) {
        write_file(file, text.substr(0, at) + "\"importance\":" + value + text.substr(end));
        EXPECT_THROW(store.read(), Error) << value;
    }
}

TEST(Decisions, GroupThatIsAlwaysOpenedIsNotBuiltUntilItIsNoLonger) {
    std::string reason;
    if (!ray::available(&reason))
        GTEST_SKIP() << reason;
    const segment::Store store(scratch("opened"));
    Problems problems;
    Model model = models::row_of_balls(4);
    placement(model, kPair, 0).coarsest = 0;
    hierarchy::build_hierarchy(model, store, {}, problems, {});
    EXPECT_GT(model.objects[kBall].representations.size(), 1u);
    EXPECT_EQ(model.objects[kPair].representations.size(), 1u);
    EXPECT_EQ(model.objects[model.root].representations.size(), 1u);
    Model again = models::row_of_balls(4);
    placement(again, kPair, 0).importance = 2;  // its stand-in is the same for anybody
    EXPECT_EQ(hierarchy::build_hierarchy(again, store, {}, problems, {}).built, 2u);
    EXPECT_GT(again.objects[kPair].representations.size(), 1u);
    EXPECT_TRUE(problems.empty());
}
