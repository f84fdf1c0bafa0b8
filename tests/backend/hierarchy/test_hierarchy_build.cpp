// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the building of hierarchies: lists in order, only the stale built, cancel without loss.
#include "base/files.h"
#include "base/parallel.h"
#include "choose/cut.h"
#include "hierarchy/flattened_group.h"
#include "hierarchy/hierarchy_build.h"
#include "hierarchy/run/stand_in_surroundings.h"
#include "ray/mesh_scene.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"
#include "segment/store_json.h"

#include <atomic>
#include <gtest/gtest.h>
#include <thread>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

hierarchy::BuildReport build_in(Model& model, const fs::path& folder) {
    Problems problems;
    const hierarchy::BuildReport report = hierarchy::build_hierarchy(
        model, segment::Store(folder), hierarchy::BuildSettings{}, problems, {});
    EXPECT_TRUE(problems.empty()) << problems[0].message;
    return report;
}

/// A table and chairs, a lamp on a wall: four leaves, two groups, one of them used twice.
Model room() {
    Model model;
    const Material wood = models::colored("wood", {0.4, 0.2, 0.1}, 0.6);
    const Material red = models::colored("red", {0.8, 0.1, 0.1}, 0.3);
    const ObjectIndex top =
        models::add_leaf(model, "top", shapes::box({-1, -0.5, 0.7}, {1, 0.5, 0.75}), wood);
    const ObjectIndex vase = models::add_leaf(model, "vase", shapes::sphere(0.1, 4), red);
    const ObjectIndex wall = models::add_leaf(model, "wall", shapes::box({-3, 2, 0}, {3, 2.2, 3}),
                                              wood, ObjectRole::Environment);
    const ObjectIndex table = models::add_group(
        model, "table", {{top, Affine{}, "top"}, {vase, models::moved(0, 0, 0.85), "vase"}});
    model.root = models::add_group(model, "room",
                                   {{table, models::moved(-1.5, 0, 0), "table left"},
                                    {table, models::moved(1.5, 0, 0), "table right"},
                                    {wall, Affine{}, "wall"}});
    return model;
}

Model row_of_terrains(int count) {
    Model model;
    std::vector<Placement> row;
    for (int i = 0; i < count; ++i) {
        const std::string uid = std::to_string(i);
        row.push_back({models::add_leaf(model, uid, shapes::terrain(static_cast<size_t>(24 + i))),
                       models::moved(2.0 * i, 0, 0), uid});
    }
    model.root = models::add_group(model, "row", row);
    return model;
}

/// Builds in an empty folder and stops as soon as a store is there; false when it was done before.
bool stopped_when_something_is_kept(Model model, const fs::path& folder) {
    const segment::Store store(folder);
    hierarchy::BuildSettings settings;
    settings.keep_every_s = 0;
    volatile int32_t cancel = 0;
    std::atomic<bool> over{false};
    std::thread watcher([&] {
        while (!over && !store.exists())
            std::this_thread::yield();
        cancel = 1;
    });
    Problems problems;
    bool stopped = false;
    try {
        hierarchy::build_hierarchy(model, store, settings, problems,
                                   Job(&cancel, nullptr, nullptr));
    } catch (const Error& error) {
        stopped = error.status == Status::Cancelled;
    }
    over = true;
    watcher.join();
    for (const Object& object : model.objects)
        EXPECT_TRUE(!stopped || object.representations.size() == 1u);
    return stopped;
}

ObjectIndex index_of(const Model& model, const std::string& uid) {
    for (ObjectIndex i = 0; i < model.objects.size(); ++i) {
        if (model.objects[i].uid == uid)
            return i;
    }
    return kNoObject;
}

void expect_valid(const Model& model) {
    for (const ObjectIndex index : bottom_up(model)) {
        const Object& object = model.objects[index];
        double last_error = -1;
        uint64_t last_bytes = ~uint64_t{0};
        const Representation& finest = object.representations[0];
        bool drawable = object.group() && finest.assembly().placements.size() == 1;
        for (const Representation& representation : object.representations) {
            EXPECT_GT(representation.summary.error, last_error) << object.name;
            EXPECT_GE(representation.summary.max_error, representation.summary.error);
            EXPECT_LT(representation.summary.cost.bytes, last_bytes) << object.name;
            last_error = representation.summary.error;
            last_bytes = object.group() ? last_bytes : representation.summary.cost.bytes;
            drawable = drawable || representation.summary.kind != Kind::Assembly;
        }
        EXPECT_EQ(finest.summary.error, 0);
        EXPECT_TRUE(drawable) << object.name;
    }
}

class Hierarchy : public WithRays {};

}  // namespace

TEST_F(Hierarchy, EmptyModelBuildsAnEmptyStore) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    const hierarchy::BuildReport report = build_in(model, scratch("empty"));
    EXPECT_EQ(model.objects[0].representations.size(), 1u);
    EXPECT_EQ(report.representations, 1u);
}

TEST_F(Hierarchy, CubeBecomesABoxThatIsTheCube) {
    Model model;
    model.root = models::add_leaf(model, "cube", shapes::cube());
    build_in(model, scratch("cube"));
    ASSERT_GE(model.objects[0].representations.size(), 2u);
    const Representation& box = model.objects[0].representations.back();
    ASSERT_EQ(box.summary.kind, Kind::Box);
    EXPECT_NEAR(box.primitive().half_size.x, 0.5, 0.01);
    EXPECT_LT(box.summary.error, 0.02);
}

TEST_F(Hierarchy, SmoothClosedMeshKeepsItsFineLevels) {
    // Errors that grew on the way down to a floor of coarse pictures left no level but the last.
    Model model;
    model.root = models::add_leaf(model, "ring", shapes::torus(80, 32),
                                  models::colored("red", {0.8, 0.1, 0.1}, 0.3));
    build_in(model, scratch("ring"));
    const auto& levels = model.objects[model.root].representations;
    ASSERT_GE(levels.size(), 6u);
    for (size_t i = 1; i < 5; ++i) {
        ASSERT_EQ(levels[i].summary.kind, Kind::Mesh) << i;
        EXPECT_GT(3 * levels[i].summary.cost.triangles, levels[i - 1].summary.cost.triangles) << i;
    }
}

TEST_F(Hierarchy, RoomHasListsInOrderAndAStandInEverywhere) {
    Model model = room();
    const hierarchy::BuildReport report = build_in(model, scratch("room"));
    EXPECT_EQ(report.objects, 5u);
    EXPECT_EQ(report.built, 5u);
    expect_valid(model);
}

TEST_F(Hierarchy, AnEmptySceneIsNoObjectToBuild) {
    Model model;
    const ObjectIndex inside = models::add_group(model, "inside", {});
    model.root = models::add_group(model, "scene", {{inside, Affine{}, "inside"}});
    const fs::path folder = scratch("empty");
    for (const hierarchy::BuildReport& report :
         {hierarchy::estimate_build(model, segment::Store(folder), {}), build_in(model, folder)}) {
        EXPECT_EQ(report.objects, 0u);
        EXPECT_EQ(report.built, 0u);
    }
}

TEST_F(Hierarchy, EnvironmentIsNeverAPrimitiveNorIsAGroupWithOne) {
    Model model = room();
    build_in(model, scratch("environment"));
    for (const Object& object : model.objects) {
        for (const Representation& representation : object.representations) {
            if (object.uid == "wall" || object.uid == "room") {
                EXPECT_FALSE(models::is_solid(representation.summary.kind)) << object.uid;
            }
        }
    }
}

TEST_F(Hierarchy, NothingStandsInForWhatDeformsNorForItsGroups) {
    Model model = room();
    model.objects[index_of(model, "vase")].deforms = true;
    model.objects[index_of(model, "top")].role =
        ObjectRole::Ordinary;  // else it is the vase's ground
    const fs::path folder = scratch("deforms");
    const hierarchy::BuildReport report = build_in(model, folder);
    const std::vector<uint8_t> deforming = with_deforming(model);
    for (const char* still : {"top", "wall"})
        EXPECT_EQ(deforming[index_of(model, still)], 0) << still;
    for (const char* changing : {"vase", "table", "room"}) {
        const ObjectIndex index = index_of(model, changing);
        EXPECT_EQ(deforming[index], 1) << changing;
        EXPECT_EQ(model.objects[index].representations.size(), 1u) << changing;
    }
    EXPECT_GT(model.objects[index_of(model, "top")].representations.size(), 1u);
    EXPECT_EQ(report.built, 2u);
    EXPECT_TRUE(segment::Store(folder).read().objects[1].deforms);
}

TEST_F(Hierarchy, GroupOfGroupsWithEnvironmentIsNoPrimitive) {
    Model model = room();
    const ObjectIndex inner = model.root;
    model.root = models::add_group(model, "house", {{inner, Affine{}, "room"}});
    EXPECT_EQ(with_environment(model)[model.root], 1);
    build_in(model, scratch("nested"));
    for (const Representation& representation : model.objects[model.root].representations) {
        EXPECT_FALSE(models::is_solid(representation.summary.kind));
    }
}

TEST_F(Hierarchy, SecondBuildBuildsNothingAndGivesTheSameLists) {
    Model model = room();
    const fs::path folder = scratch("again");
    build_in(model, folder);
    Model again = room();
    const hierarchy::BuildReport report = build_in(again, folder);
    EXPECT_EQ(report.built, 0u);
    ASSERT_EQ(model.objects.size(), again.objects.size());
    for (size_t i = 0; i < model.objects.size(); ++i) {
        ASSERT_EQ(model.objects[i].representations.size(), again.objects[i].representations.size());
        for (size_t lod = 0; lod < model.objects[i].representations.size(); ++lod) {
            EXPECT_EQ(model.objects[i].representations[lod].summary.hash,
                      again.objects[i].representations[lod].summary.hash);
            EXPECT_EQ(model.objects[i].representations[lod].summary.error,
                      again.objects[i].representations[lod].summary.error);
        }
    }
}

TEST_F(Hierarchy, AStandInThatIsGoneFromTheStoreIsBuiltAgain) {
    const auto ring = [] {
        Model model;
        model.root = models::add_leaf(model, "ring", shapes::torus(40, 16));
        return model;
    };
    const fs::path folder = scratch("gone");
    Model first = ring();
    build_in(first, folder);
    fs::path file;
    for (const Representation& one : first.objects[0].representations) {
        if (one.summary.kind == Kind::Mesh && one.summary.error > 0)
            file = folder / segment::file_of(one.summary.hash);
    }
    ASSERT_FALSE(file.empty());
    const std::string before = read_file(file);
    for (const bool emptied : {false, true}) {
        fs::remove(file);
        if (emptied)
            write_file(file, "");
        Model again = ring();
        EXPECT_EQ(build_in(again, folder).built, 1u);
        EXPECT_EQ(read_file(file), before);
    }
}

TEST_F(Hierarchy, RenamedObjectsAreFoundByTheirSourceAndCostNothing) {
    const fs::path folder = scratch("renamed");
    Model before = room();
    build_in(before, folder);
    Model renamed = room();
    for (Object& object : renamed.objects) {
        object.uid = "new " + object.uid;
        object.name = "new " + object.name;
    }
    // Two that swap their ids must not swap their levels.
    std::swap(renamed.objects[0].uid, renamed.objects[1].uid);
    for (Material& material : renamed.materials)
        material.name = "new " + material.name;
    const segment::Store store(folder);
    EXPECT_EQ(hierarchy::estimate_build(renamed, store, {}).built, 0u);
    const hierarchy::BuildReport report = build_in(renamed, folder);
    EXPECT_EQ(report.built, 0u);
    const Model stored = store.read();
    ASSERT_EQ(stored.objects.size(), before.objects.size());
    for (const Object& object : stored.objects)
        EXPECT_EQ(object.uid.substr(0, 4), "new ");
    for (size_t i = 0; i < before.objects.size(); ++i) {
        const auto& old = before.objects[i].representations;
        const auto& now = renamed.objects[i].representations;
        ASSERT_EQ(now.size(), old.size());
        for (size_t lod = 0; lod < old.size(); ++lod) {
            EXPECT_EQ(now[lod].summary.hash, old[lod].summary.hash);
            EXPECT_EQ(now[lod].summary.error, old[lod].summary.error);
        }
    }
}

TEST_F(Hierarchy, OneChangedObjectRebuildsItAndItsGroupsOnly) {
    Model model = room();
    const fs::path folder = scratch("stale");
    build_in(model, folder);
    Model changed = room();
    changed.objects[1].name = "renamed: no reason to build";
    changed.objects[1].representations[0].payload =
        std::make_shared<const Mesh>(shapes::sphere(0.12, 4));
    summarize(changed.objects[1].representations[0], changed);
    const segment::Store store(folder);
    EXPECT_EQ(hierarchy::estimate_build(changed, store, {}).built, 3u);  // vase, table, room
    EXPECT_EQ(build_in(changed, folder).built, 3u);
    expect_valid(changed);
}

TEST_F(Hierarchy, ScopeBuildsWhatItReachesAndTheRestStaysStale) {
    Model model = room();
    const fs::path folder = scratch("scope");
    hierarchy::BuildSettings settings;
    settings.scope = {3};  // the table
    Problems problems;
    const segment::Store store(folder);
    EXPECT_EQ(hierarchy::estimate_build(model, store, settings).built, 3u);
    const hierarchy::BuildReport report =
        hierarchy::build_hierarchy(model, store, settings, problems, {});
    EXPECT_EQ(report.built, 3u);  // table, top, vase
    EXPECT_EQ(model.objects[2].representations.size(), 1u);
    EXPECT_EQ(model.objects[model.root].representations.size(), 1u);
    Model rest = room();
    EXPECT_EQ(build_in(rest, folder).built, 2u);  // wall, room
    expect_valid(rest);

    settings.scope = {99};
    Model again = room();
    EXPECT_THROW(hierarchy::build_hierarchy(again, store, settings, problems, {}), Error);
}

TEST_F(Hierarchy, ContentEqualObjectsAreBuiltOnce) {
    Model model;
    const ObjectIndex a = models::add_leaf(model, "a", shapes::terrain(24));
    const ObjectIndex b = models::add_leaf(model, "b", shapes::terrain(24));
    model.root =
        models::add_group(model, "both", {{a, Affine{}, "a"}, {b, models::moved(3, 0, 0), "b"}});
    EXPECT_EQ(build_in(model, scratch("equal")).built, 2u);
    ASSERT_EQ(model.objects[a].representations.size(), model.objects[b].representations.size());
    EXPECT_GT(model.objects[a].representations.size(), 2u);
}

TEST_F(Hierarchy, SameListsOnOneAndOnManyThreads) {
    Model one = room();
    Model many = room();
    const fs::path by_one = scratch("one");
    const fs::path by_many = scratch("many");
    {
        const ThreadLimit limit(1);
        build_in(one, by_one);
    }
    build_in(many, by_many);
    EXPECT_EQ(read_file(by_one / "tileset.json"), read_file(by_many / "tileset.json"));
}

TEST_F(Hierarchy, CancelledBuildChangesNothing) {
    Model model = room();
    const fs::path folder = scratch("cancel");
    const int32_t cancel = 1;
    Problems problems;
    EXPECT_THROW(hierarchy::build_hierarchy(model, segment::Store(folder), {}, problems,
                                            Job(&cancel, nullptr, nullptr)),
                 Error);
    EXPECT_FALSE(segment::Store(folder).exists());
    for (const Object& object : model.objects)
        EXPECT_EQ(object.representations.size(), 1u);
}

TEST_F(Hierarchy, AStoppedBuildIsGoneOnWith) {
    Model whole = row_of_terrains(12);
    const uint64_t all = build_in(whole, scratch("whole")).built;
    for (int attempt = 0; attempt < 5; ++attempt) {  // the thread that stops it may come too late
        const fs::path folder = scratch("stopped");
        if (!stopped_when_something_is_kept(row_of_terrains(12), folder))
            continue;
        Model model = row_of_terrains(12);
        const uint64_t rest = build_in(model, folder).built;
        EXPECT_GT(rest, 0u);
        EXPECT_LT(rest, all);
        expect_valid(model);
        for (size_t i = 0; i < model.objects.size(); ++i)
            EXPECT_EQ(model.objects[i].representations.size(),
                      whole.objects[i].representations.size());
        return;
    }
    FAIL() << "five builds were done before they could be stopped";
}

TEST_F(Hierarchy, HowOftenItIsKeptChangesNoResult) {
    Model once = room();
    Model often = room();
    const fs::path by_once = scratch("once");
    const fs::path by_often = scratch("often");
    build_in(once, by_once);
    hierarchy::BuildSettings settings;
    settings.keep_every_s = 0;
    Problems problems;
    hierarchy::build_hierarchy(often, segment::Store(by_often), settings, problems, {});
    EXPECT_EQ(read_file(by_once / "tileset.json"), read_file(by_often / "tileset.json"));
}

TEST_F(Hierarchy, WhatGroupsShareIsFlattenedCoarserThanWhatOneHasForItself) {
    Model model;
    std::vector<ObjectIndex> groups;
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(1, 4));
    for (int i = 0; i < 9; ++i) {  // eight of one mesh in nine different groups
        std::vector<Placement> placements(8, {ball, {}, "ball"});
        for (size_t k = 0; k < placements.size(); ++k)
            placements[k].transform =
                models::moved(3.0 * static_cast<double>(k), i * static_cast<double>(k), 0);
        groups.push_back(models::add_group(model, "row " + std::to_string(i), placements));
    }
    std::vector<Placement> own;
    for (int k = 0; k < 8; ++k) {
        const std::string uid = "own " + std::to_string(k);
        own.push_back(
            {models::add_leaf(model, uid, shapes::sphere(1, 4)), models::moved(3 * k, 0, 0), uid});
    }
    groups.push_back(models::add_group(model, "own", own));
    std::vector<Placement> all;
    all.reserve(groups.size());
    for (const ObjectIndex group : groups)
        all.push_back({group, {}, model.objects[group].name});
    model.root = models::add_group(model, "all", all);
    build_in(model, scratch("shared"));
    const std::vector<uint64_t> uses = hierarchy::uses_of(model);
    const auto flattened = [&](ObjectIndex group, uint64_t most) {
        hierarchy::OpenedGroup opened(model, group, uses);
        const double error = hierarchy::error_to_flatten(opened, most, most, {});
        return opened.drawn_within(error, {}).triangles;
    };
    EXPECT_LT(5 * flattened(groups[0], 1000000), flattened(groups[9], 1000000));
    EXPECT_LE(flattened(groups[9], 500), 500u);
}

TEST_F(Hierarchy, WhatNobodySeesCostsAGroupNothing) {
    // A sphere of 20,480 triangles inside a closed box: the group's stand-ins are boxes.
    Model model;
    const ObjectIndex shell = models::add_leaf(model, "shell", shapes::cube());
    const ObjectIndex inside = models::add_leaf(model, "inside", shapes::sphere(0.3, 5));
    model.root = models::add_group(model, "safe",
                                   {{shell, Affine{}, "shell"}, {inside, Affine{}, "inside"}});
    build_in(model, scratch("hidden"));
    const Object& safe = model.objects[model.root];
    ASSERT_GE(safe.representations.size(), 2u);
    EXPECT_LE(safe.representations[1].summary.cost.triangles, 12u);
    EXPECT_LT(safe.representations[1].summary.error, 0.05);
}

TEST_F(Hierarchy, DegenerateObjectsStayAsTheyAre) {
    Model model;
    Mesh line;
    line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.triangles = {{0, 1, 2}};
    const ObjectIndex flat = models::add_leaf(model, "line", line);
    const ObjectIndex nothing = models::add_leaf(model, "nothing", Mesh{});
    model.root = models::add_group(model, "root",
                                   {{flat, Affine{}, "line"}, {nothing, Affine{}, "nothing"}});
    EXPECT_NO_THROW(build_in(model, scratch("degenerate")));
    EXPECT_EQ(model.objects[flat].representations.size(), 1u);
    EXPECT_EQ(model.objects[nothing].representations.size(), 1u);
}

TEST_F(Hierarchy, CutOfTheBuiltModelKeepsItsPromise) {
    Model model = models::row_of_balls(16);
    build_in(model, scratch("promise"));
    View view;
    view.camera.position = {24, -60, 0};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 0, 0.5625};
    const choose::Cut fine = choose::choose_cut(model, view);
    view.pixel_error = 0;
    const choose::Cut full = choose::choose_cut(model, view);
    EXPECT_LE(fine.largest_error_px, 1);
    EXPECT_LT(fine.triangles * 4, full.triangles);
}
