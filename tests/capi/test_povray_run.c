/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards running POV-Ray from C: a picture of two cubes, the memory it took, failures. Passes
   without a look when there is no POV-Ray. */
#include "cube.h"

enum { WIDTH = 64, HEIGHT = 36 };

static void test_two_cubes_are_seen(const char* folder) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_world world = {
        .struct_size = sizeof world, .color = {0.5, 0.5, 0.5}, .transparent = 1};
    EXPECT(lds_model_set_world(model, &world) == LDS_OK);
    const lds_camera camera = camera_before(20);
    const lds_view view = view_of(&camera, WIDTH, HEIGHT);
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    lds_povray_options options = {.struct_size = sizeof options};
    EXPECT(lds_povray_options_default(&options) == LDS_OK);
    options.antialias = LDS_ANTIALIAS_OFF;
    lds_export_report exported;
    memset(&exported, 0, sizeof exported);
    exported.struct_size = sizeof exported;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &exported) == LDS_OK);
    lds_povray_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    lds_job job = {sizeof job, 0, 0, 0};
    EXPECT(lds_povray_run(folder, "picture.png", &options, &job, &report) == LDS_OK);
    EXPECT(report.exit_code == 0 && report.wall_s > 0 && report.peak_bytes > 1000000);
    char path[512];
    snprintf(path, sizeof path, "%s/picture.png", folder);
    static float pixels[WIDTH * HEIGHT * 4];
    EXPECT(lds_image_read(path, 0, pixels, WIDTH * HEIGHT * 4) == LDS_OK);
    /* The left cube's lower left front corner is in the middle of the picture. */
    EXPECT(pixels[4 * ((HEIGHT / 2 - 2) * WIDTH + WIDTH / 2 + 1) + 3] > 0.99f);
    EXPECT(pixels[4 * ((HEIGHT / 2 - 2) * WIDTH + WIDTH / 2 - 2) + 3] < 0.01f);
    uint64_t empty = 0;
    EXPECT(lds_povray_empty_bytes(WIDTH, HEIGHT, NULL, &empty) == LDS_OK);
    EXPECT(empty > 1000000 && empty < report.peak_bytes + 10000000);
    EXPECT(lds_povray_run("no_such_folder", "picture.png", &options, NULL, &report) != LDS_OK);
    lds_cut_destroy(cut);
    lds_model_destroy(model);
}

int main(int argc, char** argv) {
    const char* program = NULL;
    if (lds_povray_find(NULL, &program) == LDS_OK) {
        EXPECT(strlen(program) > 0);
        test_two_cubes_are_seen(argc > 1 ? argv[1] : "capi_povray_run");
    }
    return finish();
}
