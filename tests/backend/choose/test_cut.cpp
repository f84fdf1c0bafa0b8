// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the cut: each path crossed once, the cheapest that is good enough, groups never opened in
// vain.
#include "choose/criterion.h"
#include "choose/cut.h"
#include "choose/cut_chooser.h"
#include "scenes/small_models.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using models::add_level;
using models::view_from;

namespace {

Model balls_with_levels() {
    Model model = models::row_of_balls(8);
    add_level(model, 0, 0.01, shapes::sphere(1, 1));
    add_level(model, 0, 0.1, shapes::sphere(1, 0));
    add_level(model, 1, 0.2, shapes::cube());  // the pair
    summarize_assemblies(model, bottom_up(model));
    return model;
}

}  // namespace

TEST(DetailCriterion, PixelGrowsWithDistanceAndNeverBelowTheNearClip) {
    const View view = view_from(10, 1);
    EXPECT_NEAR(choose::pixel_size(view, 64), 0.1, 1e-12);
    EXPECT_EQ(choose::pixel_size(view, 0), choose::pixel_size(view, view.camera.near_clip));
    View flat = view;
    flat.camera.orthographic = true;
    EXPECT_EQ(choose::pixel_size(flat, 1), choose::pixel_size(flat, 1000));
    EXPECT_NEAR(choose::error_on_screen(view, 0.1, 2, 64), 2, 1e-12);
}

TEST(Cut, ModelWithoutRootIsRefused) {
    EXPECT_THROW(choose::choose_cut(Model{}, View{}), Error);
    View view;
    view.width = 0;
    EXPECT_THROW(choose::choose_cut(models::row_of_balls(2), view), Error);
    view = View{};
    view.pixel_error = std::nan("");
    EXPECT_THROW(choose::choose_cut(models::row_of_balls(2), view), Error);
}

TEST(Cut, EmptyGroupDrawsNothing) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    EXPECT_TRUE(choose::choose_cut(model, View{}).chosen.empty());
}

TEST(Cut, ZeroPixelErrorDrawsTheOriginalsOnce) {
    const Model model = balls_with_levels();
    const choose::Cut cut = choose::choose_cut(model, view_from(1000, 0));
    ASSERT_EQ(cut.chosen.size(), 8u);
    for (const uint32_t index : cut.chosen)
        EXPECT_EQ(cut.nodes[index].lod, 0u);
    EXPECT_EQ(cut.triangles, 8u * 1280u);
    EXPECT_EQ(cut.largest_error_px, 0);
    EXPECT_EQ(cut.kinds.at("mesh"), 8u);
}

TEST(Cut, AGroupWhoseStandInCostsMoreThanItsChildrenIsOpened) {
    Model model = models::row_of_balls(8);
    Representation box;
    box.summary.kind = Kind::Box;
    box.materials = {0};
    box.payload = Primitive{};
    summarize(box, model);
    box.summary.error = 0.15;
    model.objects[0].representations.push_back(box);         // a ball
    add_level(model, 1, 0.2, shapes::sphere(1, 1));          // the pair: more than two boxes
    add_level(model, model.root, 30, shapes::sphere(1, 2));  // the row: more than four spheres
    summarize_assemblies(model, bottom_up(model));
    View far = view_from(1e6, 1);
    choose::Cut cut = choose::choose_cut(model, far);
    EXPECT_EQ(cut.kinds.at("box"), 8u);
    EXPECT_EQ(cut.nodes.size(), 1u + 4u + 8u);
    for (const uint32_t index : cut.chosen)
        EXPECT_EQ(choose::path_of(model, cut, index).substr(0, 5), "pair ");
    far.kinds = mask_of(Kind::Mesh);  // spheres for pairs cost less than the balls themselves
    cut = choose::choose_cut(model, far);
    EXPECT_EQ(cut.chosen.size(), 1u);
    add_level(model, 1, 0.3, shapes::cube());
    cut = choose::choose_cut(model, far);
    EXPECT_EQ(cut.chosen.size(), 4u);
    EXPECT_EQ(cut.nodes.size(), 1u + 4u);
    EXPECT_EQ(cut.triangles, 4u * 12u);
    add_level(model, model.root, 40, shapes::cube());
    cut = choose::choose_cut(model, far);
    EXPECT_EQ(cut.chosen.size(), 1u);
    EXPECT_EQ(cut.nodes.size(), 1u);
    EXPECT_EQ(cut.largest_error_node, 0u);
}

TEST(Cut, FarGroupsAreNeverOpened) {
    const Model model = balls_with_levels();
    const choose::Cut cut = choose::choose_cut(model, view_from(1000, 1));
    EXPECT_EQ(cut.chosen.size(), 4u);      // one stand-in a pair
    EXPECT_EQ(cut.nodes.size(), 1u + 4u);  // the row and the pairs
    EXPECT_EQ(choose::path_of(model, cut, cut.chosen[2]), "pair 2");
    EXPECT_LE(cut.largest_error_px, 1);
    EXPECT_GT(cut.largest_error_px, 0);
}

TEST(Cut, EveryChoiceIsTheCheapestThatIsGoodEnough) {
    const Model model = balls_with_levels();
    for (const double distance : {2.0, 9.0, 33.0, 150.0, 700.0}) {
        const View view = view_from(distance, 1);
        const choose::Cut cut = choose::choose_cut(model, view);
        for (const uint32_t index : cut.chosen) {
            const choose::CutNode& node = cut.nodes[index];
            const Object& object = model.objects[node.object];
            const double z = lodestone::distance(transformed(object.bound(), cut.world(node)),
                                                 view.camera.position);
            const auto good = [&](size_t lod) {
                return choose::good_enough(view, object.representations[lod].summary.error, 1, z);
            };
            EXPECT_TRUE(good(node.lod));
            if (node.lod + 1 < object.representations.size()) {
                EXPECT_FALSE(good(node.lod + 1));
            }
        }
    }
}

TEST(Cut, CoarserPixelErrorNeverDrawsMore) {
    const Model model = balls_with_levels();
    uint64_t last = ~uint64_t{0};
    for (const double pixel_error : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 64.0}) {
        const choose::Cut cut = choose::choose_cut(model, view_from(20, pixel_error));
        EXPECT_LE(cut.triangles, last);
        EXPECT_LE(cut.largest_error_px, pixel_error + 1e-12);
        last = cut.triangles;
    }
}

TEST(Cut, EnlargedPlacementIsHeldToItsStretch) {
    Model model;
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(1, 3));
    Affine ten = models::moved(0, 0, 0);
    ten.linear = glm::dmat3(10.0);
    model.root = models::add_group(model, "root", {{ball, ten, "big"}});
    add_level(model, ball, 0.01, shapes::cube());
    summarize_assemblies(model, bottom_up(model));
    // 0.01 m enlarged ten times is one pixel at 64 m from the bound.
    EXPECT_EQ(choose::choose_cut(model, view_from(64 + 10 - 0.1, 1)).kinds.at("mesh"), 1u);
    EXPECT_EQ(choose::choose_cut(model, view_from(64 + 10 - 0.1, 1)).triangles, 1280u);
    EXPECT_EQ(choose::choose_cut(model, view_from(64 + 10 + 0.1, 1)).triangles, 12u);
}

TEST(Cut, OnlyKindsTheViewCanDrawAreChosen) {
    Model model = balls_with_levels();
    Representation box;
    box.summary.kind = Kind::Box;
    box.payload = Primitive{};
    box.materials = {0};
    summarize(box, model);
    box.summary.error = 0.5;
    model.objects[1].representations.push_back(box);
    EXPECT_EQ(choose::choose_cut(model, view_from(1000, 2)).kinds.at("box"), 4u);
    View view = view_from(1000, 2);
    view.kinds = mask_of(Kind::Mesh);
    EXPECT_EQ(choose::choose_cut(model, view).kinds.count("box"), 0u);
    EXPECT_EQ(choose::choose_cut(model, view).kinds.at("mesh"), 4u);
}

TEST(Cut, CycleIsRefusedWithBothNames) {
    Model model;
    const ObjectIndex a = models::add_group(model, "a", {});
    const ObjectIndex b = models::add_group(model, "b", {{a, Affine{}, ""}});
    auto assembly = std::make_shared<Assembly>();
    assembly->placements = {{b, Affine{}, ""}};
    model.objects[a].representations[0].payload = std::shared_ptr<const Assembly>(assembly);
    model.root = a;
    try {
        bottom_up(model);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "group 'b' contains 'a', which contains it");
    }
}

TEST(Cut, CancelledJobStops) {
    const int32_t cancel = 1;
    const Job job(&cancel, nullptr, nullptr);
    EXPECT_THROW(choose::choose_cut(models::row_of_balls(4), view_from(1, 1), job), Error);
}

TEST(Cut, ManyOccurrencesOfDeepSharing) {
    // 8^5 = 32,768 occurrences of one ball through five shared groups.
    Model model;
    ObjectIndex below = models::add_leaf(model, "ball", shapes::sphere(0.1, 1));
    double step = 1;
    for (int level = 0; level < 5; ++level) {
        std::vector<Placement> eight;
        eight.reserve(8);
        for (int i = 0; i < 8; ++i)
            eight.push_back({below, models::moved((i & 1) * step, (i & 2) * step, (i & 4) * step),
                             std::to_string(i)});
        below = models::add_group(model, "group " + std::to_string(level), std::move(eight));
        step *= 8;
    }
    model.root = below;
    summarize_assemblies(model, bottom_up(model));
    EXPECT_EQ(totals(model).occurrences, 32768u);
    const choose::Cut cut = choose::choose_cut(model, view_from(10, 1));
    EXPECT_EQ(cut.chosen.size(), 32768u);
    size_t seen = 0;
    for_each_occurrence(model, [&](const Occurrence& occurrence) {
        EXPECT_EQ(occurrence.world.offset, cut.world(cut.nodes[cut.chosen[seen]]).offset);
        ++seen;
    });
    EXPECT_EQ(seen, 32768u);
}

TEST(Cut, GroupsThatPlaceAnotherTwiceSixtyTimesOverAreRefused) {
    // 2^60 occurrences of 61 objects
    Model model;
    ObjectIndex below = models::add_leaf(model, "ball", shapes::sphere(1, 0));
    for (int depth = 0; depth < 60; ++depth) {
        std::vector<Placement> twice(2);
        twice[0].object = twice[1].object = below;
        below = models::add_group(model, "group " + std::to_string(depth), std::move(twice));
    }
    model.root = below;
    summarize_assemblies(model, bottom_up(model));
    const View view = view_from(100, 0);
    const choose::ChoiceTable table = choose::ChoiceTable::whole(model, model.root, view.kinds);
    const Job job;
    for (const uint64_t triangles : {uint64_t{0}, uint64_t{1} << 60u}) {
        choose::FactorField field(model, view);
        choose::CutChooser chooser(table, nullptr, view, field, job, 1000);
        choose::Cut cut;
        if (triangles == 0) {
            EXPECT_THROW(chooser.run(table.find(model.root), {}, cut), Error);
        } else {
            EXPECT_FALSE(chooser.run(table.find(model.root), {triangles, 0}, cut));
        }
        EXPECT_LT(cut.nodes.size(), 1002u);
    }
}
