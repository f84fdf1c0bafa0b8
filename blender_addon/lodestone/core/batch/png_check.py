# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a PNG is whole, by its chunks and their checksums; its pixels are not looked at."""

import zlib
from pathlib import Path

_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def is_whole(path: str | Path) -> bool:
    """True when every chunk from IHDR to IEND is there and none is damaged."""
    try:
        with open(path, "rb") as file:
            if file.read(8) != _SIGNATURE:
                return False
            first, pixels = True, False
            while True:
                head = file.read(8)
                if len(head) < 8 or (first and head[4:] != b"IHDR"):
                    return False
                length = int.from_bytes(head[:4], "big")
                body = file.read(length + 4) if length < 1 << 31 else b""
                if len(body) < length + 4:
                    return False
                if zlib.crc32(body[:-4], zlib.crc32(head[4:])) != int.from_bytes(body[-4:], "big"):
                    return False
                if head[4:] == b"IEND":
                    return pixels
                first, pixels = False, pixels or head[4:] == b"IDAT"
    except OSError:
        return False
