# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: reading, writing and comparing them."""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Mapping
from ctypes import c_double, c_float
from dataclasses import dataclass

from . import records, structs
from .base import pointer_to, text_in
from .library import check, library


@dataclass(frozen=True)
class Image:
    """Linear RGBA with associated alpha; pixels: array('f') [height][width][4]."""

    width: int
    height: int
    pixels: array[float]


def image_size(path: str) -> tuple[int, int]:
    width, height = ctypes.c_int32(), ctypes.c_int32()
    check(library().lds_image_size(text_in(path), width, height))
    return width.value, height.value


def keep_pictures(folder: str) -> None:
    """Finds what a folder keeps about pictures, and writes there what was found since the last
    call: to be called before Model.add_picture() and bake_picture(), and after."""
    check(library().lds_pictures_keep(text_in(folder)))


def image_read(path: str, bottom_up: bool = False) -> Image:
    """A PNG, JPEG or EXR. bottom_up: the lowest row first (Blender's order)."""
    width, height = image_size(path)
    pixels = _black(width, height)
    check(
        library().lds_image_read(
            text_in(path), int(bottom_up), pointer_to(pixels, c_float), len(pixels)
        )
    )
    return Image(width, height, pixels)


def image_read_part(path: str, part: tuple[int, int, int, int], bottom_up: bool = False) -> Image:
    """A part of an EXR of any size: left, top, width, height in pixels."""
    pixels, wanted = _black(*part[2:]), (ctypes.c_int32 * 4)(*part)
    check(
        library().lds_image_read_part(
            text_in(path), wanted, int(bottom_up), pointer_to(pixels, c_float), len(pixels)
        )
    )
    return Image(*part[2:], pixels)


def image_write_png(path: str, image: Image) -> None:
    """Top row first -> 8-bit sRGB."""
    if image.pixels.itemsize != 4 or len(image.pixels) != 4 * image.width * image.height:
        raise ValueError("the pixels do not fit the size of the image")
    check(
        library().lds_image_write_png(
            text_in(path), image.width, image.height, pointer_to(image.pixels, c_float)
        )
    )


def image_add_text(path: str, lines: Mapping[str, str]) -> None:
    """Adds lines of text by keyword to a PNG; those of the same keyword are replaced."""
    strings = ctypes.c_char_p * len(lines)
    keywords = strings(*(text_in(keyword) for keyword in lines))
    texts = strings(*(text_in(value) for value in lines.values()))
    check(library().lds_image_add_text(text_in(path), keywords, texts, len(lines)))


def image_compare(path_a: str, path_b: str, mask: str | None = None) -> records.Difference:
    """mask: a picture whose alpha > 1/255 marks the compared pixels."""
    out = structs.Difference()
    check(library().lds_image_compare(text_in(path_a), text_in(path_b), text_in(mask), out))
    return out.record()


def image_compare_shown(
    paths: tuple[str, str],
    shown: tuple[str, str],
    counts: tuple[int, int],
    bottom_up: bool = False,
) -> tuple[records.Difference, tuple[array[float], array[float]], Image]:
    """Compares two pictures where either shows something. `shown`: pictures of their cuts by
    Cut.set_identities(); `counts`: how many choices these have. Returns the difference, each
    choice's share of it (pixels that show something in the first are put down to that), and a
    picture of it in false colors."""
    width, height = image_size(paths[0])
    picture = Image(width, height, _black(width, height))
    sums = (array("d", bytes(8 * counts[0])), array("d", bytes(8 * counts[1])))
    out = structs.Difference()
    check(
        library().lds_image_compare_shown(
            text_in(paths[0]),
            text_in(paths[1]),
            text_in(shown[0]),
            text_in(shown[1]),
            pointer_to(sums[0], c_double),
            counts[0],
            pointer_to(sums[1], c_double),
            counts[1],
            int(bottom_up),
            pointer_to(picture.pixels, c_float),
            len(picture.pixels),
            out,
        )
    )
    return out.record(), sums, picture


def image_difference_color(difference: float) -> tuple[float, float, float]:
    """Linear; of a difference of display-encoded values."""
    out = (ctypes.c_double * 3)()
    check(library().lds_image_difference_color(difference, out))
    return (out[0], out[1], out[2])


def _black(width: int, height: int) -> array[float]:
    return array("f", [0.0]) * (4 * width * height)
