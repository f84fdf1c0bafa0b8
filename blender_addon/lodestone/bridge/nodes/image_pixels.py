# SPDX-License-Identifier: GPL-3.0-or-later
"""The pixels of a Blender image, read by Blender."""

from array import array
from typing import Any, NamedTuple


class Pixels(NamedTuple):
    """Lowest row first."""

    width: int
    height: int
    values: array  # 'f'
    channels: int
    encoded: bool  # in sRGB
    floats: bool  # the image is not made of bytes


def read_pixels(image: Any) -> Pixels | None:
    """The pixels by Blender's own reader; None when it cannot be read. An image that was not loaded
    is not kept."""
    loaded = image.has_data
    width, height = image.size  # loads it
    channels = image.channels
    count = width * height * channels
    if count == 0 or len(image.pixels) != count:
        return None
    pixels = array("f", bytes(4 * count))
    image.pixels.foreach_get(pixels)
    floats = image.is_float
    encoded = not floats and image.colorspace_settings.name == "sRGB"
    if not loaded and not image.is_dirty and image.source != "GENERATED":
        image.buffers_free()
    return Pixels(width, height, pixels, channels, encoded, floats)


def with_four_channels(pixels: Pixels) -> array:
    """RGBA of gray, gray and alpha, or RGB."""
    values, channels = pixels.values, pixels.channels
    if channels == 4:
        return values
    wide = array("f", [1.0]) * (len(values) // channels * 4)
    for channel in range(3):
        wide[channel::4] = values[(channel if channels == 3 else 0) :: channels]
    if channels == 2:
        wide[3::4] = values[1::2]
    return wide
