# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring bare triangle buffers."""

from __future__ import annotations

import ctypes
from array import array
from typing import NamedTuple

from .base import pointer_to
from .library import check, library


class SurfaceInertia(NamedTuple):
    area: float  # square metres
    center: tuple[float, ...]  # metres
    inertia: tuple[float, ...]  # xx yy zz xy yz zx about center, m^4


def surface_inertia(positions: array[float], triangles: array[int]) -> SurfaceInertia:
    """Area, center and inertia of a triangle surface of uniform thickness (flat buffers)."""
    if positions.itemsize != 4 or triangles.itemsize != 4:
        raise ValueError("positions and triangles need 4-byte items")
    if len(positions) % 3 or len(triangles) % 3:
        raise ValueError("positions and triangles come in threes")
    area, center, inertia = ctypes.c_double(), (ctypes.c_double * 3)(), (ctypes.c_double * 6)()
    check(
        library().lds_surface_inertia(
            pointer_to(positions, ctypes.c_float),
            len(positions) // 3,
            pointer_to(triangles, ctypes.c_uint32),
            len(triangles) // 3,
            area,
            center,
            inertia,
        )
    )
    return SurfaceInertia(area.value, tuple(center), tuple(inertia))
