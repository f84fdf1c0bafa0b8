# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures, materials and what they are baked from."""

from ctypes import POINTER, Structure, c_char_p, c_double, c_int32, c_size_t, c_uint32, c_void_p

from .base import Sized


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
