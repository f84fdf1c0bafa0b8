// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what viewers keep of a cut: every triangle once, keys that tell what has changed.
#include "base/parallel.h"
#include "scenes/small_models.h"
#include "view/viewer_batches.h"

#include <gtest/gtest.h>
#include <set>

using namespace lodestone;
using models::add_level;
using models::view_from;
using view::BatchMesh;
using view::ViewerBatch;

namespace {

/// Balls of 1280 triangles in pairs, with levels of 80 and 20.
Model balls(int count) {
    Model model = models::row_of_balls(count);
    add_level(model, 0, 0.01, shapes::sphere(1, 1));
    add_level(model, 0, 0.1, shapes::sphere(1, 0));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

std::set<Hash> keys_of(const std::vector<ViewerBatch>& batches) {
    std::set<Hash> keys;
    for (const ViewerBatch& batch : batches)
        keys.insert(batch.key);
    return keys;
}

uint64_t triangles_of(const Model& model, const choose::Cut& cut,
                      const std::vector<ViewerBatch>& batches) {
    uint64_t triangles = 0;
    for (const ViewerBatch& batch : batches) {
        const BatchMesh mesh = view::mesh_of(model, cut, batch);
        EXPECT_EQ(mesh.triangles.size(), batch.triangles);
        EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
        EXPECT_EQ(mesh.colors.size(), mesh.positions.size());
        for (const Triangle& triangle : mesh.triangles)
            EXPECT_LT(std::max({triangle.x, triangle.y, triangle.z}), mesh.positions.size());
        triangles += mesh.triangles.size();
    }
    return triangles;
}

}  // namespace

TEST(Batches, EmptyCutHasNone) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    EXPECT_TRUE(view::batches_of(model, choose::choose_cut(model, View{})).empty());
}

TEST(Batches, OneTriangleIsWhereItIsPlacedInItsColor) {
    Model model;
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.triangles = {{0, 1, 2}};
    const ObjectIndex leaf = models::add_leaf(model, "t", mesh, models::colored("red", {1, 0, 0}));
    Affine place = models::moved(5, 0, 0);
    place.linear = glm::dmat3(2.0);
    place.linear[2] = {0, 0, -2};  // mirrored, so that normals point the other way
    model.root = models::add_group(model, "g", {{leaf, place, "t"}});
    summarize_assemblies(model, bottom_up(model));
    const choose::Cut cut = choose::choose_cut(model, view_from(10));
    const std::vector<ViewerBatch> batches = view::batches_of(model, cut);
    ASSERT_EQ(batches.size(), 1u);
    const BatchMesh made = view::mesh_of(model, cut, batches[0]);
    ASSERT_EQ(made.positions.size(), 3u);
    EXPECT_EQ(made.positions[1], glm::vec3(7, 0, 0));
    EXPECT_EQ(std::abs(made.normals[0][2]), 32767);
    EXPECT_EQ(made.normals[0][3], 0);
    EXPECT_EQ(made.colors[0], (std::array<uint8_t, 4>{255, 0, 0, 255}));
}

TEST(Batches, EachTriangleIsInExactlyOne) {
    const Model model = balls(512);
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    const std::vector<ViewerBatch> batches = view::batches_of(model, cut);
    EXPECT_GT(batches.size(), 1u);
    EXPECT_LT(batches.size(), 16u);  // not one for each ball or pair
    EXPECT_EQ(triangles_of(model, cut, batches), uint64_t{512} * 1280);
    EXPECT_EQ(keys_of(batches).size(), batches.size());
}

TEST(Batches, MeshLargerThanABatchIsCutUp) {
    Model model;
    const ObjectIndex leaf = models::add_leaf(model, "big", shapes::sphere(1, 7));  // 327,680
    model.root = models::add_group(model, "g", {{leaf, Affine{}, "big"}});
    summarize_assemblies(model, bottom_up(model));
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    const std::vector<ViewerBatch> batches = view::batches_of(model, cut);
    ASSERT_EQ(batches.size(), 2u);
    for (const ViewerBatch& batch : batches)
        EXPECT_LE(batch.triangles, view::kMostInBatch);
    EXPECT_EQ(triangles_of(model, cut, batches), 327'680u);
}

TEST(Batches, TheSameCutAgainHasTheSameKeysAndAStepChangesFew) {
    const Model model = balls(512);
    View view = view_from(3, 1);
    const std::set<Hash> before = keys_of(view::batches_of(model, choose::choose_cut(model, view)));
    EXPECT_EQ(keys_of(view::batches_of(model, choose::choose_cut(model, view))), before);
    view.camera.position.x += 4;
    size_t kept = 0;
    const std::set<Hash> after = keys_of(view::batches_of(model, choose::choose_cut(model, view)));
    for (const Hash key : after)
        kept += before.count(key);
    EXPECT_GT(2 * kept, after.size());
    EXPECT_LT(kept, after.size());
}

TEST(Batches, ColorsOfTheirOwnReplaceMaterialsAndChangeKeys) {
    const Model model = balls(4);
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    const std::vector<glm::dvec3> colors(cut.chosen.size(), {0, 0, 1});
    const std::vector<ViewerBatch> plain = view::batches_of(model, cut);
    const std::vector<ViewerBatch> painted = view::batches_of(model, cut, colors);
    ASSERT_EQ(plain.size(), painted.size());
    EXPECT_NE(plain[0].key, painted[0].key);
    const BatchMesh mesh = view::mesh_of(model, cut, painted[0], colors);
    EXPECT_EQ(mesh.colors[0], (std::array<uint8_t, 4>{0, 0, 255, 255}));
    EXPECT_THROW(view::batches_of(model, cut, {{1, 1, 1}}), Error);
}

TEST(Batches, SlotsGlassAndGlowAreTold) {
    Model model;
    Material glass = models::colored("glass", {1, 1, 1});
    glass.transmission = 1;
    Material glow = models::colored("glow", {0, 0, 0});
    glow.emission = {0, 4, 0};
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 1, 3}};
    mesh.slots = {0, 1, 7};  // the last has no material of its own
    const ObjectIndex leaf = models::add_leaf(model, "l", mesh, glass);
    model.materials.push_back(glow);
    model.objects[leaf].representations[0].materials.push_back(1);
    model.root = models::add_group(model, "g", {{leaf, Affine{}, "l"}});
    summarize_assemblies(model, bottom_up(model));
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    const BatchMesh made = view::mesh_of(model, cut, view::batches_of(model, cut).front());
    const uint32_t first = made.triangles[0].x;
    const uint32_t second = made.triangles[1].x;
    EXPECT_EQ(made.colors[first][3], 64);
    EXPECT_EQ(made.normals[first][3], 0);
    EXPECT_EQ(made.normals[first][2], 0);  // flat
    EXPECT_EQ(made.colors[second], (std::array<uint8_t, 4>{0, 255, 0, 255}));
    EXPECT_EQ(made.normals[second][3], 32767);
    EXPECT_EQ(made.positions.size(), 9u);  // no vertex serves two slots
}

TEST(Batches, WhatCamerasDoNotSeeIsInNone) {
    Model model = balls(4);
    auto pair = std::make_shared<Assembly>(model.objects[1].representations[0].assembly());
    pair->placements[0].hidden = kCameraRays;
    model.objects[1].representations[0].payload = std::shared_ptr<const Assembly>(pair);
    summarize_assemblies(model, bottom_up(model));
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    EXPECT_EQ(triangles_of(model, cut, view::batches_of(model, cut)), uint64_t{2} * 1280);
}

TEST(Batches, MeshThatIsNotInMemoryIsNamedAsAnError) {
    Model model = balls(4);
    const choose::Cut cut = choose::choose_cut(model, view_from(1, 0));
    const std::vector<ViewerBatch> batches = view::batches_of(model, cut);
    model.objects[0].representations[0].payload = std::monostate();
    EXPECT_THROW(view::mesh_of(model, cut, batches[0]), Error);
}
