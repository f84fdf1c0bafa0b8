# SPDX-License-Identifier: GPL-3.0-or-later
"""Result and argument types of every function of lodestone.h, one per line, in its order."""

import ctypes
from ctypes import POINTER as P
from ctypes import c_char_p, c_double, c_float, c_int32, c_size_t, c_uint8, c_uint32, c_uint64
from ctypes import c_void_p

from . import structs as s
from .job import Job

I, U, Z, D, T = c_int32, c_uint32, c_size_t, c_double, c_char_p  # noqa: E741
M, C = c_void_p, c_void_p  # lds_model*, lds_cut*
OUT = P(c_void_p)

# fmt: off
PROTOTYPES = (
    ("lds_abi_version", U, []),
    ("lds_version", T, []),
    ("lds_status_name", T, [I]),
    ("lds_last_error_text", T, []),
    ("lds_rays_check", I, []),
    ("lds_material_default", s.Material, []),
    ("lds_model_create", I, [OUT]),
    ("lds_model_destroy", None, [M]),
    ("lds_model_read", I, [T, OUT]),
    ("lds_model_write", I, [M, T]),
    ("lds_model_add_picture", I, [M, P(s.Picture), P(c_uint32)]),
    ("lds_model_texture_mean", I, [M, P(s.Texture), P(D)]),
    ("lds_model_bake_picture", I, [M, P(s.Bake), P(Job), P(c_uint32)]),
    ("lds_model_add_material", I, [M, P(s.Material), P(c_uint32)]),
    ("lds_faces_project_uvs", I, [P(s.FacesView), P(s.UvProjection), c_void_p]),
    ("lds_faces_largest", Z, [c_void_p, Z, Z]),
    ("lds_model_add_mesh", I, [M, P(s.ObjectInfo), P(s.MeshView), P(c_uint32), Z, P(s.Object)]),
    ("lds_model_add_faces", I, [M, P(s.ObjectInfo), P(s.FacesView), P(c_uint32), Z, P(s.Object)]),
    ("lds_model_add_strands", I,
     [M, P(s.ObjectInfo), P(s.StrandsView), P(c_uint32), Z, P(s.Object)]),
    ("lds_model_add_group", I, [M, P(s.ObjectInfo), P(s.Object)]),
    ("lds_model_add_placement", I, [M, s.Object, s.Object, P(c_double), T]),
    ("lds_model_add_placements", I,
     [M, s.Object, Z, P(s.Object), c_void_p, c_char_p, c_void_p]),
    ("lds_model_hide_placement", I, [M, s.Object, U]),
    ("lds_model_decide_placement", I, [M, s.Object, Z, D, U]),
    ("lds_model_pin_placement", I, [M, s.Object, Z, U]),
    ("lds_model_change_placement", I, [M, s.Object, Z, P(D), U]),
    ("lds_model_move_placement", I, [M, s.Object, Z, P(D)]),
    ("lds_model_group_by_position", I, [M, s.Object, U, P(Z)]),
    ("lds_structure_options_default", s.StructureOptions, []),
    ("lds_model_structure", I,
     [M, P(s.Object), Z, P(s.StructureOptions), P(Job), P(s.StructureReport)]),
    ("lds_loose_options_default", s.LooseOptions, []),
    ("lds_model_split_loose_parts", I,
     [M, P(s.Object), Z, P(s.LooseOptions), P(Job), P(s.LooseReport)]),
    ("lds_model_set_root", I, [M, s.Object]),
    ("lds_model_add_light", I, [M, P(s.Light)]),
    ("lds_model_add_camera", I, [M, P(s.Camera)]),
    ("lds_model_set_world", I, [M, P(s.World)]),
    ("lds_model_totals", I, [M, P(s.Totals)]),
    ("lds_model_object_count", Z, [M]),
    ("lds_model_object_at", I, [M, Z, P(s.Object)]),
    ("lds_model_find_object", I, [M, T, P(s.Object)]),
    ("lds_model_object_summary", I, [M, s.Object, P(s.ObjectSummary)]),
    ("lds_model_child", I, [M, s.Object, Z, P(s.Placement)]),
    ("lds_model_representation", I, [M, s.Object, U, P(s.Representation)]),
    ("lds_model_occurrence_count", I, [M, P(c_size_t)]),
    ("lds_model_occurrence_copy", I, [M, P(s.Occurrence), Z]),
    ("lds_model_occurrence_hidden", I, [M, P(c_uint32), Z]),
    ("lds_model_camera_count", Z, [M]),
    ("lds_model_camera", I, [M, Z, P(s.Camera)]),
    ("lds_model_light_count", Z, [M]),
    ("lds_model_problem_count", Z, [M]),
    ("lds_model_problem", I, [M, Z, P(s.Problem)]),
    ("lds_surface_inertia", I, [P(c_float), Z, P(c_uint32), Z, P(D), P(D), P(D)]),
    ("lds_measure_options_default", s.MeasureOptions, []),
    ("lds_model_measure", I, [M, s.Object, P(s.MeasureOptions), P(Job), P(s.Attributes)]),
    ("lds_simplify_options_default", s.SimplifyOptions, []),
    ("lds_model_simplify", I, [M, P(s.SimplifyOptions), P(Job), P(s.SimplifyReport)]),
    ("lds_build_options_default", s.BuildOptions, []),
    ("lds_model_build_estimate", I, [M, T, P(s.BuildOptions), P(s.BuildReport)]),
    ("lds_model_build", I, [M, T, P(s.BuildOptions), P(Job), P(s.BuildReport)]),
    ("lds_modifiers_default", s.Modifiers, []),
    ("lds_cut_create", I, [M, P(s.View), P(Job), OUT]),
    ("lds_cut_step", I, [M, C, P(s.View), P(Job)]),
    ("lds_cut_create_within", I, [M, P(s.View), P(s.Budget), P(Job), P(s.BudgetReport), OUT]),
    ("lds_cut_destroy", None, [C]),
    ("lds_cut_get_summary", I, [C, P(s.CutSummary)]),
    ("lds_cut_choice_count", Z, [C]),
    ("lds_cut_choice_copy", I, [C, P(s.Choice), Z]),
    ("lds_cut_level_uses", I, [C, P(s.LevelUse), Z, P(Z)]),
    ("lds_cut_choice_path", T, [C, Z]),
    ("lds_cut_choice_reason", I, [M, C, Z, P(s.Reason)]),
    ("lds_cut_get_rays", I, [C, U, P(s.RaySummary)]),
    ("lds_cut_choice_rays", I, [M, C, Z, U, P(s.RayChoice)]),
    ("lds_cut_find_choice", I, [M, C, s.Object, P(c_double), P(c_int32), P(c_size_t)]),
    ("lds_model_most_demanding", I, [M, s.Object, P(c_char_p)]),
    ("lds_model_release_meshes", I, [M]),
    ("lds_cut_set_colors", I, [C, P(c_double), Z]),
    ("lds_cut_set_identities", I, [C]),
    ("lds_cut_make_surface", I, [M, C, c_uint64, P(Job), P(c_uint64)]),
    ("lds_cut_surface_copy", I, [C, P(c_float), P(c_uint8), Z]),
    ("lds_cut_make_batches", I, [M, C, P(Z)]),
    ("lds_cut_batch_keys", I, [C, c_void_p, c_void_p, Z]),
    ("lds_batch_create", I, [M, C, Z, P(Job), OUT]),
    ("lds_batch_destroy", None, [c_void_p]),
    ("lds_batch_vertex_count", Z, [c_void_p]),
    ("lds_batch_triangle_count", Z, [c_void_p]),
    ("lds_batch_box", I, [c_void_p, P(D)]),
    ("lds_batch_copy", I, [c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    ("lds_povray_options_default", s.PovrayOptions, []),
    ("lds_povray_export", I, [M, C, P(s.View), T, P(s.PovrayOptions), P(Job), P(s.ExportReport)]),
    ("lds_povray_run", I, [T, T, P(s.PovrayOptions), P(Job), P(s.PovrayReport)]),
    ("lds_povray_empty_bytes", I, [c_int32, c_int32, T, P(c_uint64)]),
    ("lds_povray_find", I, [T, P(c_char_p)]),
    ("lds_povray_false_color", I, [c_int32, c_uint32, P(c_double)]),
    ("lds_image_size", I, [T, P(c_int32), P(c_int32)]),
    ("lds_image_read", I, [T, I, P(c_float), Z]),
    ("lds_image_read_part", I, [T, P(c_int32), I, P(c_float), Z]),
    ("lds_image_write_png", I, [T, I, I, P(c_float)]),
    ("lds_image_add_text", I, [T, P(c_char_p), P(c_char_p), Z]),
    ("lds_image_compare", I, [T, T, T, P(s.Difference)]),
    ("lds_image_compare_shown", I,
     [T, T, T, T, P(c_double), Z, P(c_double), Z, I, P(c_float), Z, P(s.Difference)]),
    ("lds_image_difference_color", I, [c_double, P(c_double)]),
)
# fmt: on


def declare(library: ctypes.CDLL) -> None:
    """Raises AttributeError naming the first function the library lacks."""
    for name, result, arguments in PROTOTYPES:
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
