/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards the C interface as a C11 program sees it: null pointers, stale ids, outputs untouched on
   failure, sentences that name the thing, one small model through every call. */
#include "cube.h"

static void test_versions(void) {
    EXPECT(lds_abi_version() == LDS_ABI_VERSION);
    EXPECT(strlen(lds_version()) >= 5);
    EXPECT(strcmp(lds_status_name(LDS_ERROR_STALE_ID), "STALE_ID") == 0);
    EXPECT(strcmp(lds_status_name((lds_status)999), "UNKNOWN") == 0);
}

static void test_null_pointers(void) {
    lds_object object = {7, 7};
    lds_totals totals = {sizeof totals, 0, 0, 0, 0, 0};
    size_t count = 42;
    EXPECT(lds_model_create(NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strcmp(lds_last_error_text(), "out_model is null") == 0);
    EXPECT(lds_model_read(NULL, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_add_mesh(NULL, NULL, NULL, NULL, 0, &object) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_add_group(NULL, NULL, &object) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(object.index == 7 && object.generation == 7);
    EXPECT(lds_model_totals(NULL, &totals) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_occurrence_count(NULL, &count) == LDS_ERROR_INVALID_ARGUMENT && count == 42);
    EXPECT(lds_model_object_count(NULL) == 0);
    EXPECT(lds_model_problem_count(NULL) == 0);
    EXPECT(lds_cut_choice_count(NULL) == 0);
    EXPECT(strcmp(lds_cut_choice_path(NULL, 0), "") == 0);
    EXPECT(lds_cut_create(NULL, NULL, NULL, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_image_size(NULL, NULL, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(NULL);
    lds_cut_destroy(NULL);
}

static void test_mistakes_are_named(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_mesh_view view = cube_view();
    lds_object_info info = info_of("other", "Other");
    lds_object object = {7, 7};
    view.vertex_count = 3;
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, &object) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strcmp(lds_last_error_text(), "triangle 1 uses vertex 3 of 3") == 0);
    view = cube_view();
    view.struct_size = 4;
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, &object) == LDS_ERROR_INVALID_ARGUMENT);
    view = cube_view();
    const uint32_t material = 9;
    EXPECT(lds_model_add_mesh(model, &info, &view, &material, 1, &object) ==
           LDS_ERROR_INVALID_ARGUMENT);
    info = info_of("cube", "Twice");
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, &object) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "'cube'") != NULL);
    EXPECT(object.index == 7 && object.generation == 7);
    double bad[12];
    memcpy(bad, kIdentity, sizeof bad);
    bad[5] = NAN;
    EXPECT(lds_model_add_placement(model, cube, cube, kIdentity, "in a mesh") ==
           LDS_ERROR_INVALID_ARGUMENT);
    lds_object group;
    EXPECT(lds_model_find_object(model, "pair", &group) == LDS_OK);
    EXPECT(lds_model_add_placement(model, group, cube, bad, "nan") == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "'nan'") != NULL);
    lds_totals totals = {sizeof totals, 0, 0, 0, 0, 0};
    EXPECT(lds_model_totals(model, &totals) == LDS_OK);
    EXPECT(totals.occurrences == 2 && totals.triangles_placed == 24 &&
           totals.triangles_unique == 12);
    /* A group inside itself is refused when it is used. */
    EXPECT(lds_model_add_placement(model, group, group, kIdentity, "itself") == LDS_OK);
    EXPECT(lds_model_totals(model, &totals) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

static void test_stale_ids(void) {
    lds_object cube;
    lds_model* first = two_cubes(&cube);
    lds_model_destroy(first);
    lds_object other;
    lds_model* second = two_cubes(&other);
    EXPECT(lds_model_set_root(second, cube) == LDS_ERROR_STALE_ID);
    const lds_object none = {0, 0};
    EXPECT(lds_model_set_root(second, none) == LDS_ERROR_STALE_ID);
    lds_object_summary summary;
    memset(&summary, 0, sizeof summary);
    summary.struct_size = sizeof summary;
    EXPECT(lds_model_object_summary(second, cube, &summary) == LDS_ERROR_STALE_ID);
    EXPECT(summary.name == NULL);
    lds_model_destroy(second);
}

static void test_surface_inertia(void) {
    double area = 0;
    double center[3];
    double inertia[6];
    EXPECT(lds_surface_inertia(&kPositions[0][0], 8, &kTriangles[0][0], 12, &area, center,
                               inertia) == LDS_OK);
    EXPECT(fabs(area - 6) < 1e-12);
    EXPECT(fabs(center[1] - 0.5) < 1e-12);
    EXPECT(fabs(inertia[0] - 5.0 / 3) < 1e-12 && fabs(inertia[3]) < 1e-12);
    area = -1;
    EXPECT(lds_surface_inertia(&kPositions[0][0], 8, &kTriangles[0][0], 0, &area, center,
                               inertia) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(area == -1);
}

static void test_build_and_cut(const char* scratch) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_camera camera = camera_before(400);
    EXPECT(lds_model_add_camera(model, &camera) == LDS_OK);
    lds_world world = {.struct_size = sizeof world, .color = {0.1, 0.1, 0.1}};
    EXPECT(lds_model_set_world(model, &world) == LDS_OK);
    lds_light light;
    memset(&light, 0, sizeof light);
    light.struct_size = sizeof light;
    EXPECT(lds_model_add_light(model, &light) == LDS_ERROR_INVALID_ARGUMENT); /* no direction */
    light.direction[2] = -1;
    light.color[0] = light.power = 1;
    EXPECT(lds_model_add_light(model, &light) == LDS_OK);

    lds_build_options options = {.struct_size = sizeof options};
    EXPECT(lds_build_options_default(&options) == LDS_OK);
    lds_cost_model costs = {.struct_size = sizeof costs};
    EXPECT(lds_cost_model_default(&costs) == LDS_OK);
    EXPECT(costs.triangle_bytes > 0 && costs.primitive_bytes > costs.triangle_bytes);
    EXPECT(costs.occurrence_bytes > 0);
    EXPECT(lds_cost_model_default(NULL) == LDS_ERROR_INVALID_ARGUMENT);
    options.rebuild = 1; /* an earlier run may have left its store here */
    lds_build_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    EXPECT(lds_model_build_estimate(model, scratch, &options, &report) == LDS_OK);
    EXPECT(report.built == 2);
    lds_job job = {sizeof job, 0, 0, 0};
    EXPECT(lds_model_build(model, scratch, &options, &job, &report) == LDS_OK);
    EXPECT(job.fraction == 1);
    lds_model_destroy(model);

    EXPECT(lds_model_read(scratch, &model) == LDS_OK);
    EXPECT(lds_model_camera_count(model) == 1);
    lds_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    lds_camera stored = {.struct_size = sizeof stored};
    EXPECT(lds_model_camera(model, 0, &stored) == LDS_OK);
    view.camera = &stored;
    view.width = 640;
    view.height = 360;
    view.pixel_error = 1;
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    lds_cut_summary summary;
    memset(&summary, 0, sizeof summary);
    summary.struct_size = sizeof summary;
    EXPECT(lds_cut_get_summary(cut, &summary) == LDS_OK);
    EXPECT(summary.occurrences >= 1 && summary.largest_error_px <= 1);
    uint64_t drawn = 0;
    for (int kind = 0; kind < LDS_KIND_ASSEMBLY; ++kind)
        drawn += summary.occurrences_of_kind[kind];
    EXPECT(drawn == summary.occurrences && summary.occurrences_of_kind[LDS_KIND_ASSEMBLY] == 0);
    lds_choice choices[8];
    EXPECT(lds_cut_choice_copy(cut, choices, 8) == LDS_OK);
    EXPECT(lds_cut_choice_count(cut) == summary.occurrences);
    lds_cut_destroy(cut);
    view.pixel_error = NAN;
    cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_ERROR_INVALID_ARGUMENT && cut == NULL);
    job.cancel = 1;
    EXPECT(lds_model_build(model, scratch, &options, &job, &report) == LDS_ERROR_CANCELLED);
    lds_model_destroy(model);
}

int main(int argc, char** argv) {
    test_versions();
    test_null_pointers();
    test_mistakes_are_named();
    test_stale_ids();
    test_surface_inertia();
    if (lds_rays_check() == LDS_OK)
        test_build_and_cut(argc > 1 ? argv[1] : "capi_store");
    return finish();
}
