/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards what shows and explains a cut, as a C program sees it: colors, surface, finding things. */
#include "cube.h"

static void test_a_surface_is_all_that_is_drawn_in_its_colors(lds_model* model, lds_cut* cut) {
    const double colors[6] = {1, 0, 0, 0, 0, 1};
    EXPECT(lds_cut_set_colors(NULL, colors, 2) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_set_colors(cut, colors, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_set_colors(cut, NULL, 2) == LDS_ERROR_INVALID_ARGUMENT);
    const double bright[6] = {2, 0, 0, 0, 0, 1};
    EXPECT(lds_cut_set_colors(cut, bright, 2) == LDS_ERROR_INVALID_ARGUMENT);
    const double wrong[6] = {NAN, 0, 0, 0, 0, 1};
    EXPECT(lds_cut_set_colors(cut, wrong, 2) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_set_colors(cut, colors, 2) == LDS_OK);
    uint64_t triangles = 7;
    EXPECT(lds_cut_make_surface(NULL, cut, 100, NULL, &triangles) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(triangles == 7);
    lds_object other;
    lds_model* stranger = two_cubes(&other);
    EXPECT(lds_cut_make_surface(stranger, cut, 100, NULL, &triangles) == LDS_ERROR_STALE_ID);
    lds_model_destroy(stranger);
    EXPECT(lds_cut_make_surface(model, cut, 100, NULL, &triangles) == LDS_OK);
    EXPECT(triangles == 24);
    static float corners[24][3][3];
    static uint8_t pixels[24][3][4];
    EXPECT(lds_cut_surface_copy(cut, &corners[0][0][0], &pixels[0][0][0], 23) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_surface_copy(cut, &corners[0][0][0], &pixels[0][0][0], 24) == LDS_OK);
    EXPECT(corners[0][0][0] >= 0 && corners[0][0][0] <= 1);
    EXPECT(corners[23][0][0] >= 5 && corners[23][0][0] <= 6);
    EXPECT(pixels[0][0][0] > 150 && pixels[0][0][2] == 0 && pixels[0][0][3] == 255);
    EXPECT(pixels[23][2][0] == 0 && pixels[23][2][2] > 150);
    EXPECT(lds_cut_make_surface(model, cut, 0, NULL, &triangles) == LDS_OK && triangles == 0);
    EXPECT(lds_cut_surface_copy(cut, NULL, NULL, 0) == LDS_OK);
    EXPECT(lds_cut_set_identities(NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_set_identities(cut) == LDS_OK);
    EXPECT(lds_cut_set_colors(cut, NULL, 0) == LDS_OK);
}

static void test_batches_are_all_that_is_drawn(lds_model* model, lds_cut* cut) {
    size_t count = 9;
    EXPECT(lds_cut_make_batches(NULL, cut, &count) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_make_batches(model, cut, NULL) == LDS_ERROR_INVALID_ARGUMENT && count == 9);
    lds_batch* batch = NULL;
    EXPECT(lds_batch_create(model, cut, 0, NULL, &batch) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_make_batches(model, cut, &count) == LDS_OK && count == 1);
    uint64_t key = 0;
    uint64_t triangles = 0;
    EXPECT(lds_cut_batch_keys(cut, NULL, &triangles, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_batch_keys(cut, &key, &triangles, 1) == LDS_OK && key != 0 && triangles == 24);
    EXPECT(lds_batch_create(model, cut, 1, NULL, &batch) == LDS_ERROR_INVALID_ARGUMENT);
    lds_job job;
    memset(&job, 0, sizeof job);
    job.struct_size = sizeof job;
    job.cancel = 1;
    EXPECT(lds_batch_create(model, cut, 0, &job, &batch) == LDS_ERROR_CANCELLED && batch == NULL);
    EXPECT(lds_batch_create(model, cut, 0, NULL, &batch) == LDS_OK);
    EXPECT(lds_batch_vertex_count(batch) == 16 && lds_batch_triangle_count(batch) == 24);
    static float positions[16][3];
    static int16_t normals[16][4];
    static uint8_t colors[16][4];
    static uint32_t corners[24][3];
    EXPECT(lds_batch_copy(batch, NULL, &normals[0][0], &colors[0][0], &corners[0][0]) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_batch_copy(batch, &positions[0][0], &normals[0][0], &colors[0][0], &corners[0][0]) ==
           LDS_OK);
    EXPECT(colors[0][3] == 255 && corners[23][2] < 16);
    double box[6] = {0};
    EXPECT(lds_batch_box(batch, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_batch_box(batch, box) == LDS_OK && box[0] == 0 && box[3] == 6 && box[5] == 1);
    EXPECT(lds_batch_vertex_count(NULL) == 0 && lds_batch_triangle_count(NULL) == 0);
    lds_batch_destroy(batch);
    lds_batch_destroy(NULL);
}

static void test_changed_placements_are_where_they_are_now(lds_model* model, lds_object group,
                                                           const lds_view* view) {
    double there[12];
    memcpy(there, kIdentity, sizeof there);
    there[3] = -7;
    EXPECT(lds_model_change_placement(NULL, group, 0, there, 0) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_change_placement(model, group, 2, there, 0) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_change_placement(model, group, 0, there, 16) == LDS_ERROR_INVALID_ARGUMENT);
    there[0] = NAN;
    EXPECT(lds_model_change_placement(model, group, 0, there, 0) == LDS_ERROR_INVALID_ARGUMENT);
    there[0] = 1;
    EXPECT(lds_model_change_placement(model, group, 0, there, 0) == LDS_OK);
    EXPECT(lds_model_change_placement(model, group, 1, NULL, 15) == LDS_OK);
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, view, NULL, &cut) == LDS_OK);
    lds_choice choice;
    EXPECT(lds_cut_choice_count(cut) == 1 && lds_cut_choice_copy(cut, &choice, 1) == LDS_OK);
    EXPECT(choice.world[3] == -7);
    lds_cut_destroy(cut);
}

static void test_things_are_found_where_they_are(lds_model* model, lds_cut* cut, lds_object cube) {
    int32_t drawn = -1;
    size_t position = 9;
    double world[12];
    memcpy(world, kIdentity, sizeof world);
    EXPECT(lds_cut_find_choice(model, cut, cube, NULL, &drawn, &position) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(drawn == -1 && position == 9);
    EXPECT(lds_cut_find_choice(model, cut, cube, world, &drawn, &position) == LDS_OK);
    EXPECT(drawn == LDS_DRAWN_ITSELF && position == 0);
    world[3] = 5;
    EXPECT(lds_cut_find_choice(model, cut, cube, world, &drawn, &position) == LDS_OK);
    EXPECT(drawn == LDS_DRAWN_ITSELF && position == 1);
    world[3] = 2;
    EXPECT(lds_cut_find_choice(model, cut, cube, world, &drawn, &position) == LDS_OK);
    EXPECT(drawn == LDS_DRAWN_MISSING);
    world[3] = NAN;
    EXPECT(lds_cut_find_choice(model, cut, cube, world, &drawn, &position) ==
           LDS_ERROR_INVALID_ARGUMENT);
    const lds_object none = {0, 0};
    EXPECT(lds_cut_find_choice(model, cut, none, kIdentity, &drawn, &position) ==
           LDS_ERROR_STALE_ID);
    const char* path = NULL;
    EXPECT(lds_model_most_demanding(model, none, &path) == LDS_ERROR_STALE_ID && path == NULL);
    EXPECT(lds_model_most_demanding(model, cube, &path) == LDS_OK && strcmp(path, "") == 0);
    EXPECT(lds_model_release_meshes(NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_release_meshes(model) == LDS_OK); /* no store has them: they stay */
    uint64_t triangles = 0;
    EXPECT(lds_cut_make_surface(model, cut, 100, NULL, &triangles) == LDS_OK && triangles == 24);
}

static void test_pictures_of_what_is_shown_must_be_linear(void) {
    static const float white[4] = {1, 1, 1, 1};
    EXPECT(lds_image_write_png("capi_shown.png", 1, 1, white) == LDS_OK);
    lds_difference difference;
    memset(&difference, 0, sizeof difference);
    difference.struct_size = sizeof difference;
    double sum = 7;
    const char* one = "capi_shown.png";
    EXPECT(lds_image_compare_shown(one, one, one, one, &sum, 1, NULL, 0, 0, NULL, 0, &difference) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_image_compare_shown(one, one, "no_such.exr", one, &sum, 1, NULL, 0, 0, NULL, 0,
                                   &difference) == LDS_ERROR_IO);
    EXPECT(sum == 7);
    double color[3] = {-1, -1, -1};
    EXPECT(lds_image_difference_color(0, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_image_difference_color(0, color) == LDS_OK && color[0] == 0 && color[2] == 0);
    EXPECT(lds_image_difference_color(1, color) == LDS_OK && color[0] > 0.8);
}

int main(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_camera camera = camera_before(20);
    const lds_view view = view_of(&camera, 64, 36);
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    test_a_surface_is_all_that_is_drawn_in_its_colors(model, cut);
    test_things_are_found_where_they_are(model, cut, cube);
    test_pictures_of_what_is_shown_must_be_linear();
    test_batches_are_all_that_is_drawn(model, cut);
    lds_cut_destroy(cut);
    lds_object group;
    EXPECT(lds_model_find_object(model, "pair", &group) == LDS_OK);
    test_changed_placements_are_where_they_are_now(model, group, &view);
    lds_model_destroy(model);
    return finish();
}
