# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, faces and strands, and the sides of them that a projection sees."""

from ctypes import c_double, c_int32, c_size_t, c_uint32, c_void_p

from .base import Sized


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
