# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that move or change their shape in the course of an animation.

Things that move are not grouped with those that rest, and nothing stands in for things that change
their shape: levels would be those of one frame. `Motion` tells from how objects are animated, which
errs towards "changes"; `sample()` looks at the evaluated objects of a few frames and knows better.
"""

import functools
import hashlib
from array import array
from collections.abc import Callable, Iterable
from typing import Any

from .. import datablock_ids

# Modifiers that make another mesh of the same inputs as time goes by
_IN_TIME = {
    "BUILD",
    "CLOTH",
    "DYNAMIC_PAINT",
    "EXPLODE",
    "FLUID",
    "MESH_CACHE",
    "MESH_SEQUENCE_CACHE",
    "OCEAN",
    "PARTICLE_INSTANCE",
    "SOFT_BODY",
    "SURFACE",
    "WAVE",
}
_TIME_NODES = {"INPUT_SCENE_TIME", "SIMULATION_INPUT", "SIMULATION_OUTPUT"}
_MOST_NESTED = 32


def animated(datablock: Any | None) -> bool:
    """An action, a strip or a driver."""
    data = getattr(datablock, "animation_data", None)
    if data is None:
        return False
    return data.action is not None or len(data.drivers) > 0 or len(data.nla_tracks) > 0


class Motion:
    """The motion of one scene, by how its objects are animated; `known` are sample()'s findings."""

    def __init__(self, known: dict[str, list[str]] | None = None) -> None:
        self._known = {kind: set(uids) for kind, uids in (known or {}).items()}
        self._moves: dict[int, bool] = {}
        self._trees: dict[int, bool] = {}

    def deforms(self, item: Any) -> bool:
        """The object's mesh may differ from frame to frame."""
        return self._may_deform(item) and not self._found_still(item, "shape")

    def moves(self, item: Any) -> bool:
        """Whether its place may differ."""
        return self._may_move(item) and not self._found_still(item, "place")

    def emits_anew(self, item: Any) -> bool:
        """Whether what it emits (particles, nodes' instances) may be elsewhere or something
        else."""
        for system in item.particle_systems:
            settings = system.settings
            if settings.type == "EMITTER" or system.use_hair_dynamics or animated(settings):
                return True
        return any(self._modifier(item, m) for m in item.modifiers if m.show_render)

    def _found_still(self, item: Any, kind: str) -> bool:
        return datablock_ids.uid_of("object", item) in self._known.get(f"still_{kind}", ())

    # ---- Places ----

    def _may_move(self, item: Any, depth: int = 0) -> bool:
        key = item.original.as_pointer()
        if key not in self._moves:
            self._moves[key] = False  # a ring of parents ends here
            self._moves[key] = depth < _MOST_NESTED and self._moved_by(item, depth + 1)
        return self._moves[key]

    def _moved_by(self, item: Any, depth: int) -> bool:
        if animated(item):
            return True
        body = item.rigid_body
        if body is not None and body.type == "ACTIVE" and body.enabled:
            return True
        parent = item.parent
        if parent is not None and (self._may_move(parent, depth) or self._pose_moves(parent)):
            return True
        for constraint in item.constraints:
            if constraint.mute:
                continue
            target = getattr(constraint, "target", None)
            if target is None or self._may_move(target, depth) or self._pose_moves(target):
                return True
            if animated(target.data):  # a path's evaluation time
                return True
        return False

    def _pose_moves(self, item: Any) -> bool:
        """A rig whose bones move: its action is the object's own; bones may follow others too."""
        if item.type != "ARMATURE" or item.pose is None:
            return False
        return animated(item) or any(len(bone.constraints) for bone in item.pose.bones)

    # ---- Shapes ----

    def _may_deform(self, item: Any) -> bool:
        data = item.data
        if data is None:
            return False
        keys = getattr(data, "shape_keys", None)
        if animated(data) or animated(keys) or self._animates(item, "modifiers["):
            return True
        if item.type == "META":  # one surface of all balls of its name
            return True
        if item.soft_body is not None:
            return True
        return any(self._modifier(item, m) for m in item.modifiers if m.show_render)

    def _animates(self, item: Any, start: str) -> bool:
        data = item.animation_data
        if data is None:
            return False
        curves = list(data.drivers) + list(data.action.fcurves if data.action else [])
        return len(data.nla_tracks) > 0 or any(c.data_path.startswith(start) for c in curves)

    def _modifier(self, item: Any, modifier: Any) -> bool:
        kind = modifier.type
        if kind in _IN_TIME:
            return True
        if kind == "PARTICLE_SYSTEM":
            return False  # the particles move, not the mesh
        if kind == "NODES":
            tree = modifier.node_group
            if tree is not None and self._in_time(tree, 0):
                return True
        for target in _targets(modifier):
            if target.original.as_pointer() == item.original.as_pointer():
                continue
            if self._pose_moves(target) or animated(target.data):
                return True
            if self._may_move(target) or self._may_move(item):
                return True  # unless they move as one: sample() finds out
        return False

    def _in_time(self, tree: Any, depth: int) -> bool:
        key = tree.original.as_pointer()
        if key not in self._trees:
            self._trees[key] = False
            self._trees[key] = animated(tree) or any(
                node.type in _TIME_NODES
                or (
                    node.type == "GROUP"
                    and node.node_tree is not None
                    and depth < _MOST_NESTED
                    and self._in_time(node.node_tree, depth + 1)
                )
                or (node.type == "OBJECT_INFO" and self._node_object_moves(node))
                for node in tree.nodes
            )
        return self._trees[key]

    def _node_object_moves(self, node: Any) -> bool:
        target = node.inputs[0].default_value
        return target is not None and (self._may_move(target) or animated(target.data))


@functools.cache
def _object_properties(kind: type) -> list[str]:
    """The names of those properties of a type of modifier that are objects."""
    return [
        name
        for name, prop in kind.bl_rna.properties.items()
        if prop.type == "POINTER" and prop.fixed_type.identifier == "Object"
    ]


def _targets(modifier: Any) -> Iterable[Any]:
    """The objects a modifier looks at, its nodes' inputs included."""
    for name in _object_properties(type(modifier)):
        target = getattr(modifier, name)
        if target is not None:
            yield target
    if modifier.type == "NODES":
        for key in modifier.keys():
            value = modifier[key]
            if getattr(getattr(value, "bl_rna", None), "identifier", "") == "Object":
                yield value


class Still(Motion):
    """The motion of a scene in which nothing changes, or what does is to be simplified in each
    frame anew."""

    def deforms(self, item: Any) -> bool:
        return False

    def moves(self, item: Any) -> bool:
        return False

    def emits_anew(self, item: Any) -> bool:
        return False


# ---- Sampling ----


def frames_to_sample(first: int, last: int, count: int = 4) -> list[int]:
    """First, last and evenly between, each once."""
    count = min(count, last - first + 1)
    if count < 2:
        return [first]
    return sorted({first + round(i * (last - first) / (count - 1)) for i in range(count)})


def sample(
    scene: Any, view_layer: Any, frames: Iterable[int], tick: Callable[[], None] = lambda: None
) -> dict[str, list[str]]:
    """Evaluates the scene at each frame (and at its own again afterwards) and compares what might
    move or deform. Returns the uids of what turned out not to: {"still_shape", "still_place"}.
    `tick()` is called between objects. On the main thread, not while rendering."""
    motion = Motion()
    before = scene.frame_current, scene.frame_subframe
    shapes: dict[str, set[bytes]] = {}
    places: dict[str, set[bytes]] = {}
    try:
        for frame in frames:
            scene.frame_set(frame)
            depsgraph = view_layer.depsgraph
            for item in view_layer.objects:
                shape, place = motion.deforms(item), motion.moves(item)
                if not (shape or place):
                    continue
                tick()
                uid = datablock_ids.uid_of("object", item)
                evaluated = item.evaluated_get(depsgraph)
                if place:
                    places.setdefault(uid, set()).add(_place(evaluated))
                if shape:
                    shapes.setdefault(uid, set()).add(_shape(evaluated))
    finally:
        scene.frame_set(before[0], subframe=before[1])
    return {
        "still_shape": sorted(uid for uid, seen in shapes.items() if len(seen) == 1),
        "still_place": sorted(uid for uid, seen in places.items() if len(seen) == 1),
    }


def _place(evaluated: Any) -> bytes:
    return array("f", (value for row in evaluated.matrix_world for value in row)).tobytes()


def _shape(evaluated: Any) -> bytes:
    """The hash of an evaluated mesh's positions and its counts."""
    try:
        mesh = evaluated.to_mesh()
    except RuntimeError:
        return b""
    try:
        if mesh is None:
            return b""
        positions = array("f", bytes(12 * len(mesh.vertices)))
        mesh.vertices.foreach_get("co", positions)
        counts = array("q", (len(mesh.vertices), len(mesh.edges), len(mesh.polygons)))
        return hashlib.blake2b(counts.tobytes() + positions.tobytes(), digest_size=16).digest()
    finally:
        evaluated.to_mesh_clear()
