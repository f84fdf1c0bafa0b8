/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards what a C program does with a model: files, problems, cameras, measuring,
   occurrences and the choices of a cut, each against a known answer. */
#include "cube.h"

static void test_files_keep_the_model(const char* path) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    EXPECT(lds_model_write(model, "no_such_folder/cubes.obj") == LDS_ERROR_IO);
    EXPECT(lds_model_write(model, path) == LDS_OK);
    lds_model_destroy(model);
    EXPECT(lds_model_read(path, &model) == LDS_OK);
    EXPECT(lds_model_problem_count(model) == 0);
    lds_totals totals = {sizeof totals, 0, 0, 0, 0, 0};
    EXPECT(lds_model_totals(model, &totals) == LDS_OK);
    EXPECT(totals.triangles_placed == 24);
    lds_model_destroy(model);
    lds_model* none = NULL;
    EXPECT(lds_model_read("no_such_file.obj", &none) != LDS_OK && none == NULL);
    EXPECT(strstr(lds_last_error_text(), "no_such_file.obj") != NULL);
}

static void test_problems_name_the_object(void) {
    float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, NAN, 0}};
    const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    lds_mesh_view view = cube_view();
    view.positions = &positions[0][0];
    view.vertex_count = 4;
    view.triangles = &triangles[0][0];
    view.triangle_count = 2;
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    const lds_object_info info = info_of("torn", "Torn");
    lds_object torn;
    EXPECT(lds_model_add_mesh(model, &info, &view, NULL, 0, &torn) == LDS_OK);
    EXPECT(lds_model_problem_count(model) == 1);
    lds_problem problem;
    memset(&problem, 0, sizeof problem);
    problem.struct_size = sizeof problem;
    EXPECT(lds_model_problem(model, 1, &problem) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(problem.object == NULL);
    EXPECT(lds_model_problem(model, 0, &problem) == LDS_OK);
    EXPECT(strcmp(problem.object, "Torn") == 0);
    EXPECT(problem.severity >= 1 && problem.severity <= 2);
    EXPECT(strlen(problem.code) > 0 && strlen(problem.message) > 0);
    lds_representation finest;
    memset(&finest, 0, sizeof finest);
    finest.struct_size = sizeof finest;
    EXPECT(lds_model_representation(model, torn, 0, &finest) == LDS_OK);
    EXPECT(finest.triangles == 1);
    lds_model_destroy(model);
}

static void test_cameras_come_back(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    EXPECT(lds_model_camera_count(model) == 0);
    const lds_camera given = camera_before(7);
    EXPECT(lds_model_add_camera(model, &given) == LDS_OK);
    lds_camera back;
    memset(&back, 0, sizeof back);
    back.struct_size = sizeof back;
    EXPECT(lds_model_camera(model, 1, &back) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_camera(model, 0, &back) == LDS_OK);
    EXPECT(strcmp(back.name, "eye") == 0 && back.orthographic == 0);
    EXPECT(back.position[1] == -7 && back.right[0] == 1 && back.up[2] == 0.5625);
    lds_model_destroy(model);
}

static void test_lights_of_every_kind_are_checked(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_light light;
    memset(&light, 0, sizeof light);
    light.struct_size = sizeof light;
    light.name = "Lamp";
    light.direction[2] = -1;
    light.spot_size = 1;
    for (light.kind = LDS_LIGHT_SUN; light.kind <= LDS_LIGHT_AREA; ++light.kind)
        EXPECT(lds_model_add_light(model, &light) == LDS_OK);
    EXPECT(lds_model_light_count(model) == 4 && lds_model_light_count(NULL) == 0);
    EXPECT(lds_model_add_light(model, &light) == LDS_ERROR_INVALID_ARGUMENT); /* no such kind */
    light.kind = LDS_LIGHT_SPOT;
    light.spot_size = 4;
    EXPECT(lds_model_add_light(model, &light) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "spot_size") != NULL);
    light.kind = LDS_LIGHT_POINT;
    light.radius = -1;
    EXPECT(lds_model_add_light(model, &light) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

static void test_lengths_that_no_struct_has_are_refused(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_camera camera = camera_before(20);
    --camera.struct_size;
    EXPECT(lds_model_add_camera(model, &camera) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "camera.struct_size is") != NULL);
    EXPECT(lds_model_camera_count(model) == 0);
    lds_light light;
    memset(&light, 0, sizeof light);
    light.direction[2] = -1;
    EXPECT(lds_model_add_light(model, &light) == LDS_ERROR_INVALID_ARGUMENT);
    light.struct_size = sizeof light + 1000;
    EXPECT(lds_model_add_light(model, &light) == LDS_OK);
    lds_material material = {.struct_size = 8, .roughness = 7};
    EXPECT(lds_material_default(&material) == LDS_OK);
    EXPECT(material.struct_size == 8 && material.roughness == 7); /* not filled */
    EXPECT(lds_material_default(NULL) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

static void test_representations_and_occurrences(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    lds_object first;
    EXPECT(lds_model_object_count(model) == 2);
    EXPECT(lds_model_object_at(model, 2, &first) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_object_at(model, 0, &first) == LDS_OK);
    EXPECT(first.index == cube.index && first.generation == cube.generation);
    lds_representation finest;
    memset(&finest, 0, sizeof finest);
    finest.struct_size = sizeof finest;
    EXPECT(lds_model_representation(model, cube, 1, &finest) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "'Cube'") != NULL);
    EXPECT(lds_model_representation(model, cube, 0, &finest) == LDS_OK);
    EXPECT(finest.kind == LDS_KIND_MESH && finest.triangles == 12 && finest.error == 0);
    size_t count = 0;
    EXPECT(lds_model_occurrence_count(model, &count) == LDS_OK && count == 2);
    lds_occurrence found[3];
    memset(found, 0, sizeof found);
    EXPECT(lds_model_occurrence_copy(model, found, 1) == LDS_OK);
    EXPECT(found[0].object.index == cube.index && found[1].world[0] == 0);
    EXPECT(lds_model_occurrence_copy(model, found, 3) == LDS_OK);
    EXPECT(found[0].world[3] == 0 && found[1].world[3] == 5 && found[2].world[0] == 0);
    lds_model_destroy(model);
}

static void test_positions_that_are_not_there_are_refused(void) {
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    const lds_object_info info = info_of("none", "None");
    lds_object none;
    lds_mesh_view mesh;
    memset(&mesh, 0, sizeof mesh);
    mesh.struct_size = sizeof mesh;
    mesh.vertex_count = 1000; /* and no triangle that would use one */
    EXPECT(lds_model_add_mesh(model, &info, &mesh, NULL, 0, &none) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "mesh.positions") != NULL);
    lds_faces_view faces;
    memset(&faces, 0, sizeof faces);
    faces.struct_size = sizeof faces;
    faces.vertex_count = 1000;
    EXPECT(lds_model_add_faces(model, &info, &faces, NULL, 0, &none) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "faces.positions") != NULL);
    lds_model_destroy(model);
}

static void test_materials_mixed_without_end_are_refused(void) {
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    lds_material material = {.struct_size = sizeof material};
    EXPECT(lds_material_default(&material) == LDS_OK);
    material.mix = 0.5;
    uint32_t index = 0;
    lds_status status = LDS_OK;
    int mixtures = -1;
    while (status == LDS_OK && mixtures < 100000) {
        status = lds_model_add_material(model, &material, &index);
        material.other = index + 1;
        ++mixtures;
    }
    EXPECT(status == LDS_ERROR_INVALID_ARGUMENT && mixtures == 65);
    EXPECT(strstr(lds_last_error_text(), "64") != NULL);
    lds_model_destroy(model);
}

static void test_pictures_and_textures_are_checked(void) {
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    const float pixels[] = {1, 0, 0, 1, 0, 0, 1, 1}; /* red, blue */
    lds_picture picture;
    memset(&picture, 0, sizeof picture);
    picture.struct_size = sizeof picture;
    picture.name = "two";
    uint32_t index = 9;
    EXPECT(lds_model_add_picture(model, &picture, &index) == LDS_ERROR_INVALID_ARGUMENT);
    picture.pixels = pixels;
    picture.width = 2;
    EXPECT(lds_model_add_picture(model, &picture, &index) == LDS_ERROR_INVALID_ARGUMENT);
    picture.height = 1;
    EXPECT(lds_model_add_picture(model, &picture, &index) == LDS_OK && index == 0);
    EXPECT(lds_model_add_picture(model, &picture, &index) == LDS_OK && index == 0);
    EXPECT(lds_pictures_keep(NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_pictures_keep("") == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_pictures_keep("/dev/null/nowhere") == LDS_OK); /* which is no error */
    EXPECT(lds_model_add_picture(model, &picture, &index) == LDS_OK && index == 0);
    EXPECT(lds_pictures_keep("/dev/null/nowhere") == LDS_OK);
    picture.pixels = NULL;
    picture.bytes = "no picture";
    picture.byte_count = 10;
    EXPECT(lds_model_add_picture(model, &picture, &index) == LDS_ERROR_BAD_FILE);
    EXPECT(strstr(lds_last_error_text(), "two") != NULL);
    picture.bytes = NULL;
    picture.path = "nowhere.png";
    EXPECT(lds_model_add_picture(model, &picture, &index) == LDS_ERROR_IO);

    lds_bake_step steps[2] = {{LDS_BAKE_TEXEL, {0, 0, 0}, {0}, NULL, 0},
                              {LDS_BAKE_CHANNEL, {0, 0, 0}, {2, 0, 0, 0}, NULL, 0}};
    lds_texture two = {0};
    two.picture = 1;
    two.to_picture[0] = two.to_picture[4] = 1;
    lds_bake bake = {0};
    bake.struct_size = sizeof bake;
    bake.name = "blue";
    bake.steps = steps;
    bake.step_count = 2;
    bake.textures = &two;
    bake.texture_count = 1;
    bake.linear = 1;
    EXPECT(lds_model_bake_picture(model, &bake, NULL, &index) == LDS_OK && index == 1);
    double blue[3] = {-1, -1, -1};
    two.picture = 2;
    two.scale[0] = two.scale[1] = two.scale[2] = 1;
    EXPECT(lds_model_texture_mean(model, &two, blue) == LDS_OK && blue[0] == 0.5);
    two.picture = 3;
    EXPECT(lds_model_bake_picture(model, &bake, NULL, &index) == LDS_ERROR_INVALID_ARGUMENT);
    bake.texture_count = 0;
    EXPECT(lds_model_bake_picture(model, &bake, NULL, &index) == LDS_ERROR_INVALID_ARGUMENT);
    steps[0].op = LDS_BAKE_RAMP;
    steps[0].table_count = 3;
    EXPECT(lds_model_bake_picture(model, &bake, NULL, &index) == LDS_ERROR_INVALID_ARGUMENT);
    bake.steps = NULL;
    EXPECT(lds_model_bake_picture(model, &bake, NULL, &index) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_bake_picture(model, NULL, NULL, &index) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(index == 1);

    lds_material material = {.struct_size = sizeof material};
    EXPECT(lds_material_default(&material) == LDS_OK);
    material.name = "brick";
    material.base_color_texture.picture = 1;
    material.base_color_texture.to_picture[0] = material.base_color_texture.to_picture[4] = 1;
    for (int i = 0; i < 3; ++i)
        material.base_color_texture.scale[i] = 0.5;
    double mean[3] = {-1, -1, -1};
    EXPECT(lds_model_texture_mean(model, &material.base_color_texture, mean) == LDS_OK);
    EXPECT(mean[0] == 0.25 && mean[1] == 0 && mean[2] == 0.25);
    EXPECT(lds_model_texture_mean(model, &material.mix_texture, mean) ==
           LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_model_add_material(model, &material, &index) == LDS_OK && index == 0);
    material.other = 2;
    EXPECT(lds_model_add_material(model, &material, &index) == LDS_ERROR_INVALID_ARGUMENT);
    material.other = 1;
    EXPECT(lds_model_add_material(model, &material, &index) == LDS_OK && index == 1);
    material.base_color_texture.picture = 7;
    EXPECT(lds_model_add_material(model, &material, &index) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "'brick'") != NULL);
    material.base_color_texture.picture = 1;
    material.base_color_texture.channel = 17;
    EXPECT(lds_model_add_material(model, &material, &index) == LDS_ERROR_INVALID_ARGUMENT);
    lds_model_destroy(model);
}

static void test_texture_coordinates_are_projected(void) {
    const float positions[9] = {0, 0, 0, 2, 0, 0, 0, 2, 0};
    const uint32_t triangle[3] = {0, 1, 2};
    const int32_t slots[1] = {5};
    lds_faces_view faces = {0};
    faces.struct_size = sizeof faces;
    faces.positions = positions;
    faces.vertex_count = 3;
    faces.corner_vertices = triangle;
    faces.corner_count = 3;
    faces.face_count = 1;
    faces.face_slots = slots;
    lds_uv_projection flat = {0};
    flat.struct_size = sizeof flat;
    flat.to_space[0] = flat.to_space[5] = flat.to_space[10] = 0.5;
    flat.to_space[3] = 1;
    flat.slot_count = 2; /* slot 5 counts as the last */
    float uvs[6] = {9, 9, 9, 9, 9, 9};
    flat.slot = 0;
    EXPECT(lds_faces_project_uvs(&faces, &flat, uvs) == LDS_OK && uvs[0] == 9);
    flat.slot = 1;
    EXPECT(lds_faces_project_uvs(&faces, &flat, uvs) == LDS_OK);
    EXPECT(uvs[0] == 1 && uvs[1] == 0 && uvs[2] == 2 && uvs[5] == 1);
    const float points[9] = {4, 4, 4, 4, 4, 4, 4, 4, 4};
    flat.points = points;
    EXPECT(lds_faces_project_uvs(&faces, &flat, uvs) == LDS_OK && uvs[0] == 3);
    flat.projection = 4;
    EXPECT(lds_faces_project_uvs(&faces, &flat, uvs) == LDS_ERROR_INVALID_ARGUMENT);
    flat.projection = LDS_PROJECTION_BOX;
    faces.vertex_count = 2;
    EXPECT(lds_faces_project_uvs(&faces, &flat, uvs) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_faces_project_uvs(&faces, NULL, uvs) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_faces_project_uvs(&faces, &flat, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(uvs[0] == 3);
}

static void test_a_cube_is_seen_all_around(void) {
    lds_model* model = NULL;
    EXPECT(lds_model_create(&model) == LDS_OK);
    lds_material red = {.struct_size = sizeof red};
    EXPECT(lds_material_default(&red) == LDS_OK);
    red.name = "red";
    red.base_color[0] = 0.8;
    red.base_color[1] = red.base_color[2] = 0.1;
    red.roughness = 0.25;
    uint32_t index = 9;
    EXPECT(lds_model_add_material(model, &red, &index) == LDS_OK && index == 0);
    lds_material bad = red;
    bad.roughness = NAN;
    EXPECT(lds_model_add_material(model, &bad, &index) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(lds_last_error_text(), "'red'") != NULL && index == 0);
    const lds_object_info info = info_of("cube", "Cube");
    const lds_mesh_view view = cube_view();
    lds_object cube;
    EXPECT(lds_model_add_mesh(model, &info, &view, &index, 1, &cube) == LDS_OK);
    EXPECT(lds_model_set_root(model, cube) == LDS_OK);
    lds_measure_options options = {.struct_size = sizeof options};
    EXPECT(lds_measure_options_default(&options) == LDS_OK);
    EXPECT(options.rays == 4096 && options.relative_error == 0);
    lds_job job = {sizeof job, 0, 0, 0};
    lds_attributes a;
    memset(&a, 0, sizeof a);
    a.struct_size = sizeof a;
    EXPECT(lds_model_measure(model, cube, &options, &job, &a) == LDS_OK);
    EXPECT(job.fraction == 1);
    EXPECT(fabs(a.visible_area - 6) < 0.06 && fabs(a.surface_area - 6) < 0.06);
    for (int i = 0; i < 3; ++i) {
        EXPECT(fabs(a.centroid[i] - 0.5) < 0.02);
        EXPECT(fabs(a.inertia[i] - 5.0 / 3) < 0.1);
        EXPECT(fabs(a.color[i] - red.base_color[i]) < 1e-6);
    }
    EXPECT(fabs(a.roughness - 0.25) < 1e-6 && a.metallic == 0);
    job.cancel = 1;
    a.visible_area = -1;
    EXPECT(lds_model_measure(model, cube, &options, &job, &a) == LDS_ERROR_CANCELLED);
    EXPECT(a.visible_area == -1);
    lds_model_destroy(model);
}

static void test_choices_carry_the_path_of_placements(void) {
    lds_object cube;
    lds_model* model = two_cubes(&cube);
    const lds_camera camera = camera_before(20);
    const lds_view view = view_of(&camera, 640, 360); /* Pixel Error 0: originals */
    lds_cut* cut = NULL;
    EXPECT(lds_cut_create(model, &view, NULL, &cut) == LDS_OK);
    EXPECT(lds_cut_choice_count(cut) == 2);
    lds_choice choices[2];
    memset(choices, 0, sizeof choices);
    EXPECT(lds_cut_choice_copy(cut, choices, 2) == LDS_OK);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT(choices[i].object.index == cube.index && choices[i].kind == LDS_KIND_MESH);
        EXPECT(choices[i].lod == 0 && choices[i].error_px == 0);
        const char* path = choices[i].world[3] == 0 ? "left" : "right";
        EXPECT(strcmp(lds_cut_choice_path(cut, i), path) == 0);
    }
    EXPECT(choices[0].world[3] != choices[1].world[3]);
    EXPECT(strcmp(lds_cut_choice_path(cut, 2), "") == 0);
    lds_level_use use = {{0, 0}, 9, 9, 9};
    size_t count = 9;
    EXPECT(lds_cut_level_uses(cut, &use, 1, &count) == LDS_OK && count == 1);
    EXPECT(use.object.index == cube.index && use.object.generation == cube.generation);
    EXPECT(use.lod == 0 && use.unused == 0 && use.occurrences == 2);
    EXPECT(lds_cut_level_uses(cut, NULL, 0, &count) == LDS_OK && count == 1);
    EXPECT(lds_cut_level_uses(cut, NULL, 1, &count) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_level_uses(NULL, &use, 1, &count) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_cut_level_uses(cut, &use, 1, NULL) == LDS_ERROR_INVALID_ARGUMENT);
    lds_cut_destroy(cut);
    lds_model_destroy(model);
}

int main(void) {
    test_files_keep_the_model("capi_cubes.obj");
    test_files_keep_the_model("capi_cubes.ply");
    test_files_keep_the_model("capi_cubes.glb");
    test_problems_name_the_object();
    test_cameras_come_back();
    test_lights_of_every_kind_are_checked();
    test_lengths_that_no_struct_has_are_refused();
    test_representations_and_occurrences();
    test_choices_carry_the_path_of_placements();
    test_positions_that_are_not_there_are_refused();
    test_materials_mixed_without_end_are_refused();
    if (lds_rays_check() == LDS_OK) {
        test_pictures_and_textures_are_checked();
        test_texture_coordinates_are_projected();
        test_a_cube_is_seen_all_around();
    }
    return finish();
}
