# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring bare triangle buffers."""

import ctypes
from array import array
from typing import NamedTuple

from .library import check, library


class SurfaceInertia(NamedTuple):
    area: float  # square metres
    center: tuple[float, ...]  # metres
    inertia: tuple[float, ...]  # xx yy zz xy yz zx about center, m^4


def surface_inertia(positions: array, triangles: array) -> SurfaceInertia:
    """Area, center and inertia of a triangle surface of uniform thickness (flat buffers)."""
    if positions.itemsize != 4 or triangles.itemsize != 4:
        raise ValueError("positions and triangles need 4-byte items")
    if len(positions) % 3 or len(triangles) % 3:
        raise ValueError("positions and triangles come in threes")
    area, center, inertia = ctypes.c_double(), (ctypes.c_double * 3)(), (ctypes.c_double * 6)()
    check(
        library().lds_surface_inertia(
            ctypes.cast(positions.buffer_info()[0], ctypes.POINTER(ctypes.c_float)),
            len(positions) // 3,
            ctypes.cast(triangles.buffer_info()[0], ctypes.POINTER(ctypes.c_uint32)),
            len(triangles) // 3,
            ctypes.byref(area),
            center,
            inertia,
        )
    )
    return SurfaceInertia(area.value, tuple(center), tuple(inertia))
