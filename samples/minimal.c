/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The smallest program: makes a wavy sheet and keeps a tenth of its triangles. */
#include "lodestone/lodestone.h"

#include <math.h>
#include <stdio.h>

enum { SIDE = 65 };

int main(void) {
    static float positions[SIDE * SIDE][3];
    static uint32_t triangles[2 * (SIDE - 1) * (SIDE - 1)][3];
    size_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        positions[i][0] = 0.1f * (float)(i % SIDE);
        positions[i][1] = 0.1f * (float)(i / SIDE);
        positions[i][2] = sinf(positions[i][0]) * cosf(positions[i][1]);
        if (i % SIDE == SIDE - 1 || i / SIDE == SIDE - 1)
            continue; /* no square begins in the last column or row */
        const uint32_t square[6] = {i, i + 1, i + SIDE, i + 1, i + SIDE + 1, i + SIDE};
        for (size_t k = 0; k < 6; ++k)
            triangles[count + k / 3][k % 3] = square[k];
        count += 2;
    }
    const lds_object_info info = {.struct_size = sizeof info, .uid = "sheet", .name = "Sheet"};
    const lds_mesh_view mesh = {.struct_size = sizeof mesh,
                                .positions = positions[0],
                                .vertex_count = SIDE * SIDE,
                                .triangles = triangles[0],
                                .triangle_count = count};
    const lds_simplify_options tenth = {.struct_size = sizeof tenth, .ratio = 0.1, .measure = 1};
    lds_simplify_report report = {.struct_size = sizeof report};
    lds_model* model = NULL;
    lds_object sheet;
    int failed = lds_model_create(&model) || /* LDS_OK is 0 */
                 lds_model_add_mesh(model, &info, &mesh, NULL, 0, &sheet) ||
                 lds_model_set_root(model, sheet) ||
                 lds_model_simplify(model, &tenth, NULL, &report);
    if (failed)
        fprintf(stderr, "%s\n", lds_last_error_text());
    else
        printf("%d triangles -> %d, at most %.3f m off\n", (int)report.triangles_before,
               (int)report.triangles, report.max_error);
    lds_model_destroy(model);
    return failed;
}
