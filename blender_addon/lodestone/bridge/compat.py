# SPDX-License-Identifier: GPL-3.0-or-later
"""Differences between Blender versions, chosen by what is there: 3.4 (tested), 4.1 and later."""

from array import array
from typing import Any


def buffer(code: str, count: int) -> array:
    """Of 4-byte items, all 0."""
    return array(code, bytes(4 * count))


def corner_normals(mesh: Any, buffer: array) -> None:
    """Normals of all corners into a float buffer [corner][3]."""
    if hasattr(mesh, "calc_normals_split"):  # until 4.0
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", buffer)
        mesh.free_normals_split()
    else:
        mesh.corner_normals.foreach_get("vector", buffer)


def corner_uvs(layer: Any, buffer: array) -> None:
    """UVs of all corners into a float buffer [corner][2]."""
    if hasattr(layer, "uv"):  # since 3.5, contiguous
        layer.uv.foreach_get("vector", buffer)
    else:
        layer.data.foreach_get("uv", buffer)


def color_attribute(mesh: Any, name: str) -> Any | None:
    """The color attribute of that name, else, for "", the one active for rendering."""
    attributes = mesh.color_attributes
    if name:
        found = attributes.get(name)
    else:
        index = getattr(attributes, "render_color_index", 0)
        found = attributes[index] if 0 <= index < len(attributes) else None
    return found if found is not None and found.domain in {"POINT", "CORNER"} else None


def set_pass(render_pass: Any, width: int, height: int, pixels: array) -> None:
    """Linear RGBA floats, bottom row first, into a render pass."""
    try:
        render_pass.rect.foreach_set(pixels)
    except TypeError:  # 3.4 wants a sequence of four-tuples
        values = iter(pixels)
        render_pass.rect = list(zip(values, values, values, values))


def principled_input(node: Any, *names: str) -> Any:
    """The first socket of these names: several were renamed in 4.0."""
    for name in names:
        socket = node.inputs.get(name)
        if socket is not None:
            return socket
    return None
