# SPDX-License-Identifier: GPL-3.0-or-later
"""The sources of the pixels of Blender's images, found without reading them."""

import os
import re
import stat
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import bpy

from ...core.problems import ERROR, WARNING
from ..datablock_ids import name_of

FILE, PACKED, PIXELS, MISSING = "file", "packed", "pixels", "missing"
Note = Callable[[str, str, str], None]  # severity, code, words

_HEAD = 4096  # bytes that tell the kind
_DISPLAY = {"sRGB"}
_LINEAR = {"Linear", "Linear Rec.709", "Non-Color", "Raw", "Generic Data"}
_DATA = {"Non-Color", "Raw", "Generic Data"}


@dataclass(frozen=True)
class Source:
    """`linear` as add_picture() wants it; `data`: numbers, not colors. `associated`: the file's
    colors are times alpha already."""

    name: str
    kind: str
    key: int = 0  # the image's pointer
    path: str = ""  # the path of a FILE
    frame: int = 0
    linear: bool = False
    data: bool = False
    has_alpha: bool = False  # that counts; opaque pictures may have it too
    packed_channels: bool = False  # color and alpha have nothing to do with each other
    associated: bool = False
    image: Any = field(default=None, compare=False, repr=False)


def missing(name: str) -> Source:
    return Source(name, MISSING)


def source_of(image: Any, user: Any, frame: int, note: Note) -> Source:
    """The source of an image as an image user (or None) shows it at a frame."""
    space = image.colorspace_settings.name
    if space and space not in _DISPLAY and space not in _LINEAR:  # "": of a broken image
        note(
            WARNING,
            "color_space",
            f'color space {space} of image "{name_of(image)}" counts as sRGB',
        )
    kind, path, head = _place(image, user, frame, note)
    alpha_mode = image.alpha_mode
    exr = head.startswith(b"\x76\x2f\x31\x01")
    if exr and space in _DISPLAY:
        kind = PIXELS  # Blender decodes it twice: its own pixels tell how
    return Source(
        name=name_of(image),
        kind=kind,
        key=image.as_pointer(),
        path=path if kind == FILE else "",
        frame=frame if image.source == "MOVIE" else 0,
        linear=space in _LINEAR,
        data=space in _DATA,
        has_alpha=alpha_mode != "NONE" and _may_have_alpha(head),
        packed_channels=alpha_mode == "CHANNEL_PACKED",
        associated=alpha_mode == "PREMUL" and not exr and kind == PACKED,
        image=image,
    )


def _place(image: Any, user: Any, frame: int, note: Note) -> tuple[str, str, bytes]:
    """Kind, path, and the first bytes ("" where only Blender can tell)."""
    name, origin = name_of(image), image.source
    if origin == "VIEWER":
        note(ERROR, "image_missing", f'image "{name}" exists only while Blender renders')
        return MISSING, "", b""
    if origin == "GENERATED" or image.is_dirty:
        return PIXELS, "", b""
    packed = image.packed_file
    if packed is not None and origin == "FILE":
        head = packed.data[:_HEAD]
        return (PACKED if _known(head) else PIXELS), "", head
    if origin == "MOVIE":
        note(WARNING, "movie", f'of movie "{name}" one frame is drawn')
    if origin == "TILED":
        note(WARNING, "udim", f'of the tiles of image "{name}" only the first is drawn')
        if packed is not None:
            return PIXELS, "", b""
    path = _path(image, user, frame)
    head = _head(path)
    if head is None:
        if packed is not None:
            return PIXELS, "", b""
        note(ERROR, "image_missing", f'image "{name}" is missing; drawn in magenta')
        return MISSING, "", b""
    return (FILE if _known(head) else PIXELS), path, head


def _path(image: Any, user: Any, frame: int) -> str:
    path = bpy.path.abspath(image.filepath, library=image.library)
    if image.source == "TILED" and len(image.tiles):
        tile = image.tiles[0].number
        path = path.replace("<UDIM>", str(tile))
        return path.replace("<UVTILE>", f"u{(tile - 1001) % 10 + 1}_v{(tile - 1001) // 10 + 1}")
    if image.source == "SEQUENCE" and user is not None:
        return _frame_path(path, _frame_of(user, frame))
    return path


def _frame_of(user: Any, frame: int) -> int:
    """The number of the file that a render shows: it looks at no `use_auto_refresh`, and what
    `frame_current` holds for the viewport may be of any other frame."""
    length = user.frame_duration
    if length <= 0:
        return user.frame_offset
    at = frame - user.frame_start + 1
    if user.use_cyclic:
        at = at % length or length
    return min(max(at, 0), length) + user.frame_offset


def _frame_path(path: str, number: int) -> str:
    """The path with the last digits of its name replaced, as many as there were or more."""
    folder, name = os.path.split(path)
    stem, ending = os.path.splitext(name)
    found = re.search(r"(\d+)(\D*)$", stem)
    if found is None:
        return path
    digits = f"{max(0, number):0{len(found[1])}d}"
    return os.path.join(folder, stem[: found.start()] + digits + found[2] + ending)


def _head(path: str) -> bytes | None:
    """The first bytes of a file; None when there is no such file."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            return None
        with open(path, "rb") as file:
            return file.read(_HEAD) or None
    except (OSError, ValueError):
        return None


def _known(head: bytes) -> bool:
    """PNG, JPEG or OpenEXR."""
    return head.startswith((b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"\x76\x2f\x31\x01"))


def _may_have_alpha(head: bytes) -> bool:
    if head.startswith(b"\xff\xd8\xff"):
        return False
    if head.startswith(b"\x89PNG"):
        return head[25:26] not in {b"\x00", b"\x02"} or b"tRNS" in head
    return True
