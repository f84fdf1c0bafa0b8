# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaf objects: each drawn mesh with its materials, extracted once however often it is placed."""

from dataclasses import dataclass
from typing import Any

from ..core import identity
from ..core.problems import ERROR, Problems
from . import ids, mesh
from .materials import Materials

DRAWN = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
UNDRAWN = {"CURVES", "POINTCLOUD", "VOLUME", "GPENCIL"}


@dataclass(frozen=True)
class Leaf:
    """An added object, and what it shows by Blender's names."""

    object: Any  # lodestone_native.Object
    uid: str
    data: str
    materials: tuple[str, ...]
    triangles: int


class Leaves:
    def __init__(self, model: Any, scene: Any, uids: ids.Uids, problems: Problems) -> None:
        self._model = model
        self._scene = scene
        self._uids = uids
        self._problems = problems
        self._materials = Materials(model, problems)
        self._found: dict[tuple, Leaf | None] = {}
        self._emitted: dict[str, int] = {}

    def __iter__(self) -> Any:
        return (leaf for leaf in self._found.values() if leaf is not None)

    def leaf(self, shown: Any, owner: Any, environment: bool) -> Leaf | None:
        """Of an evaluated object as a depsgraph instance shows it; `owner` is the evaluated object
        that shows it (they differ in their data where nodes make a mesh). None: it has no faces.
        """
        slots = material_slots(shown)
        key = (
            shown.data.as_pointer(),
            tuple(m.as_pointer() if m else 0 for m in slots),
            environment,
        )
        if key not in self._found:
            self._found[key] = self._extract(shown, owner, slots, environment)
        return self._found[key]

    def _extract(self, shown: Any, owner: Any, slots: list, environment: bool) -> Leaf | None:
        indices = [self._materials.index(material) for material in slots]
        textured = any(self._materials.textured(material) for material in slots)
        try:
            buffers = mesh.extract(shown, len(slots), textured)
        except RuntimeError as error:
            text = f'Object "{owner.name}" cannot be read and is left out: {error}'
            self._problems.add(owner.name, ERROR, "mesh_unreadable", text)
            return None
        if buffers is None:
            return None
        uid, name = self._name(shown, owner, slots, environment)
        item = self._model.add_mesh(uid, name, buffers, indices, ids.role(environment))
        names = tuple(material.name if material else "" for material in slots)
        return Leaf(item, uid, shown.data.name, names, len(buffers.triangles) // 3)

    def _name(self, shown: Any, owner: Any, slots: list, environment: bool) -> tuple[str, str]:
        """Its uid and name: a shared mesh's own, else those of the object that shows it."""
        if shown.type != "MESH" or owner.type != "MESH":
            base, name = ids.uid_of("object", owner), owner.name
        elif shown.data.as_pointer() != owner.data.as_pointer():  # made by nodes
            base = identity.stable_id(ids.uid_of("object", owner), "nodes", shown.data.name)
            name = f"{owner.name}: {shown.data.name}"
        elif owner.is_modified(self._scene, "RENDER"):
            base, name = ids.uid_of("object", owner), owner.name
        else:
            base = ids.uid_of("mesh", shown.data)
            name = shown.data.name
            own = [ids.named_id_of(m) for m in shown.data.materials]
            if own != [ids.named_id_of(m) for m in slots]:  # materials linked to the object
                base = identity.stable_id(base, *(ids.named_id_of(m) for m in slots))
        if environment:
            base = identity.stable_id(base, "environment")
        return self._uids.claim(base), name


def material_slots(shown: Any) -> list[Any]:
    """Resolved materials by slot, those linked to the object included."""
    if shown.data is None:  # material_slots of an evaluated empty crash Blender 3.4
        return []
    return [slot.material for slot in shown.material_slots]
