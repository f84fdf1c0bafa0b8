# SPDX-License-Identifier: GPL-3.0-or-later
"""Color attributes of a mesh, each slot's as its material wants them."""

from array import array
from collections.abc import Sequence
from itertools import chain
from typing import Any

from .. import blender_versions
from ..nodes.material_looks import VertexColors
from .mesh_uvs import corners_of_slots


def vertex_colors(mesh: Any, wanted: Sequence[VertexColors | None]) -> array | None:
    """Colors [vertex][4], linear, where one attribute of the vertices is all that is wanted, as it
    is most often; None: ask for corner_colors()."""
    kinds = _kinds(wanted)
    attribute = blender_versions.color_attribute(mesh, kinds[0].name)
    if len(kinds) > 1 or attribute is None or attribute.domain != "POINT":
        return None
    return _masked(_read(attribute), kinds[0])


def corner_colors(mesh: Any, wanted: Sequence[VertexColors | None]) -> array:
    """Colors [corner][4], linear, by slot; white where a slot wants none. An attribute the mesh
    lacks is black, as in Blender."""
    kinds = _kinds(wanted)
    if len(kinds) == 1:  # the other slots do not look at them
        return _colors(mesh, kinds[0])
    colors = array("f", [1.0]) * (4 * len(mesh.loops))
    for item in kinds:
        found = _colors(mesh, item)
        for start, end in corners_of_slots(mesh, wanted, item):
            colors[4 * start : 4 * end] = found[4 * start : 4 * end]
    return colors


def _kinds(wanted: Sequence[VertexColors | None]) -> list[VertexColors]:
    return list(dict.fromkeys(item for item in wanted if item is not None))


def _colors(mesh: Any, wanted: VertexColors) -> array:
    """The colors of the corners."""
    attribute = blender_versions.color_attribute(mesh, wanted.name)
    if attribute is None:
        colors = blender_versions.buffer("f", 4 * len(mesh.loops))
        colors[3::4] = array("f", [1.0]) * len(mesh.loops)
    else:
        colors = _read(attribute)
        if attribute.domain == "POINT":
            colors = _to_corners(mesh, colors)
    return _masked(colors, wanted)


def _read(attribute: Any) -> array:
    colors = blender_versions.buffer("f", 4 * len(attribute.data))
    attribute.data.foreach_get("color", colors)
    return colors


def _masked(colors: array, wanted: VertexColors) -> array:
    """White in what does not count."""
    white = array("f", [1.0]) * (len(colors) // 4)
    if not wanted.alpha:
        colors[3::4] = white
    if not wanted.color:
        for k in range(3):
            colors[k::4] = white
    return colors


def _to_corners(mesh: Any, colors: array) -> array:
    vertices = blender_versions.buffer("I", len(mesh.loops))
    mesh.loops.foreach_get("vertex_index", vertices)
    values = iter(colors)
    points = list(zip(values, values, values, values))
    return array("f", chain.from_iterable(map(points.__getitem__, vertices)))
