# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of batch.py's options from text. Each raises ArgumentTypeError with a sentence."""

import argparse
import math
import re
from collections.abc import Callable

from ..picture import unseen_detail
from ..picture.quality_tree import Control

_MAX_SIZE = 65536


def frame_range(text: str) -> tuple[int, int]:
    """A-B or one number."""
    found = re.fullmatch(r"(-?\d{1,7})(?:-(-?\d{1,7}))?", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text!r} is no range of frames like 1-24")
    first = int(found[1])
    last = int(found[2]) if found[2] is not None else first
    if last < first:
        raise argparse.ArgumentTypeError(f"{text!r} ends before it begins")
    return first, last


def size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,6})[xX](\d{1,6})", text)
    width, height = (int(found[1]), int(found[2])) if found else (0, 0)
    if not (0 < width <= _MAX_SIZE and 0 < height <= _MAX_SIZE):
        raise argparse.ArgumentTypeError(f"{text!r} is no size like 640x360")
    return width, height


def memory(text: str) -> int:
    """The bytes that are meant by 8G, 500M, 1.5GB, 2GiB or a plain number: powers of 1000 as
    reports have them, with an i of 1024."""
    found = re.fullmatch(r"(\d{1,12}(?:\.\d{1,6})?)\s?([KMGT]?)(i?)B?", text, re.IGNORECASE)
    power = "KMGT".find(found[2].upper()) + 1 if found and found[2] else 0
    bytes_ = int(float(found[1]) * (1024 if found[3] else 1000) ** power) if found else 0
    if bytes_ <= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no size of memory like 8G or 500M")
    return bytes_


def number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return value


def pixels(text: str) -> float:
    value = number(text)
    if not 0.0 <= value <= 1024.0:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 1024 pixels")
    return value


def control(wanted: Control) -> Callable[[str], float]:
    """The values that a control of quality may be given."""

    def value(text: str) -> float:
        found = number(text)
        least, most = wanted.least or 0.0, wanted.most or 0.0
        if not least <= found <= most:
            limits = f"{least:g} and {most:g} {wanted.unit}".rstrip()
            raise argparse.ArgumentTypeError(f"{text} is not between {limits}")
        if isinstance(wanted.least, int):
            if found != int(found):
                raise argparse.ArgumentTypeError(f"{text} is no whole number")
            return int(found)
        return found

    return value


def off_screen(text: str) -> str:
    """One of the words in unseen_detail.OFF_SCREEN."""
    if text not in unseen_detail.OFF_SCREEN:
        raise argparse.ArgumentTypeError(
            f"{text!r} is none of {', '.join(unseen_detail.OFF_SCREEN)}"
        )
    return text


def ray_classes(text: str) -> str:
    """The classes of rays that a text names, as unseen_detail.text_of() has it."""
    try:
        return unseen_detail.text_of(unseen_detail.rays_of(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def positive(text: str) -> float:
    value = number(text)
    if value <= 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def threads(text: str) -> int:
    if not re.fullmatch(r"\d{1,4}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is no number of threads")
    return int(text)


def children(text: str) -> int:
    if not re.fullmatch(r"\d{1,3}", text) or int(text) == 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of files from 1 to 999")
    return int(text)
