// SPDX-License-Identifier: GPL-3.0-or-later
// Guards environment: which child of a group is recognized as the ground of the others, and that no
// solid stands for it or for its group.
#include "hierarchy/environment_objects.h"
#include "scenes/built_models.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace lodestone;

namespace {

Mesh slab(double half, double thickness) {
    return shapes::box({-half, -half, -thickness}, {half, half, 0});
}

struct Plot {
    Model model;
    ObjectIndex ground = kNoObject;
    ObjectIndex stone = kNoObject;
};

/// Balls in rows, so many metres above a slab of 20 m that is `thickness` thick.
Plot plot(double height, double thickness = 0.2, ObjectRole role = ObjectRole::Automatic) {
    Plot out;
    Model& model = out.model;
    out.ground = models::add_leaf(model, "ground", slab(10, thickness),
                                  models::colored("earth", {0.2, 0.3, 0.1}), role);
    out.stone = models::add_leaf(model, "stone", shapes::sphere(0.5, 3),
                                 models::colored("stone", {0.5, 0.5, 0.5}));
    std::vector<Placement> placements{{out.ground, models::moved(0, 0, 0), "ground"}};
    for (int x = 0; x < 6; ++x) {
        for (int y = 0; y < 6; ++y)
            placements.push_back(
                {out.stone, models::moved(1.2 * x - 3, 1.2 * y - 3, height), "stone"});
    }
    model.root = models::add_group(model, "plot", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    return out;
}

std::optional<size_t> ground_in(const Model& model) {
    return hierarchy::ground_of(model, model.root,
                                hierarchy::marked_environment(model, bottom_up(model)));
}

class Environment : public WithRays {};

}  // namespace

TEST(Ground, IsWhatMostOfTheOthersStandOn) {
    EXPECT_EQ(ground_in(plot(0.5).model), std::optional<size_t>(0));
    EXPECT_EQ(ground_in(plot(0.5, 3).model), std::nullopt) << "no block";
    EXPECT_EQ(ground_in(plot(-1).model), std::nullopt) << "no table top, with things below";
    EXPECT_EQ(ground_in(plot(0.5, 0.2, ObjectRole::Ordinary).model), std::nullopt)
        << "told not to be";
    EXPECT_EQ(ground_in(plot(0.5, 0.2, ObjectRole::Environment).model), std::nullopt)
        << "is marked";
}

TEST(Ground, HasNothingBesideItThatIsNearlyAsLarge) {
    Plot shelf = plot(0.5);
    Assembly boards = shelf.model.objects[shelf.model.root].representations[0].assembly();
    boards.placements.push_back({shelf.ground, models::moved(0, 0, 2), "board"});
    shelf.model.root = models::add_group(shelf.model, "shelf", boards.placements);
    summarize_assemblies(shelf.model, bottom_up(shelf.model));
    EXPECT_EQ(ground_in(shelf.model), std::nullopt);
}

TEST(Ground, IsToldOfAllThatIsBelowIt) {
    Plot now = plot(0.5);
    const ObjectIndex tiles =
        models::add_group(now.model, "tiles", {{now.ground, models::moved(0, 0, 0), "tile"}});
    now.model.root = models::add_group(
        now.model, "garden",
        {{tiles, models::moved(0, 0, 0), "tiles"}, {now.stone, models::moved(1, 0, 0.5), "stone"}});
    const std::vector<ObjectIndex> order = bottom_up(now.model);
    summarize_assemblies(now.model, order);
    const std::vector<uint8_t> ground =
        hierarchy::grounds_of(now.model, order, hierarchy::marked_environment(now.model, order));
    EXPECT_EQ(ground[tiles], 1);
    EXPECT_EQ(ground[now.ground], 1);
    EXPECT_EQ(ground[now.stone], 0);
}

TEST_F(Environment, NoSolidStandsForAGroundOrItsGroup) {
    for (const ObjectRole role : {ObjectRole::Automatic, ObjectRole::Environment}) {
        Plot now = plot(0.5, 0.2, role);
        build_in(now.model, "ground");
        for (const ObjectIndex index : {now.ground, now.model.root}) {
            const Object& object = now.model.objects[index];
            for (size_t i = 1; i < object.representations.size(); ++i)
                EXPECT_EQ(object.representations[i].summary.kind, Kind::Mesh) << object.name;
        }
    }
}

TEST_F(Environment, StaysBesideTheSolidsThatStandOnIt) {
    Plot now = plot(0.5);
    build_in(now.model, "beside");
    // Among them is the slab and one box for all stones, nearer than a mesh of as few triangles.
    const Object& group = now.model.objects[now.model.root];
    const auto beside =
        std::find_if(group.representations.begin() + 1, group.representations.end(),
                     [](const Representation& level) { return level.materials.size() == 3; });
    ASSERT_NE(beside, group.representations.end());
    ASSERT_EQ(beside->summary.kind, Kind::Mesh);
    EXPECT_LE(beside->summary.cost.triangles, 24u);
    EXPECT_LT(beside->summary.error, 0.15 * group.bound().radius);
    const Box3 box = bound_of(beside->mesh().positions).box;
    EXPECT_NEAR(box.size().x, 20, 0.1);
    EXPECT_NEAR(box.high.z, 1, 0.3);
}

TEST_F(Environment, AnOrdinaryGroundMayBecomeABox) {
    Plot now = plot(0.5, 0.2, ObjectRole::Ordinary);
    build_in(now.model, "ordinary");
    size_t solids = 0;
    for (const Object& object : now.model.objects) {
        for (const Representation& level : object.representations)
            solids += models::is_solid(level.summary.kind) ? 1 : 0;
    }
    EXPECT_GT(solids, 0u);
}
