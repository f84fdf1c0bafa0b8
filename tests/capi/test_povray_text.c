/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards the export to POV-Ray as a C program sees it: the files, what is shared, false colors, a
   missing program. POV-Ray itself is not needed. */
#include "cube.h"

#include <math.h>
#include <stddef.h>

/* How often `part` is in the file; -1 when it cannot be read. */
static int count_in(const char* path, const char* part) {
    FILE* file = fopen(path, "rb");
    if (file == NULL)
        return -1;
    static char text[1 << 16];
    const size_t size = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[size] = '\0';
    int count = 0;
    for (const char* at = strstr(text, part); at != NULL; at = strstr(at + 1, part))
        ++count;
    return count;
}

static void test_two_cubes_share_one_file(const char* folder) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_camera camera = camera_before(20);
    const lds_view view = view_of(&camera, 64, 36);
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    lds_povray_options options = {.struct_size = sizeof options};
    EXPECT(lds_povray_options_default(&options) == LDS_OK);
    EXPECT(options.antialias == LDS_ANTIALIAS_FINAL && options.false_color == 0);
    EXPECT(options.light_error < 0); /* the view's Pixel Error */
    lds_export_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    options.antialias = 3;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(report.files == 0);
    options.antialias = LDS_ANTIALIAS_OFF;
    options.light_error = NAN;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    options.light_error = 2;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) == LDS_OK);
    EXPECT(report.lamps == 0 && report.lights_each == 0);
    lds_povray_options few = options;
    few.struct_size = 4;
    EXPECT(lds_povray_export(model, cut, &view, folder, &few, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(report.files == 3 && report.bytes > 0); /* scene.pov, scene.ini, the cube */
    char path[512];
    snprintf(path, sizeof path, "%s/scene.pov", folder);
    EXPECT(count_in(path, "camera") == 1);
    EXPECT(count_in(path, "#include") == 1);
    EXPECT(count_in(path, "object") == 2);
    EXPECT(count_in(path, "Cube") == 0); /* names of users stay out */
    snprintf(path, sizeof path, "%s/scene.ini", folder);
    EXPECT(count_in(path, "Width=64") == 1 && count_in(path, "Height=36") == 1);
    const uint64_t bytes = report.bytes;
    options.shadow_error = -1;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    options.shadow_error = 0;
    options.bounces = 2;
    options.bounce_error = NAN;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    options.bounce_error = 0;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) == LDS_OK);
    EXPECT(count_in(path, "radiosity") == 0); /* scene.ini */
    snprintf(path, sizeof path, "%s/scene.pov", folder);
    EXPECT(count_in(path, "radiosity{") == 1);
    options.trace_depth = 9;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) == LDS_OK);
    EXPECT(count_in(path, "max_trace_level 9") == 1);
    options.bounces = 0; /* rough cubes mirror nothing */
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) == LDS_OK);
    EXPECT(count_in(path, "max_trace_level 1 ") == 1);
    options.trace_depth = 0;
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, NULL, &report) == LDS_OK);
    EXPECT(report.bytes == bytes && report.written < report.files);
    lds_job job = {sizeof job, 1, 0, 0};
    EXPECT(lds_povray_export(model, cut, &view, folder, &options, &job, &report) ==
           LDS_ERROR_CANCELLED);
    lds_object other;
    lds_model* stranger = two_cubes(&other);
    EXPECT(lds_povray_export(stranger, cut, &view, folder, &options, NULL, &report) ==
           LDS_ERROR_STALE_ID);
    lds_model_destroy(stranger);
    lds_cut_destroy(cut);
    lds_model_destroy(model);
}

static void test_false_colors_tell_kinds_and_levels_apart(void) {
    double fine[3] = {-1, -1, -1};
    double coarse[3];
    double box[3];
    double coarse_box[3];
    EXPECT(lds_povray_false_color(LDS_KIND_ASSEMBLY, 0, fine) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(fine[0] == -1);
    EXPECT(lds_povray_false_color(LDS_KIND_MESH, 0, fine) == LDS_OK);
    EXPECT(lds_povray_false_color(LDS_KIND_MESH, 4, coarse) == LDS_OK);
    EXPECT(lds_povray_false_color(LDS_KIND_BOX, 2, box) == LDS_OK);
    EXPECT(lds_povray_false_color(LDS_KIND_BOX, 9, coarse_box) == LDS_OK);
    EXPECT(memcmp(fine, coarse, sizeof fine) != 0);
    EXPECT(memcmp(box, coarse_box, sizeof box) == 0);
    for (int i = 0; i < 3; ++i)
        EXPECT(fine[i] >= 0 && fine[i] <= 1 && box[i] >= 0 && box[i] <= 1);
}

static void test_a_missing_program_is_named(void) {
    const char* path = NULL;
    EXPECT(lds_povray_find("/no/such/povray", &path) == LDS_ERROR_POVRAY_MISSING);
    EXPECT(path == NULL && strstr(lds_last_error_text(), "/no/such/povray") != NULL);
    uint64_t bytes = 7;
    EXPECT(lds_povray_empty_bytes(64, 36, "/no/such/povray", &bytes) == LDS_ERROR_POVRAY_MISSING);
    EXPECT(bytes == 7);
}

int main(int argc, char** argv) {
    test_two_cubes_share_one_file(argc > 1 ? argv[1] : "capi_povray_text");
    test_false_colors_tell_kinds_and_levels_apart();
    test_a_missing_program_is_named();
    return finish();
}
