# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates made from positions."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import c_float
from typing import TYPE_CHECKING

from . import structs
from .base import pointer_to
from .buffers import FaceBuffers
from .enums import Projection
from .library import check, library

if TYPE_CHECKING:
    from .base import Buffer


def project_uvs(
    faces: FaceBuffers,
    uvs: Buffer,
    to_space: Sequence[float],
    projection: int = Projection.FLAT,
    points: Buffer | None = None,
    slot: int = -1,
    slot_count: int = 1,
) -> None:
    """Writes the coordinates of the corners of one slot (-1: of all) of FaceBuffers into uvs
    ([corner][2]). to_space: row-major 3x4 from positions, or from `points` in their place, to the
    space that the picture is laid on."""
    view = faces.struct()
    if uvs.itemsize != 4 or len(uvs) < 2 * view.corner_count:
        raise ValueError("too few texture coordinates for the corners")
    if points is not None and (points.itemsize != 4 or len(points) != 3 * view.vertex_count):
        raise ValueError("points and positions differ in length")
    given = structs.UvProjection(
        projection=projection,
        to_space=tuple(to_space),
        points=pointer_to(points, c_float),
        slot=slot,
        slot_count=slot_count,
    )
    check(library().lds_faces_project_uvs(view, given, pointer_to(uvs, c_float)))
