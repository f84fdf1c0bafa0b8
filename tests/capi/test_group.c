/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards what a C program does with strands and groups: tubes of known size, grouping by position,
   placements that some rays do not see. */
#include "cube.h"

#include <math.h>

enum { MANY = 200 };
enum { kNoRayClass = 256 }; /* their masks have eight bits */

static void test_strands_become_tubes(void) {
    const float points[4][3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}};
    const float radii[4] = {0.1f, 0.1f, 0.1f, 0};
    const uint32_t counts[2] = {2, 2};
    const int32_t slots[2] = {0, 99};
    lds_strands_view view;
    memset(&view, 0, sizeof view);
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    const lds_object_info info = info_of("hair", "Hair");
    lds_object hair = {7, 7};
    EXPECT(lds_model_add_strands(model, &info, &view, NULL, 0, &hair) ==
           LDS_ERROR_INVALID_ARGUMENT);
    view.struct_size = sizeof view;
    view.points = &points[0][0];
    view.radii = radii;
    view.counts = counts;
    view.point_count = 3;
    view.strand_count = 2;
    view.slots = slots;
    EXPECT(lds_model_add_strands(model, &info, &view, NULL, 0, &hair) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(hair.index == 7);
    view.point_count = 4;
    view.radii = NULL;
    EXPECT(lds_model_add_strands(model, &info, &view, NULL, 0, &hair) ==
           LDS_ERROR_INVALID_ARGUMENT);
    view.radii = radii;
    EXPECT(lds_model_add_strands(model, &info, &view, NULL, 0, &hair) == LDS_OK);
    lds_representation finest;
    memset(&finest, 0, sizeof finest);
    finest.struct_size = sizeof finest;
    EXPECT(lds_model_representation(model, hair, 0, &finest) == LDS_OK);
    EXPECT(finest.kind == LDS_KIND_MESH && finest.triangles == 8 + 4);
    lds_model_destroy(model);
}

static void test_equal_meshes_are_one_content(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_object_info info = info_of("twin", "Twin");
    const lds_mesh_view view = cube_view();
    lds_object twin;
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, &twin) == LDS_OK);
    lds_representation a, b;
    memset(&a, 0, sizeof a);
    a.struct_size = sizeof a;
    b = a;
    EXPECT(lds_model_representation(model, cube, 0, &a) == LDS_OK);
    EXPECT(lds_model_representation(model, twin, 0, &b) == LDS_OK);
    EXPECT(a.hash == b.hash && a.triangles == b.triangles);
    lds_model_destroy(model);
}

static void test_loose_parts_become_clusters_of_one_object(void) {
    enum { TILES = 40 };
    float points[TILES * 4][3];
    uint32_t triangles[TILES * 2][3];
    for (uint32_t i = 0; i < TILES; ++i) {
        const float x = 3.0f * (float)i;
        const float corners[4][3] = {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}};
        const uint32_t two[2][3] = {{4 * i, 4 * i + 1, 4 * i + 2}, {4 * i, 4 * i + 2, 4 * i + 3}};
        memcpy(points[4 * i], corners, sizeof corners);
        memcpy(triangles[2 * i], two, sizeof two);
    }
    lds_mesh_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    view.positions = &points[0][0];
    view.vertex_count = TILES * 4;
    view.triangles = &triangles[0][0];
    view.triangle_count = TILES * 2;
    lds_model* model = NULL;
    lds_object tiles;
    EXPECT(lds_model_create(&model) == LDS_OK);
    const lds_object_info info = info_of("tiles", "Tiles");
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, &tiles) == LDS_OK);
    EXPECT(lds_model_set_root(model, tiles) == LDS_OK);
    lds_loose_options options = {.struct_size = sizeof options};
    EXPECT(lds_loose_options_default(&options) == LDS_OK);
    lds_loose_report report;
    memset(&report, 0, sizeof report);
    EXPECT(lds_model_split_loose_parts(model, NULL, 0, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    report.struct_size = sizeof report;
    EXPECT(lds_model_split_loose_parts(model, NULL, 0, NULL, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_split_loose_parts(model, NULL, 0, &options, NULL, &report) == LDS_OK);
    EXPECT(report.split == 0);
    options.always = 1;
    options.fewest_triangles = 0;
    EXPECT(lds_model_split_loose_parts(model, &tiles, 1, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    options.fewest_triangles = 8;
    EXPECT(lds_model_split_loose_parts(model, &tiles, 1, &options, NULL, &report) == LDS_OK);
    EXPECT(report.split == 1 && report.parts == TILES && report.made >= TILES / 4);
    lds_totals totals;
    memset(&totals, 0, sizeof totals);
    totals.struct_size = sizeof totals;
    EXPECT(lds_model_totals(model, &totals) == LDS_OK);
    EXPECT(totals.objects == 1 && totals.occurrences == 1 && totals.triangles_placed == 2 * TILES);
    lds_model_destroy(model);
}

static void test_structuring_keeps_every_occurrence(void) {
    lds_object cube, many, child;
    lds_model* model = two_cubes(&cube);
    const lds_object_info info = info_of("many", "Many");
    EXPECT(lds_model_add_group(model, &info, &many) == LDS_OK);
    for (int i = 0; i < MANY; ++i) {
        double place[12];
        memcpy(place, kIdentity, sizeof place);
        place[3] = i;
        EXPECT(lds_model_add_placement(model, many, cube, place, "one") == LDS_OK);
    }
    EXPECT(lds_model_set_root(model, many) == LDS_OK);
    lds_structure_options options = {.struct_size = sizeof options};
    EXPECT(lds_structure_options_default(&options) == LDS_OK);
    lds_structure_report report;
    memset(&report, 0, sizeof report);
    EXPECT(lds_model_structure(model, NULL, 0, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    report.struct_size = sizeof report;
    EXPECT(lds_model_structure(model, NULL, 0, NULL, NULL, &report) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_structure(model, &cube, 1, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    options.orders = 0;
    EXPECT(lds_model_structure(model, NULL, 0, &options, NULL, &report) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strcmp(lds_last_error_text(), "orders is 0; 1 to 1024 expected") == 0);
    EXPECT(lds_structure_options_default(&options) == LDS_OK);
    EXPECT(lds_model_structure(model, NULL, 0, &options, NULL, &report) == LDS_OK);
    EXPECT(report.structured == 1 && report.made > 2 && report.cost_after < report.cost_before / 2);
    size_t count = 0;
    EXPECT(lds_model_occurrence_count(model, &count) == LDS_OK && count == MANY);
    lds_placement placed;
    memset(&placed, 0, sizeof placed);
    EXPECT(lds_model_child(model, many, 0, &placed) == LDS_ERROR_INVALID_ARGUMENT);
    placed.struct_size = sizeof placed;
    EXPECT(lds_model_child(model, many, 0, &placed) == LDS_OK && strcmp(placed.name, "Many") > 0);
    EXPECT(memcmp(placed.transform, kIdentity, sizeof kIdentity) == 0 && placed.hidden == 0);
    EXPECT(lds_model_child(model, many, MANY, &placed) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_child(model, cube, 0, &placed) == LDS_ERROR_INVALID_ARGUMENT);
    lds_object_summary summary;
    memset(&summary, 0, sizeof summary);
    summary.struct_size = sizeof summary;
    EXPECT(lds_model_object_summary(model, placed.object, &summary) == LDS_OK &&
           summary.group == 1);
    EXPECT(lds_model_find_object(model, summary.uid, &child) == LDS_OK);
    EXPECT(child.index == placed.object.index);
    lds_model_destroy(model);
}

static void test_grouping_keeps_every_occurrence(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_object_info info = info_of("many", "Many");
    lds_object many;
    EXPECT(lds_model_add_group(model, &info, &many) == LDS_OK);
    double moved[12];
    memcpy(moved, kIdentity, sizeof moved);
    for (int i = 0; i < MANY; ++i) {
        moved[3] = i;
        EXPECT(lds_model_add_placement(model, many, cube, moved, "one of many") == LDS_OK);
    }
    EXPECT(lds_model_set_root(model, many) == LDS_OK);
    size_t added = 9;
    EXPECT(lds_model_group_by_position(model, cube, 8, &added) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_group_by_position(model, many, 7, &added) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(added == 9);
    EXPECT(lds_model_group_by_position(model, many, 256, &added) == LDS_OK && added == 0);
    EXPECT(lds_model_group_by_position(model, many, 8, &added) == LDS_OK && added >= MANY / 8);
    EXPECT(lds_model_group_by_position(model, many, 8, NULL) == LDS_OK);
    lds_object_summary summary;
    memset(&summary, 0, sizeof summary);
    summary.struct_size = sizeof summary;
    EXPECT(lds_model_object_summary(model, many, &summary) == LDS_OK);
    EXPECT(summary.child_count <= 8);
    static lds_occurrence found[MANY];
    size_t count = 0;
    EXPECT(lds_model_occurrence_count(model, &count) == LDS_OK && count == MANY);
    EXPECT(lds_model_occurrence_copy(model, found, MANY) == LDS_OK);
    int seen[MANY] = {0};
    for (int i = 0; i < MANY; ++i)
        ++seen[(int)found[i].world[3]];
    for (int i = 0; i < MANY; ++i)
        EXPECT(seen[i] == 1);
    const size_t last = lds_model_object_count(model) - 1;
    lds_object part, again;
    EXPECT(lds_model_object_at(model, last, &part) == LDS_OK);
    EXPECT(lds_model_object_summary(model, part, &summary) == LDS_OK && summary.group == 1);
    EXPECT(lds_model_find_object(model, summary.uid, &again) == LDS_OK);
    EXPECT(again.index == part.index && again.generation == part.generation);
    lds_model_destroy(model);
}

static void test_decided_placements_keep_importance_and_limit(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_object pair;
    EXPECT(lds_model_find_object(model, "pair", &pair) == LDS_OK);
    EXPECT(lds_model_decide_placement(NULL, pair, 0, 2, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_decide_placement(model, cube, 0, 2, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_decide_placement(model, pair, 2, 2, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_decide_placement(model, pair, 0, 0, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_decide_placement(model, pair, 0, 65, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_decide_placement(model, pair, 0, NAN, 1) == LDS_ERROR_INVALID_ARGUMENT);
    lds_placement found;
    found.struct_size = sizeof found;
    EXPECT(lds_model_child(model, pair, 0, &found) == LDS_OK);
    EXPECT(found.importance == 1 && found.coarsest == LDS_ANY_LEVEL);
    EXPECT(lds_model_decide_placement(model, pair, 0, 0.25, 3) == LDS_OK);
    EXPECT(lds_model_child(model, pair, 0, &found) == LDS_OK);
    EXPECT(found.importance == 0.25 && found.coarsest == 3);
    EXPECT(lds_model_child(model, pair, 1, &found) == LDS_OK);
    EXPECT(found.importance == 1 && found.coarsest == LDS_ANY_LEVEL);
    lds_model_destroy(model);
}

static void test_pinned_placements_replace_limits(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_object pair;
    EXPECT(lds_model_find_object(model, "pair", &pair) == LDS_OK);
    EXPECT(lds_model_pin_placement(NULL, pair, 0, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_pin_placement(model, cube, 0, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_pin_placement(model, pair, 2, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_pin_placement(model, pair, 0, 2) == LDS_OK);
    lds_placement found;
    found.struct_size = sizeof found;
    EXPECT(lds_model_child(model, pair, 0, &found) == LDS_OK);
    EXPECT(found.coarsest == 2);
    EXPECT(lds_model_pin_placement(model, pair, 0, LDS_ANY_LEVEL) == LDS_OK);
    EXPECT(lds_model_child(model, pair, 0, &found) == LDS_OK);
    EXPECT(found.coarsest == LDS_ANY_LEVEL);
    lds_model_destroy(model);
}

static void test_hidden_placements_hide_all_below(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_object pair;
    EXPECT(lds_model_find_object(model, "pair", &pair) == LDS_OK);
    const lds_object_info info = info_of("top", "Top");
    lds_object top;
    EXPECT(lds_model_add_group(model, &info, &top) == LDS_OK);
    EXPECT(lds_model_hide_placement(model, top, LDS_RAY_CAMERA) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_add_placement(model, top, pair, kIdentity, "pair") == LDS_OK);
    EXPECT(lds_model_hide_placement(model, cube, LDS_RAY_CAMERA) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_hide_placement(model, top, kNoRayClass) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_hide_placement(model, top, LDS_RAY_CAMERA) == LDS_OK);
    EXPECT(lds_model_hide_placement(model, pair, LDS_RAY_SHADOW | LDS_RAY_REFLECTION) == LDS_OK);
    EXPECT(lds_model_set_root(model, top) == LDS_OK);
    uint32_t hidden[3] = {9, 9, 9};
    EXPECT(lds_model_occurrence_hidden(model, NULL, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_occurrence_hidden(model, hidden, 3) == LDS_OK);
    EXPECT(hidden[0] == LDS_RAY_CAMERA && hidden[2] == 9);
    EXPECT(hidden[1] == (LDS_RAY_CAMERA | LDS_RAY_SHADOW | LDS_RAY_REFLECTION));
    lds_model_destroy(model);
}

static void test_many_are_placed_at_once_or_not_at_all(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_object_info info = info_of("many", "Many");
    lds_object many;
    EXPECT(lds_model_add_group(model, &info, &many) == LDS_OK);
    const lds_object children[2] = {cube, cube};
    const lds_object strangers[2] = {cube, {7, 9}};
    float places[2][12];
    for (int i = 0; i < 24; ++i)
        places[i / 12][i % 12] = (float)kIdentity[i % 12];
    places[1][3] = 5;
    const char* names = "near\0far";
    const uint32_t hidden[2] = {0, LDS_RAY_SHADOW};
    const uint32_t unknown[2] = {0, kNoRayClass};
    const float* rows = &places[0][0];
    EXPECT(lds_model_add_placements(model, many, 0, NULL, NULL, NULL, NULL) == LDS_OK);
    EXPECT(lds_model_add_placements(model, cube, 2, children, rows, names, NULL) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_add_placements(model, many, 2, NULL, rows, names, NULL) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_add_placements(model, many, 2, strangers, rows, names, NULL) ==
           LDS_ERROR_STALE_ID);
    EXPECT(lds_model_add_placements(model, many, 2, children, rows, names, unknown) ==
           LDS_ERROR_INVALID_ARGUMENT);
    places[1][7] = NAN;
    EXPECT(lds_model_add_placements(model, many, 2, children, rows, names, hidden) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "far") != NULL);
    places[1][7] = 0;
    EXPECT(lds_model_add_placements(model, many, 2, children, rows, names, hidden) == LDS_OK);
    EXPECT(lds_model_set_root(model, many) == LDS_OK);
    lds_occurrence found[3];
    size_t count = 0;
    EXPECT(lds_model_occurrence_count(model, &count) == LDS_OK && count == 2);
    EXPECT(lds_model_occurrence_copy(model, found, 3) == LDS_OK);
    EXPECT(found[0].world[3] == 0 && found[1].world[3] == 5);
    uint32_t seen[2] = {9, 9};
    EXPECT(lds_model_occurrence_hidden(model, seen, 2) == LDS_OK);
    EXPECT(seen[0] == 0 && seen[1] == LDS_RAY_SHADOW);
    lds_model_destroy(model);
}

static void test_faces_become_triangles(void) {
    const uint32_t corners[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                  1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    const uint32_t starts[6] = {0, 4, 8, 12, 16, 20};
    lds_faces_view faces;
    memset(&faces, 0, sizeof faces);
    faces.struct_size = sizeof faces;
    faces.positions = &kPositions[0][0];
    faces.vertex_count = 8;
    faces.corner_vertices = corners;
    faces.corner_count = 24;
    faces.face_starts = starts;
    faces.face_count = 6;
    EXPECT(lds_faces_largest(starts, 6, 24) == 4);
    EXPECT(lds_faces_largest(starts, 6, 26) == 6);
    EXPECT(lds_faces_largest(starts, 6, 19) == 0);
    EXPECT(lds_faces_largest(NULL, 6, 24) == 0);
    lds_object cube, made;
    lds_model* model = two_cubes(&cube);
    const lds_object_info info = info_of("faces", "Faces");
    faces.vertex_count = 7;
    EXPECT(lds_model_add_faces(model, &info, &faces, NULL, 0, &made) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strcmp(lds_last_error_text(), "corner 7 uses vertex 7 of 7") == 0);
    faces.vertex_count = 8;
    faces.face_starts = NULL;
    EXPECT(lds_model_add_faces(model, &info, &faces, NULL, 0, &made) == LDS_ERROR_INVALID_ARGUMENT);
    faces.face_starts = starts;
    faces.corner_vertices = NULL;
    EXPECT(lds_model_add_faces(model, &info, &faces, NULL, 0, &made) == LDS_ERROR_INVALID_ARGUMENT);
    faces.corner_vertices = corners;
    EXPECT(lds_model_add_faces(model, &info, &faces, NULL, 0, &made) == LDS_OK);
    lds_representation a;
    memset(&a, 0, sizeof a);
    a.struct_size = sizeof a;
    EXPECT(lds_model_representation(model, made, 0, &a) == LDS_OK);
    EXPECT(a.triangles == 12);
    float uvs[24][2] = {{9, 9}};
    lds_uv_projection flat;
    memset(&flat, 0, sizeof flat);
    flat.struct_size = sizeof flat;
    memcpy(flat.to_space, kIdentity, sizeof flat.to_space);
    flat.slot = -1;
    EXPECT(lds_faces_project_uvs(&faces, &flat, &uvs[0][0]) == LDS_OK);
    for (int i = 0; i < 24; ++i)
        EXPECT(uvs[i][0] == kPositions[corners[i]][0] && uvs[i][1] == kPositions[corners[i]][1]);
    EXPECT(lds_faces_project_uvs(&faces, &flat, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

int main(void) {
    test_many_are_placed_at_once_or_not_at_all();
    test_faces_become_triangles();
    test_strands_become_tubes();
    test_equal_meshes_are_one_content();
    test_grouping_keeps_every_occurrence();
    test_loose_parts_become_clusters_of_one_object();
    test_structuring_keeps_every_occurrence();
    test_decided_placements_keep_importance_and_limit();
    test_pinned_placements_replace_limits();
    test_hidden_placements_hide_all_below();
    return failures == 0 ? 0 : 1;
}
