# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes and pictures by POV-Ray, and how pictures differ."""

from ctypes import c_char_p, c_double, c_int32, c_uint32, c_uint64

from .base import Sized


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
        ("bounces", c_int32),
        ("bounce_rays", c_int32),
        ("bounce_error", c_double),
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
