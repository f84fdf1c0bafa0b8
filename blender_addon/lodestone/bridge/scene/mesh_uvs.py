# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates of a mesh's corners, each slot's as its material wants them."""

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from mathutils import Matrix

from ...core.native import lodestone_native as native
from .. import blender_versions
from ..datablock_ids import called
from ..nodes.texture_coordinates import Coordinates


def corner_uvs(mesh: Any, buffers: Any, shown: Any, wanted: Sequence[Coordinates | None]) -> array:
    """Texture coordinates [corner][2]; `wanted` by slot. A uv layer the mesh lacks is 0 everywhere,
    as in Blender."""
    kinds = list(dict.fromkeys(item for item in wanted if item is not None))
    uvs = blender_versions.buffer("f", 2 * len(mesh.loops))
    for number, item in enumerate(item for item in kinds if item.kind == "UV"):
        layer = _layer(mesh, item.name)
        found = blender_versions.buffer("f", len(uvs)) if number else uvs
        if layer is not None:
            blender_versions.corner_uvs(layer, found)
        if number:
            for start, end in corners_of_slots(mesh, wanted, item):
                uvs[2 * start : 2 * end] = found[2 * start : 2 * end]
    bounds = None
    for slot, item in enumerate(wanted):
        if item is None or item.kind == "UV":
            continue
        points = None
        if item.kind == "GENERATED":
            bounds = bounds or _undeformed(mesh)
            points = bounds
        native.project_uvs(
            buffers,
            uvs,
            _to_space(mesh, shown, item),
            item.projection,
            points,
            slot if len(wanted) > 1 else -1,
            len(wanted),
        )
    return uvs


def corners_of_slots(mesh: Any, wanted: Sequence[Any], kind: Any) -> Iterator[tuple[int, int]]:
    """Runs of the corners of all faces whose slot wants this kind."""
    count = len(mesh.polygons)
    slots, starts, totals = (blender_versions.buffer(code, count) for code in "iII")
    blender_versions.face_slots(mesh, slots)
    mesh.polygons.foreach_get("loop_start", starts)
    mesh.polygons.foreach_get("loop_total", totals)
    last = len(wanted) - 1
    for slot, start, total in zip(slots, starts, totals):
        if wanted[min(max(slot, 0), last)] == kind:
            yield start, start + total


def _layer(mesh: Any, name: str) -> Any | None:
    if name:
        return called(mesh.uv_layers, name)
    return next((layer for layer in mesh.uv_layers if layer.active_render), None)


def _undeformed(mesh: Any) -> array:
    """The positions that Blender takes generated coordinates from: those before deforming
    modifiers."""
    points = blender_versions.buffer("f", 3 * len(mesh.vertices))
    mesh.vertices.foreach_get("undeformed_co", points)
    return points


def _to_space(mesh: Any, shown: Any, wanted: Coordinates) -> tuple[float, ...]:
    rows = wanted.rows
    matrix = Matrix((rows[0:4], rows[4:8], rows[8:12], (0.0, 0.0, 0.0, 1.0)))
    if wanted.kind == "GENERATED":
        matrix = matrix @ _generated(mesh)
    elif wanted.kind == "FRAME":
        matrix = matrix @ frame_of(shown.matrix_world, wanted)
    return (*matrix[0], *matrix[1], *matrix[2])


def depend_on_place(wanted: Sequence[Any]) -> bool:
    return any(item.coordinates is not None and item.coordinates.kind == "FRAME" for item in wanted)


def frames(world: Matrix, wanted: Sequence[Any]) -> tuple[float, ...]:
    """The values that the texture coordinates of these slots depend on besides the mesh: the same
    mesh has other ones at another place."""
    found: list[float] = []
    for item in wanted:
        if item.coordinates is not None and item.coordinates.kind == "FRAME":
            matrix = frame_of(world, item.coordinates)
            found.extend(round(v, 6) for row in matrix[:3] for v in row)
    return tuple(found)


def placed(wanted: Sequence[Any], world: Matrix) -> list[Any]:
    """The wanted coordinates, in the object's own frame for those in another one's."""
    return [_placed(item, world) for item in wanted]


def _placed(item: Any, world: Matrix) -> Any:
    given = item.coordinates
    if given is None or given.kind != "FRAME":
        return item
    rows = given.rows
    matrix = Matrix((rows[0:4], rows[4:8], rows[8:12], (0.0, 0.0, 0.0, 1.0)))
    matrix = matrix @ frame_of(world, given)
    rows = (*matrix[0], *matrix[1], *matrix[2])
    return replace(item, coordinates=replace(given, kind="OBJECT", name="", frame=None, rows=rows))


def frame_of(world: Matrix, wanted: Coordinates) -> Matrix:
    """The transform from an object's own frame to that of the object its coordinates are of."""
    return world if wanted.frame is None else wanted.frame.matrix_world.inverted_safe() @ world


def _generated(mesh: Any) -> Matrix:
    """The mesh's texture space to 0...1.
    source: Cycles' generated coordinates; a side without length gives 0.5"""
    made = Matrix()
    for k in range(3):
        size = mesh.texspace_size[k]
        scale = 0.5 / size if size else 0.0
        made[k][k] = scale
        made[k][3] = 0.5 - mesh.texspace_location[k] * scale
    return made
