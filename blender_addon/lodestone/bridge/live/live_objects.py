# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects as they are now, for what a viewport's levels do not know: new, edited, deforming."""

import math
import time
from collections.abc import Mapping
from typing import Any

from mathutils import Matrix

from ...core.native import lodestone_native as native
from ...core.preview.preview_worker import LiveThing
from ...core.problems import Problems
from .. import datablock_ids
from ..listed_instances import rows
from ..nodes.materials import Materials, Wanted
from ..scene import mesh_buffers
from ..scene.leaf_objects import material_slots

GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
_PLAIN = Wanted()
_GRAY = (0.8, 0.8, 0.8)


def color_of(material: Any | None) -> tuple[float, float, float]:
    """A material's base color without looking at images: its color in the viewport where it has
    one."""
    if material is None:
        return _GRAY
    value = Materials(None, Problems()).look(material, None).base_color
    found = value.color if value.texture is None else tuple(material.diffuse_color[:3])
    return tuple(min(1.0, max(0.0, part)) for part in found)  # type: ignore[return-value]


def shows_itself(item: Any) -> bool:
    """An evaluated object whose own surface is seen, and not as wires or bounds."""
    return item.type in GEOMETRY and item.display_type in {"SOLID", "TEXTURED"}


class Reader:
    """Reads evaluated objects for some time, each mesh once."""

    def __init__(self, depsgraph: Any, room: int) -> None:
        """`room` is the number of triangles that there may be."""
        self._depsgraph = depsgraph
        self._room = room
        self._model = native.Model()
        self._leaves: dict[int, tuple[Any, int] | None] = {}
        self._materials: dict[int, int] = {}
        self._placed: list[tuple[Any, Any]] = []
        self.names: set[str] = set()  # that were read
        self.too_much: set[str] = set()  # the names for which there was no room
        self.triangles = 0

    def read(self, items: Mapping[str, Any], seconds: float) -> "LiveThing | None":
        """Reads evaluated objects by name, as many as time allows and at least one; what they
        instance or emit with them. None: they show nothing."""
        end = time.monotonic() + seconds
        for name, item in items.items():
            self.names.add(name)
            if item.is_instancer:
                self._read_instances(name)
            elif shows_itself(item):
                self._place(name, item, item.matrix_world)
            if time.monotonic() > end:
                break
        return self._finished()

    def _read_instances(self, name: str) -> None:
        for instance in self._depsgraph.object_instances:
            by = instance.parent if instance.is_instance else instance.object
            if by is None or datablock_ids.name_of(by) != name:
                continue
            shown = instance.object
            if shown.hide_render or not shows_itself(shown):
                continue
            if instance.is_instance or instance.show_self:
                self._place(name, shown, instance.matrix_world)

    def _place(self, name: str, shown: Any, matrix: Any) -> None:
        key = shown.data.as_pointer()
        if key not in self._leaves:
            self._leaves[key] = self._add(shown, f"{len(self._leaves):016x}")
        leaf = self._leaves[key]
        if leaf is None:
            return
        place = tuple(rows(matrix))
        if self.triangles + leaf[1] > self._room or not all(map(math.isfinite, place)):
            self.too_much.add(name)
            return
        self.triangles += leaf[1]
        self._placed.append((leaf[0], place))

    def _add(self, shown: Any, uid: str) -> tuple[Any, int] | None:
        """None: it has no faces, or cannot be read."""
        slots = material_slots(shown)
        try:
            buffers = mesh_buffers.extract(shown, [_PLAIN] * max(1, len(slots)))
            if buffers is None:
                return None
            indices = [self._material(material) for material in slots]
            item = self._model.add_faces(uid, "", buffers, indices)
            return item, buffers.triangle_count
        except (RuntimeError, native.LodestoneError):
            return None  # F12 names it as unreadable

    def _material(self, material: Any | None) -> int:
        key = 0 if material is None else material.as_pointer()
        if key not in self._materials:
            color = color_of(material)
            self._materials[key] = self._model.add_material("", base_color=color)
        return self._materials[key]

    def _finished(self) -> LiveThing | None:
        if not self._placed:
            self._model.close()
            return None
        root = self._model.add_group("f" * 16, "")
        for child, place in self._placed:
            self._model.add_placement(root, child, place, "")
        self._model.set_root(root)
        return LiveThing(self._model)


def expected_world(item: Any) -> tuple[float, ...]:
    """The place where an evaluated object puts what it shows, as the levels' placements have it."""
    matrix = item.matrix_world
    if item.type == "EMPTY" and item.instance_type == "COLLECTION":
        collection = item.instance_collection
        if collection is not None:
            matrix = matrix @ Matrix.Translation(-collection.instance_offset)
    return tuple(rows(matrix))
