# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean colors of images: what stands for a texture wherever the texture itself cannot be drawn."""

import os
from array import array
from typing import Any

import bpy

from ...core import srgb
from .image_pixels import read_pixels, with_four_channels

SAMPLES = 1 << 14  # pixels looked at in a large image
_STRIDE = 7919  # prime: samples do not line up in columns

Color = tuple[float, float, float]


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
    table = srgb.DECODED
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
        """The mean color of an image; None when it cannot be read."""
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


def _mean(image: Any) -> Color | None:
    found = read_pixels(image)
    if found is None:
        return None
    return mean_of_pixels(with_four_channels(found), found.encoded)
