// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that a picture takes each chunk of a large surface as finely as it needs it, and that what
// it draws is closed.
#include "choose/criterion.h"
#include "choose/surface_detail.h"
#include "hierarchy/hierarchy_build.h"
#include "ray/mesh_scene.h"
#include "scenes/chunk_truth.h"
#include "scenes/open_edges.h"
#include "scenes/ridged_terrain.h"
#include "scenes/small_models.h"
#include "scratch.h"
#include "segment/store.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <set>

using namespace lodestone;

namespace {

constexpr double kSize = 1000;

/// A terrain of 73,728 triangles, 32 chunks; with its levels it is built once.
Model bare() {
    Model made;
    models::add_leaf(made, "terrain", terrains::terrain(193, kSize));
    made.root = 0;
    summarize_assemblies(made, bottom_up(made));
    return made;
}

size_t build(Model& model, const segment::Store& store) {
    Problems problems;
    return hierarchy::build_hierarchy(model, store, {}, problems, {}).built;
}

const Model& built() {
    static const Model kModel = [] {
        Model made = bare();
        build(made, segment::Store(scratch("built")));
        return made;
    }();
    return kModel;
}

/// From a height over a corner, looking to the middle.
View corner_view(double pixel_error) {
    View view = models::view_from(0, pixel_error);
    view.camera.position = {0.1 * kSize, 0.1 * kSize, kSize * terrains::height_at(0.1, 0.1) + 20};
    view.camera.direction = glm::normalize(glm::dvec3(1, 1, -0.1));
    view.camera.right = glm::normalize(glm::cross(view.camera.direction, glm::dvec3(0, 0, 1)));
    view.camera.up = 0.5625 * glm::cross(view.camera.right, view.camera.direction);
    return view;
}

TEST(SurfaceDetail, SmallObjectsAreNoSurfaces) {
    const Model model = models::row_of_balls(3);
    const View view = models::view_from(10);
    EXPECT_TRUE(choose::surface_details(model, view, choose::choose_cut(model, view)).empty());
}

TEST(SurfaceDetail, NearChunksAreFineAndFarOnesCoarse) {
    const Model& model = built();
    const View view = corner_view(2);
    const choose::Cut cut = choose::choose_cut(model, view);
    EXPECT_EQ(cut.triangles, model.objects[0].representations[0].summary.cost.triangles);
    const auto details = choose::surface_details(model, view, cut);
    ASSERT_EQ(details.size(), 1u);
    EXPECT_LT(details[0].triangles, cut.triangles / 2);
    EXPECT_LE(details[0].largest_error_px, 2.0);
    const std::set<uint32_t> lods(details[0].lods.begin(), details[0].lods.end());
    EXPECT_GE(lods.size(), 3u);
    const SurfaceTree& tree = *model.objects[0].representations[0].surface->tree;
    for (uint32_t chunk = 0; chunk < tree.chunks(); ++chunk) {
        const Representation& drawn = model.objects[0].representations[details[0].lods[chunk]];
        const double error =
            drawn.surface->error_of(chunk >> drawn.surface->shift, drawn.summary.error);
        const Box3& box = tree.boxes[chunk];
        const double z =
            distance(Bound{box.center(), 0.5 * glm::length(box.size()), box}, view.camera.position);
        EXPECT_TRUE(choose::good_enough(view, error, 1, z)) << "chunk " << chunk;
    }
}

TEST(SurfaceDetail, WhatIsDrawnIsOneSheet) {
    const Model& model = built();
    for (const double pixel_error : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0}) {
        const View view = corner_view(pixel_error);
        const choose::Cut cut = choose::choose_cut(model, view);
        const auto details = choose::surface_details(model, view, cut);
        ASSERT_EQ(details.size(), 1u);
        const choose::DetailedCut drawn = choose::draw_surfaces(model, cut, details);
        ASSERT_EQ(drawn.model.objects.size(), 2u);
        const choose::CutNode& node = drawn.cut.nodes[details[0].node];
        EXPECT_EQ(node.object, 1u);
        const Representation& mesh = drawn.model.objects[1].representations[node.lod];
        EXPECT_EQ(loops_of(open_edges(mesh.mesh())), 1u);
        EXPECT_LE(mesh.mesh().triangles.size(), details[0].triangles);
        EXPECT_GT(mesh.mesh().triangles.size(), details[0].triangles * 9 / 10);
        EXPECT_EQ(mesh.mesh().normals.size(), mesh.mesh().positions.size());
        EXPECT_NO_THROW(check(mesh.mesh()));
    }
}

TEST(SurfaceDetail, WhatIsDrawnIsAsNearAsItWasAskedFor) {
    const Model& model = built();
    const Mesh& original = model.objects[0].representations[0].mesh();
    for (const double pixel_error : {1.0, 4.0}) {
        const View view = corner_view(pixel_error);
        const choose::Cut cut = choose::choose_cut(model, view);
        const auto details = choose::surface_details(model, view, cut);
        const choose::DetailedCut drawn = choose::draw_surfaces(model, cut, details);
        const choose::CutNode& node = drawn.cut.nodes[details.at(0).node];
        const ray::MeshScene scene(drawn.model.objects[node.object].representations[0].mesh());
        const SurfaceTree& tree = *model.objects[0].representations[0].surface->tree;
        const ray::MeshScene finest(original);
        for (const std::vector<uint32_t>& triangles : chunks::triangles_by_chunk(original, tree)) {
            std::vector<double> pixels;
            for (const glm::dvec3& point : chunks::points_on(original, finest, triangles)) {
                const double z = glm::length(point - view.camera.position);
                pixels.push_back(scene.closest_point(point).distance / choose::pixel_size(view, z));
            }
            // Borders that were moved into those of coarser neighbors count, too.
            EXPECT_LE(chunks::quantile_of(std::move(pixels)), 1.5 * pixel_error);
        }
    }
}

TEST(SurfaceDetail, AFlatFieldDoesNotPayForTheRoughestCliff) {
    Model model;
    models::add_leaf(model, "terrain",
                     terrains::height_field(193, kSize, terrains::half_plain_height_at));
    model.root = 0;
    summarize_assemblies(model, bottom_up(model));
    build(model, segment::Store(scratch("half")));
    Model by_levels = model;
    for (Representation& level : by_levels.objects[0].representations) {
        if (level.surface == nullptr)
            continue;
        auto whole = std::make_shared<SurfaceLevel>(*level.surface);
        whole->errors.clear();
        level.surface = std::move(whole);
    }
    const View view = corner_view(1);
    const choose::Cut cut = choose::choose_cut(model, view);
    const auto own = choose::surface_details(model, view, cut);
    const auto others = choose::surface_details(by_levels, view, cut);
    ASSERT_EQ(own.size(), 1u);
    ASSERT_EQ(others.size(), 1u);
    EXPECT_LT(10 * own[0].triangles, 7 * others[0].triangles);
    EXPECT_LE(own[0].largest_error_px, 1.0);
}

TEST(SurfaceDetail, PixelErrorZeroIsTheOriginal) {
    const View view = corner_view(0);
    const choose::Cut cut = choose::choose_cut(built(), view);
    EXPECT_TRUE(choose::surface_details(built(), view, cut).empty());
}

TEST(SurfaceDetail, APinHoldsForAllChunks) {
    Model model = built();
    model.root = models::add_group(model, "pinned", {{0, {}, "terrain"}});
    auto pinned =
        std::make_shared<Assembly>(model.objects[model.root].representations[0].assembly());
    pinned->placements[0].coarsest = pinned->placements[0].finest = 2;
    model.objects[model.root].representations[0].payload =
        std::shared_ptr<const Assembly>(std::move(pinned));
    summarize_assemblies(model, bottom_up(model));
    const View view = corner_view(1);
    const choose::Cut cut = choose::choose_cut(model, view);
    ASSERT_EQ(cut.chosen.size(), 1u);
    EXPECT_EQ(cut.nodes[cut.chosen[0]].lod, 2u);
    EXPECT_TRUE(choose::surface_details(model, view, cut).empty());
}

TEST(SurfaceDetail, WhatThePictureDoesNotShowIsCoarse) {
    View view = corner_view(2);
    view.camera.position.x = view.camera.position.y = 0.55 * kSize;  // half of it lies behind
    const choose::Cut cut = choose::choose_cut(built(), view);
    const auto all = choose::surface_details(built(), view, cut);
    view.modifiers.off_screen = OffScreen::Shadows;
    const auto shown = choose::surface_details(built(), view, choose::choose_cut(built(), view));
    ASSERT_EQ(shown.size(), 1u);
    EXPECT_LT(shown[0].triangles, all[0].triangles);
}

TEST(SurfaceDetail, ManyCopiesAreDrawnByOneLevelWhereThatCostsLess) {
    Model model = built();
    constexpr int kCopies = 40;
    std::vector<Placement> placements;
    placements.reserve(kCopies);
    for (int i = 0; i < kCopies; ++i)
        placements.push_back({0, models::moved(kSize * i, 0, 0), "copy " + std::to_string(i)});
    model.root = models::add_group(model, "copies", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    View view = corner_view(0.1);
    const auto details = choose::surface_details(model, view, choose::choose_cut(model, view));
    EXPECT_TRUE(details.empty());
}

TEST(SurfaceDetail, TheStoreGivesChunksBack) {
    const segment::Store store(scratch("store"));
    store.write(built(), {});
    const Model read = store.read();
    for (size_t lod = 0; lod < read.objects[0].representations.size(); ++lod) {
        const auto& before = built().objects[0].representations[lod].surface;
        const auto& after = read.objects[0].representations[lod].surface;
        ASSERT_EQ(before == nullptr, after == nullptr) << lod;
        if (before == nullptr)
            continue;
        EXPECT_EQ(before->hash, after->hash);
        EXPECT_EQ(hash_of(*after), after->hash);
        EXPECT_EQ(before->errors, after->errors);
        EXPECT_EQ(after->tree, read.objects[0].representations[0].surface->tree);
    }
    const View view = corner_view(2);
    const auto wanted = choose::surface_details(built(), view, choose::choose_cut(built(), view));
    const auto found = choose::surface_details(read, view, choose::choose_cut(read, view));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].lods, wanted[0].lods);
}

TEST(SurfaceDetail, ABuildThatFindsItsLevelsFindsTheirChunks) {
    const segment::Store store(scratch("store"));
    Model first = bare();
    EXPECT_EQ(build(first, store), 1u);
    Model second = bare();
    EXPECT_EQ(build(second, store), 0u);
    for (size_t lod = 0; lod < first.objects[0].representations.size(); ++lod) {
        const auto& before = first.objects[0].representations[lod].surface;
        const auto& after = second.objects[0].representations[lod].surface;
        ASSERT_EQ(before == nullptr, after == nullptr) << lod;
        EXPECT_TRUE(before == nullptr || before->hash == after->hash);
    }
}

TEST(SurfaceDetail, DamagedChunksAreDrawnWholeAndMadeAgain) {
    const segment::Store store(scratch("store"));
    store.write(built(), {});
    size_t damaged = 0;
    for (const auto& entry : std::filesystem::directory_iterator(store.folder() / "r")) {
        if (entry.path().extension() != ".chunks")
            continue;
        std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(200);
        file.write("\xff\xff\xff\xff", 4);
        ++damaged;
    }
    EXPECT_GT(damaged, 3u);
    const Model read = store.read();
    const View view = corner_view(2);
    EXPECT_TRUE(choose::surface_details(read, view, choose::choose_cut(read, view)).empty());
    Model again = bare();
    EXPECT_EQ(build(again, store), 1u);
    EXPECT_EQ(choose::surface_details(again, view, choose::choose_cut(again, view)).size(), 1u);
    Model last = bare();
    EXPECT_EQ(build(last, store), 0u);
}

TEST(SurfaceDetail, ChunksOutOfTheirRangesAreRefused) {
    const SurfaceLevel& good = *built().objects[0].representations[1].surface;
    const Mesh& mesh = built().objects[0].representations[1].mesh();
    const auto refused = [&](const auto& change) {
        SurfaceLevel bad = good;
        change(bad);
        EXPECT_THROW(check(bad, mesh.positions.size(), mesh.triangles.size()), Error);
    };
    EXPECT_NO_THROW(check(good, mesh.positions.size(), mesh.triangles.size()));
    refused([](SurfaceLevel& bad) { bad.shift = 40; });
    refused([](SurfaceLevel& bad) { bad.before.back() += 1; });
    refused([](SurfaceLevel& bad) { bad.before[1] = ~uint32_t{0}; });
    ASSERT_EQ(good.errors.size(), good.nodes());
    refused([](SurfaceLevel& bad) { bad.errors.pop_back(); });
    refused([](SurfaceLevel& bad) { bad.errors[1] = -1; });
    refused([](SurfaceLevel& bad) { bad.errors[1] = std::nan(""); });
    refused([](SurfaceLevel& bad) { bad.errors[1] = std::numeric_limits<double>::infinity(); });
    refused([](SurfaceLevel& bad) { bad.touches[0] = 0xffff; });
    refused([](SurfaceLevel& bad) { bad.corners.back().vertex = ~uint32_t{0}; });
    refused([](SurfaceLevel& bad) { bad.corners[0].point = ~uint32_t{0}; });
    refused([](SurfaceLevel& bad) { bad.points[3].touch = ~uint32_t{0}; });
    refused([](SurfaceLevel& bad) {  // two that are each other's heirs
        bad.points[0].dies = bad.points[1].dies = 4;
        bad.points[0].heir = 1;
        bad.points[1].heir = 0;
    });
    refused([](SurfaceLevel& bad) {
        auto tree = std::make_shared<SurfaceTree>(*bad.tree);
        tree->planes.pop_back();
        bad.tree = tree;
    });
}

}  // namespace
