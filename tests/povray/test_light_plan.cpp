// SPDX-License-Identifier: GPL-3.0-or-later
// Guards approximated lights in pictures: rooms shade with their own lamps, nothing shines through
// walls, floors of many rooms are cut, and what the number allows is all that differs.
#include "base/color.h"
#include "base/parallel.h"
#include "light/light_plan.h"
#include "povray/povray_scenes.h"
#include "ray/mesh_scene.h"

#include <limits>

using namespace lodestone;
using namespace lodestone::light;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

constexpr int kRooms = 6;

Affine box_at(const glm::dvec3& low, const glm::dvec3& high) {
    Affine place;
    for (int i = 0; i < 3; ++i)
        place.linear[i][i] = high[i] - low[i];
    place.offset = 0.5 * (low + high);
    return place;
}

/// A row of rooms along x without ceilings, on one floor, with walls of their own and four lamps
/// each; those of every other room are red.
void add_rooms(Builder& builder) {
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({0.8, 0.8, 0.8})});
    builder.place(box, box_at({0, 0, -0.2}, {4.0 * kRooms, 4, 0}), "floor");
    for (int i = 0; i <= kRooms; ++i)
        builder.place(box, box_at({4.0 * i - 0.1, 0, 0}, {4.0 * i + 0.1, 4, 3}), "wall");
    for (int i = 0; i < kRooms; ++i) {
        for (int k = 0; k < 4; ++k) {
            Light lamp;
            lamp.kind = LightKind::Point;
            lamp.color = i % 2 == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
            lamp.power = 8;
            lamp.position = {4.0 * i + 1.5 + k % 2, k < 2 ? 1.5 : 2.5, 2.5};
            builder.model.lights.push_back(lamp);
        }
    }
}

View from_above(double pixel_error) {
    View view;
    view.width = 120;
    view.height = 24;
    view.camera.orthographic = true;
    view.camera.position = {2.0 * kRooms, 2, 20};
    view.camera.right = {4.0 * kRooms, 0, 0};
    view.camera.up = {0, 4.8, 0};
    view.pixel_error = pixel_error;
    return view;
}

class PovrayRenderLights : public testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        if (!ray::available(&reason))
            GTEST_SKIP() << reason;
    }
};

ExportOptions into(const std::string& name) {
    ExportOptions options;
    options.folder = scratch(name);
    options.antialiasing = Antialiasing::Off;
    return options;
}

double encoded(double value) {
    return encode_srgb(std::clamp(value, 0.0, 1.0));
}

size_t count_of(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

}  // namespace

class LightPlanTest : public PovrayRenderLights {};

TEST_F(LightPlanTest, AllLampsLightEverythingWhereTheirRaysAreFewOrAllAreAskedFor) {
    Builder builder;
    add_rooms(builder);
    Problems problems;
    ExportOptions options = into("exact");
    const Model& model = builder.finish();
    options.light_error = 0;
    const ExportReport exact = scenes::write(model, from_above(1), options, problems);
    EXPECT_EQ(exact.lamps, 4u * kRooms);
    EXPECT_EQ(exact.lights_each, 4.0 * kRooms);
    const std::string all = read_file(options.folder / "scene.pov");
    EXPECT_EQ(count_of(all, "light_group"), 0u);
    EXPECT_EQ(count_of(all, "light_source"), 4u * kRooms);
    // Originals are geometry: their lamps are chosen, too.
    options.light_error.reset();
    scenes::write(model, from_above(0), options, problems);
    EXPECT_GT(count_of(read_file(options.folder / "scene.pov"), "light_group"), 0u);
    options.light_error = 1;
    scenes::write(model, from_above(0), options, problems);
    EXPECT_GT(count_of(read_file(options.folder / "scene.pov"), "light_group"), 0u);
    builder.model.lights.resize(static_cast<size_t>(kFewShadowRays) - 1);
    scenes::write(builder.model, from_above(1), options, problems);
    EXPECT_EQ(count_of(read_file(options.folder / "scene.pov"), "light_group"), 0u);
    EXPECT_TRUE(problems.empty());
}

TEST_F(LightPlanTest, ALampThatMattersToNothingIsNotWritten) {
    Builder builder;
    add_rooms(builder);
    builder.model.lights.clear();
    builder.model.lights.push_back(scenes::sun(0.5));
    Light lamp;
    lamp.kind = LightKind::Area;
    lamp.position = {2, 2, 400};
    lamp.power = 10;
    builder.model.lights.push_back(lamp);
    Problems problems;
    ExportOptions options = into("nothing");
    options.antialiasing = Antialiasing::Final;
    const ExportReport report = scenes::write(builder.finish(), from_above(0), options, problems);
    EXPECT_EQ(report.lamps, 1u);
    EXPECT_EQ(report.lights_each, 0);
    EXPECT_EQ(count_of(read_file(options.folder / "scene.pov"), "fade_power"), 0u);
    options.light_error = 0;
    scenes::write(builder.model, from_above(0), options, problems);
    EXPECT_EQ(count_of(read_file(options.folder / "scene.pov"), "fade_power"), 1u);
}

// Two lamps by day were said to take 106 rays from each point, soft ones then 2.
TEST_F(LightPlanTest, TheRaysToManySoftLampsAreTold) {
    Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({0.8, 0.8, 0.8})});
    builder.place(box, box_at({0, 0, -0.2}, {4.0 * kRooms, 4, 0}), "floor");
    for (int i = 0; i < 4 * kRooms; ++i)  // whose shadows are soft
        builder.place(box, box_at({i, 0, 2}, {i + 0.5, 4, 2.1}), "slat");
    for (int i = 0; i < 64; ++i) {
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.power = 8;
        lamp.radius = 0.3;
        lamp.position = {0.375 * i, 1.5 + i % 2, 6};
        builder.model.lights.push_back(lamp);
    }
    builder.finish();
    Problems problems;
    ExportOptions options = into("slow");
    options.antialiasing = Antialiasing::Final;
    View view = from_above(0);
    view.width *= 4;
    view.height *= 4;
    const ExportReport slow = scenes::write(builder.model, view, options, problems);
    EXPECT_GT(slow.shadow_rays, 30);
    EXPECT_LE(slow.shadow_rays, 1.1 * 64);
    EXPECT_EQ(slow.lamp_rays, slow.shadow_rays);  // there is no sun
    EXPECT_EQ(slow.soft_lamps, 64u);
    builder.model.lights.resize(2);
    const ExportReport quick = scenes::write(builder.model, view, options, problems);
    EXPECT_NEAR(quick.shadow_rays, 6.8, 1.5);  // POV-Ray's statistics: 6.8 a ray
    builder.model.lights.push_back(scenes::sun(2));
    const ExportReport sunny = scenes::write(builder.model, view, options, problems);
    EXPECT_LT(sunny.lamp_rays, sunny.shadow_rays);
    EXPECT_TRUE(problems.empty());
}

// One mesh of a ground got the grids of all lamps near it everywhere.
TEST_F(LightPlanTest, AGroundIsCutWhereTheLightOfALampEnds) {
    Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({0.8, 0.8, 0.8})});
    builder.place(box, box_at({-200, -200, -0.2}, {200, 200, 0}), "ground");
    builder.model.lights.push_back(scenes::sun(2));
    for (int i = 0; i < 8; ++i) {
        Light lamp;
        lamp.kind = LightKind::Area;
        lamp.position = {-150, 8 * i - 28, 2};
        lamp.power = 12;
        builder.model.lights.push_back(lamp);
    }
    builder.model.world.color = glm::dvec3(0.2);
    View view = from_above(0);
    view.width = 128;
    view.height = 128;
    view.camera.position = {0, 0, 300};
    view.camera.right = {400, 0, 0};
    view.camera.up = {0, 400, 0};
    Problems problems;
    ExportOptions options = into("ground");
    options.antialiasing = Antialiasing::Final;
    const ExportReport report = scenes::write(builder.finish(), view, options, problems);
    EXPECT_LT(report.lights_each, 2);
    EXPECT_GT(report.lights_each, 0);
    const std::string text = read_file(options.folder / "scene.pov");
    EXPECT_GE(count_of(text, "clipped_by"), 2u);
    EXPECT_GE(count_of(text, "light_group"), 1u);
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const scenes::Image ours = scenes::render(builder.model, view, options);
    ExportOptions as_they_are = into("all");
    as_they_are.light_error = 0;
    const scenes::Image all = scenes::render(builder.model, view, as_they_are);
    for (size_t i = 0; i < all.values.size(); ++i)
        ASSERT_NEAR(encoded(all.values[i]), encoded(ours.values[i]), 2.5 / 255) << i;
}

// Up to 20,000 areas were written where it could not be told what they light.
TEST_F(LightPlanTest, WhereLampsCannotBeChosenOnlyTheStrongestAreDrawn) {
    Builder builder;
    add_rooms(builder);
    const Light near_by = builder.model.lights[0];
    builder.model.lights = {scenes::sun(1)};
    for (int i = 0; i < 100; ++i) {
        Light lamp = near_by;
        lamp.name = text("lamp ", i);
        lamp.position.z = -10.0 * (i * 37 % 100);  // below the floor, each farther from the camera
        builder.model.lights.push_back(lamp);
    }
    builder.finish();
    for (Object& object : builder.model.objects) {
        for (Representation& representation : object.representations)
            representation.summary.cost.triangles += 3'000'000;
    }
    Problems problems;
    ExportOptions options = into("unchosen");
    const ExportReport report = scenes::write(builder.model, from_above(0), options, problems);
    EXPECT_EQ(report.lamps, 100u);
    EXPECT_EQ(report.lights_each, 64);
    const std::string all = read_file(options.folder / "scene.pov");
    EXPECT_EQ(count_of(all, "fade_power"), 64u);
    EXPECT_EQ(count_of(all, "parallel"), 1u);
    EXPECT_EQ(count_of(all, "light_group"), 0u);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "lights_left_out");
    EXPECT_EQ(problems[0].object, "lamp 72");  // 640 m below: 72 * 37 % 100 is 64
    EXPECT_NE(problems[0].message.find("35 more of 100"), std::string::npos);
}

// For two lamps of a street that show nothing far away the whole picture was looked through.
TEST_F(LightPlanTest, FewLampsAreNotGrouped) {
    Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({0.8, 0.8, 0.8})});
    builder.place(box, box_at({-200, -200, -0.2}, {200, 200, 0}), "ground");
    for (int i = 0; i < 7; ++i) {
        Light lamp;
        lamp.kind = LightKind::Area;
        lamp.position = {50 * i - 150, 0, 2};
        lamp.power = 100;
        builder.model.lights.push_back(lamp);
    }
    View view = from_above(0);
    view.camera.position = {0, 0, 300};
    view.camera.right = {400, 0, 0};
    view.camera.up = {0, 400, 0};
    Problems problems;
    ExportOptions options = into("few");
    options.antialiasing = Antialiasing::Final;
    const ExportReport report = scenes::write(builder.finish(), view, options, problems);
    EXPECT_EQ(report.lights_each, 7);
    EXPECT_EQ(count_of(read_file(options.folder / "scene.pov"), "light_group"), 0u);
}

TEST_F(LightPlanTest, RoomsHaveTheirOwnLampsAndTheirFloorIsCut) {
    Builder builder;
    add_rooms(builder);
    Problems problems;
    const ExportOptions options = into("rooms");
    const ExportReport report = scenes::write(builder.finish(), from_above(1), options, problems);
    EXPECT_LT(report.lights_each, 9);  // a wall's top may be lit from both sides
    EXPECT_GE(report.lights_each, 1);
    const std::string text = read_file(options.folder / "scene.pov");
    EXPECT_GE(count_of(text, "clipped_by"), size_t{kRooms});
    // One whole throws the floor's shadow.
    EXPECT_EQ(count_of(text, " no_shadow clipped_by"), count_of(text, "clipped_by"));
    EXPECT_EQ(count_of(text, " no_image no_reflection no_radiosity} // "), 1u);
    EXPECT_EQ(report.occurrences, 2u + kRooms);
}

TEST_F(LightPlanTest, IsTheSameEveryTimeAndOnOneThread) {
    Builder builder;
    add_rooms(builder);
    Problems problems;
    const ExportOptions options = into("same");
    const Model& model = builder.finish();
    scenes::write(model, from_above(1), options, problems);
    const std::string once = read_file(options.folder / "scene.pov");
    const ThreadLimit one(1);
    scenes::write(model, from_above(1), options, problems);
    EXPECT_EQ(once, read_file(options.folder / "scene.pov"));
}

TEST_F(LightPlanTest, SunsLightEverythingAndNonsenseHurtsNothing) {
    Builder builder;
    add_rooms(builder);
    builder.model.lights.push_back(scenes::sun(0.5));
    Light lamp = builder.model.lights[0];
    const double nan = std::numeric_limits<double>::quiet_NaN();
    lamp.power = nan;
    builder.model.lights.push_back(lamp);
    lamp.power = 5;
    lamp.position = {nan, 0, 0};
    builder.model.lights.push_back(lamp);
    lamp.position = {5, 2, 1};
    lamp.power = -1;
    builder.model.lights.push_back(lamp);
    Problems problems;
    const ExportOptions options = into("nonsense");
    const ExportReport report = scenes::write(builder.finish(), from_above(1), options, problems);
    EXPECT_EQ(report.lamps, 4u * kRooms);
    const std::string text = read_file(options.folder / "scene.pov");
    EXPECT_EQ(text.find("nan"), std::string::npos);
    // The sun and what takes light away are no group's; groups let them in.
    EXPECT_LT(text.find("parallel"), text.find("light_group"));
    EXPECT_EQ(count_of(text, "light_group"), count_of(text, "global_lights on"));
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "bad_light");
    // A camera inside of everything, one that looks nowhere.
    View view = from_above(1);
    view.camera.position = {2, 2, 0.5};
    view.camera.direction = {0, 0, 0};
    EXPECT_NO_THROW(plan_lights(builder.model, {}, {}, view, {}, problems));
}

// POV-Ray casts shadow rays to lamps of a group anew for each texture of a point: a night took twice
// as long with gloss in layers.
TEST_F(LightPlanTest, WhatLampsOfGroupsLightHasNoLayers) {
    Builder builder;
    Material plastic;
    plastic.roughness = 0.5;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.material(plastic)});
    builder.place(box, box_at({0, 0, -0.2}, {24, 4, 0}), "floor");
    for (size_t i = 0; i < kManyLamps; ++i) {
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.power = 8;
        lamp.position = {3.0 * static_cast<double>(i), 2, 2};
        builder.model.lights.push_back(lamp);
    }
    builder.finish();
    Problems problems;
    const auto layers = [&](const std::string& name, std::optional<double> light_error) {
        ExportOptions options = into(name);
        options.light_error = light_error;
        scenes::write(builder.model, from_above(1), options, problems);
        size_t count = 0;
        for (const auto& file : std::filesystem::directory_iterator(options.folder / "r"))
            count += count_of(read_file(file.path()), "aoi pigment_map");
        return count;
    };
    EXPECT_EQ(layers("many", {}), 0u);
    EXPECT_GT(layers("all", 0.0), 0u);  // of no group
    builder.model.lights.pop_back();
    EXPECT_GT(layers("few", {}), 0u);
}

TEST_F(LightPlanTest, ASunIsWrittenOnceAndAsFinelyAsItsShadowsNeed) {
    Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({0.8, 0.8, 0.8})});
    builder.place(box, box_at({-40, -40, -1}, {40, 40, 0}), "ground");
    builder.place(box, box_at({10, 1, 0}, {11, 4, 1}), "stone");
    builder.place(box, box_at({200, 0, 0}, {201, 1, 90}), "tower far away");
    Light sun;
    sun.kind = LightKind::Sun;
    sun.direction = glm::normalize(glm::dvec3(0.3, 0, -1));
    sun.angle = 0.02;
    builder.model.lights = {sun};
    const Model& model = builder.finish();
    Problems problems;
    ExportOptions options = into("sun");
    options.antialiasing = Antialiasing::Final;
    const auto text = [&] {
        scenes::write(model, from_above(1), options, problems);
        return read_file(options.folder / "scene.pov");
    };
    const std::string sharp = text();
    EXPECT_EQ(count_of(sharp, "parallel point_at"), 1u);
    EXPECT_EQ(count_of(sharp, "light_source"), 1u);
    EXPECT_EQ(count_of(sharp, "light_group"), 0u);
    EXPECT_EQ(count_of(sharp, "area_light"), 0u);
    // Nobody looked: as wide as a shadow could be.
    options.antialiasing = Antialiasing::Reference;
    EXPECT_EQ(count_of(text(), "area_light"), 1u);
    EXPECT_TRUE(problems.empty());
}

TEST_F(PovrayRenderLights, ThePictureIsThatOfAllLampsAndNoRoomIsLitThroughAWall) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    add_rooms(builder);
    const Model& model = builder.finish();
    ExportOptions as_they_are = into("all");
    as_they_are.light_error = 0;
    const scenes::Image all = scenes::render(model, from_above(0), as_they_are);
    const scenes::Image ours = scenes::render(model, from_above(1), into("ours"));
    double sum = 0;
    for (size_t i = 0; i < all.values.size(); ++i)
        sum += std::abs(encoded(all.values[i]) - encoded(ours.values[i]));
    EXPECT_LT(sum / static_cast<double>(all.values.size()), 1.0 / 255);
    const int wide = ours.width / kRooms;
    for (int room = 0; room < kRooms; ++room) {
        glm::dvec3 full(0.0);
        glm::dvec3 found(0.0);
        for (int y = 6; y < ours.height - 6; ++y) {
            for (int x = room * wide + 2; x < (room + 1) * wide - 2; ++x) {
                full += all.at(x, y);
                found += ours.at(x, y);
            }
        }
        const int own = room % 2 == 0 ? 0 : 2;
        EXPECT_GT(found[own], 1);
        EXPECT_EQ(found[2 - own], 0);  // of the neighbors' color
        EXPECT_NEAR(found[own], full[own], 0.02 * full[own]);
    }
}

// One wall behind all storeys of a tower, of which slits as wide as a pixel show a little: most
// storeys had no point of the wall, so no lamp of theirs, and were black.
TEST_F(PovrayRenderLights, AWallPieceAcrossStoreysHasTheLampsOfEachStoreyThatIsSeen) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    constexpr int kStoreys = 24;
    constexpr double kPixel = 0.1;
    Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({0.8, 0.8, 0.8})});
    builder.place(box, box_at({-13, 3, -1}, {13, 3.2, kStoreys + 1}), "wall");
    builder.place(box, box_at({-13, -0.2, -1}, {0, 0, kStoreys + 1}), "left of the slits");
    builder.place(box, box_at({kPixel, -0.2, -1}, {13, 0, kStoreys + 1}), "right of the slits");
    for (int i = 0; i <= kStoreys; ++i) {
        builder.place(box, box_at({-13, 0, i - 0.05}, {13, 3, i + 0.05}), "floor");
        builder.place(box, box_at({0, -0.2, i - 0.3}, {kPixel, 0, i + 0.3}), "between slits");
    }
    for (int i = 0; i < kStoreys; ++i) {
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.power = 60;
        lamp.position = {0, 1.5, i + 0.5};
        builder.model.lights.push_back(lamp);
    }
    View view = from_above(1);
    view.width = 260;
    view.height = 10 * kStoreys;
    view.camera.position = {0, -20, kStoreys / 2.0};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {kPixel * view.width, 0, 0};
    view.camera.up = {0, 0, kPixel * view.height};
    const ExportOptions options = into("tower");
    const scenes::Image image = scenes::render(builder.finish(), view, options);
    EXPECT_GT(count_of(read_file(options.folder / "scene.pov"), "light_group"), 0u);
    for (int i = 0; i < kStoreys; ++i) {
        for (const int y : {4, 5})
            EXPECT_GT(image.at(view.width / 2, 10 * i + y).x, 0.3) << "storey " << i;
    }
}

TEST_F(PovrayRenderLights, WhatIsHiddenFromSomeRaysOrClearKeepsItsFlags) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    add_rooms(builder);
    Material glass;
    glass.transmission = 1;
    glass.roughness = 0;
    const ObjectIndex pane = builder.mesh(shapes::cube(), {builder.material(glass)});
    builder.place(pane, box_at({0, 0, 2.8}, {4.0 * kRooms, 4, 2.9}), "pane");
    const ObjectIndex lid = builder.mesh(shapes::cube(), {builder.matte({0, 1, 0})});
    builder.place(lid, box_at({0, 0, 3.5}, {4.0 * kRooms, 4, 3.6}), "lid", kCameraRays);
    const Model& model = builder.finish();
    ExportOptions as_they_are = into("all");
    as_they_are.light_error = 0;
    const scenes::Image all = scenes::render(model, from_above(0), as_they_are);
    const ExportOptions options = into("ours");
    const scenes::Image ours = scenes::render(model, from_above(1), options);
    EXPECT_GT(count_of(read_file(options.folder / "scene.pov"), "light_group"), 1u);
    double sum = 0;
    double light = 0;
    for (size_t i = 0; i < all.values.size(); ++i) {
        sum += std::abs(encoded(all.values[i]) - encoded(ours.values[i]));
        light += all.values[i];
    }
    EXPECT_GT(light, 10);
    EXPECT_LT(sum / static_cast<double>(all.values.size()), 1.5 / 255);
}
