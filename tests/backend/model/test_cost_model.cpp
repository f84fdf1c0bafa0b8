// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that a model is priced by the costs it was given, and by no others.
#include "scenes/small_models.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

CostModel made_up() {
    CostModel costs;
    costs.triangle_bytes = 7;
    costs.primitive_bytes = 11;
    costs.occurrence_bytes = 13;
    return costs;
}

}  // namespace

TEST(CostModel, AModelThatWasGivenNoneCostsNothing) {
    const Model model;
    EXPECT_EQ(model.costs.triangle_bytes, 0u);
    Representation cube;
    cube.payload = std::make_shared<const Mesh>(shapes::cube());
    summarize(cube, model);
    EXPECT_EQ(cube.summary.cost.triangles, 12u);
    EXPECT_EQ(cube.summary.cost.bytes, 0u);
}

TEST(CostModel, MeshesPrimitivesAndCompositesArePricedByIt) {
    Model model;
    model.costs = made_up();
    Representation mesh;
    mesh.payload = std::make_shared<const Mesh>(shapes::cube());
    Representation box;
    box.summary.kind = Kind::Box;
    box.payload = Primitive{};
    Representation solids;
    solids.summary.kind = Kind::Composite;
    Composite three;
    three.solids.resize(3);
    solids.payload = std::make_shared<const Composite>(three);
    for (Representation* one : {&mesh, &box, &solids})
        summarize(*one, model);
    EXPECT_EQ(mesh.summary.cost.bytes, 12u * 7);
    EXPECT_EQ(box.summary.cost.bytes, 11u);
    EXPECT_EQ(solids.summary.cost.bytes, 3u * 11);
}

TEST(CostModel, ANewOnePricesLevelsAndGroupsButChangesNoHash) {
    Model model = models::row_of_balls(4);
    const std::vector<Object> before = model.objects;
    set_costs(model, made_up());
    EXPECT_EQ(model.costs.occurrence_bytes, 13u);
    for (size_t i = 0; i < model.objects.size(); ++i) {
        const RepresentationSummary& now = model.objects[i].representations[0].summary;
        const RepresentationSummary& then = before[i].representations[0].summary;
        EXPECT_EQ(now.cost.bytes, 7 * now.cost.triangles) << i;
        EXPECT_EQ(now.cost.triangles, then.cost.triangles) << i;
        EXPECT_EQ(now.hash, then.hash) << i;
    }
    EXPECT_EQ(model.objects[model.root].representations[0].summary.cost.bytes, 4u * 1280 * 7);
}

TEST(CostModel, WhatIsNotResidentKeepsItsCost) {
    Model model = models::row_of_balls(2);
    Representation& ball = model.objects[0].representations[0];
    const uint64_t known = ball.summary.cost.bytes;
    ball.payload = {};
    set_costs(model, made_up());
    EXPECT_GT(known, 0u);
    EXPECT_EQ(ball.summary.cost.bytes, known);
}
