# SPDX-License-Identifier: GPL-3.0-or-later
"""The C structs, field by field as in lodestone.h, and the ways in and out of them.

More than 500 lines: one table.
"""

import ctypes
from collections import namedtuple
from ctypes import (
    POINTER,
    Structure,
    c_char_p,
    c_double,
    c_int32,
    c_size_t,
    c_uint32,
    c_uint64,
    c_void_p,
)
from functools import lru_cache
from typing import Any


class Sized(Structure):
    """A struct that starts with struct_size; the constructor fills it."""

    def __init__(self, **fields: Any) -> None:
        super().__init__(struct_size=ctypes.sizeof(type(self)), **fields)


class Object(Structure):
    """An id: an object of one model. {0, 0} is none."""

    _fields_ = [("index", c_uint32), ("generation", c_uint32)]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Object) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def __bool__(self) -> bool:
        return self.key != (0, 0)

    def __repr__(self) -> str:
        return f"Object({self.index}, {self.generation})"

    @property
    def key(self) -> tuple[int, int]:
        return (self.index, self.generation)


class ObjectInfo(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("uid", c_char_p),
        ("name", c_char_p),
        ("role", c_int32),
        ("deforms", c_int32),
        ("connectivity", c_uint64),
    ]


class Picture(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("path", c_char_p),
        ("bytes", c_char_p),
        ("byte_count", c_size_t),
        ("pixels", c_void_p),
        ("width", c_int32),
        ("height", c_int32),
        ("linear", c_int32),
    ]


class Texture(Structure):
    _fields_ = [
        ("picture", c_uint32),
        ("channel", c_int32),
        ("extension", c_int32),
        ("closest", c_int32),
        ("to_picture", c_double * 6),
        ("scale", c_double * 3),
        ("offset", c_double * 3),
    ]


class BakeStep(Structure):
    _fields_ = [
        ("op", c_int32),
        ("args", c_uint32 * 3),
        ("value", c_double * 4),
        ("table", c_void_p),
        ("table_count", c_size_t),
    ]


class Bake(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("steps", POINTER(BakeStep)),
        ("step_count", c_size_t),
        ("textures", POINTER(Texture)),
        ("texture_count", c_size_t),
        ("width", c_int32),
        ("height", c_int32),
        ("linear", c_int32),
    ]


class Material(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("base_color", c_double * 3),
        ("roughness", c_double),
        ("metallic", c_double),
        ("specular", c_double),
        ("emission", c_double * 3),
        ("base_color_texture", Texture),
        ("roughness_texture", Texture),
        ("metallic_texture", Texture),
        ("emission_texture", Texture),
        ("vertex_colors", c_int32),
        ("alpha", c_double),
        ("alpha_texture", Texture),
        ("alpha_mode", c_int32),
        ("alpha_cutoff", c_double),
        ("transmission", c_double),
        ("ior", c_double),
        ("clearcoat", c_double),
        ("clearcoat_roughness", c_double),
        ("normal_texture", Texture),
        ("normal_strength", c_double),
        ("bump_texture", Texture),
        ("bump_distance", c_double),
        ("other", c_uint32),
        ("mix", c_double),
        ("mix_texture", Texture),
    ]


class MeshView(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("positions", c_void_p),
        ("vertex_count", c_size_t),
        ("triangles", c_void_p),
        ("triangle_count", c_size_t),
        ("corners", c_void_p),
        ("corner_count", c_size_t),
        ("corner_normals", c_void_p),
        ("corner_uvs", c_void_p),
        ("corner_colors", c_void_p),
        ("slots", c_void_p),
    ]


class FacesView(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("positions", c_void_p),
        ("vertex_count", c_size_t),
        ("corner_vertices", c_void_p),
        ("corner_count", c_size_t),
        ("face_starts", c_void_p),
        ("face_count", c_size_t),
        ("triangles", c_void_p),
        ("triangle_count", c_size_t),
        ("face_smooth", c_void_p),
        ("face_slots", c_void_p),
        ("corner_normals", c_void_p),
        ("corner_uvs", c_void_p),
        ("corner_colors", c_void_p),
        ("vertex_colors", c_void_p),
    ]


class StrandsView(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("points", c_void_p),
        ("radii", c_void_p),
        ("point_count", c_size_t),
        ("counts", c_void_p),
        ("strand_count", c_size_t),
        ("slots", c_void_p),
        ("uvs", c_void_p),
    ]


class UvProjection(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("projection", c_int32),
        ("to_space", c_double * 12),
        ("points", c_void_p),
        ("slot", c_int32),
        ("slot_count", c_uint32),
    ]


class Light(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("kind", c_int32),
        ("color", c_double * 3),
        ("power", c_double),
        ("position", c_double * 3),
        ("direction", c_double * 3),
        ("shadow", c_int32),
        ("radius", c_double),
        ("angle", c_double),
        ("spot_size", c_double),
        ("spot_blend", c_double),
        ("edge_u", c_double * 3),
        ("edge_v", c_double * 3),
        ("round", c_int32),
        ("spread", c_double),
    ]


class Camera(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("orthographic", c_int32),
        ("position", c_double * 3),
        ("direction", c_double * 3),
        ("right", c_double * 3),
        ("up", c_double * 3),
        ("near_clip", c_double),
        ("focus_distance", c_double),
        ("aperture", c_double),
    ]


class World(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("color", c_double * 3),
        ("transparent", c_int32),
        ("environment_turn", c_double * 9),
        ("environment_strength", c_double * 3),
        ("environment", c_uint32),
    ]


class Totals(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("objects", c_uint64),
        ("occurrences", c_uint64),
        ("triangles_placed", c_uint64),
        ("triangles_unique", c_uint64),
        ("representations", c_uint64),
    ]


class ObjectSummary(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("uid", c_char_p),
        ("name", c_char_p),
        ("role", c_int32),
        ("group", c_int32),
        ("representation_count", c_uint32),
        ("child_count", c_uint32),
        ("source_hash", c_uint64),
        ("center", c_double * 3),
        ("radius", c_double),
    ]


class Placement(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("object", Object),
        ("transform", c_double * 12),
        ("name", c_char_p),
        ("hidden", c_uint32),
        ("coarsest", c_uint32),
        ("importance", c_double),
    ]


class Representation(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("error", c_double),
        ("max_error", c_double),
        ("triangles", c_uint64),
        ("bytes", c_uint64),
        ("hash", c_uint64),
    ]


class Occurrence(Structure):
    _fields_ = [("object", Object), ("world", c_double * 12)]


class Problem(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("object", c_char_p),
        ("severity", c_int32),
        ("code", c_char_p),
        ("message", c_char_p),
    ]


class StructureOptions(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("fewest_children", c_uint32),
        ("most_children", c_uint32),
        ("orders", c_uint32),
        ("similarity", c_double),
        ("group_cost", c_double),
        ("seed", c_uint64),
        ("threads", c_int32),
    ]


class StructureReport(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("structured", c_uint64),
        ("made", c_uint64),
        ("cost_before", c_double),
        ("cost_after", c_double),
        ("cpu_s", c_double),
    ]


class LooseOptions(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("always", c_int32),
        ("fewest_triangles", c_uint32),
        ("most_clusters", c_uint32),
        ("threads", c_int32),
    ]


class LooseReport(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("split", c_uint64),
        ("parts", c_uint64),
        ("made", c_uint64),
        ("cpu_s", c_double),
    ]


class MeasureOptions(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("rays", c_uint64),
        ("relative_error", c_double),
        ("seed", c_uint64),
        ("threads", c_int32),
    ]


class Attributes(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("visible_area", c_double),
        ("surface_area", c_double),
        ("centroid", c_double * 3),
        ("inertia", c_double * 6),
        ("normal_moment", c_double),
        ("color", c_double * 3),
        ("roughness", c_double),
        ("metallic", c_double),
        ("relative_error", c_double),
        ("rays", c_uint64),
    ]


class SimplifyOptions(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("ratio", c_double),
        ("triangles", c_uint64),
        ("error", c_double),
        ("measure", c_int32),
        ("seed", c_uint64),
        ("threads", c_int32),
        ("pixels", c_double),
        ("height_px", c_double),
        ("mode", c_int32),
        ("keep_topology", c_int32),
    ]


class SimplifyReport(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("triangles_before", c_uint64),
        ("triangles", c_uint64),
        ("cpu_s", c_double),
        ("error", c_double),
        ("max_error", c_double),
    ]


class Lens(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("shape", c_int32),
        ("transform", c_double * 12),
        ("radius", c_double),
        ("strength", c_double),
        ("falloff", c_double),
        ("filter", c_int32),
        ("name", c_char_p),
        ("objects", POINTER(Object)),
        ("object_count", c_size_t),
    ]


class ScreenLens(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("in_pixels", c_int32),
        ("center", c_double * 2),
        ("radius", c_double),
        ("strength", c_double),
        ("falloff", c_double),
        ("name", c_char_p),
    ]


class Modifiers(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("criterion", c_int32),
        ("lenses", POINTER(Lens)),
        ("lens_count", c_size_t),
        ("screen_lenses", POINTER(ScreenLens)),
        ("screen_lens_count", c_size_t),
        ("depth", c_double),
        ("depth_focus", c_double),
        ("when_moving", c_int32),
        ("when_dark", c_int32),
        ("closing", POINTER(Camera)),
        ("off_screen", c_int32),
        ("ray_classes", c_uint32),
    ]


class View(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("camera", Camera),
        ("width", c_int32),
        ("height", c_int32),
        ("pixel_error", c_double),
        ("kinds", c_uint32),
        ("border", c_int32 * 4),
        ("modifiers", POINTER(Modifiers)),
    ]


class BuildOptions(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("level_ratio", c_double),
        ("rays", c_uint64),
        ("samples", c_uint32),
        ("group_triangles", c_uint64),
        ("seed", c_uint64),
        ("threads", c_int32),
        ("rebuild", c_int32),
        ("scope", POINTER(Object)),
        ("scope_count", c_size_t),
        ("poses", POINTER(c_void_p)),
        ("pose_count", c_size_t),
        ("view", POINTER(View)),
        ("share", c_double),
    ]


class BuildReport(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("objects", c_uint64),
        ("built", c_uint64),
        ("representations", c_uint64),
        ("triangles", c_uint64),
        ("bytes_written", c_uint64),
        ("wall_s", c_double),
        ("cpu_s", c_double),
        ("left", c_uint64),
    ]


class Budget(Sized):
    _fields_ = [("struct_size", c_uint32), ("triangles", c_uint64), ("bytes", c_uint64)]


class BudgetReport(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("fits", c_int32),
        ("pixel_error", c_double),
        ("cuts", c_uint64),
    ]


class CutSummary(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("occurrences", c_uint64),
        ("opened", c_uint64),
        ("mesh", c_uint64),
        ("box", c_uint64),
        ("ellipsoid", c_uint64),
        ("originals", c_uint64),
        ("triangles", c_uint64),
        ("bytes", c_uint64),
        ("largest_error_px", c_double),
        ("largest_error_name", c_char_p),
        ("composite", c_uint64),
        ("largest_error_choice", c_uint64),
    ]


class Choice(Structure):
    _fields_ = [
        ("object", Object),
        ("lod", c_uint32),
        ("kind", c_int32),
        ("error_px", c_double),
        ("world", c_double * 12),
    ]


class Reason(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("lod", c_uint32),
        ("z", c_double),
        ("pixel", c_double),
        ("error", c_double),
        ("stretch", c_double),
        ("error_px", c_double),
        ("factor", c_double),
        ("importance", c_double),
        ("demand", c_double),
        ("lenses", c_double),
        ("screen_lenses", c_double),
        ("depth", c_double),
        ("motion", c_double),
        ("darkness", c_double),
        ("off_screen", c_double),
        ("coarser_object", Object),
        ("coarser_lod", c_uint32),
        ("coarser_kind", c_int32),
        ("coarser_error", c_double),
        ("coarser_error_px", c_double),
        ("coarser_factor", c_double),
        ("pinned", c_int32),
    ]


class RaySummary(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("rays", c_uint32),
        ("own", c_uint64),
        ("occurrences", c_uint64),
        ("triangles", c_uint64),
        ("bytes", c_uint64),
        ("largest_error_px", c_double),
        ("kept_need", c_uint64),
        ("kept_shape", c_uint64),
        ("kept_contact", c_uint64),
        ("all_triangles", c_uint64),
        ("all_bytes", c_uint64),
    ]


class RayChoice(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("met", c_int32),
        ("object", Object),
        ("lod", c_uint32),
        ("kind", c_int32),
        ("scale", c_double),
        ("error", c_double),
        ("error_px", c_double),
    ]


class PovrayOptions(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("antialias", c_int32),
        ("false_color", c_int32),
        ("covered_only", c_int32),
        ("threads", c_int32),
        ("program", c_char_p),
        ("antialias_threshold", c_double),
        ("antialias_depth", c_int32),
        ("trace_depth", c_int32),
        ("area_samples", c_int32),
        ("sky_lights", c_int32),
        ("shadow_error", c_double),
        ("light_error", c_double),
        ("reflection_error", c_double),
        ("texture_error", c_double),
    ]


class ExportReport(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("bytes", c_uint64),
        ("files", c_uint64),
        ("written", c_uint64),
        ("cpu_s", c_double),
        ("lamps", c_uint64),
        ("lights_each", c_double),
        ("unseen", c_uint64),
    ]


class PovrayReport(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("exit_code", c_int32),
        ("parse_cpu_s", c_double),
        ("trace_cpu_s", c_double),
        ("wall_s", c_double),
        ("peak_bytes", c_uint64),
    ]


class Difference(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("mean", c_double),
        ("p999", c_double),
        ("max", c_double),
        ("ssim", c_double),
        ("pixels", c_uint64),
    ]


def text_in(text: str | None) -> bytes | None:
    """UTF-8 for the library; bytes of a name that is no UTF-8 travel through unchanged."""
    return None if text is None else text.encode("utf-8", "surrogateescape")


def text_out(data: bytes | None) -> str:
    return "" if data is None else data.decode("utf-8", "replace")


@lru_cache(maxsize=None)
def _record_type(struct: type[Structure]) -> Any:
    names = [field[0] for field in struct._fields_ if field[0] != "struct_size"]
    return namedtuple(struct.__name__, names)


def record(struct: Structure) -> Any:
    """The struct's values as a named tuple that stays valid: strings and arrays are copied."""
    kind = _record_type(type(struct))
    return kind(*(_plain(getattr(struct, name)) for name in kind._fields))


def _plain(value: Any) -> Any:
    if isinstance(value, bytes) or value is None:
        return text_out(value)
    if isinstance(value, ctypes.Array):
        return tuple(value)
    if isinstance(value, Object):
        return Object(value.index, value.generation)
    return value
