// SPDX-License-Identifier: GPL-3.0-or-later
// Guards groups that are another one moved: they share its measuring, and nothing else does.
#include "hierarchy/hierarchy_build.h"
#include "hierarchy/run/moved_copies.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

/// About Z by `angle`, then moved.
Affine turned(double angle, const glm::dvec3& offset) {
    Affine out;
    out.linear[0] = {std::cos(angle), std::sin(angle), 0};
    out.linear[1] = {-std::sin(angle), std::cos(angle), 0};
    out.offset = offset;
    return out;
}

Affine tilted(double angle) {
    Affine out;
    out.linear[1] = {0, std::cos(angle), std::sin(angle)};
    out.linear[2] = {0, -std::sin(angle), std::cos(angle)};
    return out;
}

/// Rooms of the same table and two balls, each placed by what moves the first one, in a scene.
Model rooms(const std::vector<Affine>& places, double last_ball = 1.5) {
    Model model;
    const ObjectIndex table =
        models::add_leaf(model, "table", shapes::box({-1, -0.5, 0.7}, {1, 0.5, 0.75}),
                         models::colored("wood", {0.4, 0.2, 0.1}));
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(0.4, 4),
                                              models::colored("red", {0.8, 0.1, 0.1}));
    std::vector<Placement> all;
    for (size_t i = 0; i < places.size(); ++i) {
        const double x = i + 1 == places.size() ? last_ball : 1.5;
        const std::string name = "room " + std::to_string(i);
        all.push_back({models::add_group(model, name,
                                         {{table, places[i] * Affine{}, "table"},
                                          {ball, places[i] * models::moved(-1.5, 0, 0.4), "left"},
                                          {ball, places[i] * models::moved(x, 0, 0.4), "right"}}),
                       Affine{}, name});
    }
    model.root = models::add_group(model, "scene", std::move(all));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

std::vector<hierarchy::MovedCopy> moved_in(const Model& model) {
    const std::vector<ObjectIndex> order = bottom_up(model);
    const hierarchy::MeshSource resident = [](const Representation& level) {
        return std::get<std::shared_ptr<const Mesh>>(level.payload);
    };
    return hierarchy::moved_groups(model, order,
                                   hierarchy::surroundings_of(model, order, resident, {}));
}

class MovedGroups : public WithRays {};

}  // namespace

TEST(MovedCopy, AreThoseThatPlaceTheSameThingsInTheSameWay) {
    const Affine far = turned(0.5, {200, -300, 20});
    const Model same = rooms({Affine{}, far, turned(-2, {0, 50, 0})});
    const std::vector<hierarchy::MovedCopy> found = moved_in(same);
    ASSERT_EQ(found.size(), 2u);
    for (const hierarchy::MovedCopy& one : found) {
        EXPECT_EQ(same.objects[one.original].name, "room 0");
        EXPECT_LT(one.off, 1e-9);
    }
    EXPECT_LT(glm::length(found[0].place(glm::dvec3(1, 2, 3)) - far(glm::dvec3(1, 2, 3))), 1e-9);
}

TEST(MovedCopy, AreNotThoseThatDifferALittleTiltedOrLargerOnes) {
    Affine larger;
    larger.linear *= 1.01;
    Affine mirrored;
    mirrored.linear[1].y = -1;
    Affine flat;
    flat.linear *= 0;
    for (const Affine& place : {tilted(0.01), larger, mirrored, flat})
        EXPECT_TRUE(moved_in(rooms({Affine{}, place})).empty());
    EXPECT_TRUE(moved_in(rooms({Affine{}, models::moved(9, 0, 0)}, 1.51)).empty());
    Model important = rooms({Affine{}, models::moved(9, 0, 0)});
    EXPECT_EQ(moved_in(important).size(), 1u);
    auto own = std::make_shared<Assembly>(important.objects[2].representations[0].assembly());
    own->placements[1].importance = 4;
    important.objects[2].representations[0].payload = std::shared_ptr<const Assembly>(own);
    EXPECT_TRUE(moved_in(important).empty());
}

TEST_F(MovedGroups, HaveTheStandInsOfTheOneThatIsMeasured) {
    const Affine far = turned(0.5, {20, -30, 2});
    Model model = rooms({Affine{}, far});
    Problems problems;
    const hierarchy::BuildReport report = hierarchy::build_hierarchy(
        model, segment::Store(scratch("moved")), hierarchy::BuildSettings{}, problems, {});
    EXPECT_EQ(report.built, report.objects);
    const Object& first = model.objects[2];
    const Object& second = model.objects[3];
    EXPECT_NE(second.build_hash, 0u);
    ASSERT_GE(first.representations.size(), 2u);
    ASSERT_EQ(second.representations.size(), first.representations.size());
    for (size_t i = 1; i < first.representations.size(); ++i) {
        const RepresentationSummary& a = first.representations[i].summary;
        const RepresentationSummary& b = second.representations[i].summary;
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.cost.triangles, b.cost.triangles);
        EXPECT_NEAR(a.error, b.error, 1e-6);
        EXPECT_GE(b.error, a.error);
        EXPECT_LT(glm::length(far(a.bound.center) - b.bound.center), 0.1 * a.bound.radius);
    }
    ASSERT_TRUE(first.attributes && second.attributes);
    EXPECT_NEAR(first.attributes->visible_area, second.attributes->visible_area, 1e-6);
    EXPECT_LT(glm::length(far(first.attributes->centroid) - second.attributes->centroid), 1e-6);
}

TEST_F(MovedGroups, ComeToTheSameHoweverMuchOfThemWasBuiltBefore) {
    const std::vector<Affine> places{Affine{}, turned(0.5, {20, -30, 2}), turned(2, {9, 40, 0})};
    const auto built = [&](Model& model, const fs::path& store,
                           const std::vector<ObjectIndex>& scope) {
        Problems problems;
        hierarchy::BuildSettings settings;
        settings.scope = scope;
        return hierarchy::build_hierarchy(model, segment::Store(store), settings, problems, {});
    };
    Model whole = rooms(places);
    built(whole, scratch("whole"), {});
    const fs::path parts = scratch("parts");
    const ObjectIndex third = 4;
    ASSERT_EQ(whole.objects[third].name, "room 2");
    Model part = rooms(places);
    EXPECT_EQ(built(part, parts, {third}).built, 4u);  // what it places, the first, and itself
    EXPECT_EQ(part.objects[3].build_hash, 0u);
    Model rest = rooms(places);
    EXPECT_EQ(built(rest, parts, {}).built, 2u);  // the second, of which the first is stored
    for (const Model* model : {&part, &rest}) {
        for (const ObjectIndex index : {ObjectIndex{2}, third}) {
            const Object& one = model->objects[index];
            ASSERT_EQ(one.representations.size(), whole.objects[index].representations.size());
            for (size_t i = 1; i < one.representations.size(); ++i)
                EXPECT_EQ(one.representations[i].summary.hash,
                          whole.objects[index].representations[i].summary.hash);
        }
    }
    for (size_t i = 1; i < whole.objects[3].representations.size(); ++i)
        EXPECT_EQ(rest.objects[3].representations.at(i).summary.hash,
                  whole.objects[3].representations[i].summary.hash);
}

TEST_F(MovedGroups, ThatAPictureDoesNotCallForAreCountedAsLeft) {
    Model model = rooms({Affine{}, turned(0.5, {20, -30, 2}), turned(2, {9, 40, 0})});
    Problems problems;
    hierarchy::BuildSettings settings;
    settings.demand.emplace();
    settings.demand->share = 0;  // for nothing at all
    const hierarchy::BuildReport report =
        hierarchy::build_hierarchy(model, segment::Store(scratch("left")), settings, problems, {});
    EXPECT_EQ(report.built, 0u);
    EXPECT_EQ(report.left, report.objects);
}
