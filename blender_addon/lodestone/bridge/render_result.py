# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture into Blender's render result: parts of it while it is drawn, and all of it."""

import struct
from array import array
from typing import Any

from ..core.native import lodestone_native as native
from . import blender_versions

_ENDLESS = 1e10  # metres, as Cycles has it for the sky


def read(path: str, part: tuple[int, int, int, int]) -> Any:
    """A part of an EXR (left, top, width, height) as Blender wants it: linear, lowest row first."""
    return native.image_read_part(path, part, bottom_up=True)


def cropped(image: Any, left: int, bottom: int, width: int, height: int) -> Any:
    """A part of a bottom-up image."""
    if (left, bottom, width, height) == (0, 0, image.width, image.height):
        return image
    pixels = array("f")
    for row in range(bottom, bottom + height):
        start = 4 * (row * image.width + left)
        pixels.extend(image.pixels[start : start + 4 * width])
    return native.Image(width, height, pixels)


def border(render: Any, width: int, height: int) -> tuple[int, int, int, int]:
    """Left, bottom, width, height of the part of the picture that is to be drawn."""
    if not render.use_border:
        return (0, 0, width, height)
    left, right = _pixel(render.border_min_x, width), _pixel(render.border_max_x, width)
    bottom, top = _pixel(render.border_min_y, height), _pixel(render.border_max_y, height)
    left, bottom = min(left, width - 1), min(bottom, height - 1)
    return (left, bottom, max(1, right - left), max(1, top - bottom))


def _pixel(share: float, size: int) -> int:
    """The whole pixels of a share, as Blender rounds: 0.7 of 100 are 70 in its single precision, 69
    in ours."""
    return int(struct.unpack("f", struct.pack("f", share * size))[0])


def layer_of(depsgraph: Any) -> str:
    """The name by which hand_over() knows the view layer. Raises UnicodeDecodeError for a name that
    is no text where there are others: results go to layers by their names."""
    try:
        return depsgraph.view_layer_eval.name
    except UnicodeDecodeError:
        if len(depsgraph.scene.view_layers) > 1:
            raise
        return ""  # the only one


def hand_over(engine: Any, layer: str, image: Any, stamp: dict[str, str], depth: bool) -> None:
    """A finished picture into the layer; other passes than the combined one stay empty. `stamp`
    becomes text in the saved file. `depth`: the layer asks for its depth."""
    show_part(engine, layer, native.DrawnPart(0, 0, image), depth)
    whole = engine.get_result()  # merging the part above would have dropped its stamp
    for field, value in stamp.items():
        whole.stamp_data_add_field(field, value)


def show_part(engine: Any, layer: str, part: Any, depth: bool) -> None:
    """A native.DrawnPart into the layer's combined pass, counted from the border's corner, which is
    the result's. `depth` is told to be endless: Blender 3.4, drawing grease pencil, dies where
    there is none. An exception between begin and end would take Blender down, so nothing but the
    pixels is done between them."""
    left, bottom, image = part
    if depth:
        engine.add_pass("Depth", 1, "Z", layer=layer)
        far = array("f", [_ENDLESS]) * (image.width * image.height)
    result = engine.begin_result(left, bottom, image.width, image.height, layer=layer)
    try:
        if depth:
            passed = result.layers[0].passes.find_by_name("Depth", "")
            blender_versions.set_pass(passed, image.width, image.height, far)
        combined = result.layers[0].passes.find_by_name("Combined", "")
        blender_versions.set_pass(combined, image.width, image.height, image.pixels)
    finally:
        engine.end_result(result)
