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

/* The folder has the scene of test_two_cubes_are_seen. */
static void test_it_is_drawn_before_the_eyes(const char* folder) {
    const int32_t part[4] = {0, 0, WIDTH, HEIGHT};
    lds_live_picture* live = NULL;
    EXPECT(lds_live_picture_create(part, &live) == LDS_OK);
    lds_povray_options options = {.struct_size = sizeof options};
    EXPECT(lds_povray_options_default(&options) == LDS_OK);
    lds_povray_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    lds_job job = {sizeof job, 0, 0, 0};
    EXPECT(lds_povray_run_live(folder, "live.exr", &options, NULL, &job, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_povray_run_live(folder, "live.exr", &options, live, &job, &report) == LDS_OK);
    EXPECT(report.exit_code == 0 && job.fraction == 1);
    /* So small a picture may be finished before anybody looks. */
    uint64_t finished = 0;
    EXPECT(lds_live_picture_finished(live, &finished) == LDS_OK);
    EXPECT(finished <= WIDTH * HEIGHT);
    static float pixels[WIDTH * HEIGHT * 4];
    int32_t drawn[4] = {0, 0, 1, 1};
    uint64_t taken = 0;
    while (drawn[2] != 0) {
        EXPECT(lds_live_picture_take(live, 1, drawn, pixels, WIDTH * HEIGHT * 4) == LDS_OK);
        EXPECT(drawn[0] + drawn[2] <= WIDTH && drawn[1] + drawn[3] <= HEIGHT);
        taken += (uint64_t)(drawn[2] * drawn[3]);
    }
    EXPECT(taken >= finished && taken <= WIDTH * HEIGHT);
    lds_live_picture_destroy(live);
}

static void test_a_live_picture_refuses_nonsense(void) {
    const int32_t none[4] = {0, 0, 0, HEIGHT};
    const int32_t part[4] = {0, 0, WIDTH, HEIGHT};
    lds_live_picture* live = NULL;
    EXPECT(lds_live_picture_create(none, &live) == LDS_ERROR_INVALID_ARGUMENT && live == NULL);
    EXPECT(lds_live_picture_create(NULL, &live) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_live_picture_create(part, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_live_picture_create(part, &live) == LDS_OK);
    int32_t drawn[4] = {1, 2, 3, 4};
    float pixels[4];
    uint64_t finished = 7;
    EXPECT(lds_live_picture_take(NULL, 0, drawn, pixels, 4) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_live_picture_take(live, 0, NULL, pixels, 4) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_live_picture_take(live, 0, drawn, NULL, 4) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(drawn[0] == 1 && drawn[3] == 4);
    EXPECT(lds_live_picture_take(live, 0, drawn, pixels, 4) == LDS_OK && drawn[2] == 0);
    EXPECT(lds_live_picture_finished(live, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_live_picture_finished(NULL, &finished) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(finished == 7);
    EXPECT(lds_live_picture_finished(live, &finished) == LDS_OK && finished == 0);
    lds_live_picture_destroy(live);
    lds_live_picture_destroy(NULL);
}

int main(int argc, char** argv) {
    const char* program = NULL;
    test_a_live_picture_refuses_nonsense();
    if (lds_povray_find(NULL, &program) == LDS_OK) {
        EXPECT(strlen(program) > 0);
        const char* folder = argc > 1 ? argv[1] : "capi_povray_run";
        test_two_cubes_are_seen(folder);
        test_it_is_drawn_before_the_eyes(folder);
    }
    return finish();
}
