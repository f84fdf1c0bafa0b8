# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph's instances with their world transforms, which are read all at a stroke."""

import math
from array import array
from collections.abc import Iterator
from typing import Any

from . import compat

Rows = array  # "f", 12: row-major 3x4


class Listed:
    """Iterates over (number, instance). Never keep an instance: the next step overwrites it."""

    def __init__(self, depsgraph: Any) -> None:
        self._depsgraph = depsgraph
        instances = depsgraph.object_instances
        count = len(instances)
        columns = compat.buffer("f", 16 * count)
        instances.foreach_get("matrix_world", columns)
        self._rows = compat.buffer("f", 12 * count)
        for i in range(12):
            self._rows[i::12] = columns[4 * (i % 4) + i // 4 :: 16]
        self._finite = math.isfinite(sum(self._rows))

    def __iter__(self) -> Iterator[tuple[int, Any]]:
        return enumerate(self._depsgraph.object_instances)

    def place(self, number: int) -> Rows | None:
        """From the instance's own frame to the world; None: it is not made of numbers."""
        rows = self._rows[12 * number : 12 * number + 12]
        return rows if self._finite or math.isfinite(sum(rows)) else None


def rows(matrix: Any) -> Rows:
    """Of a Matrix."""
    x, y, z, _ = matrix  # half the time of asking for one after the other
    return array("f", x[:] + y[:] + z[:])
