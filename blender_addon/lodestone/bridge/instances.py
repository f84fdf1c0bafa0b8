# SPDX-License-Identifier: GPL-3.0-or-later
"""What the depsgraph shows, sorted by where it comes from.

Truth is depsgraph.object_instances. An instance's path is its persistent_id read from the right:
each number is the place of an object in the `all_objects` of the collection the object before it
instances. Where a path leads through anything but instanced collections (geometry nodes,
particles, vertices), the rest of it is opaque and the instance belongs to that emitter.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from mathutils import Matrix

from ..core.problems import ERROR, WARNING, Problems
from . import ids
from .leaves import DRAWN, UNDRAWN, Leaf, Leaves

END = 2147483647  # fills the unused rest of a persistent_id
Rows = tuple[float, ...]  # 12: row-major 3x4


def rows(matrix: Matrix) -> Rows:
    return (*matrix[0], *matrix[1], *matrix[2])


@dataclass
class Entry:
    """One object in one context: what of it is shown there."""

    object: Any  # evaluated
    name: str
    matrix: Matrix  # in the context's frame
    leaf: Leaf | None = None
    content: "Context | None" = None  # of the collection it instances
    emitted: list[tuple[Leaf, Rows]] = field(default_factory=list)
    pending: bool = False  # shown, but no mesh: converted when nothing else shows it


@dataclass
class Context:
    """The scene itself, or an instanced collection as one of its instances shows it."""

    collection: Any | None  # evaluated; None: the scene
    frame: Matrix  # to the world
    members: list[Any]  # all_objects, evaluated
    environment: set[int]  # original pointers of objects whose collections are environment
    entries: dict[int, Entry] = field(default_factory=dict)  # by original pointer
    inverse: Matrix | None = None


class Instances:
    """Walks the depsgraph once. `tick()` is called often and may raise to stop."""

    def __init__(self, leaves: Leaves, problems: Problems, tick: Callable[[], None]) -> None:
        self.scene = Context(None, Matrix(), [], set())
        self.lights: list[tuple[Any, Matrix, str]] = []
        self.shown = 0
        self._leaves = leaves
        self._problems = problems
        self._tick = tick
        self._paths: dict[tuple, Entry | None] = {}
        self._collections: dict[int, tuple[list[Any], set[int]]] = {}

    def walk(self, depsgraph: Any, environment: set[int]) -> None:
        """`environment`: original pointers of the objects that an environment collection holds."""
        self.scene.environment = environment
        for number, instance in enumerate(depsgraph.object_instances):
            if number % 256 == 0:
                self._tick()
            if instance.show_self:
                self._take(instance)
        self._convert_pending()

    def _take(self, instance: Any) -> None:
        shown = instance.object
        kind = shown.type
        if kind == "LIGHT":
            self.lights.append((shown.data, instance.matrix_world.copy(), shown.name))
            return
        if kind not in DRAWN:
            if kind in UNDRAWN:
                text = f'Object "{shown.name}" is left out: {kind.lower()} is not drawn yet'
                self._problems.add(shown.name, ERROR, "object_kind", text)
            return
        matrix = instance.matrix_world
        values = rows(matrix)
        if not math.isfinite(sum(values)):
            text = f'Object "{shown.name}" is left out: its transform is not a number'
            self._problems.add(shown.name, ERROR, "bad_transform", text)
            return
        if not instance.is_instance:
            entry = self._entry(self.scene, shown)
            if kind == "MESH":
                entry.leaf = self._leaf(self.scene, shown, shown)
            else:
                entry.pending = True
            self.shown += entry.leaf is not None
            return
        self._take_instance(instance, shown, kind, matrix, values)

    def _take_instance(
        self, instance: Any, shown: Any, kind: str, matrix: Matrix, values: Rows
    ) -> None:
        owner = instance.instance_object
        path = [number for number in instance.persistent_id if number != END]
        context, entry, direct = self._find(instance.parent, tuple(reversed(path)), owner)
        if kind != "MESH":  # its mesh follows as an instance of itself
            if direct:
                entry.pending = True
            return
        leaf = self._leaf(context, shown, owner)
        if leaf is None:
            return
        self.shown += 1
        if direct:
            entry.leaf = leaf
        elif owner.type != "MESH" and entry.leaf is None and _is_self(entry, owner):
            entry.leaf = leaf
        else:
            entry.emitted.append((leaf, self._relative(context, matrix, values)))

    def _leaf(self, context: Context, shown: Any, owner: Any) -> Leaf | None:
        self_marked = ids.is_environment(owner)
        marked = self_marked or owner.original.as_pointer() in context.environment
        return self._leaves.leaf(shown, owner, marked)

    # ---- Paths ----

    def _find(self, parent: Any, path: tuple, owner: Any) -> tuple[Context, Entry, bool]:
        """The context and entry an instance belongs to, and whether it is the entry's object
        itself rather than something the entry emits."""
        context, entry = self.scene, self._entry(self.scene, parent)
        key: tuple = (entry.object.original.as_pointer(),)
        for place, number in enumerate(path):
            if entry.content is None:
                return context, entry, False
            context, key = entry.content, (*key, number)
            found = self._paths.get(key)
            if found is None:
                if number >= len(context.members):
                    return context, entry, False
                found = self._entry(context, context.members[number])
                self._paths[key] = found
            entry = found
            last = place + 1 == len(path)
            if last:
                return context, entry, _is_self(entry, owner)
        return context, entry, False

    def _entry(self, context: Context, item: Any) -> Entry:
        """The entry of an evaluated object, made when it is new."""
        key = item.original.as_pointer()
        entry = context.entries.get(key)
        if entry is None:
            entry = Entry(item, item.name, item.matrix_world.copy())
            context.entries[key] = entry
            if item.instance_type == "COLLECTION" and item.instance_collection is not None:
                entry.content = self._content(context, entry)
        return entry

    def _content(self, context: Context, entry: Entry) -> Context:
        collection = entry.object.instance_collection
        pointer = collection.as_pointer()
        if pointer not in self._collections:
            marked: set[int] = set()
            _mark(collection, False, marked)
            self._collections[pointer] = (list(collection.all_objects), marked)
        members, marked = self._collections[pointer]
        frame = context.frame @ entry.matrix @ offset(collection)
        return Context(collection, frame, members, marked)

    def _relative(self, context: Context, world: Matrix, values: Rows) -> Rows:
        if context.collection is None:
            return values
        if context.inverse is None:
            try:
                context.inverse = context.frame.inverted()
            except ValueError:  # flattened to nothing: whatever is in it, it shows nothing
                context.inverse = context.frame.inverted_safe()
        return rows(context.inverse @ world)

    # ---- Curves, texts, surfaces, metaballs that nothing shows as a mesh ----

    def _convert_pending(self) -> None:
        waiting = [self.scene]
        while waiting:
            context = waiting.pop()
            for entry in context.entries.values():
                if entry.content is not None:
                    waiting.append(entry.content)
                if entry.pending and entry.leaf is None and not entry.emitted:
                    self._tick()
                    entry.leaf = self._leaf(context, entry.object, entry.object)
                    self.shown += entry.leaf is not None


def offset(collection: Any) -> Matrix:
    """From a collection's own space to that of its instancer."""
    return Matrix.Translation(-collection.instance_offset)


def _is_self(entry: Entry, owner: Any) -> bool:
    return entry.object.original.as_pointer() == owner.original.as_pointer()


def _mark(collection: Any, inherited: bool, marked: set[int]) -> None:
    environment = inherited or ids.is_environment(collection)
    if environment:
        marked.update(item.original.as_pointer() for item in collection.objects)
    for child in collection.children:
        _mark(child, environment, marked)


def report_outside(problems: Problems, name: str) -> None:
    text = f'Object "{name}" is in none of the scene\'s collections; placed in the scene itself'
    problems.add(name, WARNING, "outside_collections", text)
