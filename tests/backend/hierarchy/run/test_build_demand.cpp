// SPDX-License-Identifier: GPL-3.0-or-later
// Guards building for one picture: what helps it first, within its share, and never another result.
#include "choose/cut.h"
#include "hierarchy/hierarchy_build.h"
#include "hierarchy/run/build_demand.h"
#include "hierarchy/run/effort_estimate.h"
#include "scenes/small_models.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <numeric>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

/// Looks along -z from `distance` metres before the origin.
View view_from(double distance) {
    View view;
    view.camera.position = {0, 0, distance};
    return view;
}

hierarchy::BuildSettings settings_for(double distance, double share) {
    hierarchy::BuildSettings settings;
    settings.demand = hierarchy::BuildDemand{view_from(distance), share};
    return settings;
}

hierarchy::BuildReport build_in(Model& model, const fs::path& folder,
                                const hierarchy::BuildSettings& settings) {
    Problems problems;
    const hierarchy::BuildReport report =
        hierarchy::build_hierarchy(model, segment::Store(folder), settings, problems, {});
    EXPECT_TRUE(problems.empty()) << problems[0].message;
    return report;
}

/// One ball `near` metres from a camera at the origin, one 500 m away and a flat one beside it.
Model three(double near) {
    Model model;
    const ObjectIndex close = models::add_leaf(model, "close", shapes::sphere(1, 4));
    const ObjectIndex far = models::add_leaf(model, "far", shapes::sphere(1.1, 4));
    const ObjectIndex plain = models::add_leaf(model, "plain", shapes::box({0, 0, 0}, {1, 1, 1}));
    model.root = models::add_group(model, "all",
                                   {{close, models::moved(0, 0, -near), "close"},
                                    {far, models::moved(0, 0, -500), "far"},
                                    {plain, models::moved(9, 0, -500), "plain"}});
    summarize_assemblies(model, bottom_up(model));
    return model;
}

std::vector<hierarchy::StaleObject> everything(const Model& model) {
    std::vector<hierarchy::StaleObject> stale;
    for (const ObjectIndex index : bottom_up(model))
        stale.push_back({index, {}});
    return stale;
}

std::vector<std::string> called_names(const Model& model,
                                      const hierarchy::BuildSettings& settings) {
    const std::vector<hierarchy::StaleObject> stale = everything(model);
    const std::vector<uint8_t> called = hierarchy::select_demanded(model, stale, settings, {});
    std::vector<std::string> names;
    for (size_t i = 0; i < stale.size(); ++i) {
        if (called[i] != 0)
            names.push_back(model.objects[stale[i].index].name);
    }
    return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST(BuildDemand, OfNothingStaleCallsForNothing) {
    const Model model = three(1.1);
    EXPECT_TRUE(hierarchy::select_demanded(model, {}, settings_for(0, 1), {}).empty());
}

TEST(BuildDemand, WithoutTimeCallsForNothing) {
    EXPECT_EQ(called_names(three(1.1), settings_for(0, 0)), Names{});
}

TEST(BuildDemand, CallsForWhatIsFarAndHasManyTriangles) {
    EXPECT_EQ(called_names(three(1.1), settings_for(0, 1)), Names{"far"});
}

TEST(BuildDemand, CallsForNothingThatAnotherStandInDrawsAlready) {
    Model model = three(500);
    Representation box;
    box.summary = {Kind::Box, 0.1, 0.1, model.objects[model.root].bound(), {0, 1500}, 7};
    box.payload = Primitive{};
    model.objects[model.root].representations.push_back(box);
    EXPECT_EQ(called_names(model, settings_for(0, 100)), Names{});
}

TEST(BuildDemand, CallsForGroupsOnlyWhenAllBelowIsThere) {
    const Model rows = models::row_of_balls(200);
    const Names all = called_names(rows, settings_for(3000, 100));
    EXPECT_EQ(all, (Names{"ball", "pair", "row"}));
    // Half a share less than all of it takes leaves out the last, not the first.
    double seconds = 0;
    for (const hierarchy::StaleObject& stale : everything(rows))
        seconds += hierarchy::seconds_to_build(rows.objects[stale.index], {});
    const View view = view_from(3000);
    const double picture = hierarchy::seconds_to_draw(rows, choose::choose_cut(rows, view), view);
    EXPECT_EQ(called_names(rows, settings_for(3000, 0.9 * seconds / picture)),
              (Names{"ball", "pair"}));
}

TEST(BuildDemand, MovedAndEnlargedTogetherCallsForTheSame) {
    // A scene ten times as large from ten times as far away.
    Model large = three(11);
    for (Object& object : large.objects) {
        if (!object.group()) {
            Mesh mesh = object.representations[0].mesh();
            for (glm::vec3& position : mesh.positions)
                position *= 10.0F;
            object.representations[0].payload = std::make_shared<const Mesh>(std::move(mesh));
            summarize(object.representations[0], large);
        }
    }
    large.root = models::add_group(large, "larger",
                                   {{0, models::moved(0, 0, -11), "close"},
                                    {1, models::moved(0, 0, -5000), "far"},
                                    {2, models::moved(90, 0, -5000), "plain"}});
    summarize_assemblies(large, bottom_up(large));
    EXPECT_EQ(called_names(large, settings_for(0, 1)),
              called_names(three(1.1), settings_for(0, 1)));
}

TEST(BuildDemand, OfAViewOfNoDepthIsFinite) {
    // The camera in the middle of everything, a pixel as large as the world, one of no error.
    Model model = three(0);
    for (const double error : {0.0, 1e-300, 1e300}) {
        hierarchy::BuildSettings settings = settings_for(0, 1e9);
        settings.demand->view.pixel_error = error;
        const Names names = called_names(model, settings);
        EXPECT_LE(names.size(), 4U);
        if (error < 1) {
            EXPECT_EQ(names, Names{});
        }
    }
}

TEST(BuildDemand, BuildsItsShareAndThenTheRestAsIfAtOnce) {
    const fs::path parts = scratch("parts");
    const fs::path once = scratch("once");
    Model first = three(1.1);
    const hierarchy::BuildReport helped = build_in(first, parts, settings_for(0, 1));
    EXPECT_EQ(helped.built, 1U);
    EXPECT_EQ(helped.left, 3U);
    EXPECT_EQ(first.objects[0].representations.size(), 1U);  // close
    EXPECT_GT(first.objects[1].representations.size(), 1U);  // far

    Model again = three(1.1);
    EXPECT_EQ(build_in(again, parts, settings_for(0, 1)).built, 0U);
    EXPECT_GT(again.objects[1].representations.size(), 1U);

    Model rest = three(1.1);
    const hierarchy::BuildReport full = build_in(rest, parts, {});
    EXPECT_EQ(full.built, 3U);
    EXPECT_EQ(full.left, 0U);
    Model whole = three(1.1);
    EXPECT_EQ(build_in(whole, once, {}).built, 4U);
    for (size_t i = 0; i < whole.objects.size(); ++i) {
        ASSERT_EQ(rest.objects[i].representations.size(), whole.objects[i].representations.size());
        for (size_t lod = 0; lod < whole.objects[i].representations.size(); ++lod)
            EXPECT_EQ(rest.objects[i].representations[lod].summary.hash,
                      whole.objects[i].representations[lod].summary.hash);
    }
}

TEST(BuildDemand, OfTenThousandObjectsIsFoundAtOnce) {
    Model model;
    std::vector<Placement> placements;
    for (int i = 0; i < 10000; ++i) {
        const std::string name = std::to_string(i);
        placements.push_back({models::add_leaf(model, name, shapes::box({0, 0, 0}, {1, 1, 1. + i})),
                              models::moved(i, 0, 0), name});
    }
    model.root = models::add_group(model, "all", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    EXPECT_TRUE(called_names(model, settings_for(1e6, 1e9)).empty());
}
