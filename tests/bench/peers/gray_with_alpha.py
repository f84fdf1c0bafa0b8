# SPDX-License-Identifier: GPL-3.0-or-later
"""PNGs of gray and alpha, which Cycles shows wrong."""

from pathlib import Path

_HEAD = b"\x89PNG\r\n\x1a\n"
_KIND_AT, _GRAY_WITH_ALPHA = 25, 4  # the byte of the color type


def is_gray_with_alpha(path: Path) -> bool:
    """Whether a file is such a picture; one that cannot be read is none."""
    try:
        with open(path, "rb") as file:
            head = file.read(_KIND_AT + 1)
    except OSError:
        return False
    return head.startswith(_HEAD) and head[_KIND_AT:] == bytes([_GRAY_WITH_ALPHA])
