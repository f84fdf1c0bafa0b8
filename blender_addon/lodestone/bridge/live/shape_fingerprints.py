# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an object has another shape than it had. Blender reports shapes as changed that are not
(of whatever was tagged, undone, or shown again).

Shapes are looked at in idle moments, a few at a time. One that is reported before it was looked at
counts as changed.
"""

import time
import zlib
from collections.abc import Iterable
from typing import Any, NamedTuple

from .. import blender_versions
from ..datablock_ids import name_of


class Shape(NamedTuple):
    vertices: int
    corners: int
    faces: int
    positions: int  # a checksum


def shape_of(item: Any) -> Shape | None:
    """The fingerprint of an evaluated object; None: it is no mesh, or is being edited."""
    if item.type != "MESH" or item.mode != "OBJECT" or item.data is None:
        return None
    data = item.data
    count = len(data.vertices)
    positions = blender_versions.buffer("f", 3 * count)
    data.vertices.foreach_get("co", positions)
    return Shape(count, len(data.loops), len(data.polygons), zlib.crc32(positions))


class Fingerprints:
    """Fingerprints by object; those of one mesh are looked at once in a call."""

    def __init__(self) -> None:
        self._known: dict[str, Shape] = {}

    def learn(self, items: Iterable[Any], skipped: set[str], seconds: float) -> bool:
        """Looks at evaluated objects, as many as time allows. True when all are known."""
        end = time.monotonic() + seconds
        seen: dict[int, Shape | None] = {}
        for item in items:
            if item.type != "MESH":
                continue
            name = name_of(item)
            if name in self._known or name in skipped:
                continue
            key = item.data.as_pointer() if item.data is not None else 0
            if key not in seen:
                if time.monotonic() > end:
                    return False
                seen[key] = shape_of(item)
            shape = seen[key]
            if shape is None:
                skipped.add(name)
            else:
                self._known[name] = shape
        return True

    def changed(self, name: str, item: Any) -> bool:
        """Whether an evaluated object that Blender reported has another shape."""
        known = self._known.get(name)
        return known is None or known != shape_of(item)
