# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects show which material: noted on the way to the leaves, whoever makes them."""

from collections.abc import Callable
from functools import partial
from typing import Any

from ..core.problems import Problem, Subject
from . import compat, ids
from .leaves import material_slots


class Users:
    """Stands before Leaves, or what takes its place, and notes every leaf that is asked for."""

    def __init__(self, leaves: Any) -> None:
        self._leaves = leaves
        self._slots_of = partial(material_slots, override=leaves.override)
        self._seen: set[tuple[int, int]] = set()
        self._slots: dict[int, list[Subject]] = {}  # materials by leaf
        self._found: dict[Subject, dict[Subject, None]] = {}

    def leaf(self, shown: Any, owner: Any, *how: Any) -> Any:
        return self._noted(self._leaves.leaf(shown, owner, *how), shown, owner, self._worn)

    def __getattr__(self, name: str) -> Callable[..., Any]:
        """The other ways to a leaf, of what has no faces: all its materials are seen."""
        give = getattr(self._leaves, name)
        return lambda shown, owner, *how: self._noted(
            give(shown, owner, *how), shown, owner, self._slots_of
        )

    def _noted(self, leaf: Any, shown: Any, owner: Any, worn: Callable[[Any], list]) -> Any:
        if leaf is None:
            return None
        pair = (id(leaf), owner.original.as_pointer())
        if pair not in self._seen:
            self._seen.add(pair)
            if id(leaf) not in self._slots:  # leaves live as long as their model
                self._slots[id(leaf)] = [
                    ids.key_of("material", material) for material in worn(shown) if material
                ]
            user = ids.key_of("object", owner)
            for material in self._slots[id(leaf)]:
                self._found.setdefault(material, {})[user] = None
        return leaf

    def _worn(self, shown: Any) -> list[Any]:
        return _worn_by_faces(shown, self._slots_of(shown))

    def found(self) -> dict[Subject, tuple[Subject, ...]]:
        """The objects of every material that a face of them wears."""
        return {material: tuple(users) for material, users in self._found.items()}

    def concerns(self, problem: Problem) -> bool:
        """False for a material that no face wears: whatever is wrong with it, nobody sees it."""
        return problem.kind != "material" or problem.subject in self._found


def _worn_by_faces(shown: Any, slots: list[Any]) -> list[Any]:
    if len(slots) > 1 and shown.type == "MESH":
        used = _used_slots(shown.data)
        if used is not None:
            # Blender gives faces beyond the last slot the last one
            used = {min(max(index, 0), len(slots) - 1) for index in used}
            slots = [slots[index] for index in sorted(used)]
    return slots


def _used_slots(mesh: Any) -> set[int] | None:
    """The slots that faces use; None when the faces cannot be seen (Edit Mode)."""
    count = len(mesh.polygons)
    if count == 0:
        return None
    values = compat.buffer("i", count)
    compat.face_slots(mesh, values)
    return set(values)
