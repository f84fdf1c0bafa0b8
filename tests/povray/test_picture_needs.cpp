// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that a picture is the same without what it does not need, and what is never left out.
#include "povray/mask_cards.h"
#include "povray_export/lamp/renderer_surfaces.h"
#include "povray_export/occurrence/picture_needs.h"
#include "ray/mesh_scene.h"
#include "scenes/fine_grids.h"

#include <map>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

class PictureNeedsScenes : public testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        if (!ray::available(&reason))
            GTEST_SKIP() << reason;
        std::filesystem::remove_all(own_scratch());
        builder.model.world.color = glm::dvec3(0.3);
        builder.model.lights = {scenes::sun(2, {0.5, 0, -1})};
        view.modifiers.off_screen = OffScreen::Reflected;
    }

    /// A ground that reaches far out of the picture, in 20,000 triangles; balls on it, one of them
    /// out of the picture with its shadow inside, one in the picture's middle below a table, and
    /// many far away.
    void fill() {
        Mesh ground = shapes::grid(100);
        for (glm::vec3& at : ground.positions)
            at = {20 * (at.x - 0.5f), 20 * (at.y - 0.5f), -1};
        ground.uvs.clear();
        ground.normals.clear();
        const uint32_t green = builder.matte({0.2, 0.5, 0.1});
        const uint32_t red = builder.matte({0.6, 0.1, 0.1});
        builder.place(builder.mesh(ground, {green}), {}, "ground");
        const ObjectIndex ball = builder.mesh(shapes::sphere(0.3, 3), {red});
        const ObjectIndex table = builder.mesh(shapes::box({-0.5, -0.5, 0}, {0.5, 0.5, 0.1}));
        builder.place(table, {}, "table");
        builder.place(ball, {glm::dmat3(0.5), {0, 0, -0.5}}, "below");
        builder.place(ball, {glm::dmat3(1.0), {-1.6, 0.4, 0.5}}, "aside");
        builder.place(ball, {glm::dmat3(1.0), {0.6, -0.6, -0.6}}, "seen");
        for (int i = 0; i < 20; ++i)
            builder.place(ball, {glm::dmat3(1.0), {6 + 0.1 * i, -5 + 0.5 * i, 0}}, "far");
    }
    ExportReport write(const char* folder) {
        ExportOptions options;
        options.folder = own_scratch() / folder;
        Problems problems;
        const ExportReport report = scenes::write(builder.finish(), view, options, problems);
        EXPECT_TRUE(problems.empty());
        return report;
    }

    Builder builder;
    View view = scenes::above();
};
using PovrayRenderNeeds = PictureNeedsScenes;

}  // namespace

TEST_F(PictureNeedsScenes, WhatIsNotNeededIsLeftOut) {
    fill();
    const ExportReport needed = write("needed");
    view.modifiers.off_screen = OffScreen::Full;
    const ExportReport full = write("full");
    EXPECT_EQ(full.left_out, 0u);
    EXPECT_EQ(full.occurrences, 25u);
    EXPECT_EQ(needed.left_out, 21u);  // those far away, and the one below
    EXPECT_EQ(needed.occurrences, 4u);
    EXPECT_LT(5 * needed.bytes, full.bytes);
    EXPECT_LT(5 * needed.text_bytes, full.text_bytes);
    EXPECT_EQ(needed.covered, 1);  // by the ground
    const std::string scene = read_file(own_scratch() / "needed" / "scene.pov");
    EXPECT_EQ(scene.find("far"), std::string::npos);
    EXPECT_NE(scene.find("aside"), std::string::npos);
}

TEST_F(PictureNeedsScenes, NothingIsLeftOutWhereMoreThanRaysTell) {
    fill();
    view.pixel_error = 0;
    EXPECT_EQ(write("originals").left_out, 0u);
    view.pixel_error = 1;
    ExportOptions options;
    options.folder = own_scratch() / "bounces";
    options.shading.bounces = 1;
    Problems problems;
    EXPECT_EQ(scenes::write(builder.finish(), view, options, problems).left_out, 0u);
    options.folder = own_scratch() / "flat";
    options.shading.bounces = 0;
    options.false_color = true;
    EXPECT_EQ(scenes::write(builder.finish(), view, options, problems).left_out, 0u);
    view = scenes::above();
    view.modifiers.off_screen = OffScreen::Reflected;
    view.camera.orthographic = false;
    view.camera.right /= 10;
    view.camera.up /= 10;
    EXPECT_NE(write("sharp").left_out, 0u);
    view.camera.focus_distance = 10;
    view.camera.aperture = 0.5;
    EXPECT_EQ(write("blurred").left_out, 0u);
}

// Full detail found the sky's light on a street behind the camera, and had no rays left for the rest.
TEST_F(PictureNeedsScenes, FullDetailDrawsAllAndKnowsWhatItShows) {
    fill();
    view.pixel_error = 0;
    const choose::Cut cut = choose::choose_cut(builder.finish(), view);
    PictureNeeds needs;
    EXPECT_TRUE(needs.shown(0));
    const auto find = [&](bool still) {
        needs.find(builder.model, renderer_surfaces(builder.model), cut, view, builder.model.lights,
                   still, {});
    };
    // Frames that found the light of what each of them shows wrote the same things over and over.
    find(false);
    EXPECT_TRUE(needs.shown_triangles(0).empty());
    find(true);
    size_t shown = 0;
    for (size_t i = 0; i < cut.chosen.size(); ++i) {
        EXPECT_FALSE(needs.left_out(i));
        EXPECT_TRUE(needs.seen(i));
        EXPECT_TRUE(needs.triangles(i).empty());
        EXPECT_EQ(needs.shown_triangles(i).empty(), false);
        shown += needs.shown(i) ? 1 : 0;
    }
    EXPECT_EQ(cut.chosen.size(), 25u);
    EXPECT_EQ(shown, 3u);  // ground, table and one ball
    EXPECT_EQ(needs.bytes_left_out(), 0u);
    EXPECT_EQ(needs.covered(), 1);
}

TEST_F(PictureNeedsScenes, SmallScenesAreNotLookedThrough) {
    const ObjectIndex box = builder.mesh(shapes::cube());
    builder.place_at(box, {0, 0, 0});
    builder.place_at(box, {50, 0, 0});
    EXPECT_EQ(write("small").left_out, 0u);
}

// A tree of 400 bulbs: each ray to a lamp passed the boxes of those behind it.
TEST_F(PictureNeedsScenes, SmallScenesOfManyLampsAreLookedThrough) {
    const ObjectIndex box = builder.mesh(shapes::cube());
    builder.place_at(box, {0, 0, 0});
    builder.place_at(box, {50, 0, 0});
    for (int i = 0; i < 8; ++i) {
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.position = {0.1 * i, 0, 3};
        lamp.power = 10;
        builder.model.lights.push_back(lamp);
    }
    EXPECT_EQ(write("many").left_out, 1u);
    builder.model.lights.pop_back();
    EXPECT_EQ(write("few").left_out, 0u);
}

// What a picture of much sky takes was foretold as if all of it were covered.
TEST_F(PictureNeedsScenes, TheShareOfThePictureThatIsCoveredIsTold) {
    const double wide = glm::length(view.camera.right);
    const double high = glm::length(view.camera.up);
    ASSERT_TRUE(view.camera.orthographic);
    Mesh plate = shapes::grid(40);
    for (glm::vec3& at : plate.positions)
        at = {wide * (at.x - 0.5) / 2, high * (at.y - 0.5) / 2, 0};
    plate.uvs.clear();
    plate.normals.clear();
    builder.place(builder.mesh(plate), {}, "plate");
    EXPECT_NEAR(write("quarter").covered, 0.25, 0.02);
    view.modifiers.off_screen = OffScreen::Full;
    // It is not looked through then: the discs around bounds count.
    EXPECT_NEAR(write("unknown").covered, 0.25, 0.2);
}

TEST_F(PictureNeedsScenes, CopiesShareTheTrianglesThatAnyNeeds) {
    fill();
    write("needed");
    std::map<std::string, int> meshes;
    for (const auto& entry : std::filesystem::directory_iterator(own_scratch() / "needed" / "r")) {
        if (entry.path().extension() != ".inc")
            continue;
        const std::string text = read_file(entry.path());
        const size_t at = text.find("face_indices{") + 13;
        ++meshes[text.substr(at, text.find(',', at) - at)];
    }
    // The ground in part, the table, and the ball: its sunny side throws the shadow, and the other
    // copy shows its upper half.
    ASSERT_EQ(meshes.size(), 3u);
    EXPECT_EQ(meshes.count("20000"), 0u);
    EXPECT_EQ(meshes.count("12"), 1u);
}

TEST_F(PovrayRenderNeeds, APictureIsTheSameWithoutWhatItDoesNotNeed) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    fill();
    // A tree before it all, through whose leaves the rest is seen.
    const uint32_t leaf_material = builder.material(leaf(disk(16)));
    const ObjectIndex leaves = builder.mesh(card(), {leaf_material});
    for (int i = 0; i < 12; ++i)
        builder.place(leaves, {glm::dmat3(0.1), {-0.8 + 0.1 * i, 0.5, 1 + 0.05 * i}}, "leaf");
    builder.finish();
    ExportOptions options;
    options.antialiasing = Antialiasing::Off;
    options.folder = own_scratch() / "needed";
    const scenes::Image needed = scenes::render(builder.model, view, options);
    view.modifiers.off_screen = OffScreen::Full;
    options.folder = own_scratch() / "full";
    const scenes::Image full = scenes::render(builder.model, view, options);
    ASSERT_EQ(needed.values.size(), full.values.size());
    size_t off = 0;
    for (size_t i = 0; i < full.values.size(); ++i)
        off += std::abs(needed.values[i] - full.values[i]) > 0.02 ? 1 : 0;
    EXPECT_LE(off, full.values.size() / 1000);
}
