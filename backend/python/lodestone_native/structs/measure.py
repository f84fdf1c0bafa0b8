# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of a representation, and levels made from it."""

from ctypes import c_double, c_int32, c_uint32, c_uint64

from .base import Sized


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
