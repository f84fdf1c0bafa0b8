# SPDX-License-Identifier: GPL-3.0-or-later
"""What a model holds besides meshes: objects, placements, lights, cameras, the world."""

from ctypes import Structure, c_char_p, c_double, c_int32, c_uint32, c_uint64

from .base import Object, Sized


class ObjectInfo(Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("uid", c_char_p),
        ("name", c_char_p),
        ("role", c_int32),
        ("deforms", c_int32),
        ("connectivity", c_uint64),
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
