// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what a build does again after a change: only what depends on it, and nothing where nothing
// changed. What is taken over is what a build from scratch makes.
#include "base/files.h"
#include "hierarchy/hierarchy_build.h"
#include "hierarchy/run/build_plan.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"
#include "segment/store.h"

#include <functional>
#include <gtest/gtest.h>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

class BuildPlans : public WithRays {};

hierarchy::BuildReport build_in(Model& model, const fs::path& folder, bool of_one_frame = false) {
    Problems problems;
    hierarchy::BuildSettings settings;
    settings.of_one_frame = of_one_frame;
    const hierarchy::BuildReport report =
        hierarchy::build_hierarchy(model, segment::Store(folder), settings, problems, {});
    EXPECT_TRUE(problems.empty()) << problems[0].message;
    return report;
}

/// Two tables with a vase each in a room, and a stone beside them.
Model room() {
    Model model;
    const Material wood = models::colored("wood", {0.4, 0.2, 0.1}, 0.6);
    const ObjectIndex top =
        models::add_leaf(model, "top", shapes::box({-1, -0.5, 0.7}, {1, 0.5, 0.75}), wood);
    const ObjectIndex vase = models::add_leaf(model, "vase", shapes::sphere(0.1, 4),
                                              models::colored("red", {0.8, 0.1, 0.1}, 0.3));
    const ObjectIndex stone = models::add_leaf(model, "stone", shapes::torus(24, 12),
                                               models::colored("gray", {0.4, 0.4, 0.4}, 0.8));
    const ObjectIndex table = models::add_group(
        model, "table", {{top, Affine{}, "top"}, {vase, models::moved(0, 0, 0.85), "vase"}});
    model.root = models::add_group(model, "room",
                                   {{table, models::moved(-1.5, 0, 0), "table left"},
                                    {table, models::moved(1.5, 0, 0), "table right"},
                                    {stone, models::moved(0, 4, 0), "stone"}});
    model.cameras.emplace_back();
    return model;
}

}  // namespace

TEST_F(BuildPlans, ABuildInWhichNothingChangedWritesNothing) {
    const fs::path folder = scratch("unchanged");
    Model first = room();
    EXPECT_GT(build_in(first, folder).bytes_written, 0u);
    const FileState state = file_state(folder / "tileset.json");
    Model second = room();
    const hierarchy::BuildReport report = build_in(second, folder);
    EXPECT_EQ(report.built, 0u);
    EXPECT_EQ(report.bytes_written, 0u);
    EXPECT_EQ(file_state(folder / "tileset.json"), state);
}

TEST_F(BuildPlans, AFrameInWhichOnlyTheCameraMovedWritesNothing) {
    const fs::path folder = scratch("frame");
    Model first = room();
    build_in(first, folder);
    const FileState state = file_state(folder / "tileset.json");
    Model frame = room();
    frame.cameras[0].position.x += 1;
    EXPECT_EQ(build_in(frame, folder, true).bytes_written, 0u);
    EXPECT_EQ(file_state(folder / "tileset.json"), state);
    EXPECT_GT(build_in(frame, folder).bytes_written, 0u);  // a picture of the store asks for it
    EXPECT_EQ(segment::Store(folder).read().cameras.at(0).position.x, 1);
}

namespace {

/// Leaves and groups whose levels are meshes, solids and boxes of several colors, of materials that
/// they share.
Model village() {
    Model model;
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(0.5, 4),
                                              models::colored("red", {0.8, 0.1, 0.1}, 0.3));
    Mesh two = shapes::box({0, 0, 0}, {3, 2, 2});
    append(two, shapes::torus(40, 16), {}, 1);
    const ObjectIndex house =
        models::add_leaf(model, "house", two, models::colored("wall", {0.7, 0.7, 0.6}, 0.9));
    model.materials.push_back(models::colored("roof", {0.5, 0.2, 0.1}, 0.7));
    Representation& finest = model.objects[house].representations[0];
    finest.materials.push_back(static_cast<uint32_t>(model.materials.size() - 1));
    summarize(finest, model);
    const ObjectIndex stone = models::add_leaf(model, "stone", shapes::terrain(24));
    model.materials.pop_back();
    model.objects[stone].representations[0].materials = finest.materials;
    model.objects[stone].representations[0].materials.pop_back();  // "wall"
    summarize(model.objects[stone].representations[0], model);
    std::vector<Placement> yard;
    yard.reserve(12);
    for (int i = 0; i < 12; ++i) {
        const int row = i / 4;
        yard.push_back({i % 3 == 0 ? house : ball, models::moved(4.0 * (i % 4), 4.0 * row, 0),
                        std::to_string(i)});
    }
    const ObjectIndex block = models::add_group(model, "block", yard);
    model.root = models::add_group(model, "village",
                                   {{block, Affine{}, "left"},
                                    {block, models::moved(20, 0, 0), "right"},
                                    {stone, models::moved(10, 30, 0), "stone"}});
    return model;
}

/// The leaves' hashes after a change of materials.
void summarize_leaves(Model& model) {
    for (Object& object : model.objects) {
        if (!object.group())
            summarize(object.representations[0], model);
    }
}

void expect_same_levels(const Model& a, const Model& b) {
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (size_t i = 0; i < a.objects.size(); ++i) {
        const Object& x = a.objects[i];
        const Object& y = b.objects[i];
        ASSERT_EQ(x.representations.size(), y.representations.size()) << x.name;
        for (size_t lod = 0; lod < x.representations.size(); ++lod) {
            const RepresentationSummary& one = x.representations[lod].summary;
            const RepresentationSummary& other = y.representations[lod].summary;
            EXPECT_EQ(one.hash, other.hash) << x.name << " " << lod;
            EXPECT_EQ(one.error, other.error) << x.name << " " << lod;
            EXPECT_EQ(one.max_error, other.max_error) << x.name << " " << lod;
            EXPECT_EQ(one.sealed, other.sealed) << x.name << " " << lod;
        }
        ASSERT_EQ(x.attributes.has_value(), y.attributes.has_value());
        if (!x.attributes)
            continue;
        EXPECT_EQ(x.attributes->roughness, y.attributes->roughness) << x.name;
        EXPECT_EQ(x.attributes->metallic, y.attributes->metallic) << x.name;
        EXPECT_EQ(x.attributes->specular, y.attributes->specular) << x.name;
    }
}

/// Builds a changed model in the store of the unchanged one; how much was built. Expects what a
/// build from scratch gives.
uint64_t built_after(const Model& before, const Model& after) {
    const fs::path folder = scratch("changed");
    const fs::path empty = scratch("from_scratch");
    fs::remove_all(folder);
    fs::remove_all(empty);
    Model first = before;
    build_in(first, folder);
    Model incremental = after;
    const uint64_t built = build_in(incremental, folder).built;
    Model whole = after;
    build_in(whole, empty);
    expect_same_levels(incremental, whole);
    // What is stored of it is that, too.
    Model again = after;
    EXPECT_EQ(build_in(again, folder).built, 0u);
    expect_same_levels(again, whole);
    for (const Object& object : again.objects) {
        for (size_t lod = 1; lod < object.representations.size(); ++lod) {
            const RepresentationSummary& level = object.representations[lod].summary;
            EXPECT_TRUE(level.kind != Kind::Mesh || segment::Store(folder).has_mesh(level.hash));
        }
    }
    return built;
}

Model with_material(const char* name, const std::function<void(Material&)>& change) {
    Model model = village();
    for (Material& material : model.materials) {
        if (material.name == name)
            change(material);
    }
    summarize_leaves(model);
    return model;
}

}  // namespace

TEST_F(BuildPlans, AChangedFinishBuildsNothing) {
    const Model before = village();
    EXPECT_EQ(built_after(before, with_material("red", [](Material& m) { m.roughness = 0.9; })),
              0u);
    const auto metal = [](Material& m) {
        m.roughness = 0.1;
        m.metallic = 1;
        m.specular = 0.2;
    };
    EXPECT_EQ(built_after(before, with_material("wall", metal)), 0u);
    // The stone's box is as light as the stone, so that its material was the wall's: of one that
    // has a coat and one that has none the group above is built again.
    EXPECT_LE(built_after(before, with_material("wall",
                                                [&](Material& m) {
                                                    metal(m);
                                                    m.clearcoat = 0.4;
                                                    m.clearcoat_roughness = 0.1;
                                                    m.normal_strength = 0.5;
                                                    m.ior = 1.8;
                                                })),
              1u);
}

TEST_F(BuildPlans, AnyChangeOfAMaterialGivesWhatABuildFromScratchGives) {
    const Model before = village();
    uint64_t taken_over = 0;
    for_each_field_of<double>([&](const MaterialField<double>& field) {
        const Model after = with_material("roof", [&](Material& m) {
            m.alpha_mode = AlphaMode::Opaque;
            m.*field.member = m.*field.member == 0.25 ? 0.5 : 0.25;
        });
        const uint64_t built = built_after(before, after);
        taken_over += built == 0 ? 1 : 0;
        const bool look =
            field.member == &Material::transmission || field.member == &Material::alpha;
        EXPECT_TRUE(built > 0 || !look) << field.key;
    });
    EXPECT_EQ(taken_over, 8u);  // a finish has 8 numbers
    EXPECT_GT(built_after(before, with_material("roof",
                                                [](Material& m) {
                                                    m.base_color = {0.1, 0.1, 0.6};
                                                })),
              0u);
    EXPECT_GT(built_after(before, with_material("roof", [](Material& m) { m.emission.x = 2; })),
              0u);
    EXPECT_GT(built_after(before, with_material("roof",
                                                [](Material& m) {
                                                    m.roughness_texture.picture = models::checker();
                                                })),
              0u);
}

TEST_F(BuildPlans, OfGlassWhatBendsLightIsNoFinish) {
    const auto glass = [](double ior, double roughness, double metallic) {
        return with_material("roof", [&](Material& m) {
            m.transmission = 1;
            m.ior = ior;
            m.roughness = roughness;
            m.metallic = metallic;
        });
    };
    EXPECT_GT(built_after(glass(1.45, 0.7, 0), glass(1.2, 0.7, 0)), 0u);
    EXPECT_GT(built_after(glass(1.45, 0.7, 0), glass(1.45, 0.7, 1)), 0u);
    EXPECT_EQ(built_after(glass(1.45, 0.7, 0), glass(1.45, 0, 0)), 0u);
}

TEST_F(BuildPlans, TwoMaterialsThatBecomeOneOrOneThatBecomesTwoAreBuiltAgain) {
    Model before = village();  // "red", "wall", "roof"
    Model apart = before;
    Material other = before.materials[1];
    other.roughness = 0.2;
    apart.materials.push_back(other);
    for (Object& object : apart.objects) {
        if (object.name == "stone")
            object.representations[0].materials = {
                static_cast<uint32_t>(apart.materials.size() - 1)};
    }
    summarize_leaves(apart);
    EXPECT_GT(built_after(before, apart), 0u);
    EXPECT_GT(built_after(apart, before), 0u);
}

namespace {

Model with_place() {
    Model model = village();
    for (Object& object : model.objects) {
        if (object.name != "block")
            continue;
        auto own = std::make_shared<Assembly>(object.representations[0].assembly());
        own->placements[1].transform.offset.x += 0.5;
        object.representations[0].payload = std::shared_ptr<const Assembly>(own);
    }
    return model;
}

Model with_vertex() {
    Model model = village();
    Representation& finest = model.objects[0].representations[0];
    auto mesh = std::make_shared<Mesh>(finest.mesh());
    mesh->positions[0].z += 0.25f;
    finest.payload = std::shared_ptr<const Mesh>(mesh);
    summarize(finest, model);
    return model;
}

}  // namespace

TEST_F(BuildPlans, GoingBackToAnEarlierMeshPlaceOrMaterialBuildsNothing) {
    const fs::path folder = scratch("undo");
    const std::vector<Model> states{village(), with_vertex(), with_place(),
                                    with_material("wall",
                                                  [](Material& m) {
                                                      m.base_color = {0.1, 0.2, 0.3};
                                                  }),
                                    with_material("red", [](Material& m) { m.roughness = 1; })};
    std::vector<Model> made = states;
    for (Model& model : made)
        build_in(model, folder);
    for (size_t i : {0, 1, 2, 3, 4, 2, 0}) {
        Model again = states[i];
        EXPECT_EQ(build_in(again, folder).built, 0u) << i;
        expect_same_levels(again, made[i]);
    }
}

TEST_F(BuildPlans, AMovedObjectBuildsOnlyTheGroupsAboveIt) {
    const fs::path folder = scratch("moved_one");
    Model first = village();
    build_in(first, folder);
    Model moved = with_place();
    EXPECT_EQ(build_in(moved, folder).built, 2u);  // "block" and "village"
}

TEST_F(BuildPlans, AnEarlierStateThatIsDamagedIsBuiltAgain) {
    const fs::path folder = scratch("damaged_undo");
    Model first = village();
    build_in(first, folder);
    Model second = with_vertex();
    build_in(second, folder);
    for (const char* broken : {"", "{", "[]", R"({"format":3})"}) {
        write_file(folder / "earlier.json", broken);
        Model again = village();
        EXPECT_GT(build_in(again, folder).built, 0u) << broken;
        expect_same_levels(again, first);
        Model other = with_vertex();
        EXPECT_EQ(build_in(other, folder).built, 0u) << broken;
    }
}

TEST_F(BuildPlans, NineHundredEqualCollectionsAreMeasuredOnce) {
    constexpr size_t kCollections = 912;
    Model model;
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(0.5, 2));
    std::vector<Placement> all;
    for (size_t i = 0; i < kCollections; ++i) {
        const auto at = static_cast<double>(i);
        const std::string name = std::to_string(i);
        all.push_back({models::add_group(model, name,
                                         {{ball, models::moved(10 * at, 0, 0), "left"},
                                          {ball, models::moved(10 * at + 2, 1, 0), "right"}}),
                       Affine{}, name});
    }
    model.root = models::add_group(model, "all", all);
    const std::vector<ObjectIndex> order = bottom_up(model);
    summarize_assemblies(model, order);
    const segment::Store store(scratch("equal"));
    const hierarchy::StoredStandIns shelf(store, false);
    const hierarchy::StandInSurroundings around =
        hierarchy::surroundings_of(model, order,
                                   [](const Representation& one) {
                                       return std::get<std::shared_ptr<const Mesh>>(one.payload);
                                   },
                                   {});
    hierarchy::MaterialPalette palette(model);
    const hierarchy::BuildPlan plan =
        hierarchy::plan_build(model, order, around, shelf, palette, {});
    EXPECT_EQ(plan.tasks.size(), 3u);  // the ball, one collection, and all of them
    size_t moved = 0;
    for (const hierarchy::BuildTask& task : plan.tasks)
        moved += task.moved.size();
    EXPECT_EQ(moved, kCollections - 1);
}
