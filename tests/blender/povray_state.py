# SPDX-License-Identifier: GPL-3.0-or-later
"""The file in which POV-Ray keeps what it has drawn, for tests in which another program takes its
place. Needs no Blender."""

import struct


def _attribute(key, kind, data):
    count = len(data) // 4 if kind.startswith(b"V") else len(data)
    return key + kind + struct.pack(">I", count) + data


def _message(kind, *attributes):
    body = b"OBJE" + struct.pack(">I", 1 + len(attributes)) + _attribute(b"MIDE", b"TYPE", kind)
    body += b"".join(attributes)
    return b"POVRAYMS" + struct.pack(">II", 0x370, len(body)) + b"RAWS" + body


def rectangle(left, top, right, bottom, color):
    """A file of one finished rectangle of one linear color."""
    corners = zip((b"Left", b"Top ", b"Righ", b"Bott"), (left, top, right, bottom))
    count = (right - left + 1) * (bottom - top + 1)
    block = struct.pack(">5f", *color, 0.0, 0.0) * count
    return b"POV-Ray Render State File".ljust(512, b"\0") + _message(
        b"PxBS",
        _attribute(b"PBlo", b"VFL4", block),
        *(_attribute(key, b"INT4", struct.pack(">i", value)) for key, value in corners),
    )
