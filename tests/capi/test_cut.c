/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards choosing from C: what bends quality is refused by name where it makes no sense, budgets
   say what fits, reasons name every factor. */
#include "cube.h"

#include <stddef.h>

static lds_lens lens_of(double radius, double strength) {
    lds_lens lens;
    memset(&lens, 0, sizeof lens);
    memcpy(lens.transform, kIdentity, sizeof kIdentity);
    lens.radius = radius;
    lens.strength = strength;
    lens.falloff = 1;
    lens.name = "Lens";
    return lens;
}

/* The status of a cut with these modifiers. */
static lds_status status_of(lds_model* model, const lds_modifiers* modifiers) {
    lds_camera camera = camera_before(30);
    lds_view view = view_of(&camera, 640, 360);
    view.modifiers = modifiers;
    lds_cut* cut = NULL;
    const lds_status status = lds_cut_create(model, &view, NULL, &cut);
    EXPECT((status == LDS_OK) == (cut != NULL));
    lds_cut_destroy(cut);
    return status;
}

/* What a later version of a caller may hand in: a summary with a field more. */
struct longer {
    lds_cut_summary summary;
    uint64_t more;
};

static void test_views_of_older_and_newer_callers(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_camera camera = camera_before(30);
    lds_view view = view_of(&camera, 640, 360);
    lds_cut* cut = NULL;
    view.struct_size = 4;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_ERROR_INVALID_ARGUMENT && cut == NULL);
    EXPECT(strstr(lds_last_error_text(), "view.struct_size is") != NULL);
    lds_modifiers refused = {.struct_size = sizeof refused, .criterion = 4};
    view.modifiers = &refused;
    view.struct_size = sizeof view;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_ERROR_INVALID_ARGUMENT && cut == NULL);
    view.struct_size = offsetof(lds_view, modifiers); /* the field is not read */
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK && cut != NULL);
    lds_cut_destroy(cut);
    cut = NULL;
    view.modifiers = NULL;
    view.struct_size = sizeof view + 16;
    view.camera = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_ERROR_INVALID_ARGUMENT && cut == NULL);
    EXPECT(strcmp(lds_last_error_text(), "camera is null") == 0);
    view.camera = &camera;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    struct longer longer;
    memset(&longer, 0, sizeof longer);
    longer.more = 77;
    for (uint32_t wrong = 0; wrong < 8; ++wrong) {
        longer.summary.struct_size = wrong;
        EXPECT(lds_cut_get_summary(cut, &longer.summary) == LDS_ERROR_INVALID_ARGUMENT);
        EXPECT(longer.summary.occurrences == 0 && longer.summary.struct_size == wrong);
    }
    longer.summary.struct_size = offsetof(lds_cut_summary, bytes);
    longer.summary.bytes = 7;
    EXPECT(lds_cut_get_summary(cut, &longer.summary) == LDS_OK);
    EXPECT(longer.summary.occurrences == 2 && longer.summary.triangles > 0);
    EXPECT(longer.summary.bytes == 7); /* an older caller's summary has no such field */
    longer.summary.struct_size = sizeof longer;
    EXPECT(lds_cut_get_summary(cut, &longer.summary) == LDS_OK);
    EXPECT(longer.summary.occurrences == 2 && longer.more == 77);
    EXPECT(longer.summary.struct_size == sizeof longer);
    lds_cut_destroy(cut);
    lds_model_destroy(model);
}

static void test_occurrences_are_counted_by_kind(void) {
    EXPECT(strcmp(lds_kind_name(LDS_KIND_MESH), "mesh") == 0);
    EXPECT(strcmp(lds_kind_name(LDS_KIND_COMPOSITE), "composite") == 0);
    EXPECT(strcmp(lds_kind_name(LDS_KIND_ASSEMBLY), "assembly") == 0);
    EXPECT(strcmp(lds_kind_name(LDS_KIND_COUNT - 1), "") != 0);
    EXPECT(strcmp(lds_kind_name(LDS_KIND_COUNT), "") == 0);
    EXPECT(strcmp(lds_kind_name(0), "") == 0 && strcmp(lds_kind_name(-1), "") == 0);
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_camera camera = camera_before(30);
    const lds_view view = view_of(&camera, 640, 360);
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    lds_cut_summary summary;
    memset(&summary, 0, sizeof summary);
    summary.struct_size = sizeof summary;
    EXPECT(lds_cut_get_summary(cut, &summary) == LDS_OK);
    for (int kind = 0; kind < LDS_KIND_COUNT; ++kind)
        EXPECT(summary.occurrences_of_kind[kind] == (kind == LDS_KIND_MESH ? 2 : 0));
    lds_cut_destroy(cut);
    lds_model_destroy(model);
}

static void test_nonsense_is_refused_by_name(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_modifiers modifiers = {.struct_size = sizeof modifiers};
    EXPECT(lds_modifiers_default(&modifiers) == LDS_OK);
    EXPECT(status_of(model, &modifiers) == LDS_OK);
    lds_lens lens = lens_of(1, 4);
    modifiers.lenses = &lens;
    modifiers.lens_count = 1;
    EXPECT(status_of(model, &modifiers) == LDS_OK);
    lens.strength = NAN;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "lens 'Lens' has a strength of") != NULL);
    lens = lens_of(-1, 4);
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT);
    lens = lens_of(1, 4);
    lens.shape = 9;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT);
    lens = lens_of(1, 4);
    lens.filter = LDS_LENS_FILTER_REFINE;
    lens.object_count = 1;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT); /* no list */
    const lds_object stale = {0, 12345};
    lens.objects = &stale;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_STALE_ID);
    lens.objects = &cube;
    EXPECT(status_of(model, &modifiers) == LDS_OK);
    modifiers.lenses = NULL;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT);
    modifiers.lens_count = 10000;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strcmp(lds_last_error_text(), "10000 lenses; at most 1024") == 0);
    EXPECT(lds_modifiers_default(&modifiers) == LDS_OK);
    modifiers.criterion = 4;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_modifiers_default(&modifiers) == LDS_OK);
    modifiers.struct_size = 4;
    EXPECT(status_of(model, &modifiers) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

/* A new cut and a step say the same of a view. */
static lds_status both_of(lds_model* model, const lds_view* view) {
    const lds_camera camera = camera_before(30);
    const lds_view usual = view_of(&camera, 640, 360);
    lds_cut* stepped = NULL;
    EXPECT(lds_cut_create(model, &usual, NULL, &stepped) == LDS_OK);
    EXPECT(lds_cut_step(model, stepped, &usual, NULL) == LDS_OK);
    lds_cut* anew = NULL;
    const lds_status status = lds_cut_create(model, view, NULL, &anew);
    EXPECT(lds_cut_step(model, stepped, view, NULL) == status);
    EXPECT(status == LDS_OK || strlen(lds_last_error_text()) > 0);
    EXPECT(lds_cut_choice_count(stepped) == 2); /* also where it has stayed as it was */
    EXPECT(status != LDS_OK || lds_cut_choice_count(anew) == 2);
    lds_cut_destroy(anew);
    lds_cut_destroy(stepped);
    return status;
}

static void test_views_of_nonsense_are_refused_and_odd_ones_are_not(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const double bad[] = {NAN, INFINITY, -INFINITY, -1, 0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        lds_camera camera = camera_before(30);
        lds_view view = view_of(&camera, 640, 360);
        camera.near_clip = bad[i];
        EXPECT(both_of(model, &view) == LDS_ERROR_INVALID_ARGUMENT);
        camera = camera_before(30);
        view.pixel_error = bad[i]; /* 0: the originals */
        EXPECT(both_of(model, &view) == (bad[i] == 0 ? LDS_OK : LDS_ERROR_INVALID_ARGUMENT));
        double* const frame[] = {camera.position, camera.direction, camera.right, camera.up};
        view.pixel_error = 0;
        for (size_t k = 0; k < 4; ++k) {
            camera = camera_before(30);
            for (int axis = 0; axis < 3; ++axis)
                frame[k][axis] = bad[i];
            /* All -1 is a skewed frame, and all 0 a place. */
            const int fine = bad[i] == -1 || (bad[i] == 0 && k == 0);
            EXPECT(both_of(model, &view) == (fine ? LDS_OK : LDS_ERROR_INVALID_ARGUMENT));
        }
    }
    lds_camera camera = camera_before(30);
    lds_view view = view_of(&camera, 640, 360);
    memcpy(camera.direction, camera.right, sizeof camera.right);
    EXPECT(both_of(model, &view) == LDS_ERROR_INVALID_ARGUMENT); /* it looks along the picture */
    camera = camera_before(30);
    camera.right[0] *= -1; /* mirrored */
    EXPECT(both_of(model, &view) == LDS_OK);
    camera = camera_before(0); /* inside of everything */
    EXPECT(both_of(model, &view) == LDS_OK);
    camera = camera_before(1e300);
    EXPECT(both_of(model, &view) == LDS_OK);
    lds_lens many[1024];
    for (int i = 0; i < 1024; ++i)
        many[i] = lens_of(i % 2, 4); /* half of them of radius 0 */
    lds_modifiers modifiers = {.struct_size = sizeof modifiers};
    EXPECT(lds_modifiers_default(&modifiers) == LDS_OK);
    modifiers.lenses = many;
    modifiers.lens_count = 1024;
    EXPECT(status_of(model, &modifiers) == LDS_OK);
    lds_model_destroy(model);
}

static void test_a_budget_says_what_fits(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_camera camera = camera_before(30);
    const lds_view view = view_of(&camera, 640, 360);
    lds_budget budget = {sizeof budget, 24, 0};
    lds_budget_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create_within(model, &view, &budget, NULL, &report, &cut) == LDS_OK);
    EXPECT(report.fits == 1 && report.pixel_error == view.pixel_error);
    lds_cut_destroy(cut);
    cut = NULL;
    budget.triangles = 23; /* there are no other levels */
    EXPECT(lds_cut_create_within(model, &view, &budget, NULL, &report, &cut) == LDS_OK);
    EXPECT(report.fits == 0 && lds_cut_choice_count(cut) == 2);
    lds_cut_destroy(cut);
    EXPECT(lds_cut_create_within(model, &view, NULL, NULL, &report, &cut) ==
           LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

static void test_a_reason_names_every_factor(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_lens lens = lens_of(1000, 4);
    lens.falloff = 0;
    lds_modifiers modifiers = {.struct_size = sizeof modifiers};
    EXPECT(lds_modifiers_default(&modifiers) == LDS_OK);
    modifiers.lenses = &lens;
    modifiers.lens_count = 1;
    lds_camera camera = camera_before(30);
    lds_view view = view_of(&camera, 640, 360);
    view.modifiers = &modifiers;
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    lds_reason reason;
    memset(&reason, 0, sizeof reason);
    reason.struct_size = sizeof reason;
    EXPECT(lds_cut_choice_reason(model, cut, 0, &reason) == LDS_OK);
    EXPECT(reason.lod == 0 && reason.error == 0 && reason.lenses == 4 && reason.factor == 4);
    EXPECT(reason.importance == 1 && reason.screen_lenses == 1 && reason.depth == 1);
    EXPECT(reason.motion == 1 && reason.darkness == 1 && reason.z > 0 && reason.pixel > 0);
    EXPECT(reason.coarser_object.generation == 0); /* there is none */
    EXPECT(lds_cut_choice_reason(model, cut, 2, &reason) == LDS_ERROR_INVALID_ARGUMENT);
    lds_object other;
    lds_model* foreign = two_cubes(&other);
    EXPECT(lds_cut_choice_reason(foreign, cut, 0, &reason) == LDS_ERROR_STALE_ID);
    EXPECT(lds_cut_choice_reason(NULL, cut, 0, &reason) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(foreign);
    lds_cut_destroy(cut);
    lds_model_destroy(model);
}

static void test_what_moves_is_coarser_only_where_that_counts(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_object pair = {cube.index + 1, cube.generation};
    double there[12];
    memcpy(there, kIdentity, sizeof there);
    there[3] = 5 + 1; /* the right one, by a metre */
    EXPECT(lds_model_move_placement(model, pair, 1, there) == LDS_OK);
    EXPECT(lds_model_move_placement(model, pair, 2, there) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_move_placement(model, cube, 0, there) == LDS_ERROR_INVALID_ARGUMENT);
    there[0] = NAN;
    EXPECT(lds_model_move_placement(model, pair, 1, there) == LDS_ERROR_INVALID_ARGUMENT);
    lds_modifiers modifiers = {.struct_size = sizeof modifiers};
    EXPECT(lds_modifiers_default(&modifiers) == LDS_OK);
    modifiers.when_moving = 1;
    for (int counts = 1; counts >= 0; --counts) {
        lds_camera camera = camera_before(30);
        lds_view view = view_of(&camera, 640, 360);
        camera.orthographic = 1; /* a metre is the picture's width */
        view.modifiers = counts ? &modifiers : NULL;
        lds_cut* cut = NULL;
        lds_reason reason;
        memset(&reason, 0, sizeof reason);
        reason.struct_size = sizeof reason;
        EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
        EXPECT(lds_cut_choice_reason(model, cut, 0, &reason) == LDS_OK && reason.motion == 1);
        EXPECT(lds_cut_choice_reason(model, cut, 1, &reason) == LDS_OK);
        EXPECT(reason.motion == (counts ? 64 : 1));
        lds_cut_destroy(cut);
    }
    EXPECT(lds_model_move_placement(model, pair, 1, NULL) == LDS_OK); /* rests again */
    lds_model_destroy(model);
}

static void test_classes_of_rays_are_counted_and_named(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_modifiers modifiers = {.struct_size = sizeof modifiers};
    EXPECT(lds_modifiers_default(&modifiers) == LDS_OK);
    EXPECT(modifiers.ray_classes == 0);
    modifiers.ray_classes = LDS_RAYS_SHADOW;
    lds_camera camera = camera_before(30);
    lds_view view = view_of(&camera, 640, 360);
    view.modifiers = &modifiers;
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    lds_ray_summary summary;
    memset(&summary, 0, sizeof summary);
    EXPECT(lds_cut_get_rays(cut, LDS_RAYS_SHADOW, &summary) == LDS_ERROR_INVALID_ARGUMENT);
    summary.struct_size = sizeof summary;
    EXPECT(lds_cut_get_rays(cut, LDS_RAYS_SHADOW, &summary) == LDS_OK);
    EXPECT(summary.rays == LDS_RAYS_SHADOW && summary.occurrences == 2 && summary.own == 0);
    EXPECT(summary.triangles == 24 && summary.all_triangles == 24 && summary.kept_need == 2);
    EXPECT(lds_cut_get_rays(cut, LDS_RAYS_REFLECTION, &summary) == LDS_OK);
    EXPECT(summary.occurrences == 2 && summary.kept_need == 0); /* not asked for: the camera's */
    EXPECT(lds_cut_get_rays(cut, 3, &summary) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_get_rays(NULL, 1, &summary) == LDS_ERROR_INVALID_ARGUMENT);
    lds_ray_choice choice;
    memset(&choice, 0, sizeof choice);
    choice.struct_size = sizeof choice;
    EXPECT(lds_cut_choice_rays(model, cut, 1, LDS_RAYS_SHADOW, &choice) == LDS_OK);
    EXPECT(choice.met == LDS_MET_NEED && choice.object.index == cube.index && choice.lod == 0);
    EXPECT(choice.kind == LDS_KIND_MESH && choice.scale == 1 && choice.error == 0);
    EXPECT(lds_cut_choice_rays(model, cut, 1, LDS_RAYS_RADIOSITY, &choice) == LDS_OK);
    EXPECT(choice.met == LDS_MET_OFF);
    EXPECT(lds_cut_choice_rays(model, cut, 2, LDS_RAYS_SHADOW, &choice) ==
           LDS_ERROR_INVALID_ARGUMENT);
    lds_object other;
    lds_model* foreign = two_cubes(&other);
    EXPECT(lds_cut_choice_rays(foreign, cut, 0, LDS_RAYS_SHADOW, &choice) == LDS_ERROR_STALE_ID);
    lds_model_destroy(foreign);
    lds_cut_destroy(cut);
    modifiers.ray_classes = 256; /* no class: their masks have eight bits */
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

static void test_a_cut_goes_along_with_the_camera(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_camera camera = camera_before(30);
    lds_view view = view_of(&camera, 640, 360);
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    const double color[6] = {1, 0, 0, 0, 1, 0};
    EXPECT(lds_cut_set_colors(cut, color, 2) == LDS_OK);
    for (int step = 0; step < 3; ++step) {
        camera = camera_before(30 + 20 * step);
        EXPECT(lds_cut_step(model, cut, &view, NULL) == LDS_OK);
        lds_cut* anew = NULL;
        EXPECT(lds_cut_create(model, &view, NULL, &anew) == LDS_OK);
        lds_choice choices[2][2];
        memset(choices, 0, sizeof choices);
        EXPECT(lds_cut_choice_count(cut) == 2 && lds_cut_choice_count(anew) == 2);
        EXPECT(lds_cut_choice_copy(cut, choices[0], 2) == LDS_OK);
        EXPECT(lds_cut_choice_copy(anew, choices[1], 2) == LDS_OK);
        EXPECT(memcmp(choices[0], choices[1], sizeof choices[0]) == 0);
        lds_cut_destroy(anew);
    }
    view.width = 0;
    EXPECT(lds_cut_step(model, cut, &view, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_choice_count(cut) == 2);
    EXPECT(lds_cut_step(model, cut, NULL, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_step(model, NULL, &view, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    lds_object other;
    lds_model* foreign = two_cubes(&other);
    view.width = 640;
    EXPECT(lds_cut_step(foreign, cut, &view, NULL) == LDS_ERROR_STALE_ID);
    lds_model_destroy(foreign);
    lds_model_destroy(model);
    EXPECT(strcmp(lds_cut_choice_path(cut, 1), "right") == 0);
    EXPECT(strcmp(lds_cut_choice_path(cut, 2), "") == 0);
    lds_cut_destroy(cut);
}

static void test_a_cut_is_stale_once_its_groups_are_structured(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_object_info info = info_of("many", "Many");
    lds_object many;
    EXPECT(lds_model_add_group(model, &info, &many) == LDS_OK);
    double moved[12];
    memcpy(moved, kIdentity, sizeof moved);
    for (int i = 0; i < 40; ++i) {
        moved[3] = 5 * i;
        EXPECT(lds_model_add_placement(model, many, cube, moved, "one") == LDS_OK);
    }
    EXPECT(lds_model_set_root(model, many) == LDS_OK);
    lds_camera camera = camera_before(30);
    lds_view view = view_of(&camera, 640, 360);
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    lds_reason reason;
    memset(&reason, 0, sizeof reason);
    reason.struct_size = sizeof reason;
    EXPECT(lds_cut_choice_reason(model, cut, 39, &reason) == LDS_OK);
    size_t added = 0;
    EXPECT(lds_model_group_by_position(model, many, 8, &added) == LDS_OK && added > 0);
    EXPECT(lds_cut_choice_reason(model, cut, 39, &reason) == LDS_ERROR_STALE_ID);
    int32_t drawn = 0;
    size_t position = 0;
    EXPECT(lds_cut_find_choice(model, cut, cube, moved, &drawn, &position) == LDS_ERROR_STALE_ID);
    lds_ray_choice choice;
    memset(&choice, 0, sizeof choice);
    choice.struct_size = sizeof choice;
    EXPECT(lds_cut_choice_rays(model, cut, 39, LDS_RAYS_SHADOW, &choice) == LDS_ERROR_STALE_ID);
    EXPECT(strcmp(lds_cut_choice_path(cut, 39), "one") == 0);
    EXPECT(lds_cut_step(model, cut, &view, NULL) == LDS_OK);
    EXPECT(lds_cut_choice_count(cut) == 40);
    EXPECT(lds_cut_choice_reason(model, cut, 39, &reason) == LDS_OK);
    lds_cut_destroy(cut);
    lds_model_destroy(model);
}

int main(void) {
    test_a_cut_is_stale_once_its_groups_are_structured();
    test_views_of_older_and_newer_callers();
    test_occurrences_are_counted_by_kind();
    test_nonsense_is_refused_by_name();
    test_views_of_nonsense_are_refused_and_odd_ones_are_not();
    test_a_budget_says_what_fits();
    test_a_reason_names_every_factor();
    test_a_cut_goes_along_with_the_camera();
    test_what_moves_is_coarser_only_where_that_counts();
    test_classes_of_rays_are_counted_and_named();
    return finish();
}
