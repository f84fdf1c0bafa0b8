# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenEXR bytes of linear colors: what has no file of its own, brighter than white or smooth."""

from __future__ import annotations

import struct
import sys
from array import array


def encode(width: int, height: int, pixels: array[float]) -> bytes:
    """RGB of float32, uncompressed; pixels: array('f') [height][width][3], lowest row first."""
    if len(pixels) != 3 * width * height or width < 1 or height < 1:
        raise ValueError("the pixels do not fit the size of the picture")
    channels = b"".join(
        name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")
    )
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"".join(
        (
            b"\x76\x2f\x31\x01" + struct.pack("<i", 2),
            _attribute("channels", "chlist", channels + b"\0"),
            _attribute("compression", "compression", b"\0"),
            _attribute("dataWindow", "box2i", window),
            _attribute("displayWindow", "box2i", window),
            _attribute("lineOrder", "lineOrder", b"\0"),
            _attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
            _attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
            _attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)),
            b"\0",
        )
    )
    line = 8 + 12 * width
    first = len(header) + 8 * height
    parts = [header]
    parts.extend(struct.pack("<Q", first + row * line) for row in range(height))
    for row in range(height):
        below = height - 1 - row
        colors = pixels[3 * width * below : 3 * width * (below + 1)]
        parts.append(struct.pack("<ii", row, 12 * width))
        for channel in (2, 1, 0):
            plane = colors[channel::3]
            if sys.byteorder == "big":
                plane.byteswap()
            parts.append(plane.tobytes())
    return b"".join(parts)


def _attribute(name: str, kind: str, value: bytes) -> bytes:
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
