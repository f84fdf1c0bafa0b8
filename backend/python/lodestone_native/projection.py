# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates made from positions."""

from array import array
from collections.abc import Sequence
from typing import Any

from . import structs
from .enums import Projection
from .library import check, library


def project_uvs(
    mesh: Any,
    uvs: array,
    to_space: Sequence[float],
    projection: int = Projection.FLAT,
    points: array | None = None,
    slot: int = -1,
    slot_count: int = 1,
) -> None:
    """Writes the coordinates of the corners of one slot (-1: of all) of a MeshBuffers into uvs
    ([corner][2]). to_space: row-major 3x4 from positions, or from `points` in their place, to the
    space that the picture is laid on."""
    view = mesh.struct()
    corners = view.corner_count or len(uvs) // 2 if mesh.corners else view.vertex_count
    view.corner_count = corners
    if uvs.itemsize != 4 or len(uvs) < 2 * corners:
        raise ValueError("too few texture coordinates for the corners")
    if points is not None and (points.itemsize != 4 or len(points) != 3 * view.vertex_count):
        raise ValueError("points and positions differ in length")
    given = structs.UvProjection(
        projection=projection,
        to_space=tuple(to_space),
        points=None if points is None else points.buffer_info()[0],
        slot=slot,
        slot_count=slot_count,
    )
    check(library().lds_mesh_project_uvs(view, given, uvs.buffer_info()[0]))
