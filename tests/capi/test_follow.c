/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards poses at the C interface: levels of what deforms, told apart by connectivity. */
#include "cube.h"

#include <stddef.h>

enum { kCells = 20, kSide = kCells + 1 };

/* A waving sheet as one object. `turned`: cells are cut along their other diagonals. */
static lds_model* sheet(float height, int turned, uint64_t connectivity) {
    static float positions[kSide * kSide][3];
    static uint32_t triangles[2 * kCells * kCells][3];
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            float* p = positions[y * kSide + x];
            p[0] = (float)x / kCells;
            p[1] = (float)y / kCells;
            p[2] = height * sinf(9 * p[0]) * cosf(7 * p[1]);
        }
    }
    for (uint32_t i = 0; i < kCells * kCells; ++i) {
        const uint32_t a = i / kCells * kSide + i % kCells;
        const uint32_t corners[4] = {a, a + 1, a + kSide + 1, a + kSide};
        const uint32_t ways[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
        for (int corner = 0; corner < 6; ++corner)
            triangles[2 * i + (uint32_t)corner / 3][corner % 3] = corners[ways[turned][corner]];
    }
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    lds_object_info info = info_of("sheet", "Sheet");
    info.deforms = 1;
    info.connectivity = connectivity;
    lds_mesh_view view = cube_view();
    view.positions = &positions[0][0];
    view.vertex_count = kSide * kSide;
    view.triangles = &triangles[0][0];
    view.triangle_count = 2 * kCells * kCells;
    lds_object object;
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, &object) == LDS_OK);
    EXPECT(lds_model_set_root(model, object) == LDS_OK);
    return model;
}

/* Levels of the sheet when it is built with these poses; destroys it. */
static uint64_t levels(lds_model* model, const lds_model* const* poses, size_t count,
                       const char* store, size_t* out_problems) {
    lds_build_options options = {.struct_size = sizeof options};
    EXPECT(lds_build_options_default(&options) == LDS_OK);
    options.poses = poses;
    options.pose_count = count;
    lds_build_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    EXPECT(lds_model_build(model, store, &options, NULL, &report) == LDS_OK);
    *out_problems = lds_model_problem_count(model);
    lds_model_destroy(model);
    return report.representations;
}

static void test_poses(const char* store) {
    lds_model* poses[2] = {sheet(0.0f, 0, 7), sheet(0.1f, 0, 7)};
    const lds_model* const* given = (const lds_model* const*)poses;
    size_t problems = 0;
    EXPECT(levels(sheet(0.05f, 0, 7), NULL, 0, store, &problems) == 1 && problems == 0);
    EXPECT(levels(sheet(0.05f, 0, 7), given, 2, store, &problems) > 2 && problems == 0);
    EXPECT(levels(sheet(0.06f, 1, 7), given, 2, store, &problems) > 2 && problems == 0);
    EXPECT(levels(sheet(0.05f, 0, 8), given, 2, store, &problems) == 1 && problems == 1);
    lds_model_destroy(poses[0]);
    lds_model_destroy(poses[1]);

    /* Without a number the triangles tell. */
    poses[0] = sheet(0.0f, 0, 0);
    EXPECT(levels(sheet(0.05f, 0, 0), given, 1, store, &problems) > 2 && problems == 0);
    EXPECT(levels(sheet(0.05f, 1, 0), given, 1, store, &problems) == 1 && problems == 1);
    lds_model_destroy(poses[0]);
}

static void test_mistakes(const char* store) {
    lds_model* model = sheet(0.1f, 0, 0);
    lds_build_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    lds_build_options options = {.struct_size = sizeof options};
    EXPECT(lds_build_options_default(&options) == LDS_OK);
    options.pose_count = 1;
    EXPECT(lds_model_build(model, store, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    const lds_model* const none[1] = {NULL};
    options.poses = none;
    EXPECT(lds_model_build(model, store, &options, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "pose") != NULL);
    lds_model_destroy(model);
}

int main(int argc, char** argv) {
    const char* store = argc > 1 ? argv[1] : "capi_follow_store";
    if (lds_rays_check() == LDS_OK)
        test_poses(store);
    test_mistakes(store);
    return finish();
}
