# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups from collections: membership gives the tree, instancing empties the sharing."""

from collections import defaultdict
from dataclasses import dataclass, field
from typing import Any

from ..core import identity
from . import ids
from .instances import Context, Emitted, Entry, Rows, offset, rows
from .leaves import HAIR
from .motion import Motion

IDENTITY: Rows = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
ROUNDING = 1e-6  # of the largest number in a transform: Blender's are 32-bit
MOST_CHILDREN = 64  # of an emitter's group: more are grouped by position
Placement = tuple[Any, Rows, str, int]  # object, transform, name, hidden from which ray classes


@dataclass
class Branch:
    """A collection in outliner order, with the objects that belong to it here: each thing that is
    linked under several parents belongs to the first and is in no other branch."""

    collection: Any | None  # None: the scene's master collection
    name: str
    environment: bool
    children: list["Branch"] = field(default_factory=list)
    objects: list[int] = field(default_factory=list)  # original pointers


def scene_branch(scene: Any, view_layer: Any, roles: ids.Roles) -> Branch:
    """Of what a view layer includes: render-hidden collections are left out, excluded ones lend
    nothing but their included children."""
    claimed: set[int] = set()

    def branch(layer: Any, inherited: bool) -> Branch:
        collection = layer.collection
        environment = inherited or roles.is_environment(collection)
        made = Branch(collection, collection.name, environment)
        for child in layer.children:
            if child.collection.hide_render:
                continue
            if child.exclude or _claim(claimed, child.collection):
                inner = branch(child, environment)
                if inner.children or inner.objects:
                    made.children.append(inner)
        if not layer.exclude:
            made.objects = _own(claimed, collection)
        return made

    root = branch(view_layer.layer_collection, False)
    root.collection, root.name = None, scene.name
    return root


def collection_branch(collection: Any, roles: ids.Roles) -> Branch:
    """Of an evaluated collection as its instances show it: layers play no part."""
    claimed: set[int] = {collection.original.as_pointer()}

    def branch(item: Any, inherited: bool) -> Branch:
        environment = inherited or roles.is_environment(item)
        made = Branch(item, item.name, environment)
        for child in item.children:
            if not child.hide_render and _claim(claimed, child):
                made.children.append(branch(child, environment))
        made.objects = _own(claimed, item)
        return made

    return branch(collection, False)


def _claim(claimed: set[int], collection: Any) -> bool:
    key = collection.original.as_pointer()
    if key in claimed:
        return False
    claimed.add(key)
    return True


def _own(claimed: set[int], collection: Any) -> list[int]:
    """The collection's own objects that belong to no earlier one."""
    found = []
    for item in collection.objects:
        key = item.original.as_pointer()
        if key not in claimed:
            claimed.add(key)
            found.append(key)
    return found


def environment_objects(branch: Branch) -> set[int]:
    """Original pointers of the objects in environment branches."""
    found = set(branch.objects) if branch.environment else set()
    for child in branch.children:
        found |= environment_objects(child)
    return found


def _same_but_for_rounding(a: list[Emitted], b: list[Emitted]) -> bool:
    if len(a) != len(b):
        return False
    for (leaf, place, hidden), (other, other_place, other_hidden) in zip(a, b):
        if leaf is not other or hidden != other_hidden:
            return False
        limit = ROUNDING * max(1.0, *map(abs, place))
        if any(abs(x - y) > limit for x, y in zip(place, other_place)):
            return False
    return True


class Groups:
    """Adds groups to a model; equal contents become one group."""

    def __init__(self, model: Any, uids: ids.Uids, roles: ids.Roles, motion: Motion) -> None:
        self._model = model
        self._uids = uids
        self._roles = roles
        self._motion = motion
        self._above: list[Branch] = []  # branches around the one at hand, with collections
        self._made: dict[tuple, Any] = {}
        self._branches: dict[int, Branch] = {}
        self._emitters: dict[int, list[tuple[list[Emitted], Any]]] = {}
        self.unplaced: list[str] = []  # names of objects no branch holds
        self.parts: dict[ids.Key, set[Any]] = defaultdict(set)  # what a datablock became

    def build(self, context: Context, branch: Branch) -> Any | None:
        """The group of a context, or None when it shows nothing."""
        rest = dict(context.entries)
        changing: list[Placement] = []
        placements, anew = self._members(context, branch, rest, changing)
        for entry in rest.values():  # shown, but in no branch: never lose it
            extra = self._entry(entry)
            if extra:
                self.unplaced.append(entry.name)
                placements += extra
        if changing:
            uid = identity.stable_id(ids.scene_uid(branch.name), "changing")
            name = f"{branch.name} in motion"
            placements.append((self._intern(uid, name, False, changing, True), IDENTITY, name, 0))
        return self._group(branch, placements, anew)

    def _members(
        self, context: Context, branch: Branch, rest: dict[int, Entry], changing: list[Placement]
    ) -> tuple[list[Placement], bool]:
        """What of a context is in a branch, and whether it changes in an animation. What does in
        the scene itself goes to `changing`: a group of things that rest keeps its levels in every
        frame. An instanced collection is drawn as it is while it changes."""
        placements: list[Placement] = []
        anew = False
        self._above.append(branch)
        for child in branch.children:
            group = self._group(child, *self._members(context, child, rest, changing))
            if group is not None:
                placements.append((group, IDENTITY, child.name, 0))
        for key in branch.objects:
            entry = rest.pop(key, None)
            if entry is None:
                continue
            made, changes = self._entry(entry), self._changes(entry)
            if changes and context.collection is None:
                changing += made
                for above in self._above:
                    if above.collection is not None:
                        collection = ids.key_of("collection", above.collection)
                        self.parts[collection].update(placement[0] for placement in made)
            else:
                placements += made
                anew = anew or changes
        self._above.pop()
        return placements, anew

    def _changes(self, entry: Entry) -> bool:
        """Whether an animation moves it, or makes another thing of it or of what it emits."""
        motion, item = self._motion, entry.object
        if motion.moves(item) or (entry.leaf is not None and motion.deforms(item)):
            return True
        return bool(entry.emitted or entry.hair) and motion.emits_anew(item)

    def _entry(self, entry: Entry) -> list[Placement]:
        placements: list[Placement] = []
        if entry.leaf is not None:
            placements.append((entry.leaf.object, rows(entry.matrix), entry.name, entry.hidden))
        if entry.hair is not None:
            name = f"{entry.name} {HAIR}"
            placements.append((entry.hair.object, rows(entry.matrix), name, entry.hidden))
        if entry.content is not None:
            collection = entry.content.collection
            pointer = collection.as_pointer()
            if pointer not in self._branches:
                self._branches[pointer] = collection_branch(collection, self._roles)
            group = self.build(entry.content, self._branches[pointer])
            if group is not None:
                place = rows(entry.matrix @ offset(collection))
                placements.append((group, place, entry.name, entry.hidden))
        if entry.emitted:
            name = f"{entry.name} instances"
            placements.append((self._emitter(entry), IDENTITY, name, entry.hidden))
        made = (placement[0] for placement in placements)
        self.parts[ids.key_of("object", entry.object)].update(made)
        return placements

    def _emitter(self, entry: Entry) -> Any:
        """Its group of instances. In every context that shows it they are the same but for
        rounding, which must not keep the contexts from sharing one group."""
        known = self._emitters.setdefault(entry.object.original.as_pointer(), [])
        for emitted, group in known:
            if _same_but_for_rounding(emitted, entry.emitted):
                return group
        uid = identity.stable_id(ids.uid_of("object", entry.object), "instances")
        children = [(leaf.object, place, leaf.data, hid) for leaf, place, hid in entry.emitted]
        environment = self._roles.is_environment(entry.object)
        anew = self._motion.emits_anew(entry.object)
        group = self._intern(uid, f"{entry.name} instances", environment, children, anew)
        if len(children) > MOST_CHILDREN and not anew:
            self._model.group_by_position(group, MOST_CHILDREN)
        known.append((entry.emitted, group))
        return group

    def _group(
        self, branch: Branch, placements: list[Placement], changes: bool = False
    ) -> Any | None:
        if not placements:
            return None
        if branch.collection is None:
            uid = ids.scene_uid(branch.name)
        else:
            uid = ids.uid_of("collection", branch.collection)
        group = self._intern(uid, branch.name, branch.environment, placements, changes)
        if branch.collection is not None:
            self.parts[ids.key_of("collection", branch.collection)].add(group)
        return group

    def _intern(
        self,
        uid: str,
        name: str,
        environment: bool,
        placements: list[Placement],
        changes: bool = False,
    ) -> Any:
        key = (uid, environment, changes, tuple((p[0].key, *p[1:]) for p in placements))
        group = self._made.get(key)
        if group is None:
            claimed = self._uids.claim(uid)
            group = self._model.add_group(claimed, name, ids.role(environment), changes)
            self._model.add_placements(group, placements)
            self._made[key] = group
        return group
