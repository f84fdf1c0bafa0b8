// SPDX-License-Identifier: GPL-3.0-or-later
// Guards meshes of many loose parts: clusters of what is near, nothing lost or changed, one object.
#include "base/parallel.h"
#include "base/random.h"
#include "choose/cut.h"
#include "group/loose_parts.h"
#include "hierarchy/hierarchy_build.h"
#include "scenes/small_models.h"
#include "scratch.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <set>

using namespace lodestone;

namespace {

constexpr size_t kHuts = 200;

/// Triangles with all that belongs to them, to be compared bit by bit.
using Drawn = std::multiset<std::vector<float>>;

void add_drawn(Drawn& drawn, const Mesh& mesh, const std::vector<uint32_t>& materials) {
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const uint16_t slot = mesh.slot(i);
        std::vector<float> one{
            static_cast<float>(materials.at(slot < materials.size() ? slot : 0))};
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t v = mesh.triangles[i][corner];
            const auto add = [&](const auto& values) {
                if (values.empty())
                    return;
                for (int k = 0; k < values[v].length(); ++k)
                    one.push_back(values[v][k]);
            };
            add(mesh.positions);
            add(mesh.normals);
            add(mesh.uvs);
            add(mesh.colors);
        }
        drawn.insert(std::move(one));
    }
}

Drawn drawn_by(const Model& model) {
    Drawn drawn;
    for_each_occurrence(
        model,
        [&](const Occurrence& occurrence) {
            const Representation& finest = model.objects[occurrence.object].representations[0];
            EXPECT_EQ(occurrence.world.linear, glm::dmat3(1.0));
            EXPECT_EQ(occurrence.world.offset, glm::dvec3(0.0));
            add_drawn(drawn, finest.mesh(), finest.materials);
        },
        OccurrenceUnit::Parts);
    return drawn;
}

/// Balls (320 triangles each) strewn over a square, in one mesh with all a mesh may have.
Mesh strewn(size_t count, double spread = 100) {
    Mesh mesh;
    for (size_t i = 0; i < count; ++i) {
        Mesh ball = shapes::sphere(0.5, 2);
        ball.uvs.assign(ball.positions.size(), glm::vec2(0.25f, 0.125f * static_cast<float>(i)));
        ball.colors.assign(ball.positions.size(), glm::vec4(0.5f, 0.25f, 1, 1));
        ball.slots.assign(ball.triangles.size(), static_cast<uint16_t>(i % 3));
        const glm::dvec3 at(spread * PcgRandom(1, i).uniform(), spread * PcgRandom(2, i).uniform(),
                            0);
        append(mesh, ball, models::moved(at.x, at.y, at.z));
    }
    return mesh;
}

Model model_of(Mesh mesh, Material material = {}) {
    Model model;
    model.root = models::add_leaf(model, "town", std::move(mesh), std::move(material));
    for (int i = 1; i < 3; ++i) {
        model.objects[0].representations[0].materials.push_back(
            static_cast<uint32_t>(model.materials.size()));
        model.materials.push_back(models::colored("more", {0.1 * i, 0.5, 0.5}));
    }
    summarize(model.objects[0].representations[0], model);
    model.root = models::add_group(model, "scene", {{0, Affine{}, "Town"}});
    summarize_assemblies(model, bottom_up(model));
    return model;
}

group::LooseReport split(Model& model, bool always = false, size_t fewest = 2048) {
    group::LooseOptions options;
    options.always = always;
    options.fewest_triangles = fewest;
    options.most_clusters = 256;
    const group::LooseReport report =
        group::split_loose_parts(model, group::leaves_of(model), options, {});
    summarize_assemblies(model, bottom_up(model));
    return report;
}

std::set<std::string> uids_of(const Model& model) {
    std::set<std::string> uids;
    for (const ObjectIndex index : bottom_up(model))
        EXPECT_TRUE(uids.insert(model.objects[index].uid).second);
    return uids;
}

size_t part_count(const Mesh& mesh) {
    const std::vector<uint32_t> parts = group::loose_parts(mesh);
    return std::set<uint32_t>(parts.begin(), parts.end()).size();
}

}  // namespace

TEST(LooseParts, NothingIsNoPart) {
    EXPECT_TRUE(group::loose_parts({}).empty());
    Model empty;
    EXPECT_EQ(group::split_loose_parts(empty, {}, {}, {}).split, 0u);
    Model model = model_of({});
    EXPECT_EQ(split(model, true).split, 0u);
}

TEST(LooseParts, WhatSharesEdgesIsOnePart) {
    EXPECT_EQ(part_count(shapes::cube()), 1u);
    EXPECT_EQ(part_count(shapes::sphere(1, 2)), 1u);
    Mesh two = shapes::cube();
    append(two, shapes::cube(), models::moved(3, 0, 0));
    EXPECT_EQ(group::loose_parts(two).front(), 0u);
    EXPECT_EQ(group::loose_parts(two).back(), 1u);
    EXPECT_EQ(part_count(two), 2u);
}

TEST(LooseParts, BoxesThatTouchFaceToFaceArePartsOfTheirOwn) {
    Mesh wall = shapes::box({0, 0, 0}, {1, 1, 1});
    append(wall, shapes::box({1, 0, 0}, {2, 1, 1}), {});
    append(wall, shapes::box({0, 0, 1}, {1, 1, 2}), {});
    EXPECT_EQ(part_count(wall), 3u);
}

TEST(LooseParts, ASheetWithTwoSidesIsOnePartAndSoIsAFin) {
    Mesh sheet = shapes::terrain(4);
    const size_t count = sheet.triangles.size();
    for (size_t i = 0; i < count; ++i) {
        const Triangle t = sheet.triangles[i];
        sheet.triangles.emplace_back(t.x, t.z, t.y);
    }
    EXPECT_EQ(part_count(sheet), 1u);
    Mesh fin;  // three triangles on one edge
    fin.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
    fin.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    EXPECT_EQ(part_count(fin), 1u);
}

TEST(LooseParts, EveryTriangleStaysExactlyWhatItWas) {
    Model model = model_of(strewn(kHuts));
    Drawn before;
    const Representation finest = model.objects[0].representations[0];
    add_drawn(before, finest.mesh(), finest.materials);
    const group::LooseReport report = split(model);
    EXPECT_EQ(report.split, 1u);
    EXPECT_EQ(report.parts, kHuts);
    EXPECT_GT(report.made, 20u);
    EXPECT_EQ(drawn_by(model), before);
    for (const ObjectIndex index : bottom_up(model)) {
        if (model.objects[index].group()) {
            EXPECT_LE(model.objects[index].representations[0].assembly().placements.size(), 64u);
        }
    }
}

TEST(LooseParts, ItIsOneObjectAndOneOccurrenceAsBefore) {
    Model model = model_of(strewn(kHuts));
    const ModelTotals before = totals(model);
    split(model);
    const ModelTotals after = totals(model);
    EXPECT_TRUE(model.objects[0].made_of_parts);
    EXPECT_EQ(model.objects[0].uid, "town");
    EXPECT_EQ(after.objects, before.objects);
    EXPECT_EQ(after.occurrences, before.occurrences);
    EXPECT_EQ(after.triangles_placed, before.triangles_placed);
    EXPECT_EQ(after.triangles_unique, before.triangles_unique);
    size_t visited = 0;
    for_each_occurrence(model, [&](const Occurrence& occurrence) {
        EXPECT_EQ(occurrence.object, 0u);
        EXPECT_EQ(occurrence.path, "Town");
        ++visited;
    });
    EXPECT_EQ(visited, 1u);
    EXPECT_EQ(split(model).split, 0u);  // a second time there is nothing to do
}

TEST(LooseParts, ClustersAreOfWhatIsNear) {
    Model model = model_of(strewn(kHuts));
    split(model);
    double sum = 0;
    size_t clusters = 0;
    for (const ObjectIndex index : group::leaves_of(model)) {
        sum += model.objects[index].bound().radius;
        ++clusters;
    }
    // 100 m squared over so many clusters, each a square
    const double square = 100 / std::sqrt(static_cast<double>(clusters)) * std::sqrt(0.5);
    EXPECT_LT(sum / static_cast<double>(clusters), 1.2 * square);
}

TEST(LooseParts, AutomaticallyOnlyWhereItPays) {
    Model few = model_of(strewn(60));  // 19,200 triangles
    EXPECT_EQ(split(few).split, 0u);
    EXPECT_EQ(split(few, true).split, 1u);
    Model near = model_of(strewn(kHuts, 2));  // all as large as the whole, nearly
    EXPECT_EQ(split(near).split, 0u);
    Mesh statue = shapes::sphere(50, 6);  // most triangles are in one part
    append(statue, strewn(70), {});
    Model pebbles = model_of(std::move(statue));
    EXPECT_EQ(split(pebbles).split, 0u);
    Model one = model_of(shapes::sphere(1, 3));
    EXPECT_EQ(split(one, true).split, 0u);
}

TEST(LooseParts, WhatLiesAcrossEverythingIsNotTakenIntoTheClusters) {
    Mesh mesh = strewn(kHuts);
    append(mesh, shapes::box({0, 0, -1}, {100, 100, -0.9}), {});
    Model model = model_of(std::move(mesh));
    split(model);
    size_t wide = 0;
    for (const ObjectIndex index : group::leaves_of(model)) {
        const Object& leaf = model.objects[index];
        if (leaf.bound().radius > 50) {
            ++wide;
            EXPECT_EQ(leaf.representations[0].mesh().triangles.size(), 12u);
        }
    }
    EXPECT_EQ(wide, 1u);
}

TEST(LooseParts, WhatDeformsOrRefractsStaysOneMesh) {
    Model model = model_of(strewn(kHuts));
    model.objects[0].deforms = true;
    EXPECT_EQ(split(model, true).split, 0u);
    Material glass;
    glass.transmission = 1;
    Model bottles = model_of(strewn(kHuts), glass);
    EXPECT_EQ(split(bottles, true).split, 0u);
}

TEST(LooseParts, TheSameClustersOnEveryRunAndAnyNumberOfThreads) {
    Model first = model_of(strewn(kHuts));
    Model second = first;
    split(first);
    const ThreadLimit one(1);
    split(second);
    EXPECT_EQ(uids_of(first), uids_of(second));
    EXPECT_EQ(first.objects[0].source_hash, second.objects[0].source_hash);
}

TEST(LooseParts, ThePartThatMovesChangesItsOwnClusterAlone) {
    Mesh mesh = strewn(kHuts);
    Model before = model_of(mesh);
    for (uint32_t i = 0; i < 162; ++i)  // the first ball, by a hand's breadth
        mesh.positions[i].z += 0.125f;
    Model after = model_of(std::move(mesh));
    split(before);
    split(after);
    std::map<Hash, int> hashes;
    for (const ObjectIndex index : group::leaves_of(before))
        hashes[before.objects[index].source_hash] += 1;
    size_t fresh = 0;
    for (const ObjectIndex index : group::leaves_of(after))
        fresh += hashes.count(after.objects[index].source_hash) == 0 ? 1 : 0;
    EXPECT_EQ(fresh, 1u);
}

TEST(LooseParts, PartsInOnePlaceAreCutByTheirNumbers) {
    Mesh mesh;
    for (int i = 0; i < 40; ++i)
        append(mesh, shapes::sphere(1 + 0.001 * i, 2), {});
    Model model = model_of(std::move(mesh));
    EXPECT_EQ(split(model, true).parts, 40u);
    EXPECT_EQ(totals(model).triangles_placed, 40u * 320u);
}

TEST(LooseParts, MeshesThatAreBrokenAreDrawnAsTheyAre) {
    Mesh mesh = strewn(40);
    mesh.triangles[7] = {0, 0, 0};
    mesh.triangles[9] = {5, 5, 8};
    mesh.slots[3] = 77;
    Model flat = model_of(mesh);
    const uint64_t count = totals(flat).triangles_placed;
    Drawn before;
    add_drawn(before, flat.objects[0].representations[0].mesh(),
              flat.objects[0].representations[0].materials);
    EXPECT_EQ(split(flat, true).split, 1u);
    EXPECT_EQ(totals(flat).triangles_placed, count);
    EXPECT_EQ(drawn_by(flat), before);
    mesh.positions[3].x = std::numeric_limits<float>::quiet_NaN();
    Model broken = model_of(mesh);
    split(broken, true);
    EXPECT_EQ(totals(broken).triangles_placed, count);
    mesh.positions[3].x = 3e38f;
    mesh.positions[900].y = -3e38f;
    Model huge = model_of(mesh);
    EXPECT_EQ(split(huge, true).split, 1u);
    const ObjectIndex none = 99;
    EXPECT_THROW(group::split_loose_parts(huge, std::span(&none, 1), {}, {}), Error);
}

TEST(LooseParts, CancelledItIsAsBefore) {
    Model model = model_of(strewn(kHuts));
    const int32_t cancel = 1;
    const Job job(&cancel, nullptr, nullptr);
    EXPECT_THROW(group::split_loose_parts(model, group::leaves_of(model), {}, job), Error);
    EXPECT_EQ(model.objects.size(), 2u);
    EXPECT_FALSE(model.objects[0].group());
}

TEST(LooseParts, WhatIsNearDoesNotForceWhatIsFarToBeFine) {
    Model whole = model_of(strewn(24, 1000));
    Model parts = whole;
    split(parts, true, 640);
    hierarchy::BuildSettings settings;
    settings.rays = 64;
    settings.samples = 64;
    const std::filesystem::path folder = own_scratch() / "loose_parts";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    Problems problems;
    hierarchy::build_hierarchy(whole, segment::Store(folder / "whole"), settings, problems, {});
    hierarchy::build_hierarchy(parts, segment::Store(folder / "parts"), settings, problems, {});
    EXPECT_TRUE(problems.empty());
    const Model stored = segment::Store(folder / "parts").read();
    EXPECT_EQ(totals(stored).occurrences, 1u);
    EXPECT_EQ(totals(stored).objects, 2u);
    View view;
    view.camera.position = {500, 500, 1};
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 0.5, 0};
    view.width = 640;
    view.height = 320;
    view.pixel_error = 0;
    EXPECT_EQ(choose::choose_cut(stored, view).triangles, totals(whole).triangles_placed);
    view.pixel_error = 1;
    EXPECT_LT(2 * choose::choose_cut(stored, view).triangles,
              choose::choose_cut(whole, view).triangles);
    const hierarchy::BuildReport again =
        hierarchy::build_hierarchy(parts, segment::Store(folder / "parts"), settings, problems, {});
    EXPECT_EQ(again.built, 0u);
}
