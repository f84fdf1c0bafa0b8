# SPDX-License-Identifier: GPL-3.0-or-later
"""How groups are structured and loose parts taken apart, and what came of it."""

from ctypes import c_double, c_int32, c_uint32, c_uint64

from .base import Sized


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
