// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what lies on, behind or beside something else: lines on roads, lamps in globes, tiles.
#include "choose/cut.h"
#include "hierarchy/flattened_group.h"
#include "hierarchy/hierarchy_build.h"
#include "hierarchy/run/stand_in_surroundings.h"
#include "measure/deviation/surface_deviation.h"
#include "scenes/built_models.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

class Layers : public WithRays {};

/// A road of 8 x 6 m sunk by 8 cm between two kerbs, in steps along its length.
Mesh road() {
    constexpr int kSteps = 8;
    Mesh mesh;
    const std::vector<glm::vec2> profile{{-3, 0},         {-2.6f, 0}, {-2.55f, -0.08f},
                                         {2.55f, -0.08f}, {2.6f, 0},  {3, 0}};
    for (int step = 0; step <= kSteps; ++step) {
        for (const glm::vec2& at : profile)
            mesh.positions.emplace_back(static_cast<float>(step) - 4.0f, at.x, at.y);
    }
    const auto width = static_cast<uint32_t>(profile.size());
    for (uint32_t step = 0; step < kSteps; ++step) {
        for (uint32_t i = 0; i + 1 < width; ++i) {
            const uint32_t a = step * width + i;
            mesh.triangles.push_back({a, a + width, a + 1});
            mesh.triangles.push_back({a + 1, a + width, a + width + 1});
        }
    }
    return mesh;
}

/// A white line across the road, 4 mm above it.
Mesh line() {
    Mesh mesh;
    mesh.positions = {{-0.5f, -2.5f, -0.076f},
                      {0.5f, -2.5f, -0.076f},
                      {0.5f, 2.5f, -0.076f},
                      {-0.5f, 2.5f, -0.076f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

View from_above(double pixel) {
    View view;
    view.camera.orthographic = true;
    view.camera.position = {0, 0, 50};
    view.camera.direction = {0, 0, -1};
    view.camera.right = {10, 0, 0};
    view.camera.up = {0, 10, 0};
    view.width = view.height = static_cast<int>(10 / pixel);
    return view;
}

}  // namespace

TEST_F(Layers, StartLineOnATrackDoesNotVanishAtOnePixel) {
    Model model;
    const ObjectIndex track = models::add_leaf(model, "track", road());
    const ObjectIndex start =
        models::add_leaf(model, "start", line(), models::colored("white", {0.9, 0.9, 0.9}));
    model.root =
        models::add_group(model, "race", {{track, Affine{}, "track"}, {start, Affine{}, "start"}});
    build_in(model, "race");
    const std::vector<uint64_t> uses = hierarchy::uses_of(model);
    hierarchy::OpenedGroup opened(model, model.root, uses);
    for (const double pixel : {0.05, 0.1, 0.2}) {
        const hierarchy::FlattenedGroup shown =
            hierarchy::flatten_group(opened, pixel,
                                     [](const Representation& r) {
                                         return std::get<std::shared_ptr<const Mesh>>(r.payload);
                                     },
                                     {});
        const ray::MeshScene scene(shown.mesh);
        int white = 0;
        for (int i = 0; i < 100; ++i) {
            const int row = i / 10;
            const glm::dvec3 from(0.09 * (i % 10) - 0.4, 0.45 * row - 2.0, 1);
            const ray::RayHit hit = scene.first_hit(from, {0, 0, -1});
            if (hit.hit && shown.materials[shown.mesh.slot(hit.triangle)].name == "white")
                ++white;
        }
        EXPECT_GE(white, 95) << "at " << pixel << " m";
    }
    EXPECT_LE(choose::choose_cut(model, from_above(0.2)).largest_error_px, 1);
}

TEST_F(Layers, FlatThingIsAsWrongAsItIsOffWhereNothingLiesOnIt) {
    const auto largest_error = [](const Mesh* on_it, const glm::dvec3& at) {
        Model model;
        std::vector<Placement> placements{{models::add_leaf(model, "road", road()), {}, "road"}};
        if (on_it != nullptr)
            placements.push_back({models::add_leaf(model, "other", *on_it),
                                  models::moved(at.x, at.y, at.z), "other"});
        model.objects[0].role = ObjectRole::Ordinary;  // a ground would be no box in any case
        model.root = models::add_group(model, "scene", std::move(placements));
        build_in(model, text("scene ", at.x, " ", at.z));
        return model.objects[0].representations.back().summary.error;
    };
    const Mesh white = line();
    const Mesh hall = shapes::box({0, 0, 0}, {2, 5, 1});
    const double alone = largest_error(nullptr, {});
    EXPECT_NEAR(alone, 0.08, 0.001);
    EXPECT_NEAR(largest_error(&white, {0.1, 0, 0}) / alone, 16, 1e-6);
    EXPECT_DOUBLE_EQ(largest_error(&white, {0.2, 0, 3}), alone) << "far above";
    EXPECT_DOUBLE_EQ(largest_error(&white, {9, 0, 0}), alone) << "beside";
    EXPECT_DOUBLE_EQ(largest_error(&hall, {-1, -2.5, -0.08}), alone)
        << "what stands on it sticks out";
}

TEST_F(Layers, WhatComesToLieOnAFlatThingBuildsItAgain) {
    Model model;
    const ObjectIndex track = models::add_leaf(model, "track", road());
    const ObjectIndex start = models::add_leaf(model, "start", line());
    const auto scene_of = [&](double height) {
        const ObjectIndex root = models::add_group(
            model, "race", {{track, {}, "track"}, {start, models::moved(0, 0, height), "start"}});
        return root;
    };
    const segment::Store store(scratch("rebuilt"));
    const auto built = [&](ObjectIndex root) {
        model.root = root;
        summarize_assemblies(model, bottom_up(model));
        Problems problems;
        const uint64_t stale = hierarchy::estimate_build(model, store, {}).built;
        const hierarchy::BuildReport report =
            hierarchy::build_hierarchy(model, store, {}, problems, {});
        EXPECT_EQ(stale, report.built);
        return report.built;
    };
    const ObjectIndex above = scene_of(3);
    const ObjectIndex upon = scene_of(0);
    EXPECT_EQ(built(above), 3u);
    EXPECT_EQ(built(above), 0u);
    EXPECT_EQ(built(upon), 3u) << "both leaves, and their group";
    EXPECT_EQ(built(upon), 0u);
}

TEST_F(Layers, BulbInAGlassGlobeIsSeenFromOutside) {
    Mesh lamp = shapes::sphere(1, 3);
    const size_t of_globe = lamp.triangles.size();
    append(lamp, shapes::sphere(0.5, 2), {});
    lamp.slots.assign(lamp.triangles.size(), 1);
    std::fill_n(lamp.slots.begin(), of_globe, uint16_t{0});
    Material glass = models::colored("glass", {0.9, 0.9, 0.9});
    image::TexelCache texels;
    const auto off_without_bulb = [&](double transmission) {
        glass.transmission = transmission;
        const std::vector<Material> materials{glass, models::colored("bulb", {0.8, 0.1, 0.1})};
        const auto skin = std::make_shared<const ray::MeshSkin>(materials, texels);
        measure::LookPalette looks;
        const std::vector<uint16_t> of_lamp = looks.of(lamp, materials);
        Mesh globe = lamp;
        globe.triangles.resize(of_globe);
        globe.slots.resize(of_globe);
        return measure::DeviationReference(lamp, {2048, 2048, 1}, {of_lamp, &looks, skin})
            .of(globe, {looks.of(globe, materials), &looks, skin})
            .error;
    };
    EXPECT_LT(off_without_bulb(0), 0.05) << "nobody sees into a ball of porcelain";
    EXPECT_GT(off_without_bulb(1), 0.4);
}

TEST_F(Layers, BulbsStayInAGroupOfGlassGlobes) {
    Model model;
    Material glass = models::colored("glass", {0.9, 0.9, 0.9});
    glass.transmission = 1;
    const ObjectIndex globe = models::add_leaf(model, "globe", shapes::sphere(1, 2), glass);
    const ObjectIndex bulb = models::add_leaf(model, "bulb", shapes::sphere(0.5, 2));
    model.root =
        models::add_group(model, "lamp", {{globe, Affine{}, "globe"}, {bulb, Affine{}, "bulb"}});
    build_in(model, "lamp");
    size_t meshes = 0;
    for (const Representation& made : model.objects[model.root].representations) {
        if (made.summary.kind != Kind::Mesh)
            continue;
        ++meshes;
        EXPECT_EQ(made.materials.size(), 2u);
        std::array<size_t, 2> of_slot{};
        for (size_t i = 0; i < made.mesh().triangles.size(); ++i)
            ++of_slot[std::min<uint16_t>(made.mesh().slot(i), 1)];
        EXPECT_GT(std::min(of_slot[0], of_slot[1]), 0u) << made.summary.error;
    }
    EXPECT_GT(meshes, 0u);
}

TEST_F(Layers, HouseUnderARoofOfBoxesIsNotAsWrongAsItIsLarge) {
    // Boxes cannot get simpler: no error of the other children makes the whole fit a budget.
    Model model;
    const ObjectIndex tile =
        models::add_leaf(model, "tile", shapes::box({0, 0, 0}, {0.3, 0.4, 0.03}));
    Mesh two_wings = shapes::box({0, 0, 0}, {6, 1, 2});
    append(two_wings, shapes::box({0, 1, 0}, {1, 4, 2}), {});
    const ObjectIndex walls = models::add_leaf(model, "walls", two_wings);
    std::vector<Placement> placements{{walls, Affine{}, "walls"}};
    for (int i = 0; i < 200; ++i) {
        const int row = i / 20;
        placements.push_back(
            {tile, models::moved(0.31 * (i % 20), 0.41 * row, 2 + 0.02 * (i % 2)), "tile"});
    }
    model.root = models::add_group(model, "house", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    build_in(model, "house");
    const Object& house = model.objects[model.root];
    const double radius = house.bound().radius;
    const std::vector<uint64_t> uses = hierarchy::uses_of(model);
    hierarchy::OpenedGroup opened(model, model.root, uses);
    EXPECT_LE(hierarchy::error_to_flatten(opened, 1000, 40000, {}), radius / 32);
    ASSERT_GE(house.representations.size(), 2u);
    double least = radius;
    for (size_t lod = 1; lod < house.representations.size(); ++lod)
        least = std::min(least, house.representations[lod].summary.error);
    EXPECT_LT(least, radius / 8);
}
