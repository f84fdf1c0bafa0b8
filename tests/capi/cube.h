/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the C tests share: EXPECT, a cube, a model that places it twice, a camera. */
#ifndef LODESTONE_TESTS_CAPI_CUBE_H
#define LODESTONE_TESTS_CAPI_CUBE_H

#include "lodestone/lodestone.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define EXPECT(condition)                                                                      \
    do {                                                                                       \
        if (!(condition)) {                                                                    \
            printf("%s:%d: %s (%s)\n", __FILE__, __LINE__, #condition, lds_last_error_text()); \
            ++failures;                                                                        \
        }                                                                                      \
    } while (0)

static const float kPositions[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                       {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const uint32_t kTriangles[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                           {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                           {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
static const double kIdentity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static inline lds_mesh_view cube_view(void) {
    lds_mesh_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    view.positions = &kPositions[0][0];
    view.vertex_count = 8;
    view.triangles = &kTriangles[0][0];
    view.triangle_count = 12;
    return view;
}

static inline lds_object_info info_of(const char* uid, const char* name) {
    lds_object_info info;
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    info.uid = uid;
    info.name = name;
    return info;
}

/* A group with two cubes; also returns the cube. */
static inline lds_model* two_cubes(lds_object* cube) {
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    lds_object_info info = info_of("cube", "Cube");
    lds_mesh_view view = cube_view();
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, cube) == LDS_OK);
    info = info_of("pair", "Pair");
    lds_object group;
    EXPECT(lds_model_add_group(model, &info, &group) == LDS_OK);
    double moved[12];
    memcpy(moved, kIdentity, sizeof moved);
    moved[3] = 5;
    EXPECT(lds_model_add_placement(model, group, *cube, kIdentity, "left") == LDS_OK);
    EXPECT(lds_model_add_placement(model, group, *cube, moved, "right") == LDS_OK);
    EXPECT(lds_model_set_root(model, group) == LDS_OK);
    return model;
}

/* Looks along +y at what lies around the origin, 16 : 9. */
static inline lds_camera camera_before(double distance) {
    lds_camera camera;
    memset(&camera, 0, sizeof camera);
    camera.struct_size = sizeof camera;
    camera.name = "eye";
    camera.position[1] = -distance;
    camera.direction[1] = 1;
    camera.right[0] = 1;
    camera.up[2] = 0.5625;
    camera.near_clip = 0.1;
    return camera;
}

static inline lds_view view_of(const lds_camera* camera, int32_t width, int32_t height) {
    lds_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    view.camera = camera;
    view.width = width;
    view.height = height;
    return view;
}

/* Says how it went; the exit code of the program. */
static inline int finish(void) {
    printf(failures == 0 ? "all held\n" : "%d expectations failed\n", failures);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#endif
