# SPDX-License-Identifier: GPL-3.0-or-later
"""What the depsgraph shows, sorted by where it comes from.

Truth is depsgraph.object_instances. An instance's path is its persistent_id read from the right:
each number is the place of an object in the `all_objects` of the collection the object before it
instances. Where a path leads through anything but instanced collections (geometry nodes,
particles, vertices), the rest of it is opaque and the instance belongs to that emitter.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from mathutils import Matrix

from ..core.problems import ERROR, WARNING, Problems
from . import ids, strands
from .leaves import DRAWN, Leaf, Leaves, Look, undrawn
from .motion import Motion
from .visibility import Visibility

END = 2147483647  # fills the unused rest of a persistent_id
Rows = tuple[float, ...]  # 12: row-major 3x4
Emitted = tuple[Leaf, Rows, int]  # what, where, hidden from which ray classes


def rows(matrix: Matrix) -> Rows:
    x, y, z, _ = matrix  # half the time of asking for one after the other
    return x[:] + y[:] + z[:]


@dataclass
class Entry:
    """One object in one context: what of it is shown there."""

    object: Any  # evaluated
    name: str
    matrix: Matrix  # in the context's frame
    hidden: int  # from these ray classes
    holdout: bool
    leaf: Leaf | None = None
    hair: Leaf | None = None  # of its particle systems
    content: "Context | None" = None  # of the collection it instances
    emitted: list[Emitted] = field(default_factory=list)
    pending: bool = False  # shown, but no mesh: converted when nothing else shows it


@dataclass
class Context:
    """The scene itself, or an instanced collection as one of its instances shows it."""

    collection: Any | None  # evaluated; None: the scene
    frame: Matrix  # to the world
    members: list[Any]  # all_objects, evaluated
    environment: set[int]  # original pointers of objects whose collections are environment
    holdout: bool = False  # all of it
    entries: dict[int, Entry] = field(default_factory=dict)  # by original pointer
    inverse: Matrix | None = None


class Instances:
    """Walks the depsgraph once. `tick()` is called often and may raise to stop."""

    def __init__(
        self,
        leaves: Leaves,
        visibility: Visibility,
        roles: ids.Roles,
        motion: Motion,
        problems: Problems,
        tick: Callable[[], None],
    ) -> None:
        self.scene = Context(None, Matrix(), [], set())
        self.lights: list[tuple[Any, Matrix, str]] = []
        self.shown = 0
        self._leaves = leaves
        self._visibility = visibility
        self._roles = roles
        self._motion = motion
        self._problems = problems
        self._tick = tick
        self._host: Any = None  # what instances the instance at hand
        self._paths: dict[tuple, Entry | None] = {}
        self._collections: dict[int, tuple[list[Any], set[int]]] = {}
        self._hidden: dict[int, tuple[int, bool]] = {}  # of emitted objects: hidden, holdout

    def walk(self, depsgraph: Any, environment: set[int]) -> None:
        """`environment`: original pointers of the objects that an environment collection holds."""
        self.scene.environment = environment
        for number, instance in enumerate(depsgraph.object_instances):
            if number % 256 == 0:
                self._tick()
            if instance.show_self or instance.show_particles:
                self._take(instance)
        self._convert_pending()

    def _take(self, instance: Any) -> None:
        shown = instance.object
        kind = shown.type
        if kind == "LIGHT":
            self.lights.append((shown.data, instance.matrix_world.copy(), shown.name))
            return
        what = undrawn(shown)
        if what is not None:
            text = f'Object "{shown.name}" is left out: {what} cannot be drawn'
            self._problems.add(shown.name, ERROR, "object_kind", text)
        if what is not None or kind not in DRAWN:
            return
        matrix = instance.matrix_world
        if not math.isfinite(sum(rows(matrix))):
            text = f'Object "{shown.name}" is left out: its transform is not a number'
            self._problems.add(shown.name, ERROR, "bad_transform", text)
            return
        # While anybody in Python knows an evaluated object, its instances are handed out as that
        # object itself, in its own color: it is asked of what instances it.
        self._host = None
        if instance.is_instance:
            owner, self._host = instance.instance_object, instance.parent
            path = [number for number in instance.persistent_id if number != END]
            found = self._find(self._host, tuple(reversed(path)), owner)
        else:
            owner, found = shown, (self.scene, self._entry(self.scene, shown), True)
        if instance.show_self:
            self._take_data(shown, owner, matrix, instance.is_instance, *found)
        if instance.show_particles and kind == "MESH":
            self._take_hair(shown, owner, matrix, *found)

    def _take_data(
        self,
        shown: Any,
        owner: Any,
        matrix: Matrix,
        is_instance: bool,
        context: Context,
        entry: Entry,
        direct: bool,
    ) -> None:
        kind = shown.type
        if kind == "POINTCLOUD":
            self._take_points(shown, owner, matrix, context, entry)
            return
        if kind not in ("MESH", "CURVES"):  # its mesh follows as an instance of itself
            entry.pending = entry.pending or direct
            return
        leaf = self._leaves.leaf(
            shown, owner, self._look(context, entry, owner), self._host, matrix
        )
        if leaf is None:
            return
        self.shown += 1
        own = is_instance and owner.type != "MESH" and _is_self(entry, owner)
        if direct and entry.leaf is None or own and entry.leaf is None:
            entry.leaf = leaf
        else:
            self._emit(leaf, owner, matrix, context, entry)

    def _take_hair(
        self, shown: Any, owner: Any, matrix: Matrix, context: Context, entry: Entry, direct: bool
    ) -> None:
        self._tick()
        look = self._look(context, entry, owner)
        if self._motion.emits_anew(owner):
            look = replace(look, deforms=True)
        leaf = self._leaves.hair(shown, owner, look, self._host, matrix)
        if leaf is None:
            return
        self.shown += 1
        if direct:
            entry.hair = leaf
        else:
            self._emit(leaf, owner, matrix, context, entry)

    def _take_points(
        self, shown: Any, owner: Any, matrix: Matrix, context: Context, entry: Entry
    ) -> None:
        points = strands.point_cloud(shown.data)
        if not points:
            return
        leaf = self._leaves.point(
            shown, owner, self._look(context, entry, owner), self._host, matrix
        )
        for center, radius in points:
            place = matrix @ Matrix.Translation(center) @ Matrix.Scale(radius, 4)
            self._emit(leaf, owner, place, context, entry)
        self.shown += len(points)

    def _emit(self, leaf: Leaf, owner: Any, matrix: Matrix, context: Context, entry: Entry) -> None:
        hidden = 0 if _is_self(entry, owner) else self._seen(owner)[0]
        entry.emitted.append((leaf, self._relative(context, matrix), hidden))

    def _look(self, context: Context, entry: Entry, owner: Any) -> Look:
        pointer = owner.original.as_pointer()
        marked = pointer in context.environment or self._roles.is_environment(owner)
        holdout = entry.holdout or (not _is_self(entry, owner) and self._seen(owner)[1])
        return Look(marked, holdout, self._motion.deforms(owner))

    def _seen(self, owner: Any) -> tuple[int, bool]:
        """Ray classes that an emitted object is hidden from, and whether it is a holdout."""
        key = owner.original.as_pointer()
        if key not in self._hidden:
            visibility = self._visibility
            self._hidden[key] = (visibility.hidden(owner, False), visibility.holdout(owner, False))
        return self._hidden[key]

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
            in_scene = context.collection is None
            hidden = self._visibility.hidden(item, in_scene)
            holdout = context.holdout or self._visibility.holdout(item, in_scene)
            if holdout and not context.holdout:
                self._visibility.name_holdout(item.name)
            entry = Entry(item, item.name, item.matrix_world.copy(), hidden, holdout)
            context.entries[key] = entry
            if item.instance_type == "COLLECTION" and item.instance_collection is not None:
                entry.content = self._content(context, entry)
        return entry

    def _content(self, context: Context, entry: Entry) -> Context:
        collection = entry.object.instance_collection
        pointer = collection.as_pointer()
        if pointer not in self._collections:
            marked: set[int] = set()
            _mark(collection, False, marked, self._roles)
            self._collections[pointer] = (list(collection.all_objects), marked)
        members, marked = self._collections[pointer]
        frame = context.frame @ entry.matrix @ offset(collection)
        return Context(collection, frame, members, marked, entry.holdout)

    def _relative(self, context: Context, world: Matrix) -> Rows:
        if context.collection is None:
            return rows(world)
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
                    look = self._look(context, entry, entry.object)
                    entry.leaf = self._leaves.leaf(entry.object, entry.object, look)
                    self.shown += entry.leaf is not None


def offset(collection: Any) -> Matrix:
    """From a collection's own space to that of its instancer."""
    return Matrix.Translation(-collection.instance_offset)


def _is_self(entry: Entry, owner: Any) -> bool:
    return entry.object.original.as_pointer() == owner.original.as_pointer()


def _mark(collection: Any, inherited: bool, marked: set[int], roles: ids.Roles) -> None:
    environment = inherited or roles.is_environment(collection)
    if environment:
        marked.update(item.original.as_pointer() for item in collection.objects)
    for child in collection.children:
        _mark(child, environment, marked, roles)


def report_outside(problems: Problems, name: str) -> None:
    text = f'Object "{name}" is in none of the scene\'s collections; placed in the scene itself'
    problems.add(name, WARNING, "outside_collections", text)
