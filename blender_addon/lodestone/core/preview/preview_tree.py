# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the objects of a scene stand in a model read from its store, so that a viewport can follow
what was moved, hidden or pinned since levels were built.

A model's placements carry the names of the objects and collections that they were made of; which of
them may be objects or collections is asked of whoever knows the scene.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from ..native import lodestone_native as native
from ..placement_decision import ANY_LEVEL

Rows = tuple[float, ...]  # row-major 3x4

IDENTITY: Rows = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
INSTANCES, HAIR = " instances", " hair"  # appended to an object's name
ALL_RAYS = int(sum(native.RayClass))
NOT_FORCED = -1
_MOST_NESTED = 64


class Names(NamedTuple):
    """The names of a scene's things, to find them in a model. `collections`: by uid."""

    objects: frozenset[str]
    collections: Mapping[str, str]
    scene_uid: str


class Slot(NamedTuple):
    """A placement of something that has a name in the scene. `world`: where it stands there, by the
    first way to it; `above`: its group. `follows`: it stands where its object does; else it is
    given in the world (particles, for example)."""

    group: native.Object
    position: int
    above: Rows
    world: Rows
    follows: bool
    importance: float
    coarsest: int

    @property
    def key(self) -> tuple[int, int]:
        return (self.group.index, self.position)


@dataclass
class Tree:
    """The places of a scene's things in a model. `objects`: slots in the scene itself, by name.
    `inner`: of objects in instanced collections. `collections`: of collections, wherever they are,
    by uid. `lost`: slots in the scene of which no object is left."""

    objects: dict[str, list[Slot]] = field(default_factory=dict)
    inner: dict[str, list[Slot]] = field(default_factory=dict)
    collections: dict[str, list[Slot]] = field(default_factory=dict)
    lost: list[Slot] = field(default_factory=list)

    def slots(self) -> Iterator[Slot]:
        for kind in (self.objects, self.inner, self.collections):
            for found in kind.values():
                yield from found
        yield from self.lost


def multiply(a: Rows, b: Rows) -> Rows:
    """First b, then a."""
    rows = []
    for i in (0, 4, 8):
        x, y, z, w = a[i : i + 4]
        rows += [x * b[j] + y * b[4 + j] + z * b[8 + j] for j in range(4)]
        rows[-1] += w
    return tuple(rows)


def inverse(a: Rows) -> Rows | None:
    """The inverse of a transform; None: it flattens."""
    (a0, a1, a2, ax), (b0, b1, b2, bx), (c0, c1, c2, cx) = a[0:4], a[4:8], a[8:12]
    x, y, z = b1 * c2 - b2 * c1, b2 * c0 - b0 * c2, b0 * c1 - b1 * c0
    determinant = a0 * x + a1 * y + a2 * z
    if determinant == 0.0:
        return None
    part = (
        (x, a2 * c1 - a1 * c2, a1 * b2 - a2 * b1),
        (y, a0 * c2 - a2 * c0, a2 * b0 - a0 * b2),
        (z, a1 * c0 - a0 * c1, a0 * b1 - a1 * b0),
    )
    rows: list[float] = []
    for row in part:
        p, q, r = (value / determinant for value in row)
        rows += [p, q, r, -(p * ax + q * bx + r * cx)]
    return tuple(rows)


def same(a: Rows, b: Rows) -> bool:
    """But for what writing and reading rounds."""
    return all(abs(x - y) <= 1e-5 * max(1.0, abs(x)) for x, y in zip(a, b))


def tree_of(
    model: native.Model,
    root: native.Object,
    is_object: Callable[[str], bool],
    collection: Callable[[str], str | None],
) -> Tree:
    """The tree of a model. `collection`: the name of the collection with a uid, None where there is
    no such one."""
    tree = Tree()
    seen: set[int] = set()
    waiting: list[tuple[native.Object, Rows, bool, int]] = [(root, IDENTITY, True, 0)]
    while waiting:
        group, world, in_scene, depth = waiting.pop()
        if group.index in seen or depth > _MOST_NESTED:
            continue
        seen.add(group.index)
        decided = model.decided(group)
        for position, (child, local, name, _) in enumerate(model.children(group)):
            summary = model.object_summary(child)
            place = multiply(world, local)
            follows = not name.endswith(INSTANCES) or is_object(name)
            slot = Slot(group, position, world, place, follows, *decided[position])
            called = collection(summary.uid) if summary.group else None
            if called == name and same(local, IDENTITY):
                tree.collections.setdefault(summary.uid, []).append(slot)
                waiting.append((child, place, in_scene, depth + 1))
                continue
            owner = _owner(name, is_object)
            if owner is not None:
                (tree.objects if in_scene else tree.inner).setdefault(owner, []).append(slot)
                if called is not None:  # the collection it instances, once for all its instances
                    tree.collections.setdefault(summary.uid, []).append(slot)
                    waiting.append((child, place, False, depth + 1))
            elif summary.group and not name.endswith(INSTANCES):
                waiting.append((child, place, in_scene, depth + 1))
            elif in_scene:
                tree.lost.append(slot)
    return tree


def _owner(name: str, is_object: Callable[[str], bool]) -> str | None:
    for suffix in ("", INSTANCES, HAIR):
        if name.endswith(suffix) and is_object(name[: len(name) - len(suffix)]):
            return name[: len(name) - len(suffix)]
    return None


def leaves_of(model: native.Model, root: native.Object) -> list[tuple[native.Object, int]]:
    """Every placement of what is no group: (group, position), each once."""
    found: list[tuple[native.Object, int]] = []
    is_group: dict[int, bool] = {root.index: True}
    waiting = [root]
    while waiting:
        group = waiting.pop()
        for position, (child, *_) in enumerate(model.children(group)):
            if child.index not in is_group:
                is_group[child.index] = model.object_summary(child).group != 0
                if is_group[child.index]:
                    waiting.append(child)
            if not is_group[child.index]:
                found.append((group, position))
    return found


class Change(NamedTuple):
    """The difference of a placement from how levels were built. `world`: None: where it was.
    `importance`, `coarsest`, `pinned`: as placement_decision has them."""

    world: Rows | None = None
    hidden: bool = False
    importance: float = 1.0
    coarsest: int = ANY_LEVEL
    pinned: bool = False


Changes = dict[tuple[int, int], Change]


def apply(model: native.Model, slot: Slot, change: Change) -> None:
    """Makes a placement what it is now."""
    model.decide_placement(slot.group, slot.position, change.importance, change.coarsest)
    if change.pinned:
        model.pin_placement(slot.group, slot.position, change.coarsest)
    local = None
    if change.world is not None:
        back = inverse(slot.above)
        local = None if back is None else multiply(back, change.world)
    if local is None and not change.hidden:
        return
    hidden = ALL_RAYS if change.hidden else 0
    native.change_placement(model, slot.group, slot.position, local, hidden)


def take_back(model: native.Model, slot: Slot, plain: Change) -> None:
    """Makes a placement what it was, but for `plain`'s decisions."""
    back = inverse(slot.above)
    local = None if back is None else multiply(back, slot.world)
    native.change_placement(model, slot.group, slot.position, local, 0)
    apply(model, slot, plain._replace(world=None, hidden=False))


class Decided:
    """A model read from a store, and what of it was changed since. A model of another scene has an
    empty tree."""

    def __init__(self, model: native.Model, names: Names) -> None:
        self.model = model
        self._root = root = model.find_object(names.scene_uid)
        self.found = root is not None
        # Looked for when they are needed.
        self._leaves: list[tuple[native.Object, int]] | None = None
        self.tree = Tree()
        if root is not None:
            is_object = names.objects.__contains__
            self.tree = tree_of(model, root, is_object, names.collections.get)
        self._slots = {slot.key: slot for slot in self.tree.slots()}
        # Decisions for renders do not count: the placement is like one without any
        self._applied: Changes = {
            key: Change(importance=-1.0)
            for key, slot in self._slots.items()
            if (slot.importance, slot.coarsest) != (1.0, ANY_LEVEL)
        }

    def apply(self, changes: Changes, force: int = NOT_FORCED) -> None:
        """Makes the model so; what is not among the changes is as levels were built. `force`: the
        LOD number that every object is drawn with, whatever is decided about it."""
        if force != NOT_FORCED:
            changes = self._forced(changes, force)
        for key in self._applied.keys() | changes.keys():
            change, before = changes.get(key), self._applied.get(key)
            if change == before:
                continue
            slot, change = self._slots[key], change or Change()
            if before is not None and (before.hidden or before.world is not None):
                take_back(self.model, slot, change)
            apply(self.model, slot, change)
        self._applied = dict(changes)

    def _forced(self, changes: Changes, lod: int) -> Changes:
        """Groups have no say: what is in them is asked for."""
        made: Changes = {}
        for key, change in changes.items():
            change = change._replace(coarsest=ANY_LEVEL, pinned=False)
            if change != Change():
                made[key] = change
        if self._leaves is None:
            self._leaves = [] if self._root is None else leaves_of(self.model, self._root)
            for group, position in self._leaves:
                slot = Slot(group, position, IDENTITY, IDENTITY, False, 1.0, ANY_LEVEL)
                self._slots.setdefault(slot.key, slot)
        plain = Change(coarsest=lod, pinned=True)
        for group, position in self._leaves:
            key = (group.index, position)
            before = made.get(key)
            made[key] = plain if before is None else before._replace(coarsest=lod, pinned=True)
        return made
