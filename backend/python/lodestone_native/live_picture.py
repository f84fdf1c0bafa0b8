# SPDX-License-Identifier: GPL-3.0-or-later
"""What POV-Ray has drawn so far, while it draws."""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Iterator
from ctypes import c_float
from typing import NamedTuple

from . import records, structs
from .base import pointer_to, text_in
from .handle import Handle
from .image import Image
from .job import Job
from .library import check, library
from .povray import PovrayOptions


class DrawnPart(NamedTuple):
    """A rectangle that was drawn: `left` and `bottom` (bottom_up, else the top) count from the
    corner of what is drawn at all."""

    left: int
    bottom: int
    image: Image


class LivePicture(Handle):
    """A picture while povray_run_live() draws it on another thread; close it after that call.

    `part`: left, top, width, height of what is drawn of the whole picture.
    """

    _destroy = "lds_live_picture_destroy"

    def __init__(self, part: tuple[int, int, int, int]) -> None:
        self.part = part
        handle = ctypes.c_void_p()
        check(library().lds_live_picture_create((ctypes.c_int32 * 4)(*part), handle))
        self._handle = handle
        self._room = array("f")  # of take(), which is called several times a second

    def take(self, bottom_up: bool = False, most: int = 1 << 18) -> Iterator[DrawnPart]:
        """What was drawn since the last time, in rectangles of at most so many pixels (and 1,024 or
        more). Only one thread takes."""
        if len(self._room) != 4 * most:
            self._room = array("f", bytes(16)) * most
        room = self._room
        part = (ctypes.c_int32 * 4)()
        while True:
            pixels = pointer_to(room, c_float)
            check(
                library().lds_live_picture_take(
                    self.handle, int(bottom_up), part, pixels, len(room)
                )
            )
            left, bottom, width, height = part
            if width == 0:
                return
            yield DrawnPart(left, bottom, Image(width, height, room[: 4 * width * height]))

    @property
    def finished(self) -> float:
        """The share of the pixels that are finished, 0...1; those of the mosaic are not."""
        done = ctypes.c_uint64()
        check(library().lds_live_picture_finished(self.handle, done))
        return done.value / (self.part[2] * self.part[3])


def povray_run_live(
    folder: str,
    picture: str,
    options: PovrayOptions,
    live: LivePicture,
    job: Job | None = None,
) -> records.PovrayReport:
    """As povray_run(), and draws into `live` meanwhile."""
    out = structs.PovrayReport()
    check(
        library().lds_povray_run_live(
            text_in(folder), text_in(picture), options.struct(), live.handle, job, out
        )
    )
    return out.record()
