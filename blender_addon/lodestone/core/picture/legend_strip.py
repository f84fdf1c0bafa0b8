# SPDX-License-Identifier: GPL-3.0-or-later
"""A legend under a picture: squares of color with words, as many lines as they need."""

from array import array
from collections.abc import Sequence

from ..native import lodestone_native as native
from . import bitmap_letters
from .false_colors import Color

BACK: Color = (0.02, 0.02, 0.02)
INK: Color = (0.9, 0.9, 0.9)
_SIDE, _GAP, _LINE, _EDGE = 8, 10, 13, 4  # in pixels of the letters


def laid_out(
    entries: Sequence[tuple[str, Color]], width: int, scale: int
) -> list[tuple[int, int, str, Color]]:
    """The places (left, line, word, color) of the entries, in pixels of a picture so wide."""
    found, left, line = [], _EDGE, 0
    for word, color in entries:
        needed = _SIDE + 3 + bitmap_letters.width(word)
        if left > _EDGE and (left + needed) * scale > width:
            left, line = _EDGE, line + 1
        found.append((left, line, word, color))
        left += needed + _GAP
    return found


def with_legend(
    image: native.Image, title: str, entries: Sequence[tuple[str, Color]]
) -> native.Image:
    """A copy of an image (top row first), opaque and longer by the legend's lines."""
    scale = 2 if image.width >= 900 else 1
    laid = laid_out([(title, BACK), *entries], image.width, scale)
    lines = laid[-1][1] + 1
    height = (lines * _LINE + _EDGE) * scale
    strip = array("f", (*BACK, 1.0)) * (image.width * height)

    def fill(x: int, y: int, side: int, color: Color) -> None:
        row = array("f", (*color, 1.0)) * max(0, min(side, image.width - x))
        for line in range(y, min(y + side, height)):
            at = 4 * (line * image.width + x)
            strip[at : at + len(row)] = row

    for left, line, word, color in laid:
        top = _EDGE + line * _LINE
        if color != BACK:
            fill(left * scale, top * scale, _SIDE * scale, color)
        first = left + _SIDE + 3 if color != BACK else left
        for x, y in bitmap_letters.pixels(word):
            fill((first + x) * scale, (top + 1 + y) * scale, scale, INK)
    pixels = array("f", image.pixels)
    pixels[3::4] = array("f", (1.0,)) * (image.width * image.height)
    return type(image)(image.width, image.height + height, pixels + strip)


def flipped(image: native.Image) -> native.Image:
    """Lowest row first, as Blender has images."""
    row = 4 * image.width
    pixels = array("f")
    for y in reversed(range(image.height)):
        pixels += image.pixels[y * row : (y + 1) * row]
    return type(image)(image.width, image.height, pixels)
