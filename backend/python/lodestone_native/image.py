# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: reading, writing and comparing them."""

import ctypes
from array import array
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from . import structs
from .library import check, library
from .structs import record, text_in


@dataclass(frozen=True)
class Image:
    """Linear RGBA with associated alpha; pixels: array('f') [height][width][4]."""

    width: int
    height: int
    pixels: array


def image_size(path: str) -> tuple[int, int]:
    width, height = ctypes.c_int32(), ctypes.c_int32()
    check(library().lds_image_size(text_in(path), ctypes.byref(width), ctypes.byref(height)))
    return width.value, height.value


def image_read(path: str, bottom_up: bool = False) -> Image:
    """A PNG, JPEG or EXR. bottom_up: the lowest row first (Blender's order)."""
    width, height = image_size(path)
    pixels = _black(width, height)
    check(library().lds_image_read(text_in(path), int(bottom_up), _floats(pixels), len(pixels)))
    return Image(width, height, pixels)


def image_read_part(path: str, part: tuple[int, int, int, int], bottom_up: bool = False) -> Image:
    """A part of an EXR of any size: left, top, width, height in pixels."""
    pixels, wanted = _black(*part[2:]), (ctypes.c_int32 * 4)(*part)
    check(
        library().lds_image_read_part(
            text_in(path), wanted, int(bottom_up), _floats(pixels), len(pixels)
        )
    )
    return Image(*part[2:], pixels)


def image_write_png(path: str, image: Image) -> None:
    """Top row first -> 8-bit sRGB."""
    if image.pixels.itemsize != 4 or len(image.pixels) != 4 * image.width * image.height:
        raise ValueError("the pixels do not fit the size of the image")
    check(
        library().lds_image_write_png(
            text_in(path), image.width, image.height, _floats(image.pixels)
        )
    )


def image_add_text(path: str, lines: Mapping[str, str]) -> None:
    """Adds lines of text by keyword to a PNG; those of the same keyword are replaced."""
    strings = ctypes.c_char_p * len(lines)
    keywords = strings(*(text_in(keyword) for keyword in lines))
    texts = strings(*(text_in(value) for value in lines.values()))
    check(library().lds_image_add_text(text_in(path), keywords, texts, len(lines)))


def image_compare(path_a: str, path_b: str, mask: str | None = None) -> Any:
    """mask: a picture whose alpha > 1/255 marks the compared pixels."""
    out = structs.Difference()
    check(
        library().lds_image_compare(
            text_in(path_a), text_in(path_b), text_in(mask), ctypes.byref(out)
        )
    )
    return record(out)


def image_compare_shown(
    paths: tuple[str, str],
    shown: tuple[str, str],
    counts: tuple[int, int],
    bottom_up: bool = False,
) -> tuple[Any, tuple[array, array], Image]:
    """Compares two pictures where either shows something. `shown`: pictures of their cuts by
    Cut.set_identities(); `counts`: how many choices these have. Returns the difference, each
    choice's share of it (pixels that show something in the first are put down to that), and a
    picture of it in false colors."""
    width, height = image_size(paths[0])
    picture = Image(width, height, _black(width, height))
    sums = tuple(array("d", bytes(8 * count)) for count in counts)
    out = structs.Difference()
    check(
        library().lds_image_compare_shown(
            *(text_in(path) for path in (*paths, *shown)),
            *(part for one in sums for part in (_doubles(one), len(one))),
            int(bottom_up),
            _floats(picture.pixels),
            len(picture.pixels),
            ctypes.byref(out),
        )
    )
    return record(out), (sums[0], sums[1]), picture


def image_difference_color(difference: float) -> tuple[float, float, float]:
    """Linear; of a difference of display-encoded values."""
    out = (ctypes.c_double * 3)()
    check(library().lds_image_difference_color(difference, out))
    return (out[0], out[1], out[2])


def _doubles(buffer: array) -> Any:
    return ctypes.cast(buffer.buffer_info()[0], ctypes.POINTER(ctypes.c_double))


def _black(width: int, height: int) -> array:
    return array("f", [0.0]) * (4 * width * height)


def _floats(buffer: array) -> Any:
    return ctypes.cast(buffer.buffer_info()[0], ctypes.POINTER(ctypes.c_float))
