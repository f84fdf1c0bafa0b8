# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a model that each of Blender's objects and collections became."""

from collections import defaultdict
from typing import Any

from ..datablock_ids import Key, key_of_local


class Parts:
    """The model's objects by key. Few ask for them, so columns are only kept until somebody does.
    Not to be asked from two threads at once."""

    def __init__(self) -> None:
        self._found: defaultdict[Key, list[Any]] = defaultdict(list)
        self._columns: list[tuple[list[str], list[Any]]] = []

    def add(self, key: Key, items: list[Any]) -> None:
        self._found[key] += items

    def add_each(self, names: list[str], items: list[Any]) -> None:
        """Notes one item for each of these local objects."""
        self._columns.append((names, items))

    def get(self, key: Key, otherwise: Any = None) -> Any:
        for names, items in self._columns:
            for name, item in zip(names, items):
                self._found[key_of_local(name)].append(item)
        self._columns.clear()
        return self._found.get(key, otherwise)
