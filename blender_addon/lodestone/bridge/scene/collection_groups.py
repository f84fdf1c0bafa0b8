# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups from collections: membership gives the tree, instancing empties the sharing."""

from array import array
from dataclasses import dataclass, field
from itertools import repeat
from operator import attrgetter
from typing import Any, NamedTuple

from ...core import stable_ids
from ...core.placement_decision import Decision
from .. import datablock_ids
from ..datablock_ids import name_of
from ..listed_instances import Rows, gathered, rows
from ..motion.motion_sampling import Motion
from ..motion.shutter_motion import Moving
from .leaf_objects import HAIR
from .model_parts import Parts
from .placement_columns import Placements
from .plain_objects import Plain
from .shown_instances import Context, Emitted, Entry, offset

IDENTITY: Rows = array("f", (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0))
ROUNDING = 1e-6  # a share of the largest number in a transform: Blender's are 32-bit
MOST_CHILDREN = 64  # in an emitter's group: more are grouped by position
_ORIGINAL, _OBJECT = attrgetter("original"), attrgetter("object")


@dataclass
class Branch:
    """A collection in outliner order, with the objects that belong to it here: each thing that is
    linked under several parents belongs to the first and is in no other branch."""

    collection: Any | None  # None: the scene's master collection
    name: str
    environment: bool
    children: list["Branch"] = field(default_factory=list)
    objects: list[Any] = field(default_factory=list)  # originals


def scene_branch(scene: Any, view_layer: Any, roles: datablock_ids.Roles) -> Branch:
    """The branches of what a view layer includes: render-hidden collections are left out, excluded
    ones lend nothing but their included children."""
    claimed: set[Any] = set()
    taken = _Taken()

    def branch(layer: Any, inherited: bool) -> Branch:
        collection = layer.collection
        environment = inherited or roles.is_environment(collection)
        made = Branch(collection, name_of(collection), environment)
        for child in layer.children:
            if child.collection.hide_render:
                continue
            if child.exclude or _claim(claimed, child.collection):
                inner = branch(child, environment)
                if inner.children or inner.objects:
                    made.children.append(inner)
        if not layer.exclude:
            made.objects = taken.own(collection)
        return made

    root = branch(view_layer.layer_collection, False)
    root.collection, root.name = None, name_of(scene)
    return root


def collection_branch(collection: Any, roles: datablock_ids.Roles) -> Branch:
    """The branch of an evaluated collection as its instances show it: layers play no part."""
    claimed: set[Any] = {collection.original}
    taken = _Taken()

    def branch(item: Any, inherited: bool) -> Branch:
        environment = inherited or roles.is_environment(item)
        made = Branch(item, name_of(item), environment)
        for child in item.children:
            if not child.hide_render and _claim(claimed, child):
                made.children.append(branch(child, environment))
        made.objects = taken.own(item)
        return made

    return branch(collection, False)


def _claim(claimed: set[Any], collection: Any) -> bool:
    original = collection.original
    if original in claimed:
        return False
    claimed.add(original)
    return True


class _Taken:
    """Originals of the objects that belong to a branch."""

    def __init__(self) -> None:
        self._before: set[Any] = set()
        self._last: list[Any] = []  # one large collection alone is not looked through

    def own(self, collection: Any) -> list[Any]:
        """The collection's own objects that belong to no earlier one; takes them."""
        objects = collection.objects  # all are originals where the collection is one
        found = list(map(_ORIGINAL, objects) if collection.is_evaluated else objects)
        if found:
            self._before.update(self._last)
            if not self._before.isdisjoint(found):
                found = [item for item in found if item not in self._before]
            self._last = found
        return found


def environment_objects(branch: Branch) -> set[Any]:
    """Originals of the objects in environment branches."""
    found = set(branch.objects) if branch.environment else set()
    for child in branch.children:
        found |= environment_objects(child)
    return found


def _same_but_for_rounding(a: list[Emitted], b: list[Emitted]) -> bool:
    if len(a) != len(b):
        return False
    for (leaf, place, *seen), (other, other_place, *other_seen) in zip(a, b):
        if leaf is not other or seen != other_seen:
            return False
        limit = ROUNDING * max(1.0, *map(abs, place))
        if any(abs(x - y) > limit for x, y in zip(place, other_place)):
            return False
    return True


class Rest(NamedTuple):
    """The things of a context that no branch has had yet, by original."""

    entries: dict[Any, Entry]
    plain: dict[Any, int]  # their rows


class Aside(NamedTuple):
    """The things in no collection's group: they change in an animation, or the designer wants them
    in no stand-in."""

    changing: Placements
    apart: Placements
    movers: list[Any]  # originals, of each of `changing`


_ASIDE_NAMES = {"changing": "in motion", "apart": "excluded"}


class Groups:
    """Adds groups to a model; equal contents become one group."""

    def __init__(
        self, model: Any, uids: datablock_ids.Uids, roles: datablock_ids.Roles, motion: Motion
    ) -> None:
        self._model = model
        self._uids = uids
        self._roles = roles
        self._motion = motion
        self._above: list[Branch] = []  # branches around the one at hand, with collections
        # By uid, role, whether it changes, and how much it places; a second one that is the
        # same in these, and the first, by all they place too: that key takes as long as the group
        self._first: dict[tuple, tuple[Placements, Any] | None] = {}
        self._made: dict[tuple, Any] = {}
        self._branches: dict[int, Branch] = {}
        self._emitters: dict[Any, list[tuple[list[Emitted], Any]]] = {}
        self.unplaced: list[str] = []  # names of objects no branch holds
        self.parts = Parts()
        self.moving: list[Moving] = []
        self.collections: dict[Any, None] = {}  # their groups that stay as they are in every frame

    def build(self, context: Context, branch: Branch) -> Any | None:
        """The group of a context, or None when it shows nothing."""
        rest = Rest(dict(context.entries), context.plain.rows())
        aside = Aside(Placements(), Placements(), [])
        placements, anew = self._members(context, branch, rest, aside)
        # Shown, but in no branch: never lose it
        self.unplaced += map(context.plain.names.__getitem__, rest.plain.values())
        self._add_plain(placements, context.plain, list(rest.plain.values()))
        for entry in rest.entries.values():
            extra = self._entry(entry)
            if extra:
                self.unplaced.append(entry.name)
                placements.extend(extra)
        for what in _ASIDE_NAMES:
            lifted = getattr(aside, what)
            if lifted:
                uid = stable_ids.stable_id(datablock_ids.scene_uid(branch.name), what)
                name = f"{branch.name} {_ASIDE_NAMES[what]}"
                group = self._intern(uid, name, False, lifted, what == "changing")
                placements.add(group, IDENTITY, name)
                if what == "changing":
                    self._note_moving(group, lifted, aside.movers)
        return self._group(branch, placements, anew)

    def _members(
        self, context: Context, branch: Branch, rest: "Rest", aside: "Aside"
    ) -> tuple[Placements, bool]:
        """The things of a context in a branch, and whether they change in an animation. Those that
        do in the scene itself go aside: a group of things that rest keeps its levels in every
        frame. An instanced collection that changes is drawn as it is, and what moves in it is a
        group in it."""
        placements, moving = Placements(), Placements()
        in_scene = context.collection is None
        self._above.append(branch)
        for child in branch.children:
            group = self._group(child, *self._members(context, child, rest, aside))
            if group is not None:
                decision = datablock_ids.decision_of(child.collection)
                into = aside.apart if decision.apart and in_scene else placements
                into.add(group, IDENTITY, child.name, 0, decision)
        rows, done = list(map(rest.plain.pop, branch.objects, repeat(None))), 0
        for at in (at for at, row in enumerate(rows) if row is None):
            self._add_plain(placements, context.plain, rows[done:at])
            done, original = at + 1, branch.objects[at]
            entry = rest.entries.pop(original, None)
            if entry is None:
                continue
            made, changes = self._entry(entry), self._changes(entry)
            if in_scene and (changes or entry.decision.apart):
                (aside.changing if changes else aside.apart).extend(made)
                aside.movers.extend([original] * (len(made) if changes else 0))
                for above in self._above:
                    if above.collection is not None:
                        self.parts.add(
                            datablock_ids.key_of("collection", above.collection), made.objects
                        )
            else:
                (moving if changes else placements).extend(made)
        self._add_plain(placements, context.plain, rows[done:])
        self._above.pop()
        if moving:
            uid = stable_ids.stable_id(self._branch_uid(branch), "changing")
            name = f"{branch.name} {_ASIDE_NAMES['changing']}"
            placements.add(self._intern(uid, name, False, moving, True), IDENTITY, name)
        return placements, bool(moving)

    def _add_plain(self, placements: Placements, plain: Plain, rows: list[int]) -> None:
        if not rows:
            return
        items = list(map(_OBJECT, map(plain.shows.__getitem__, rows)))
        names = list(map(plain.names.__getitem__, rows))
        placements.add_all(items, gathered(plain.places, rows), names)
        self.parts.add_each(names, items)

    def _note_moving(self, group: Any, lifted: Placements, movers: list[Any]) -> None:
        for position, item in enumerate(movers):
            place = tuple(lifted.transforms[12 * position : 12 * position + 12])
            self.moving.append(Moving(group, position, item, place))

    def _changes(self, entry: Entry) -> bool:
        """Whether an animation moves it, or makes another thing of it or of what it emits."""
        motion, item = self._motion, entry.object
        if (entry.leaf is not None and entry.leaf.deforms) or motion.moves(item):
            return True
        return bool(entry.emitted or entry.hair) and motion.emits_anew(item)

    def _entry(self, entry: Entry) -> Placements:
        placements, own = Placements(), (entry.hidden, entry.decision)
        if entry.leaf is not None:
            placements.add(entry.leaf.object, entry.place, entry.name, *own)
        if entry.hair is not None:
            name = f"{entry.name} {HAIR}"
            placements.add(entry.hair.object, entry.place, name, *own)
        if entry.content is not None:
            collection = entry.content.collection
            pointer = collection.as_pointer()
            if pointer not in self._branches:
                self._branches[pointer] = collection_branch(collection, self._roles)
            group = self.build(entry.content, self._branches[pointer])
            if group is not None:
                place = rows(entry.object.matrix_world @ offset(collection))
                decision = datablock_ids.decision_of(collection).inside(entry.decision)
                placements.add(group, place, entry.name, entry.hidden, decision)
        if entry.emitted:
            name = f"{entry.name} instances"
            placements.add(self._emitter(entry), IDENTITY, name, *own)
        self.parts.add(entry.key, placements.objects)
        return placements

    def _emitter(self, entry: Entry) -> Any:
        """The group of an emitter's instances. In every context that shows it they are the same but
        for rounding, which must not keep the contexts from sharing one group."""
        known = self._emitters.setdefault(entry.object.original, [])
        for emitted, group in known:
            if _same_but_for_rounding(emitted, entry.emitted):
                return group
        uid = stable_ids.stable_id(datablock_ids.uid_of("object", entry.object), "instances")
        children = Placements()
        for leaf, place, hidden, decision in entry.emitted:
            children.add(leaf.object, place, leaf.data, hidden, decision)
        own = self._roles.of(entry.object)
        role = datablock_ids.role(own == "ENVIRONMENT", own == "ORDINARY")
        anew = self._motion.emits_anew(entry.object)
        group = self._intern(uid, f"{entry.name} instances", role, children, anew)
        if len(children) > MOST_CHILDREN and not anew:
            self._model.group_by_position(group, MOST_CHILDREN)
        known.append((entry.emitted, group))
        return group

    def _branch_uid(self, branch: Branch) -> str:
        if branch.collection is None:
            return datablock_ids.scene_uid(branch.name)
        return datablock_ids.uid_of("collection", branch.collection)

    def _group(self, branch: Branch, placements: Placements, changes: bool = False) -> Any | None:
        if not placements:
            return None
        uid = self._branch_uid(branch)
        ordinary = branch.collection is not None and self._roles.is_ordinary(branch.collection)
        role = datablock_ids.role(branch.environment, ordinary)
        group = self._intern(uid, branch.name, role, placements)
        if not changes:
            self.collections[group] = None
        if branch.collection is not None:
            self.parts.add(datablock_ids.key_of("collection", branch.collection), [group])
        return group

    def _decide(self, group: Any, position: int, decision: Decision) -> None:
        model = self._model
        model.decide_placement(group, position, decision.importance, decision.coarsest)
        if decision.pinned:
            model.pin_placement(group, position, decision.coarsest)

    def _intern(
        self,
        uid: str,
        name: str,
        role: int,
        placements: Placements,
        changes: bool = False,
    ) -> Any:
        about = (uid, role, changes, len(placements))
        key = None
        if about in self._first:
            if self._first[about] is not None:
                first, group = self._first[about]
                self._made[about, first.key] = group
                self._first[about] = None
            key = (about, placements.key)
            if key in self._made:
                return self._made[key]
        claimed = self._uids.claim(uid)
        group = self._model.add_group(claimed, name, role, changes)
        self._model.add_placements(
            group,
            placements.objects,
            placements.transforms,
            placements.names,
            placements.hidden,
        )
        for position, decision in placements.decisions.items():
            self._decide(group, position, decision)
        if key is None:
            self._first[about] = (placements, group)
        else:
            self._made[key] = group
        return group
