# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean colors of images: what a texture counts as until textures themselves are drawn."""

import os
from array import array
from typing import Any, NamedTuple

import bpy

SAMPLES = 1 << 14  # pixels looked at in a large image
_STRIDE = 7919  # prime: samples do not line up in columns

Color = tuple[float, float, float]


def to_linear(value: float) -> float:
    """One sRGB-encoded component to linear."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


_LINEAR = [to_linear(i / 255.0) for i in range(256)]


def mean_of_pixels(pixels: array, encoded: bool) -> Color | None:
    """Alpha-weighted linear mean of RGBA floats; None when nothing is opaque anywhere."""
    count = len(pixels) // 4
    if count == 0:
        return None
    if count > SAMPLES:
        chosen = [(k * count) // SAMPLES for k in range(SAMPLES)]
        chosen = [4 * ((c + (c * _STRIDE) % 61) % count) for c in chosen]
    else:
        chosen = list(range(0, 4 * count, 4))
    red = green = blue = weight = 0.0
    table = _LINEAR
    for at in chosen:
        alpha = pixels[at + 3]
        if alpha <= 0.0:
            continue
        r, g, b = pixels[at], pixels[at + 1], pixels[at + 2]
        if encoded:
            r = table[min(255, max(0, int(r * 255.0 + 0.5)))]
            g = table[min(255, max(0, int(g * 255.0 + 0.5)))]
            b = table[min(255, max(0, int(b * 255.0 + 0.5)))]
        red += alpha * r
        green += alpha * g
        blue += alpha * b
        weight += alpha
    mean = (red / weight, green / weight, blue / weight) if weight > 0.0 else None
    return mean if mean and all(0.0 <= c < 1e30 for c in mean) else None


class ImageMeans:
    """The mean of every image asked for, read once and given back to Blender unloaded."""

    def __init__(self) -> None:
        self._means: dict[int, Color | None] = {}

    def mean(self, image: Any) -> Color | None:
        """None when the image cannot be read."""
        key = image.as_pointer()
        if key not in self._means:
            self._means[key] = _mean(image)
        return self._means[key]


class ImageHeads(ImageMeans):
    """Stands where ImageMeans does when only problems are looked for: tells whether there is an
    image to read, and reads none."""

    def mean(self, image: Any) -> Color | None:
        return (0.5, 0.5, 0.5) if _is_there(image) else None


def _is_there(image: Any) -> bool:
    if image.source not in {"FILE", "SEQUENCE", "MOVIE", "TILED"}:
        return True
    if image.packed_file is not None or image.has_data or image.source in {"SEQUENCE", "TILED"}:
        return True  # the frames and tiles of a name are not looked for
    path = bpy.path.abspath(image.filepath, library=image.library)
    try:
        return os.path.isfile(path) and os.path.getsize(path) > 0
    except (OSError, ValueError):
        return False


class Pixels(NamedTuple):
    """Lowest row first."""

    width: int
    height: int
    values: array  # 'f'
    channels: int
    encoded: bool  # in sRGB
    floats: bool  # of an image that is not made of bytes


def read_pixels(image: Any) -> Pixels | None:
    """By Blender's own reader; None when it cannot be read. An image that was not loaded is not
    kept."""
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


def _mean(image: Any) -> Color | None:
    found = read_pixels(image)
    if found is None:
        return None
    return mean_of_pixels(with_four_channels(found), found.encoded)


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
