// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that a thing of the scene is found again in the cut, whatever draws it.
#include "choose/find_choice.h"
#include "scenes/small_models.h"

#include <gtest/gtest.h>

using namespace lodestone;
using choose::DrawnState;
using models::add_level;
using models::moved;
using models::view_from;

namespace {

/// Ball (0) in pairs (1) in a row (2), at x = 0, 3, ... 21.
Model balls() {
    Model model = models::row_of_balls(8);
    add_level(model, 0, 0.1, shapes::sphere(1, 1));
    add_level(model, 1, 0.2, shapes::cube());
    summarize_assemblies(model, bottom_up(model));
    return model;
}

void decide(Model& model, ObjectIndex group, size_t position, double importance,
            uint32_t coarsest = kAnyLevel) {
    Assembly assembly = model.objects[group].representations[0].assembly();
    assembly.placements[position].importance = importance;
    assembly.placements[position].coarsest = coarsest;
    model.objects[group].representations[0].payload =
        std::make_shared<const Assembly>(std::move(assembly));
    summarize_assemblies(model, bottom_up(model));
}

}  // namespace

TEST(FindChoice, AnEmptyModelMissesEverything) {
    Model model;
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(1, 0));
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    const choose::Cut cut = choose::choose_cut(model, View{});
    EXPECT_EQ(choose::find_choice(model, cut, ball, {}).drawn, DrawnState::Missing);
}

TEST(FindChoice, OfManyOccurrencesTheOneThatIsThereIsFound) {
    const Model model = balls();
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    for (int i = 0; i < 8; ++i) {
        const choose::FoundChoice found = choose::find_choice(model, cut, 0, moved(3.0 * i, 0, 0));
        ASSERT_EQ(found.drawn, DrawnState::Itself) << i;
        EXPECT_NEAR(cut.world(cut.nodes[found.node]).offset.x, 3.0 * i, 1e-12);
        EXPECT_EQ(cut.nodes[found.node].object, 0u);
    }
}

TEST(FindChoice, SinglePrecisionIsNearEnoughAndAnotherPlaceIsNot) {
    const Model model = balls();
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    EXPECT_EQ(choose::find_choice(model, cut, 0, moved(21.000002, 0, 0)).drawn, DrawnState::Itself);
    EXPECT_EQ(choose::find_choice(model, cut, 0, moved(22, 0, 0)).drawn, DrawnState::Missing);
}

TEST(FindChoice, WhatAGroupStandsForIsFoundInIt) {
    const Model model = balls();
    const choose::Cut cut = choose::choose_cut(model, view_from(1000, 1));
    const choose::FoundChoice found = choose::find_choice(model, cut, 0, moved(9, 0, 0));
    ASSERT_EQ(found.drawn, DrawnState::InGroup);
    EXPECT_EQ(cut.nodes[found.node].object, 1u);
    EXPECT_NEAR(cut.world(cut.nodes[found.node]).offset.x, 6, 1e-12);
}

TEST(FindChoice, AnOpenedGroupIsTold) {
    const Model model = balls();
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    EXPECT_EQ(choose::find_choice(model, cut, 1, moved(6, 0, 0)).drawn, DrawnState::Opened);
}

TEST(FindChoice, WhatNoRaySeesIsNotDrawn) {
    Model model = balls();
    Assembly row = model.objects[model.root].representations[0].assembly();
    row.placements[1].hidden = kAllRays;
    model.objects[model.root].representations[0].payload =
        std::make_shared<const Assembly>(std::move(row));
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    EXPECT_EQ(choose::find_choice(model, cut, 0, moved(6, 0, 0)).drawn, DrawnState::NotDrawn);
    EXPECT_EQ(choose::find_choice(model, cut, 0, moved(12, 0, 0)).drawn, DrawnState::Itself);
}

TEST(MostDemanding, NothingImportantIsNamedNot) {
    const Model model = balls();
    EXPECT_EQ(choose::most_demanding(model, model.root), "");
    EXPECT_EQ(choose::most_demanding(model, 0), "");
}

TEST(MostDemanding, TheMostImportantThingIsNamedByItsPath) {
    Model model = balls();
    decide(model, 1, 1, 4);
    EXPECT_EQ(choose::most_demanding(model, 1), "right");
    EXPECT_EQ(choose::most_demanding(model, model.root), "pair 0/right");
}

TEST(MostDemanding, ALimitDemandsMoreThanAnyImportance) {
    Model model = balls();
    decide(model, 1, 1, 64);
    decide(model, model.root, 2, 1, 0);
    EXPECT_EQ(choose::most_demanding(model, model.root), "pair 2");
}
