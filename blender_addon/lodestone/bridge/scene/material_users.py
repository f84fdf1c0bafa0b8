# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that show each material: noted on the way to the leaves, whoever makes them."""

from collections import defaultdict
from collections.abc import Iterable
from functools import partial
from itertools import chain
from typing import Any

from ...core.problems import Problem, Subject
from .. import blender_versions, datablock_ids
from .leaf_objects import material_slots


class Shown:
    """The users of materials, by leaf and by Blender's names: keeps nothing of Blender's."""

    def __init__(self) -> None:
        self._users: dict[Any, dict[Subject, None]] = {}  # by leaf
        self._more: dict[Any, list[Iterable[str]]] = {}  # by leaf; names of local objects
        self._materials: dict[Any, list[Subject]] = {}  # by leaf
        self._seen: set[Subject] = set()  # materials

    def of(self, leaf: Any) -> dict[Subject, None] | None:
        """The users of a leaf, to be added to; None: its materials are not known yet."""
        return self._users.get(leaf)

    def meet(self, leaf: Any, worn: list[Any]) -> dict[Subject, None]:
        """A new leaf wears these materials."""
        subjects = [datablock_ids.key_of("material", material) for material in worn if material]
        self._materials[leaf] = subjects
        self._seen.update(subjects)
        return self._users.setdefault(leaf, {})

    def note(self, leaf: Any, names: Iterable[str]) -> None:
        """Local objects that show a leaf that was given out, too."""
        self._more.setdefault(leaf, []).append(names)

    def found(self) -> dict[Subject, tuple[Subject, ...]]:
        """The objects of every material that a face of them wears."""
        found: defaultdict[Subject, list[tuple[Subject, ...]]] = defaultdict(list)
        for leaf, users in self._users.items():
            names = chain.from_iterable(self._more.pop(leaf, ()))
            users |= dict.fromkeys(map(datablock_ids.key_of_local, names))
            own = tuple(users)
            for material in self._materials[leaf]:
                found[material].append(own)
        return {
            material: of_leaves[0]
            if len(of_leaves) == 1
            else tuple(dict.fromkeys(chain.from_iterable(of_leaves)))
            for material, of_leaves in found.items()
        }

    def concerns(self, problem: Problem) -> bool:
        """False for a material that no face wears: whatever is wrong with it, nobody sees it."""
        return problem.kind != "material" or problem.subject in self._seen


class Users:
    """Stands before Leaves, or what takes its place, and notes every leaf that is asked for."""

    def __init__(self, leaves: Any) -> None:
        self.shown = Shown()
        self._leaves = leaves
        self._slots_of = partial(material_slots, override=leaves.override)

    def leaf(self, user: Subject, shown: Any, *how: Any) -> Any:
        """The leaf of an object, as Leaves.leaf() gives it."""
        leaf = self._leaves.leaf(shown, *how)
        if leaf is not None:
            known = self.shown.of(leaf)
            if known is None:
                known = self.shown.meet(leaf, _worn_by_faces(shown, self._slots_of(shown)))
            known[user] = None
        return leaf

    def hair(self, user: Subject, shown: Any, *how: Any) -> Any:
        return self._noted(self._leaves.hair(shown, *how), user, shown)

    def point(self, user: Subject, shown: Any, *how: Any) -> Any:
        return self._noted(self._leaves.point(shown, *how), user, shown)

    def _noted(self, leaf: Any, user: Subject, shown: Any) -> Any:
        """Notes a leaf without faces: all its materials are seen."""
        if leaf is not None:
            known = self.shown.of(leaf)
            if known is None:
                known = self.shown.meet(leaf, self._slots_of(shown))
            known[user] = None
        return leaf


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
    values = blender_versions.buffer("i", count)
    blender_versions.face_slots(mesh, values)
    return set(values)
