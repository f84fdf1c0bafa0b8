# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of which Blender said that their shape has changed since levels were built."""

import itertools
from collections.abc import Iterable

_steps = itertools.count(1)
_noted: dict[str, int] = {}
_read = 0


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
