# SPDX-License-Identifier: GPL-3.0-or-later
"""A view, and all that bends quality in it."""

from ctypes import POINTER, c_char_p, c_double, c_int32, c_size_t, c_uint32

from .base import Object, Sized
from .scene import Camera


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
