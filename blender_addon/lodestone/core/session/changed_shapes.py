# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of which Blender said that their shape has changed since levels were built."""

import itertools
from collections.abc import Iterable

_steps = itertools.count(1)
_noted: dict[str, int] = {}
_decided: set[str] = set()  # objects, and what they show
_read = 0


def decided(*names: str) -> None:
    """Something was decided about an object, of which Blender will say next that its shape, and
    that of all with the same data, has changed. An edit that a script makes in the same moment is
    not told from it."""
    _decided.update(names)


def reported(named: Iterable[tuple[str, str]]) -> list[str]:
    """Of objects that Blender reports, by their names and those of their data: those that may
    really have another shape."""
    found = [name for name, data in named if not _decided & {name, data}]
    _decided.clear()
    return found


def note(names: Iterable[str]) -> None:
    step = next(_steps)
    for name in names:
        _noted[name] = step


def reading() -> None:
    """The scene is being read, perhaps to build levels of it."""
    global _read
    _read = next(_steps)


def settle() -> None:
    """Levels of what was read last were built: only what was changed after it is left."""
    for name in [name for name, step in _noted.items() if step < _read]:
        del _noted[name]


def names() -> set[str]:
    return set(_noted)


def clear() -> None:
    _noted.clear()
    _decided.clear()
