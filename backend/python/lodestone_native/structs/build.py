# SPDX-License-Identifier: GPL-3.0-or-later
"""Building a model, and what came of it."""

from ctypes import POINTER, c_double, c_int32, c_size_t, c_uint32, c_uint64, c_void_p

from .base import Object, Sized
from .view import View


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
