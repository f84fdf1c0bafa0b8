/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards what a C program asks of simplifying: each target, each mode, older structs. */
#include "cube.h"

enum { CELLS = 16 };

/* A flat square of 2 CELLS^2 triangles, alone in its model. */
static lds_model* flat_grid(lds_object* grid) {
    static float positions[(CELLS + 1) * (CELLS + 1)][3];
    static uint32_t triangles[2 * CELLS * CELLS][3];
    for (uint32_t j = 0; j <= CELLS; ++j) {
        for (uint32_t i = 0; i <= CELLS; ++i) {
            positions[j * (CELLS + 1) + i][0] = (float)i / CELLS;
            positions[j * (CELLS + 1) + i][1] = (float)j / CELLS;
        }
    }
    for (uint32_t j = 0; j < CELLS; ++j) {
        for (uint32_t i = 0; i < CELLS; ++i) {
            const uint32_t at = j * (CELLS + 1) + i;
            uint32_t(*pair)[3] = &triangles[2 * (j * CELLS + i)];
            pair[0][0] = pair[1][0] = at;
            pair[0][1] = at + 1;
            pair[0][2] = pair[1][1] = at + CELLS + 2;
            pair[1][2] = at + CELLS + 1;
        }
    }
    lds_mesh_view view = cube_view();
    view.positions = &positions[0][0];
    view.vertex_count = (CELLS + 1) * (CELLS + 1);
    view.triangles = &triangles[0][0];
    view.triangle_count = 2 * CELLS * CELLS;
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    const lds_object_info info = info_of("grid", "Grid");
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, grid) == LDS_OK);
    EXPECT(lds_model_set_root(model, *grid) == LDS_OK);
    return model;
}

static void test_simplifying_a_flat_grid_costs_no_shape(void) {
    lds_object grid;
    lds_model* model = flat_grid(&grid);
    lds_simplify_options options = {.struct_size = sizeof options};
    EXPECT(lds_simplify_options_default(&options) == LDS_OK);
    lds_simplify_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    options.ratio = 0.25;
    options.triangles = 10;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(report.triangles_before == 0);
    options.triangles = 0;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_OK);
    EXPECT(report.triangles_before == 2 * CELLS * CELLS);
    EXPECT(report.triangles <= CELLS * CELLS / 2 && report.triangles > CELLS * CELLS / 4);
    EXPECT(report.error < 0 && report.max_error < 0); /* not asked for */
    options.ratio = 0;
    options.triangles = 8;
    options.measure = 1;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_OK);
    EXPECT(report.triangles >= 2 && report.triangles <= 8);
    EXPECT(report.error >= 0 && report.error < 1e-6 && report.max_error < 1e-6);
    options.triangles = 0;
    options.pixels = 1;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    options.height_px = 100;
    options.mode = 3;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    for (options.mode = LDS_SIMPLIFY_CLUSTER; options.mode >= LDS_SIMPLIFY_FAST; --options.mode) {
        EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_OK);
        EXPECT(report.triangles > 0 && report.error >= 0 && report.error <= 0.01);
    }
    options.keep_topology = 1;
    options.mode = LDS_SIMPLIFY_CLUSTER;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    options.mode = LDS_SIMPLIFY_BEST;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_OK);
    lds_totals totals = {sizeof totals, 0, 0, 0, 0, 0};
    EXPECT(lds_model_totals(model, &totals) == LDS_OK);
    EXPECT(totals.triangles_placed == report.triangles);
    lds_model_destroy(model);
}

static void test_fields_that_an_older_caller_lacks_count_as_0(void) {
    lds_object grid;
    lds_model* model = flat_grid(&grid);
    lds_simplify_options options = {.struct_size = sizeof options};
    EXPECT(lds_simplify_options_default(&options) == LDS_OK);
    lds_simplify_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    options.ratio = 0.25;
    options.mode = 99;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(report.triangles == 0);
    options.struct_size = offsetof(lds_simplify_options, mode);
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_OK);
    EXPECT(report.triangles > 0);
    EXPECT(lds_simplify_options_default(&options) == LDS_OK && options.mode == 99);
    options.mode = 0;
    options.ratio = 0.25;
    options.struct_size = sizeof options + 8;
    EXPECT(lds_model_simplify(model, &options, NULL, &report) == LDS_OK);
    EXPECT(report.triangles > 0 && report.triangles <= CELLS * CELLS / 2);
    lds_model_destroy(model);
}

int main(void) {
    if (lds_rays_check() == LDS_OK)
        test_simplifying_a_flat_grid_costs_no_shape();
    test_fields_that_an_older_caller_lacks_count_as_0();
    return finish();
}
