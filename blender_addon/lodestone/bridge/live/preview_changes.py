# SPDX-License-Identifier: GPL-3.0-or-later
"""The changes of a scene since its levels were built: moved, hidden and pinned things, and those
that are to be drawn as they are. Nothing of Blender's is kept but names."""

import itertools
from collections.abc import Iterable
from typing import Any, NamedTuple

import bpy

from ...core.placement_decision import UNDECIDED, Decision
from ...core.preview.preview_tree import Change, Changes, Names, Rows, Slot, Tree, same
from ...core.preview.preview_worker import MOST_TRIANGLES, LiveThing, Things
from .. import datablock_ids
from ..datablock_ids import name_of
from ..motion.motion_sampling import Motion
from . import live_objects
from .shape_fingerprints import Fingerprints

READ_S = 0.03  # seconds of a redraw, for reading what is drawn as it is
_states = itertools.count(1)
_SHOWN = live_objects.GEOMETRY | {"EMPTY", "CURVES", "POINTCLOUD"}


def names_of(scene: Any) -> Names:
    """The names of a scene's things, to find them in the store."""
    return Names(
        frozenset(name_of(item) for item in bpy.data.objects),
        {datablock_ids.uid_of("collection", item): name_of(item) for item in bpy.data.collections},
        datablock_ids.scene_uid(name_of(scene)),
    )


def decisions(tree: Tree) -> Changes:
    """The decisions for viewports about what a model places, wherever it stands now."""
    changes: Changes = {}
    for item in bpy.data.objects:
        if not datablock_ids.has_settings(item):
            continue
        decision, name = datablock_ids.decision_of(item, viewport=True), name_of(item)
        if decision != UNDECIDED:
            for slot in (*tree.objects.get(name, ()), *tree.inner.get(name, ())):
                changes[slot.key] = _with(Change(), decision)
    by_uid = {datablock_ids.uid_of("collection", item): item for item in bpy.data.collections}
    for uid, slots in tree.collections.items():
        _decide_collection(changes, slots, by_uid.get(uid))
    return changes


def any_pin() -> bool:
    """Whether viewports and renders may differ by what is decided."""
    return any(
        datablock_ids.has_settings(item)
        and (item.lodestone.use_pin_render or item.lodestone.use_pin_viewport)
        for item in itertools.chain(bpy.data.objects, bpy.data.collections)
    )


class Scene:
    """The changes of one view layer. `touched`: names of objects whose shape has changed since
    levels were built."""

    def __init__(self, touched: set[str]) -> None:
        self.things = Things()
        self.state = 0
        self._reported = set(touched)  # to have another shape
        self._touched: set[str] = set()  # that have
        self._shapes = Fingerprints()
        self._unknown: set[str] = set()  # whose shape cannot be looked at
        self.learned = False  # which shapes things have
        self._tree = Tree()
        self._deforming: dict[str, bool] = {}
        self._live: list[_Portion] = []
        self._again: set[str] = set()  # names of live objects, to be read anew
        self._inner: dict[str, Any] = {}  # for one refresh()
        self.stale = True  # refresh() has something to do

    def changed(self, depsgraph: Any) -> None:
        """Blender says that something has. Cheap; the rest is refresh()'s."""
        for update in depsgraph.updates:
            item = update.id
            if isinstance(item, bpy.types.Object):
                if item.type in _SHOWN:
                    self._again.add(name_of(item))
                    self.stale = True
            elif isinstance(item, (bpy.types.Scene, bpy.types.Collection)):
                self.stale = True

    def touch(self, names: Iterable[str]) -> None:
        """These have another shape than their levels were made of."""
        self._reported.update(names)
        self.stale = True

    def within(self, local: set[str], tree: Tree | None) -> Things:
        """The same of some objects only: of a viewport's local view."""
        changes = dict(self.things.changes)
        for name, slots in (tree or Tree()).objects.items():
            if name not in local:
                changes.update((slot.key, Change(hidden=True)) for slot in slots)
        parts = [part for part in self._live if part.names & local and part.thing is not None]
        return self.things._replace(changes=changes, live=tuple(part.thing for part in parts))

    def refresh(self, depsgraph: Any, tree: Tree | None) -> bool:
        """True when things are others than before."""
        if not self.stale:
            return False
        self.stale = False
        self._tree = tree = tree or Tree()
        shown = {
            name_of(item): item
            for item in depsgraph.objects
            if item.type in _SHOWN and not item.hide_render
        }
        self._inner = self._inner_objects(tree)
        self._judge(shown)
        live = self._live_names(depsgraph, shown, tree)
        changes: Changes = {}
        for name, slots in tree.objects.items():
            item = shown.get(name)
            gone = item is None or name in live
            world = None if item is None else live_objects.expected_world(item)
            self._change(changes, slots, self._decision(item, name), gone, world)
        for name, slots in tree.inner.items():
            self._change(changes, slots, self._decision(None, name), False, None)
        by_uid = {datablock_ids.uid_of("collection", item): item for item in bpy.data.collections}
        for uid, slots in tree.collections.items():
            _decide_collection(changes, slots, by_uid.get(uid))
        for slot in tree.lost:
            changes[slot.key] = Change(hidden=True)
        new = self._read(depsgraph, {name: shown[name] for name in sorted(live)})
        if changes == self.things.changes and not new:
            return False
        self.things = Things(
            changes,
            tuple(part.thing for part in self._live if part.thing is not None),
            len(live),
            sum(len(part.too_much) for part in self._live),
        )
        self.state = next(_states)
        return True

    def learn(self, depsgraph: Any, seconds: float) -> None:
        """Looks at shapes in idle moments, to know later whether they have changed."""
        if not self.learned and not self.stale:
            skipped = self._unknown | self._touched | self._reported
            inner = self._inner_objects(self._tree).values()
            items = itertools.chain(depsgraph.objects, inner)
            self.learned = self._shapes.learn(items, skipped, seconds)
            self._unknown |= skipped - self._touched - self._reported

    def _judge(self, shown: dict[str, Any]) -> None:
        """Whether reported things have another shape. Hidden ones are told when they are seen."""
        for name in list(self._reported):
            item = shown.get(name) or self._inner.get(name)
            if item is None:
                continue
            self._reported.discard(name)
            if _emits(item) or self._shapes.changed(name, item):
                self._touched.add(name)
            else:
                self._touched.discard(name)

    def _inner_objects(self, tree: Tree) -> dict[str, Any]:
        """Originals of objects in instanced collections, by name."""
        if not tree.inner:
            return {}
        return {name_of(item): item for item in bpy.data.objects if name_of(item) in tree.inner}

    def _live_names(self, depsgraph: Any, shown: dict[str, Any], tree: Tree) -> set[str]:
        """The names of objects that are drawn as they are."""
        motion = Motion()
        live = set()
        inside = self._touched & tree.inner.keys() - shown.keys()
        holding: dict[int, bool] = {}  # by instanced collection
        for name in self._again:
            self._deforming.pop(name, None)
        for name, item in shown.items():
            slots = tree.objects.get(name)
            if slots is None:
                if live_objects.shows_itself(item) or item.is_instancer:
                    live.add(name)
            elif name in self._touched or item.mode in {"EDIT", "SCULPT"}:
                live.add(name)
            elif inside and _instances_any(item, inside, holding):
                live.add(name)
            elif self._deforms(motion, name, item):
                live.add(name)
            elif not all(slot.follows for slot in slots):  # particles are where they were born
                own = live_objects.expected_world(item)
                if any(not same(slot.world, own) for slot in slots if slot.follows):
                    live.add(name)
        return live

    def _deforms(self, motion: Motion, name: str, item: Any) -> bool:
        if name not in self._deforming:
            self._deforming[name] = motion.deforms(item)
        return self._deforming[name]

    def _decision(self, item: Any | None, name: str) -> Decision:
        datablock = item.original if item is not None else self._inner.get(name)
        if datablock is None:
            return UNDECIDED
        return datablock_ids.decision_of(datablock, viewport=True)

    def _change(
        self,
        changes: Changes,
        slots: list[Slot],
        decision: Decision,
        gone: bool,
        world: Rows | None,
    ) -> None:
        for slot in slots:
            moved = slot.follows and world is not None and not same(slot.world, world)
            made = _with(Change(world if moved and not gone else None, gone), decision)
            if made != Change():
                changes[slot.key] = made

    def _read(self, depsgraph: Any, live: dict[str, Any]) -> bool:
        """Brings what is drawn as it is up to date, as far as time allows. True when any of it has
        changed."""
        before = len(self._live)
        self._live = [
            part
            for part in self._live
            if part.names <= live.keys() and not part.names & self._again
        ]
        self._again.clear()
        known = set().union(*(part.names for part in self._live))
        lacking = {name: item for name, item in live.items() if name not in known}
        if lacking:
            room = MOST_TRIANGLES - sum(part.triangles for part in self._live)
            reader = live_objects.Reader(depsgraph, room)
            thing = reader.read(lacking, READ_S)
            self._live.append(_Portion(reader.names, reader.too_much, reader.triangles, thing))
            self.stale = len(reader.names) < len(lacking)
        return bool(lacking) or len(self._live) != before


class _Portion(NamedTuple):
    """Objects that were read together."""

    names: set[str]
    too_much: set[str]
    triangles: int
    thing: LiveThing | None


def _emits(item: Any) -> bool:
    """Shows more than its own surface, so that this alone does not tell whether it has changed."""
    if item.instance_type in {"VERTS", "FACES"}:
        return True
    return any(modifier.type in {"NODES", "PARTICLE_SYSTEM"} for modifier in item.modifiers)


def _instances_any(item: Any, names: set[str], known: dict[int, bool]) -> bool:
    collection = item.instance_collection if item.instance_type == "COLLECTION" else None
    if collection is None:
        return False
    key = collection.as_pointer()
    if key not in known:
        known[key] = any(name_of(member) in names for member in collection.all_objects)
    return known[key]


def _decide_collection(changes: Changes, slots: list[Slot], item: Any | None) -> None:
    """Besides what is decided about what instances it."""
    decision = UNDECIDED if item is None else datablock_ids.decision_of(item, viewport=True)
    for slot in slots:
        before = changes.get(slot.key)
        if before is not None:
            outer = Decision(before.importance, before.coarsest, False, before.pinned)
            changes[slot.key] = _with(before, decision.inside(outer))
        elif decision != UNDECIDED:
            changes[slot.key] = _with(Change(), decision)


def _with(change: Change, decision: Decision) -> Change:
    return change._replace(
        importance=decision.importance, coarsest=decision.coarsest, pinned=decision.pinned
    )
