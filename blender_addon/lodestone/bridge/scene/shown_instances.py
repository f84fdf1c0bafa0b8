# SPDX-License-Identifier: GPL-3.0-or-later
"""The instances that the depsgraph shows, sorted by where they come from.

Truth is depsgraph.object_instances. An instance's path is its persistent_id read from the right:
each number is the place of an object in the `all_objects` of the collection the object before it
instances. Where a path leads through anything but instanced collections (geometry nodes,
particles, vertices), the rest of it is opaque and the instance belongs to that emitter.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

from mathutils import Matrix

from ...core.placement_decision import UNDECIDED, Decision
from ...core.problems import ERROR, INFO, WARNING, Problems
from .. import datablock_ids
from ..datablock_ids import name_of
from ..listed_instances import Listed, Rows, rows
from ..motion.motion_sampling import Motion
from . import hair_strands
from .glowing_faces import Glows
from .leaf_objects import DRAWN, GREASE_PENCIL, Leaf, Look, undrawn
from .material_users import Users
from .plain_objects import Plain, find
from .ray_visibility import RayClass, Visibility

END = 2147483647  # fills the unused rest of a persistent_id
Emitted = tuple[
    Leaf, Rows, int, Decision
]  # a leaf, its place, the ray classes it is hidden from, its decision
_ORIGINAL = attrgetter("original")


class Entry:
    """One object in one context: what of it is shown there."""

    # The values that most have, and so need not be given
    leaf: Leaf | None = None
    hidden = 0  # from these ray classes
    holdout = False
    hair: Leaf | None = None  # the hair of its particle systems
    content: "Context | None" = None  # that of the collection it instances
    emitted: list[Emitted] | tuple = ()
    decision = UNDECIDED
    pending = False  # shown, but no mesh: converted when nothing else shows it

    def __init__(self, item: Any, key: datablock_ids.Key, place: Rows) -> None:
        """An evaluated object; its transform to the context's frame."""
        self.object = item
        self.key = key
        self.place = place

    @property
    def name(self) -> str:
        return self.key[2]


@dataclass
class Context:
    """The scene itself, or an instanced collection as one of its instances shows it."""

    collection: Any | None  # evaluated; None: the scene
    frame: Matrix  # to the world
    members: list[Any]  # all_objects, evaluated
    environment: set[Any]  # originals of objects whose collections are environment
    holdout: bool = False  # all of it
    entries: dict[Any, Entry] = field(default_factory=dict)  # by original
    plain: Plain = field(default_factory=Plain)  # objects without an entry: they instance nothing
    inverse: Matrix | None = None


class Instances:
    """Walks the depsgraph once. `tick()` is called often and may raise to stop."""

    def __init__(
        self,
        leaves: Users,
        visibility: Visibility,
        roles: datablock_ids.Roles,
        motion: Motion,
        problems: Problems,
        tick: Callable[[], None],
    ) -> None:
        self.scene = Context(None, Matrix(), [], set())
        self.lights: list[tuple[Any, Matrix, str]] = []  # light, world, name
        self.glows = Glows()
        self.shown = 0
        self._leaves = leaves
        self._visibility = visibility
        self._roles = roles
        self._motion = motion
        self._problems = problems
        self._tick = tick
        self._host: Any = None  # the object that instances the instance at hand
        self._paths: dict[tuple, Entry | None] = {}
        self._collections: dict[int, tuple[list[Any], set[Any]]] = {}
        self._hidden: dict[Any, tuple[int, bool]] = {}  # emitted objects: hidden, holdout
        self._looks: dict[Any, Look] = {}  # by original, but for what the context adds
        self._keys: dict[Any, datablock_ids.Key] = {}  # by original
        self._decisions: dict[Any, Decision] = {}  # those of emitted objects, by original

    def walk(self, listed: Listed, environment: set[Any]) -> None:
        """`environment`: originals of the objects that an environment collection holds."""
        self.scene.environment = environment
        plain = self.scene.plain
        if not self._visibility.by_layer:
            plain = find(listed, environment, self._motion, self._tick)
            self.scene.plain = plain
        listed.want(plain.numbers, False)
        first = {plain.numbers[rows[0]]: rows for rows in plain.kinds}
        listed.want(first, True)
        for number, instance in listed:
            if number % 256 == 0:
                self._tick()
            alike = first.get(number)
            if alike is not None:
                if self._take_plain(instance.object, alike):
                    continue
                listed.want(map(plain.numbers.__getitem__, alike), True)
            if instance.show_self or instance.show_particles:
                self._take(instance, listed.place(number))
        self._convert_pending()

    def _take_plain(self, shown: Any, rows: list[int]) -> bool:
        """Plain objects that are made of the same, of which this is the first; what they show is
        in the columns then. False: each is something else for all that."""
        plain = self.scene.plain
        names = list(map(plain.names.__getitem__, rows))
        marked = shown.original in self.scene.environment
        look = Look(marked, deforms=self._motion.deforms(shown))
        leaf = self._leaves.leaf(datablock_ids.key_of_local(names[0]), shown, shown, look)
        if leaf is None:
            return True
        if leaf.deforms or leaf.glow is not None or not leaf.settled:
            return False
        self._leaves.shown.note(leaf, names)
        plain.settle(rows, leaf)
        self.shown += len(rows)
        return True

    def _take(self, instance: Any, place: Rows | None) -> None:
        shown = instance.object
        kind = shown.type
        if kind == "LIGHT":
            self.lights.append((shown.data, instance.matrix_world.copy(), name_of(shown)))
            return
        what = undrawn(shown)
        if what is not None:
            text = f'Object "{name_of(shown)}" is left out: {what} cannot be drawn'
            self._problems.add(name_of(shown), ERROR, "object_kind", text)
        if kind == GREASE_PENCIL:
            text = f'Object "{name_of(shown)}" is drawn by Blender, over pictures of F12 alone'
            self._problems.add(name_of(shown), INFO, "grease_pencil", text)
        if what is not None or kind not in DRAWN:
            return
        if place is None:
            return self._name_bad_place(name_of(shown))
        # While anybody in Python knows an evaluated object, its instances are handed out as that
        # object itself, in its own color: it is asked of what instances it.
        self._host = None
        if instance.is_instance:
            owner, self._host = instance.instance_object, instance.parent
            path = [number for number in instance.persistent_id if number != END]
            found = self._find(self._host, tuple(reversed(path)), owner)
        else:
            owner, found = shown, (self.scene, self._entry(self.scene, shown), True)
        matrix = instance.matrix_world
        if instance.show_self:
            self._take_data(shown, owner, matrix, instance.is_instance, *found)
        if instance.show_particles and kind == "MESH":
            self._take_hair(shown, owner, matrix, *found)

    def _name_bad_place(self, name: str) -> None:
        text = f'Object "{name}" is left out: its transform is not a number'
        self._problems.add(name, ERROR, "bad_transform", text)

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
        look = self._look(context, entry, owner)
        leaf = self._leaves.leaf(self._key(owner), shown, owner, look, self._host, matrix)
        if leaf is None:
            return
        self.shown += 1
        hidden = self._glows(leaf, matrix, entry, owner)
        own = is_instance and owner.type != "MESH" and _is_self(entry, owner)
        if direct and entry.leaf is None or own and entry.leaf is None:
            entry.leaf = leaf
            entry.hidden |= hidden
        else:
            self._emit(leaf, owner, matrix, context, entry, hidden)

    def _glows(self, leaf: Leaf, matrix: Matrix, entry: Entry, owner: Any) -> int:
        """Notes what shines; returns the ray classes that must not see it therefore."""
        if leaf.glow is None:
            return 0
        hidden = entry.hidden | (0 if _is_self(entry, owner) else self._seen(owner)[0])
        if hidden & RayClass.RADIOSITY:  # it lights nothing in Cycles
            return 0
        return self.glows.add(leaf.glow, matrix, name_of(owner))

    def _take_hair(
        self, shown: Any, owner: Any, matrix: Matrix, context: Context, entry: Entry, direct: bool
    ) -> None:
        self._tick()
        look = self._look(context, entry, owner)
        if self._motion.emits_anew(owner):
            look = look._replace(deforms=True)
        leaf = self._leaves.hair(self._key(owner), shown, owner, look, self._host, matrix)
        if leaf is None:
            return
        self.shown += 1
        self._glows(leaf, matrix, entry, owner)
        if direct:
            entry.hair = leaf
        else:
            self._emit(leaf, owner, matrix, context, entry)

    def _take_points(
        self, shown: Any, owner: Any, matrix: Matrix, context: Context, entry: Entry
    ) -> None:
        points = hair_strands.point_cloud(shown.data)
        if not points:
            return
        look = self._look(context, entry, owner)
        leaf = self._leaves.point(self._key(owner), shown, owner, look, self._host, matrix)
        self._glows(leaf, matrix, entry, owner)
        for center, radius in points:
            place = matrix @ Matrix.Translation(center) @ Matrix.Scale(radius, 4)
            self._emit(leaf, owner, place, context, entry)
        self.shown += len(points)

    def _emit(
        self,
        leaf: Leaf,
        owner: Any,
        matrix: Matrix,
        context: Context,
        entry: Entry,
        hidden: int = 0,
    ) -> None:
        own = UNDECIDED
        if not _is_self(entry, owner):
            hidden |= self._seen(owner)[0]
            own = self._decision(owner)
        if not entry.emitted:
            entry.emitted = []
        entry.emitted.append((leaf, self._relative(context, matrix), hidden, own))

    def _look(self, context: Context, entry: Entry, owner: Any) -> Look:
        original = owner.original
        look = self._looks.get(original)
        if look is None:
            marked = self._roles.is_environment(owner)
            deforms, loose = self._motion.deforms(owner), datablock_ids.loose_parts(owner)
            look = self._looks[original] = Look(
                marked, self._roles.is_ordinary(owner), deforms=deforms, loose=loose
            )
        if original in context.environment:
            look = look._replace(environment=True)
        if entry.holdout or (original != entry.object.original and self._seen(owner)[1]):
            look = look._replace(holdout=True)
        return look

    def _seen(self, owner: Any) -> tuple[int, bool]:
        """Ray classes that an emitted object is hidden from, and whether it is a holdout."""
        original = owner.original
        if original not in self._hidden:
            seen = self._visibility
            self._hidden[original] = (seen.hidden(owner, False), seen.holdout(owner, False))
        return self._hidden[original]

    def _decision(self, owner: Any) -> Decision:
        original = owner.original
        if original not in self._decisions:
            self._decisions[original] = datablock_ids.decision_of(owner)
        return self._decisions[original]

    def _key(self, item: Any) -> datablock_ids.Key:
        original = item.original
        key = self._keys.get(original)
        if key is None:
            key = self._keys[original] = datablock_ids.key_of("object", item)
        return key

    # ---- Paths ----

    def _find(self, parent: Any, path: tuple, owner: Any) -> tuple[Context, Entry, bool]:
        """The context and entry an instance belongs to, and whether it is the entry's object
        itself rather than something the entry emits."""
        context, entry = self.scene, self._entry(self.scene, parent)
        key: tuple = (entry.object.original,)
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
        original = item.original
        entry = context.entries.get(original)
        if entry is None:
            in_scene = context.collection is None
            entry = Entry(item, self._key(item), rows(item.matrix_world))
            entry.hidden = self._visibility.hidden(item, in_scene)
            entry.decision = datablock_ids.decision_of(item)
            entry.holdout = context.holdout or self._visibility.holdout(item, in_scene)
            if entry.holdout and not context.holdout:
                self._visibility.name_holdout(entry.name)
            context.entries[original] = entry
            if item.instance_type == "COLLECTION" and item.instance_collection is not None:
                entry.content = self._content(context, entry)
        return entry

    def _content(self, context: Context, entry: Entry) -> Context:
        collection = entry.object.instance_collection
        pointer = collection.as_pointer()
        if pointer not in self._collections:
            marked: set[Any] = set()
            _mark(collection, False, marked, self._roles)
            self._collections[pointer] = (list(collection.all_objects), marked)
        members, marked = self._collections[pointer]
        frame = context.frame @ entry.object.matrix_world @ offset(collection)
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
                    entry.leaf = self._leaves.leaf(entry.key, entry.object, entry.object, look)
                    if entry.leaf is not None:
                        self.shown += 1
                        world = context.frame @ entry.object.matrix_world
                        entry.hidden |= self._glows(entry.leaf, world, entry, entry.object)


def offset(collection: Any) -> Matrix:
    """The transform from a collection's own space to that of its instancer."""
    return Matrix.Translation(-collection.instance_offset)


def _is_self(entry: Entry, owner: Any) -> bool:
    return entry.object.original == owner.original


def _mark(collection: Any, inherited: bool, marked: set[Any], roles: datablock_ids.Roles) -> None:
    environment = inherited or roles.is_environment(collection)
    if environment:
        marked.update(map(_ORIGINAL, collection.objects))
    for child in collection.children:
        _mark(child, environment, marked, roles)


def report_outside(problems: Problems, name: str) -> None:
    text = f'Object "{name}" is in none of the scene\'s collections; placed in the scene itself'
    problems.add(name, WARNING, "outside_collections", text)
