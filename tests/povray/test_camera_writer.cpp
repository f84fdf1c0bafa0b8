// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the text of cameras and of the part of the picture that is drawn. That the blur is Cycles'
// is tests/blender/blender_test_camera.py's to prove.
#include "povray/povray_scenes.h"
#include "povray_export/scene/camera_writer.h"

using namespace lodestone;
using namespace lodestone::povray;

namespace {

std::string written(const Camera& camera, Problems& problems) {
    std::string text;
    append_camera(text, camera, Antialiasing::Final, problems);
    return text;
}

std::string ini_of(const View& view, int margin = 0) {
    scenes::Builder builder;
    builder.place(builder.mesh(shapes::cube()));
    ExportOptions options;
    options.folder = scratch("camera_ini");
    options.margin = margin;
    Problems problems;
    scenes::write(builder.finish(), view, options, problems);
    return read_file(options.folder / "scene.ini");
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST(PovrayCamera, WithoutDepthOfFieldNothingIsBlurred) {
    Problems problems;
    Camera camera;
    camera.focus_distance = 3;
    EXPECT_FALSE(has(written(camera, problems), "aperture"));
    EXPECT_TRUE(has(ini_of(scenes::above()), "Antialias=On"));
    EXPECT_TRUE(problems.empty());
}

TEST(PovrayCamera, TheFocusLiesOnTheDirectionAtItsDepth) {
    Problems problems;
    Camera camera;
    camera.position = {1, 2, 3};
    camera.direction = {0.5, 0, -1};  // shifted
    camera.focus_distance = 4;
    camera.aperture = 0.25;
    EXPECT_TRUE(has(written(camera, problems), "focal_point <3,2,-1> aperture 0.5 "));
    camera.direction *= 2;
    camera.right *= 2;
    camera.up *= 2;
    EXPECT_TRUE(has(written(camera, problems), "focal_point <3,2,-1> aperture 0.5 "));
    View view = scenes::above();
    view.camera = camera;
    EXPECT_TRUE(has(ini_of(view), "Antialias=Off"));
}

TEST(PovrayCamera, OrthographicBlurIsNamed) {
    Problems problems;
    Camera camera;
    camera.orthographic = true;
    camera.focus_distance = camera.aperture = 1;
    EXPECT_FALSE(has(written(camera, problems), "aperture"));
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "depth_of_field");
}

TEST(PovrayCamera, ABorderIsTheOnlyPartDrawn) {
    View view = scenes::above(64, 36);
    EXPECT_FALSE(has(ini_of(view), "Start_Column"));
    view.border = RenderBorder{16, 9, 32, 18};
    const std::string ini = ini_of(view);
    for (const char* line :
         {"Start_Column=17\n", "End_Column=48\n", "Start_Row=10\n", "End_Row=27\n"})
        EXPECT_TRUE(has(ini, line)) << line << ini;
}

TEST(PovrayCamera, AMarginIsDrawnAroundABorderWithinThePicture) {
    View view = scenes::above(64, 36);
    EXPECT_FALSE(has(ini_of(view, 2), "Start_Column"));
    view.border = RenderBorder{1, 9, 32, 26};
    const std::string ini = ini_of(view, 2);
    for (const char* line :
         {"Start_Column=1\n", "End_Column=35\n", "Start_Row=8\n", "End_Row=36\n"})
        EXPECT_TRUE(has(ini, line)) << line << ini;
}
