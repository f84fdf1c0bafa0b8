# SPDX-License-Identifier: GPL-3.0-or-later
"""What is chosen for a view, why, and what rays meet."""

from ctypes import Structure, c_char_p, c_double, c_int32, c_uint32, c_uint64

from .base import Object, Sized


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


class LevelUse(Structure):
    _fields_ = [
        ("object", Object),
        ("lod", c_uint32),
        ("unused", c_uint32),
        ("occurrences", c_uint64),
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
