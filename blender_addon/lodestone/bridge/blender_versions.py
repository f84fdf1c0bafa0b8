# SPDX-License-Identifier: GPL-3.0-or-later
"""Differences between Blender versions, chosen by what is there: 3.4 (tested), 4.1 and later."""

from array import array
from typing import Any

from .datablock_ids import called

_ZERO = {code: array(code, [0]) for code in "bfiI"}


def buffer(code: str, count: int) -> array:
    """An array of 4-byte items ("f", "i", "I") or bytes ("b"), all 0. Blender copies into the code
    that is a property's own ("I" for indices) at 2 ns an item, item by item into any other, at 20
    to 80."""
    return _ZERO[code] * count


def smooth_faces(mesh: Any) -> array | None:
    """A byte for each face, 1 for smooth ones; None: all are flat."""
    flags = [False] * len(mesh.polygons)  # no array has this code: lists are the fastest
    mesh.polygons.foreach_get("use_smooth", flags)
    if True not in flags:
        return None
    return array("b", flags) if False in flags else array("b", [1]) * len(flags)


def splits_normals(mesh: Any) -> bool:
    """Whether corners may have other normals than their face or their vertex."""
    if hasattr(mesh, "use_auto_smooth"):  # until 4.0
        return mesh.use_auto_smooth
    return mesh.normals_domain == "CORNER"


def face_slots(mesh: Any, buffer: array) -> bool:
    """The material slots of all faces into an integer buffer; False: all faces have the first."""
    layer = mesh.attributes.get("material_index")
    if layer is None:
        return False
    if layer.domain == "FACE" and len(layer.data) == len(buffer):
        layer.data.foreach_get("value", buffer)
    else:
        mesh.polygons.foreach_get("material_index", buffer)
    return True


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
        found = called(attributes, name)
    else:
        index = getattr(attributes, "render_color_index", 0)
        found = attributes[index] if 0 <= index < len(attributes) else None
    return found if found is not None and found.domain in {"POINT", "CORNER"} else None


class _PixelArray(array):
    """Floats of RGBA pixels, as long as there are pixels: Blender 3.4 copies it at once."""

    def __len__(self) -> int:
        return super().__len__() // 4


def set_pass(render_pass: Any, width: int, height: int, pixels: array) -> None:
    """Floats (linear RGBA, or one a pixel), bottom row first, into a render pass."""
    try:
        render_pass.rect.foreach_set(pixels)
    except TypeError:  # 3.4 wants an item for each pixel
        if render_pass.channels == 4 and len(pixels) == 4 * width * height:
            render_pass.rect.foreach_set(_PixelArray("f", pixels))
        else:
            render_pass.rect = list(zip(*[iter(pixels)] * render_pass.channels))


def principled_input(node: Any, *names: str) -> Any:
    """The first socket of these names: several were renamed in 4.0."""
    for name in names:
        socket = node.inputs.get(name)
        if socket is not None:
            return socket
    return None
