# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph's instances with their world transforms, which are read all at a stroke."""

import math
from array import array
from collections.abc import Iterable, Iterator, Sequence
from itertools import compress
from operator import not_
from types import SimpleNamespace
from typing import Any

from . import blender_versions

Rows = array  # "f", 12: row-major 3x4


class Listed:
    """Iterates over (number, instance). Never keep an instance: the next step overwrites it."""

    def __init__(self, depsgraph: Any) -> None:
        self._depsgraph = depsgraph
        self._objects = list(depsgraph.objects)  # until all is iterated
        instances = depsgraph.object_instances
        count = len(instances)
        columns = blender_versions.buffer("f", 16 * count)
        instances.foreach_get("matrix_world", columns)
        self.places: Rows = blender_versions.buffer("f", 12 * count)  # 12 numbers of each instance
        for i in range(12):
            self.places[i::12] = columns[4 * (i % 4) + i // 4 :: 16]
        self._finite = math.isfinite(sum(self.places))
        self._wanted = bytearray(b"\1") * count

    def __iter__(self) -> Iterator[tuple[int, Any]]:
        objects, self._objects = self._objects, []
        count = len(self._wanted)
        if len(objects) == count and not any(map(_emits, compress(objects, self._wanted))):
            wanted = compress(range(count), self._wanted)
            return ((number, by_itself(objects[number])) for number in wanted)
        del objects
        return compress(enumerate(self._depsgraph.object_instances), self._wanted)

    def want(self, numbers: Iterable[int], wanted: bool) -> None:
        """Whether the iteration comes to these, which may be under way."""
        for number in numbers:
            self._wanted[number] = wanted

    def objects(self) -> tuple[Sequence[int], list[Any]]:
        """Evaluated objects that are shown by themselves, at transforms that are numbers, and their
        numbers, in order. Do not keep them while iterating: as long as anybody in Python knows an
        evaluated object, its instances are handed out as that object itself."""
        count = len(self._wanted)
        objects, numbers = self._objects, range(count)
        if len(objects) != count:
            instanced = [False] * count
            self._depsgraph.object_instances.foreach_get("is_instance", instanced)
            numbers = list(compress(numbers, map(not_, instanced)))
        if len(objects) != len(numbers):
            return (), []
        if not self._finite:
            right = [self.place(number) is not None for number in numbers]
            numbers, objects = list(compress(numbers, right)), list(compress(objects, right))
        return numbers, objects

    def place(self, number: int) -> Rows | None:
        """The transform from the instance's own frame to the world; None: it is not made of
        numbers."""
        rows = self.places[12 * number : 12 * number + 12]
        return rows if self._finite or math.isfinite(sum(rows)) else None


def by_itself(item: Any) -> Any:
    """A stand-in for the instance that shows an evaluated object, which emits nothing, by
    itself."""
    return SimpleNamespace(
        object=item,
        is_instance=False,
        show_self=True,
        show_particles=False,
        matrix_world=item.matrix_world,
    )


def _emits(item: Any) -> bool:
    """Whether it may show something else than itself, or nothing."""
    return item.is_instancer or len(item.particle_systems) > 0


def gathered(places: Rows, numbers: Sequence[int]) -> Rows:
    """The rows of some places, 12 numbers each, out of many."""
    if not numbers:
        return array("f")
    first, end = numbers[0], numbers[-1] + 1
    if end - first == len(numbers) and list(numbers) == list(range(first, end)):
        return places[12 * first : 12 * end]
    found = array("f")
    for number in numbers:
        found += places[12 * number : 12 * number + 12]
    return found


def rows(matrix: Any) -> Rows:
    """The first three rows of a Matrix."""
    x, y, z, _ = matrix  # half the time of asking for one after the other
    return array("f", x[:] + y[:] + z[:])
