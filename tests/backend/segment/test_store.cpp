// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the store: model -> files -> model is identical, nothing outside is trusted, nothing torn.
// It is over 500 lines, for nearly all of them are about one rich model.
#include "base/files.h"
#include "scenes/small_models.h"
#include "scratch.h"
#include "segment/store.h"
#include "segment/store_json.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <gtest/gtest.h>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

/// Balls with a coarse level, a box and an ellipsoid, a camera, lights, names of all sorts.
Model rich_model() {
    Model model = models::row_of_balls(4);
    model.objects[0].name = "Ball \"1\"\n}\u540d";
    model.objects[0].uid = "ball";
    model.objects[0].role = ObjectRole::Environment;
    Attributes attributes;
    attributes.visible_area = 1.0 / 3.0;
    attributes.centroid = {0.1, 0.2, 0.3};
    model.objects[0].attributes = attributes;
    const auto add = [&](Kind kind, double error, Payload payload) {
        Representation level;
        level.summary.kind = kind;
        level.payload = std::move(payload);
        level.materials = {0};
        summarize(level, model);
        level.summary.error = error;
        level.summary.max_error = 1.5 * error;
        model.objects[0].representations.push_back(std::move(level));
    };
    Mesh slotted = shapes::cube();
    slotted.slots.assign(slotted.triangles.size(), 0);
    add(Kind::Mesh, 0.01, std::make_shared<const Mesh>(slotted));
    add(Kind::Ellipsoid, 0.1, Primitive{{1, 2, 3}, glm::dmat3(1.0), {0.5, 0.25, 0.125}});
    add(Kind::Box, 0.7, Primitive{{1, 2, 3}, glm::dmat3(1.0), {1.0 / 3, 0.25, 0.125}});
    const Primitive third{{1, 2, 3}, glm::dmat3(1.0), {1.0 / 3, 0.25, 0.125}};
    add(Kind::Composite, 0.8,
        std::make_shared<const Composite>(Composite{{{true, third, 0}, {false, third, 0}}}));
    model.objects[0].representations.back().summary.sealed = true;
    model.objects[0].build_hash = 0x0123456789abcdef;
    model.objects[0].representations[2].means = {{{0, 1.0 / 3}, {65535, 2.0 / 3}}};
    model.objects[0].sources = {{0, true}, {0, false}};
    Camera camera;
    camera.name = "far";
    camera.position = {1.0 / 7, 2, 3};
    camera.focus_distance = 1.0 / 3;
    camera.aperture = 0.02;
    model.cameras.push_back(camera);
    Light sun;
    sun.name = "Sun";
    sun.power = 3;
    sun.angle = 0.01;
    model.lights.push_back(sun);
    Light spot;
    spot.kind = LightKind::Spot;
    spot.radius = 0.1;
    spot.spot_size = 1.0 / 3;
    spot.spot_blend = 0.15;
    model.lights.push_back(spot);
    Light area;
    area.kind = LightKind::Area;
    area.edge_u = {1.0 / 3, 0, 0};
    area.round = true;
    area.spread = 1;
    model.lights.push_back(area);
    model.world.color = {0.1, 0.2, 0.3};
    model.world.environment = models::checker();
    model.world.environment_turn = {0, 1, 0, 1, 0, 0, 0, 0, -1};
    model.world.environment_strength = {1.0 / 3, 1, 2};
    Material brick = models::colored("brick", {0.5, 0.25, 0.125});
    brick.base_color_texture.picture = models::checker();
    brick.base_color_texture.extension = TextureExtension::Mirror;
    brick.base_color_texture.to_picture = {2, 0, 1.0 / 3, 0, 3, -0.25};
    brick.alpha_texture.picture = models::checker();
    brick.alpha_texture.channel = TextureChannel::Alpha;
    brick.alpha_mode = AlphaMode::Clip;
    brick.ior = 1.33;
    brick.other = std::make_shared<Material>(model.materials[0]);
    brick.mix = 1.0 / 3;
    model.materials.push_back(brick);
    summarize_assemblies(model, bottom_up(model));
    return model;
}

void expect_same(const Model& a, const Model& b) {
    ASSERT_EQ(a.objects.size(), b.objects.size());
    EXPECT_EQ(a.root, b.root);
    for (size_t i = 0; i < a.objects.size(); ++i) {
        const Object& x = a.objects[i];
        const Object& y = b.objects[i];
        EXPECT_EQ(x.uid, y.uid);
        EXPECT_EQ(x.name, y.name);
        EXPECT_EQ(x.role, y.role);
        EXPECT_EQ(x.source_hash, y.source_hash);
        EXPECT_EQ(x.build_hash, y.build_hash);
        EXPECT_EQ(x.attributes.has_value(), y.attributes.has_value());
        if (x.attributes && y.attributes) {
            EXPECT_EQ(x.attributes->visible_area, y.attributes->visible_area);
        }
        ASSERT_EQ(x.sources.size(), y.sources.size());
        for (size_t slot = 0; slot < x.sources.size(); ++slot) {
            EXPECT_EQ(x.sources[slot].material, y.sources[slot].material);
            EXPECT_EQ(x.sources[slot].plain, y.sources[slot].plain);
        }
        ASSERT_EQ(x.representations.size(), y.representations.size());
        for (size_t lod = 0; lod < x.representations.size(); ++lod) {
            const Representation& r = x.representations[lod];
            const Representation& s = y.representations[lod];
            EXPECT_EQ(r.summary.kind, s.summary.kind);
            EXPECT_EQ(r.summary.error, s.summary.error);
            EXPECT_EQ(r.summary.max_error, s.summary.max_error);
            EXPECT_EQ(r.summary.sealed, s.summary.sealed);
            EXPECT_EQ(r.summary.hash, s.summary.hash);
            EXPECT_EQ(r.summary.bound.radius, s.summary.bound.radius);
            EXPECT_EQ(r.summary.bound.box.low, s.summary.bound.box.low);
            EXPECT_EQ(r.summary.cost.triangles, s.summary.cost.triangles);
            EXPECT_EQ(r.materials, s.materials);
            EXPECT_EQ(s.summary.shape, lod == 0 ? r.summary.shape : 0);
            ASSERT_EQ(r.means.size(), s.means.size());
            for (size_t mean = 0; mean < r.means.size(); ++mean) {
                ASSERT_EQ(r.means[mean].size(), s.means[mean].size());
                for (size_t share = 0; share < r.means[mean].size(); ++share) {
                    EXPECT_EQ(r.means[mean][share].slot, s.means[mean][share].slot);
                    EXPECT_EQ(r.means[mean][share].share, s.means[mean][share].share);
                }
            }
            if (r.summary.kind == Kind::Mesh) {
                EXPECT_EQ(hash_of(r.mesh()), hash_of(s.mesh()));
            } else if (r.summary.kind == Kind::Assembly) {
                ASSERT_EQ(r.assembly().placements.size(), s.assembly().placements.size());
                for (size_t p = 0; p < r.assembly().placements.size(); ++p) {
                    EXPECT_EQ(r.assembly().placements[p].object, s.assembly().placements[p].object);
                    EXPECT_EQ(r.assembly().placements[p].name, s.assembly().placements[p].name);
                    EXPECT_EQ(r.assembly().placements[p].transform.offset,
                              s.assembly().placements[p].transform.offset);
                }
            } else if (r.summary.kind == Kind::Composite) {
                ASSERT_EQ(r.composite().solids.size(), s.composite().solids.size());
                for (size_t j = 0; j < r.composite().solids.size(); ++j) {
                    const Solid& one = r.composite().solids[j];
                    const Solid& other = s.composite().solids[j];
                    EXPECT_EQ(one.box, other.box);
                    EXPECT_EQ(one.slot, other.slot);
                    EXPECT_EQ(one.primitive.half_size, other.primitive.half_size);
                    EXPECT_EQ(one.primitive.center, other.primitive.center);
                }
            } else {
                EXPECT_EQ(r.primitive().half_size, s.primitive().half_size);
                EXPECT_EQ(r.primitive().center, s.primitive().center);
            }
        }
    }
    ASSERT_EQ(a.cameras.size(), b.cameras.size());
    EXPECT_EQ(a.cameras[0].position, b.cameras[0].position);
    EXPECT_EQ(a.cameras[0].focus_distance, b.cameras[0].focus_distance);
    EXPECT_EQ(a.cameras[0].aperture, b.cameras[0].aperture);
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (size_t i = 0; i < a.lights.size(); ++i) {
        const Light& x = a.lights[i];
        const Light& y = b.lights[i];
        EXPECT_EQ(std::tie(x.name, x.kind, x.power, x.shadow, x.radius, x.angle),
                  std::tie(y.name, y.kind, y.power, y.shadow, y.radius, y.angle));
        EXPECT_EQ(std::tie(x.spot_size, x.spot_blend, x.round, x.spread),
                  std::tie(y.spot_size, y.spot_blend, y.round, y.spread));
        EXPECT_EQ(x.edge_u, y.edge_u);
        EXPECT_EQ(x.edge_v, y.edge_v);
    }
    EXPECT_EQ(a.world.color, b.world.color);
    ASSERT_EQ(a.world.environment != nullptr, b.world.environment != nullptr);
    if (a.world.environment) {
        EXPECT_EQ(a.world.environment->hash, b.world.environment->hash);
        EXPECT_EQ(a.world.environment_turn, b.world.environment_turn);
        EXPECT_EQ(a.world.environment_strength, b.world.environment_strength);
    }
}

nlohmann::json tileset_of(const fs::path& folder) {
    return nlohmann::json::parse(read_file(folder / "tileset.json"));
}

/// Every tile has a box that holds its children's and an error no smaller than theirs.
void check_tile(const nlohmann::json& tile, const fs::path& folder, size_t& tiles) {
    ++tiles;
    ASSERT_TRUE(tile.contains("boundingVolume"));
    EXPECT_EQ(tile.at("boundingVolume").at("box").size(), 12u);
    ASSERT_TRUE(tile.contains("content"));
    EXPECT_TRUE(fs::is_regular_file(folder / tile.at("content").at("uri").get<std::string>()));
    for (const auto& child : tile.value("children", nlohmann::json::array())) {
        EXPECT_LE(child.at("geometricError").get<double>(),
                  tile.at("geometricError").get<double>());
        check_tile(child, folder, tiles);
    }
    if (!tile.contains("children")) {
        EXPECT_EQ(tile.at("geometricError"), 0);
    }
}

}  // namespace

TEST(Store, EmptyModelRoundTrips) {
    const segment::Store store(scratch("empty"));
    EXPECT_FALSE(store.exists());
    EXPECT_THROW(store.read(), Error);
    store.write(Model{}, {});
    EXPECT_TRUE(store.exists());
    EXPECT_TRUE(store.read().objects.empty());
}

TEST(Store, ModelComesBackIdentical) {
    const segment::Store store(scratch("rich"));
    Model model = rich_model();
    store.write(model, {});
    Model back = store.read();
    EXPECT_FALSE(back.objects[0].representations[0].resident());
    for (Object& object : back.objects) {
        for (Representation& representation : object.representations)
            store.load(representation);
    }
    expect_same(model, back);
    ASSERT_EQ(model.materials.size(), back.materials.size());
    for (size_t i = 0; i < model.materials.size(); ++i)
        EXPECT_EQ(hash_of(model.materials[i]), hash_of(back.materials[i])) << i;
    EXPECT_TRUE(back.materials.back().base_color_texture.picture->bytes.empty());
    store.load_pictures(back);
    const Texture& texture = back.materials.back().base_color_texture;
    EXPECT_EQ(texture.picture->bytes, models::checker()->bytes);
    EXPECT_EQ(texture.picture->mean, models::checker()->mean);
    EXPECT_EQ(texture.picture, back.materials.back().alpha_texture.picture);
}

TEST(Store, NamesOfTenKilobytesAndOfAnyBytesAreStored) {
    const segment::Store store(scratch("names"));
    Model model = models::row_of_balls(2);
    const std::string lengthy(10'000, '"');
    model.objects[0].name = lengthy;
    model.objects[1].name = "caf\xe9";
    model.materials.resize(2);
    model.materials[0].name = lengthy;
    model.materials[1].name = "\xff\xed\xa0\x80\xc3";
    store.write(model, {});
    const Model back = store.read();
    EXPECT_EQ(back.objects[0].name, lengthy);
    EXPECT_EQ(back.objects[1].name, "caf\xef\xbf\xbd");
    EXPECT_EQ(back.materials[0].name, lengthy);
    EXPECT_EQ(back.materials[1].name.find_first_not_of("\xef\xbf\xbd"), std::string::npos);
}

TEST(Store, AFolderMayBeCalledLikeTheFileInIt) {
    const fs::path folder = scratch("called") / "tileset.json";
    const segment::Store missing(folder);
    EXPECT_EQ(missing.folder(), folder.parent_path());  // the file, which is not there yet
    fs::create_directories(folder);
    segment::Store(folder).write(Model{}, {});
    EXPECT_TRUE(fs::is_regular_file(folder / "tileset.json"));
    EXPECT_FALSE(fs::exists(folder.parent_path() / "lock"));
    EXPECT_TRUE(segment::Store(folder / "tileset.json").read().objects.empty());
}

TEST(Store, AChangedPictureFileIsNamed) {
    const segment::Store store(scratch("picture"));
    store.write(rich_model(), {});
    const std::string name = segment::file_of(*models::checker());
    write_file(store.folder() / name, "not it");
    Model back = store.read();
    try {
        store.load_pictures(back);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
}

TEST(Store, SecondWriteOfTheSameModelWritesNothing) {
    const segment::Store store(scratch("again"));
    const Model model = rich_model();
    const uint64_t first = store.write(model, {});
    const FileState state = file_state(store.folder() / "tileset.json");
    EXPECT_GT(first, state.bytes);
    EXPECT_EQ(store.write(model, {}), 0u);
    EXPECT_EQ(store.write(store.read(), {}), 0u);
    EXPECT_EQ(file_state(store.folder() / "tileset.json"), state);
}

TEST(Store, AViewThatChangedIsWrittenUnlessItIsThatOfOneFrame) {
    const segment::Store store(scratch("frames"));
    Model model = rich_model();
    store.write(model, {});
    const std::string text = read_file(store.folder() / "tileset.json");
    model.cameras.at(0).position.x += 1;
    model.lights.at(0).power *= 2;
    model.world.color *= 0.5;
    EXPECT_EQ(store.write(model, {}, segment::StoreUpdate::Objects), 0u);
    EXPECT_EQ(read_file(store.folder() / "tileset.json"), text);
    EXPECT_GT(store.write(model, {}), 0u);
    EXPECT_EQ(store.read().cameras.at(0).position, model.cameras[0].position);
    model.objects[0].name += " renamed";
    EXPECT_GT(store.write(model, {}, segment::StoreUpdate::Objects), 0u);
    EXPECT_EQ(store.read().objects[0].name, model.objects[0].name);
}

TEST(Store, WhatIsSharedIsReadAgainWhenItHasChanged) {
    const segment::Store store(scratch("shared"));
    Model model = rich_model();
    store.write(model, {});
    const auto first = store.read_shared();
    EXPECT_EQ(store.read_shared(), first);
    model.objects[0].name = "another";
    store.write(model, {});
    EXPECT_EQ(store.read_shared()->objects[0].name, "another");
    EXPECT_NE(first->objects[0].name, "another");
    fs::remove(store.folder() / "tileset.json");
    EXPECT_THROW(store.read_shared(), Error);
}

TEST(Store, UnusedFilesGoAfterTheNextButOneWrite) {
    const segment::Store store(scratch("unused"));
    Model model = rich_model();
    store.write(model, {});
    const fs::path gone =
        store.folder() / segment::file_of(model.objects[0].representations.back().summary.hash);
    model.objects[0].representations.pop_back();
    store.write(model, {});
    EXPECT_TRUE(fs::exists(gone));  // a reader of the previous tileset may still want it
    store.write(model, {});
    EXPECT_FALSE(fs::exists(gone));
}

TEST(Store, FilesOfTheUserAreNotTakenForUnusedOnes) {
    const segment::Store store(scratch("mine"));
    store.write(rich_model(), {});
    const std::vector<std::string> mine{"i/holiday.png", "r/chair.glb", "r/0123456789ABCDEF.glb",
                                        "r/notes.tmp", "b/0123456789abcde.bound"};
    const std::vector<std::string> ours{"r/fedcba9876543210.glb", "r/.lodestone-1-2.tmp"};
    for (const auto* names : {&mine, &ours}) {
        for (const std::string& name : *names) {
            fs::create_directories((store.folder() / name).parent_path());
            write_file(store.folder() / name, "x");
        }
    }
    store.write(rich_model(), {});
    for (const std::string& name : mine)
        EXPECT_TRUE(fs::exists(store.folder() / name)) << name;
    for (const std::string& name : ours)
        EXPECT_FALSE(fs::exists(store.folder() / name)) << name;
}

TEST(Store, FilesThatAPowerFailureEmptiedAreWrittenAgain) {
    const segment::Store store(scratch("emptied"));
    const Model model = rich_model();
    store.write(model, {});
    const Hash hash = model.objects[0].representations[1].summary.hash;
    const std::string picture = segment::file_of(*models::checker());
    write_file(store.folder() / segment::file_of(hash), "");
    write_file(store.folder() / picture, "");
    EXPECT_FALSE(store.has_mesh(hash));
    EXPECT_FALSE(store.has_stand_ins(model.objects[0]));
    store.write(model, {});
    EXPECT_TRUE(store.has_stand_ins(model.objects[0]));
    EXPECT_NO_THROW(store.load_mesh(hash));
    EXPECT_EQ(read_file(store.folder() / picture), models::checker()->bytes);
}

TEST(Store, AGroupThatPlacesAGroupTwiceSixtyTimesOverIsStoredAndRefusedWhereEachCopyCounts) {
    Model model;
    ObjectIndex below = models::add_leaf(model, "ball", shapes::sphere(1, 1));
    for (int i = 0; i < 70; ++i)
        below = models::add_group(model, text("group", i),
                                  {{below, Affine{}, "a"}, {below, models::moved(2, 0, 0), "b"}});
    model.root = below;
    summarize_assemblies(model, bottom_up(model));
    EXPECT_EQ(totals(model).occurrences, ~uint64_t{0});
    EXPECT_EQ(model.objects[below].representations[0].summary.cost.triangles, ~uint64_t{0});
    EXPECT_THROW(for_each_occurrence(model, [](const Occurrence&) {}), Error);
    const segment::Store store(scratch("doubled"));
    store.write(model, {});
    EXPECT_LT(fs::file_size(store.folder() / "tileset.json"), 100'000u);
    EXPECT_EQ(store.read().objects.size(), 71u);
}

TEST(Store, TilesHoldTheirChildrenAndErrorsFall) {
    const segment::Store store(scratch("tiles"));
    Model model = rich_model();
    // Groups get a stand-in, so that every tile has content.
    for (Object& object : model.objects) {
        if (!object.group())
            continue;
        Representation level;
        level.summary.kind = Kind::Box;
        level.payload =
            Primitive{object.bound().center, glm::dmat3(1.0), 0.5 * object.bound().box.size()};
        level.materials = {0};
        summarize(level, model);
        level.summary.error = 0.02;  // finer than the children's coarsest: must be raised
        object.representations.push_back(level);
    }
    store.write(model, {});
    const nlohmann::json tileset = tileset_of(store.folder());
    EXPECT_EQ(tileset.at("asset").at("version"), "1.1");
    size_t tiles = 0;
    check_tile(tileset.at("root"), store.folder(), tiles);
    EXPECT_EQ(tiles, 1u + 2u + 4u * 5u);
    EXPECT_GE(tileset.at("geometricError").get<double>(),
              tileset.at("root").at("geometricError").get<double>());
}

TEST(Store, EveryBrokenTilesetIsRefusedWithASentence) {
    const segment::Store store(scratch("broken"));
    store.write(rich_model(), {});
    const nlohmann::json good = tileset_of(store.folder());
    const auto refused = [&](const std::function<void(nlohmann::json&)>& damage) {
        nlohmann::json bad = good;
        damage(bad["asset"]["extras"]["lodestone"]);
        try {
            segment::model_of_tileset(bad.dump());
            return false;
        } catch (const Error& error) {
            return error.status == Status::BadFile && std::string(error.what()).size() > 20;
        }
    };
    EXPECT_FALSE(refused([](nlohmann::json&) {}));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["format"] = 99; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["pictures"][0]["hash"] = "../../passwd"; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["pictures"][0]["format"] = "sh"; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["world"]["environment"] = 1; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["world"]["turn"] = std::vector<double>(9, 0); }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["lights"][0]["kind"] = "moon"; }));
    EXPECT_TRUE(refused(
        [](nlohmann::json& j) { j["materials"].back()["base_color_texture"]["picture"] = 1; }));
    EXPECT_TRUE(refused(
        [](nlohmann::json& j) { j["materials"].back()["base_color_texture"]["channel"] = 6; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) {
        nlohmann::json one = j["materials"].back();
        for (int i = 0; i < 100; ++i)
            one["other"] = nlohmann::json(one);
        j["materials"].back() = one;
    }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["root"] = 99; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["root"] = -1; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["root"] = uint64_t{1} << 32u; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["root"] = 0.5; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["pictures"][0]["width"] = 1e300; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j.erase("objects"); }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["objects"][0]["source_hash"] = "../../etc"; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["objects"][0]["sources"][0][0] = 99; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["objects"][0]["sources"][0][0] = -1; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) { j["objects"][0]["sources"][0] = 1; }));
    for (const char* broken : {"[[0]]", "[[65536,1]]", "[[-1,1]]", "[[0,null]]", "[[0,1],[0,1]]"})
        EXPECT_TRUE(refused([&](nlohmann::json& j) {
            j["objects"][0]["representations"][2]["means"] = nlohmann::json::parse(broken);
        })) << broken;
    EXPECT_TRUE(
        refused([](nlohmann::json& j) { j["objects"][0]["representations"][0]["hash"] = "../x"; }));
    EXPECT_TRUE(
        refused([](nlohmann::json& j) { j["objects"][0]["representations"][1]["error"] = -1; }));
    EXPECT_TRUE(
        refused([](nlohmann::json& j) { j["objects"][0]["representations"][1]["error"] = 1e9; }));
    EXPECT_TRUE(refused(
        [](nlohmann::json& j) { j["objects"][0]["representations"][0]["kind"] = "program"; }));
    EXPECT_TRUE(refused(
        [](nlohmann::json& j) { j["objects"][0]["representations"][0]["materials"] = {7}; }));
    EXPECT_TRUE(refused([](nlohmann::json& j) {
        j["objects"][1]["representations"][0]["placements"][0]["object"] = 2;  // a cycle
    }));
    EXPECT_TRUE(refused([](nlohmann::json& j) {
        j["objects"][1]["representations"][0]["placements"][0]["transform"] = {1, 2};
    }));
    EXPECT_THROW(segment::model_of_tileset("{"), Error);
    EXPECT_THROW(segment::model_of_tileset(""), Error);
    EXPECT_THROW(segment::model_of_tileset("{\"asset\":{\"version\":\"1.1\"}}"), Error);
}

TEST(Store, NumbersOfMaterialsAreBroughtIntoTheirRanges) {
    const segment::Store store(scratch("ranges"));
    store.write(rich_model(), {});
    nlohmann::json json = tileset_of(store.folder());
    nlohmann::json& material = json["asset"]["extras"]["lodestone"]["materials"][0];
    material["alpha"] = -5;
    material["roughness"] = 7;
    material["ior"] = 0;
    const Model model = segment::model_of_tileset(json.dump());
    EXPECT_EQ(model.materials[0].alpha, 0);
    EXPECT_EQ(model.materials[0].roughness, 1);
    EXPECT_EQ(model.materials[0].ior, 0.1);
}

TEST(Store, ABrokenMeshFileIsNamedWithWhatToDo) {
    const segment::Store store(scratch("torn"));
    const Model model = rich_model();
    store.write(model, {});
    const Hash hash = model.objects[0].representations[0].summary.hash;
    write_file(store.folder() / segment::file_of(hash), "glTF");
    try {
        store.load_mesh(hash);
        FAIL() << "loaded";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(hex16(hash)), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("delete it"), std::string::npos) << error.what();
    }
}

TEST(Store, MissingMeshFileIsNamed) {
    const segment::Store store(scratch("missing"));
    const Model model = rich_model();
    store.write(model, {});
    const Hash hash = model.objects[0].representations[0].summary.hash;
    fs::remove(store.folder() / segment::file_of(hash));
    try {
        store.load_mesh(hash);
        FAIL() << "loaded";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(hex16(hash)), std::string::npos);
    }
}
