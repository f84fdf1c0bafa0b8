// SPDX-License-Identifier: GPL-3.0-or-later
// Guards hierarchies of things one can see through, and of textured things in one atlas.
#include "base/files.h"
#include "hierarchy/candidate_selection.h"
#include "hierarchy/flattened_group.h"
#include "hierarchy/hierarchy_build.h"
#include "hierarchy/object_stand_ins.h"
#include "measure/visible/visible_attributes.h"
#include "povray_export/scene/povray_costs.h"
#include "ray/mesh_scene.h"
#include "scenes/built_models.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"
#include "segment/store_json.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace lodestone;

namespace {

class Foliage : public WithRays {};

/// One leaf picture, half of it there: a disk of the right size.
PicturePtr disk() {
    return foliage::picture(64, [](double x, double y) {
        const double square = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5);
        return glm::dvec4(0.1, 0.5, 0.1, square < 0.5 / 3.14159265 ? 1 : 0);
    });
}

ObjectIndex add_tree(Model& model, int leaves, uint32_t sides) {
    const ObjectIndex tree = models::add_leaf(model, "tree", foliage::tree(leaves, sides),
                                              models::colored("bark", {0.2, 0.1, 0.05}));
    model.objects[tree].representations[0].materials.push_back(
        static_cast<uint32_t>(model.materials.size()));
    model.materials.push_back(foliage::leaf(disk()));
    summarize(model.objects[tree].representations[0], model);
    return tree;
}

std::vector<Material> materials_of(const Model& model, const Representation& representation) {
    std::vector<Material> out;
    for (const uint32_t index : representation.materials)
        out.push_back(model.materials[index]);
    return out;
}

/// Lists in order, every mesh as visible as the finest to a quarter; opaque solids only where the
/// whole is a few pixels large, and some mesh with at most half of the triangles before them.
void expect_see_through_levels(const Model& model, ObjectIndex index) {
    const Object& object = model.objects[index];
    ASSERT_TRUE(object.attributes);
    const double area = object.attributes->visible_area;
    double last = -1;
    uint64_t fewest = ~uint64_t{0};
    for (const Representation& level : object.representations) {
        EXPECT_GT(level.summary.error, last);
        last = level.summary.error;
        if (level.summary.kind == Kind::Assembly)
            continue;
        if (level.summary.kind != Kind::Mesh) {
            const std::vector<Material> shown = materials_of(model, level);
            if (std::all_of(shown.begin(), shown.end(), [](const Material& material) {
                    return material.alpha_mode == AlphaMode::Opaque;
                })) {
                EXPECT_GT(level.summary.error, object.bound().radius / 6)
                    << "an opaque blob hides what shines through";
            }
            continue;
        }
        fewest = std::min(fewest, level.summary.cost.triangles);
        const Mesh& mesh = level.mesh();
        EXPECT_NO_THROW(check(mesh));
        EXPECT_FALSE(mesh.uvs.empty());
        const double visible =
            measure::measure_visible(mesh, materials_of(model, level), {}).attributes.visible_area;
        EXPECT_NEAR(visible / area, 1, 0.3);
        std::cout << object.name << ": " << level.summary.cost.triangles << " triangles, error "
                  << level.summary.error << " m, visible " << visible / area << "\n";
    }
    // Children that others share may be cheaper than any mesh of all of them.
    if (!object.group()) {
        EXPECT_LT(2 * fewest, object.representations[0].summary.cost.triangles);
    }
}

}  // namespace

TEST_F(Foliage, TreeOfLeafCardsHasSeeThroughLevelsAndBlobsOnlyFarAway) {
    Model model;
    model.costs = povray::povray_costs();
    model.root = add_tree(model, 300, 24);
    build_in(model, "tree");
    const Object& tree = model.objects[model.root];
    EXPECT_GE(tree.representations.size(), 2u) << "the stem at least becomes simpler";
    expect_see_through_levels(model, model.root);
    // 300 cards of 0.06 m^2, half of each there, both sides; what hides behind others does not
    // count.
    EXPECT_LT(tree.attributes->visible_area, 300 * 0.06 + 2.6);
    EXPECT_GT(tree.attributes->visible_area, 0.5 * 300 * 0.06);
}

TEST_F(Foliage, TreeOfManyLeavesIsPrunedNearByAndAFewSolidsFarAway) {
    Model model;
    model.costs = povray::povray_costs();
    model.root = models::add_leaf(model, "tree", foliage::tree(1500),
                                  models::colored("bark", {0.2, 0.1, 0.05}));
    Representation& finest = model.objects[model.root].representations[0];
    finest.materials.push_back(static_cast<uint32_t>(model.materials.size()));
    model.materials.push_back(models::colored("leaf", {0.1, 0.4, 0.1}));
    summarize(finest, model);
    build_in(model, "leaves");
    const Object& tree = model.objects[model.root];
    const double radius = tree.bound().radius;
    bool pruned = false;
    bool composed = false;
    for (const Representation& level : tree.representations) {
        const RepresentationSummary& summary = level.summary;
        pruned = pruned || (summary.kind == Kind::Mesh && summary.error < radius / 4 &&
                            summary.cost.triangles < 1350);
        composed = composed || (summary.kind == Kind::Composite && summary.error < radius);
        std::cout << name_of(summary.kind) << ", " << summary.cost.triangles << " triangles, error "
                  << summary.error / radius << " of the radius\n";
    }
    EXPECT_TRUE(pruned);
    EXPECT_TRUE(composed);
}

TEST_F(Foliage, CardsKeepTheirPictureInTheStoreAndInTheNextBuild) {
    const auto new_model = [](float apart = 30) {
        Model model;
        model.costs = povray::povray_costs();
        const ObjectIndex tree = add_tree(model, 400, 24);
        model.root = models::add_group(
            model, "wood",
            {{tree, models::moved(0, 0, 0), "one"}, {tree, models::moved(apart, 0, 0), "other"}});
        summarize_assemblies(model, bottom_up(model));
        return model;
    };
    Model model = new_model();
    build_in(model, "cards");
    const auto cards_of = [](const Model& built) {
        const Material* found = nullptr;
        for (const Representation& level : built.objects[0].representations) {
            for (const uint32_t index : level.materials) {
                if (built.materials[index].name == "cards")
                    found = &built.materials[index];
            }
        }
        return found;
    };
    const Material* cards = cards_of(model);
    ASSERT_NE(cards, nullptr) << "a tree of masks has cards";
    const Hash picture = cards->base_color_texture.picture->hash;
    // The next build takes them from the store, with the picture that groups are flattened with.
    Problems problems;
    const segment::Store store(own_scratch() / "cards");
    Model again = new_model(40);
    const hierarchy::BuildReport report =
        hierarchy::build_hierarchy(again, store, {}, problems, {});
    EXPECT_EQ(report.built, 1u) << "the wood alone is another one";
    cards = cards_of(again);
    ASSERT_NE(cards, nullptr);
    EXPECT_EQ(cards->base_color_texture.picture->hash, picture);
    EXPECT_FALSE(cards->base_color_texture.picture->bytes.empty());
    // Another finish of the bark is a mean of it on the cards, and builds nothing.
    const auto rough_model = [&] {
        Model out = new_model(40);
        Representation& finest = out.objects[0].representations[0];
        out.materials[finest.materials[0]].roughness = 0.9;
        summarize(finest, out);
        summarize_assemblies(out, bottom_up(out));
        return out;
    };
    Model rough = rough_model();
    EXPECT_EQ(hierarchy::build_hierarchy(rough, store, {}, problems, {}).built, 0u);
    Model anew = rough_model();
    build_in(anew, "anew");
    ASSERT_NE(cards_of(rough), nullptr);
    EXPECT_EQ(hash_of(*cards_of(rough)), hash_of(*cards_of(anew)));
    // A torn picture is an error that says what to do, and is made whole.
    const std::filesystem::path file =
        store.folder() / segment::file_of(*cards->base_color_texture.picture);
    ASSERT_TRUE(std::filesystem::exists(file));
    std::filesystem::resize_file(file, 10);
    hierarchy::BuildSettings whole;
    whole.rebuild = true;
    Model mended = new_model();
    hierarchy::build_hierarchy(mended, store, whole, problems, {});
    EXPECT_GT(std::filesystem::file_size(file), 10u);
    // A picture that is gone is made again.
    std::filesystem::remove_all(store.folder() / "i");
    Model third = new_model();
    EXPECT_GT(hierarchy::build_hierarchy(third, store, {}, problems, {}).built, 0u);
    EXPECT_NE(cards_of(third), nullptr);
    EXPECT_TRUE(problems.empty());
}

TEST_F(Foliage, WoodHasAStandInThatOneCanSeeThrough) {
    Model model;
    model.costs = povray::povray_costs();
    const ObjectIndex tree = add_tree(model, 60, 16);
    std::vector<Placement> placements;
    placements.reserve(9);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            placements.push_back({tree, models::moved(3.0 * column, 3.0 * row, 0), "tree"});
    }
    model.root = models::add_group(model, "wood", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    build_in(model, "wood");
    EXPECT_GE(model.objects[model.root].representations.size(), 2u);
    expect_see_through_levels(model, model.root);
}

TEST_F(Foliage, GlassHasNoSolidStandIn) {
    Model model;
    model.costs = povray::povray_costs();
    Material glass = models::colored("glass", {1, 1, 1});
    glass.transmission = 1;
    model.root = models::add_leaf(model, "ball", shapes::sphere(1, 4), glass);
    build_in(model, "glass");
    EXPECT_GE(model.objects[model.root].representations.size(), 2u);
    for (const Representation& level : model.objects[model.root].representations)
        EXPECT_EQ(level.summary.kind, Kind::Mesh);
    // The same ball of stone has one.
    model = {};
    model.root = models::add_leaf(model, "ball", shapes::sphere(1, 4));
    build_in(model, "stone");
    EXPECT_NE(model.objects[model.root].representations.back().summary.kind, Kind::Mesh);
}

TEST_F(Foliage, ObjectsOfOneAtlasGetTheColorsOfTheirParts) {
    const PicturePtr atlas = foliage::picture(64, [](double x, double) {
        return x < 0.5 ? glm::dvec4(0.8, 0.1, 0.1, 1) : glm::dvec4(0.1, 0.1, 0.8, 1);
    });
    Material material;
    material.base_color = glm::dvec3(atlas->mean);
    material.base_color_texture = foliage::texture(atlas);
    Model model;
    model.costs = povray::povray_costs();
    for (const bool left : {true, false}) {
        Mesh ball = shapes::sphere(1, 4);
        for (glm::vec3& p : ball.positions) {
            ball.uvs.emplace_back((left ? 0.05f : 0.55f) + 0.2f * (p.x + 1), 0.5f * (p.z + 1));
            p *= 1 + 0.04f * std::sin(6 * p.z);  // a ball itself would be an ellipsoid at once
        }
        models::add_leaf(model, left ? "red" : "blue", ball, material);
    }
    model.root = models::add_group(model, "both",
                                   {{0, Affine{}, "red"}, {1, models::moved(3, 0, 0), "blue"}});
    build_in(model, "atlas");
    for (const ObjectIndex index : {0u, 1u}) {
        const Representation& coarsest = model.objects[index].representations.back();
        ASSERT_EQ(coarsest.summary.kind, Kind::Ellipsoid);
        const Material& mean = model.materials[coarsest.materials[0]];
        EXPECT_NEAR(mean.base_color.x, index == 0 ? 0.8 : 0.1, 0.02);
        EXPECT_NEAR(mean.base_color.z, index == 0 ? 0.1 : 0.8, 0.02);
        EXPECT_FALSE(textured(mean));
        EXPECT_LT(coarsest.summary.error, 0.1) << "nobody can tell the colors apart";
        EXPECT_FALSE(model.objects[index].representations[1].mesh().uvs.empty());
    }
}

TEST(Flatten, MeshWithoutCoordinatesKeepsItsMeanBesideOneThatHasSome) {
    const PicturePtr half = foliage::left_half();
    Material shared = foliage::leaf(half);
    shared.other = std::make_shared<const Material>(shared);
    Model model;
    model.costs = povray::povray_costs();
    models::add_leaf(model, "card", foliage::card(1, 1), shared);
    models::add_leaf(model, "bare", shapes::quad(1, 1));
    model.objects[1].representations[0].materials = {0};
    model.root = models::add_group(model, "both",
                                   {{0, Affine{}, "card"}, {1, models::moved(3, 0, 0), "bare"}});
    summarize_assemblies(model, bottom_up(model));
    const hierarchy::MeshSource source = [](const Representation& representation) {
        return std::get<std::shared_ptr<const Mesh>>(representation.payload);
    };
    const std::vector<uint64_t> uses(model.objects.size(), 1);
    hierarchy::OpenedGroup opened(model, model.root, uses);
    const hierarchy::FlattenedGroup flat = hierarchy::flatten_group(opened, 0, source, {});
    ASSERT_EQ(flat.materials.size(), 2u);
    EXPECT_EQ(flat.mesh.slots, (std::vector<uint16_t>{0, 0, 1, 1}));
    EXPECT_TRUE(textured(flat.materials[0]));
    EXPECT_FALSE(textured(flat.materials[1]));
    EXPECT_EQ(flat.materials[1].base_color, flat.materials[0].base_color);
    EXPECT_EQ(flat.materials[1].alpha, flat.materials[0].alpha);
    EXPECT_TRUE(flat.materials[1].other);
}

TEST(Candidates, WhatIsClearCostsWhatTracingItTakesAndIsNoUseBesideASharedMesh) {
    using hierarchy::StandInCandidate;
    StandInCandidate mesh;
    mesh.payload = std::make_shared<const Mesh>(shapes::sphere(1, 3));  // 1280 triangles
    mesh.error = 0.1;
    const CostModel costs = povray::povray_costs();
    StandInCandidate clear;
    clear.kind = Kind::Composite;
    Composite solids;
    solids.solids.resize(8);
    for (Solid& solid : solids.solids)
        solid.primitive.half_size = glm::dvec3(0.5);
    clear.payload = std::make_shared<const Composite>(solids);
    clear.materials.resize(1);
    clear.error = 0.15;
    EXPECT_EQ(hierarchy::tracing_of(clear, costs), 0) << "opaque";
    EXPECT_EQ(hierarchy::tracing_of(mesh, costs), 0);
    clear.materials[0].alpha_mode = AlphaMode::Blend;
    clear.materials[0].alpha = 0.4;
    const double once = hierarchy::tracing_of(clear, costs);
    EXPECT_NEAR(once, 150 * 0.5 * 8 * 3.14159265 / (0.15 * 0.15), 1e-3 * once);
    clear.error *= 2;
    EXPECT_NEAR(hierarchy::tracing_of(clear, costs), once / 4, 1e-9 * once);
    clear.error /= 2;
    for (const uint64_t uses : {1, 100}) {
        std::vector<StandInCandidate> both{mesh, clear};
        hierarchy::keep_pareto_front(both, 100000000, costs, uses);
        EXPECT_EQ(both.size(), uses == 1 ? 2u : 1u);
        EXPECT_EQ(both[0].kind, Kind::Mesh);
    }
    clear.error = 0;
    EXPECT_EQ(hierarchy::tracing_of(clear, costs), 0);
}
