# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of which Blender said that their shape has changed since levels were built."""

import itertools
from collections.abc import Iterable


class ChangedShapes:
    """Names of objects, and which of them were changed after the scene was read."""

    def __init__(self) -> None:
        self._steps = itertools.count(1)
        self._noted: dict[str, int] = {}
        self._decided: set[str] = set()  # objects, and what they show
        self._read = 0

    def decided(self, *names: str) -> None:
        """Something was decided about an object, of which Blender will say next that its shape,
        and that of all with the same data, has changed. An edit that a script makes in the same
        moment is not told from it."""
        self._decided.update(names)

    def reported(self, named: Iterable[tuple[str, str]]) -> list[str]:
        """The objects that may really have another shape, of all that Blender reports, by their
        names and those of their data."""
        found = [name for name, data in named if not self._decided & {name, data}]
        self._decided.clear()
        return found

    def note(self, names: Iterable[str]) -> None:
        """These objects have another shape from now on."""
        step = next(self._steps)
        for name in names:
            self._noted[name] = step

    def reading(self) -> None:
        """The scene is being read, perhaps to build levels of it."""
        self._read = next(self._steps)

    def settle(self) -> None:
        """Levels of the scene as it was last read were built: only what changed after it is
        left."""
        for name in [name for name, step in self._noted.items() if step < self._read]:
            del self._noted[name]

    def names(self) -> set[str]:
        """The objects whose levels are of another shape."""
        return set(self._noted)

    def clear(self) -> None:
        """Another file is opened."""
        self._noted.clear()
        self._decided.clear()
