# SPDX-License-Identifier: GPL-3.0-or-later
"""Placements: what a group places, in columns as the backend takes them."""

from array import array
from typing import Any

from ...core.placement_decision import UNDECIDED, Decision
from ..listed_instances import Rows


class Placements:
    """Children of one group in the making, in order."""

    def __init__(self) -> None:
        self.objects: list[Any] = []  # lodestone_native.Object
        self.transforms = array("f")  # 12 each, as Rows
        self.names: list[str] = []
        self.hidden: list[int] = []  # bits of the ray classes that do not see it
        self.decisions: dict[int, Decision] = {}  # by position, of those that have one

    def __len__(self) -> int:
        return len(self.objects)

    def add(
        self,
        item: Any,
        place: Rows,
        name: str,
        hidden: int = 0,
        decision: Decision = UNDECIDED,
    ) -> None:
        if decision is not UNDECIDED:
            self.decisions[len(self.objects)] = decision
        self.objects.append(item)
        self.transforms.extend(place)
        self.names.append(name)
        self.hidden.append(hidden)

    def add_all(self, items: list[Any], places: Rows, names: list[str]) -> None:
        """Adds placements of which nothing is hidden or decided; 12 numbers a place."""
        self.objects += items
        self.transforms += places
        self.names += names
        self.hidden += [0] * len(items)

    def extend(self, others: "Placements") -> None:
        before = len(self.objects)
        self.decisions.update((before + at, found) for at, found in others.decisions.items())
        self.objects += others.objects
        self.transforms += others.transforms
        self.names += others.names
        self.hidden += others.hidden

    @property
    def key(self) -> tuple:
        """A value that is equal for placements that are equal in everything."""
        objects = b"".join(map(bytes, self.objects))
        decisions = tuple(sorted(self.decisions.items()))
        columns = (self.transforms.tobytes(), tuple(self.names), tuple(self.hidden), decisions)
        return (objects, *columns)
