# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaf objects: each drawn mesh with its materials, extracted once however often it is placed."""

from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any, NamedTuple

from ...core import object_random, stable_ids
from ...core.native import lodestone_native as native
from ...core.problems import ERROR, Problems
from .. import datablock_ids
from ..datablock_ids import name_of
from ..nodes.materials import Materials
from . import hair_strands, mesh_buffers, mesh_uvs
from .glowing_faces import Glow, glow_of

DRAWN = {"MESH", "CURVE", "SURFACE", "FONT", "META", "CURVES", "POINTCLOUD"}
UNDRAWN = {"VOLUME": "volumes"}
GREASE_PENCIL = "GPENCIL"  # Blender draws it over the picture of any engine
HAIR = "hair"  # the hair of particles; also in the names of leaves
POINT = "point"
MOST_IN_PLACE = 1_000_000  # corners of meshes that are not copied: Blender keeps 12 MB for them
Color = tuple[float, ...]  # RGBA, and Random where any material shows it
WHITE = (1.0, 1.0, 1.0, 1.0)
MATERIAL = attrgetter("material")


def _random_of(shown: Any, host: Any) -> float:
    """Object Info's Random: one of a few values where many objects may share a mesh, for each has
    levels of its own."""
    value = object_random.random_of(name_of(shown), name_of(host) if host else "")
    return value if shown.original.data.users == 1 and not host else object_random.graded(value)


def undrawn(shown: Any) -> str | None:
    """The name of what an object shows that cannot be drawn, in the plural. From a domain of smoke
    Cycles draws the smoke alone: as a mesh it would be a box around what burns."""
    if shown.type == "MESH":
        for modifier in shown.modifiers:
            if modifier.type == "FLUID" and modifier.fluid_type == "DOMAIN":
                if modifier.domain_settings.domain_type == "GAS":
                    return "smoke and fire"
    return UNDRAWN.get(shown.type)


@dataclass(frozen=True, eq=False)
class Leaf:
    """An added object, and what it shows by Blender's names."""

    object: Any  # lodestone_native.Object
    uid: str
    data: str
    materials: tuple[str, ...]
    size: int  # triangles of a mesh, strands of hair, 1 of a point
    deforms: bool = False  # see Look
    settled: bool = True  # it is the same whoever shows it, and wherever
    glow: Glow | None = None
    loose: str = "ONE"  # whether its mesh is one object: see datablock_ids.loose_parts()


class Look(NamedTuple):
    """The settings that decide how an object's data are drawn, besides the data and its
    materials."""

    environment: bool = False
    ordinary: bool = False
    holdout: bool = False  # all its materials are black
    deforms: bool = False  # its shape is another one in every frame
    loose: str = datablock_ids.AUTOMATIC  # see datablock_ids.loose_parts()


class Leaves:
    def __init__(
        self,
        model: Any,
        scene: Any,
        uids: datablock_ids.Uids,
        problems: Problems,
        override: Any = None,
    ) -> None:
        """`override`: the material that all wear (see override_of())."""
        self._model = model
        self.override = override
        self._scene = scene
        self._uids = uids
        self._problems = problems
        self._materials = Materials(model, problems, frame=scene.frame_current)
        self._varying: dict[tuple, tuple[bool, bool, list | None]] = {}  # by materials
        self._black: int | None = None
        self._place: Any = None  # world matrix of the instance at hand
        self._in_place = MOST_IN_PLACE  # corners of meshes that may still be read where they are
        self._found: dict[tuple, Leaf | None] = {}

    def __iter__(self) -> Any:
        return (leaf for leaf in self._found.values() if leaf is not None)

    def leaf(
        self, shown: Any, owner: Any, look: Look, host: Any = None, place: Any = None
    ) -> Leaf | None:
        """The leaf of an evaluated object as a depsgraph instance shows it; `owner` is the
        evaluated object that shows it (they differ in their data where nodes make a mesh), `host`
        what instances it and gives it its color, `place` its world matrix (that of an instance is
        not its object's). None: it has no faces and no hairs."""
        return self._get(shown.data.as_pointer(), shown, owner, look, host, place, self._add_data)

    def hair(
        self, shown: Any, owner: Any, look: Look, host: Any = None, place: Any = None
    ) -> Leaf | None:
        """The leaf of an evaluated object's particle hair."""
        key = (HAIR, shown.original.as_pointer())
        return self._get(key, shown, owner, look, host, place, self._add_hair)

    def point(
        self, shown: Any, owner: Any, look: Look, host: Any = None, place: Any = None
    ) -> Leaf | None:
        """The ball of radius 1 that every point of this point cloud shows."""
        key = (POINT, shown.data.as_pointer())
        return self._get(key, shown, owner, look, host, place, self._add_point)

    def _get(
        self, data: Any, shown: Any, owner: Any, look: Look, host: Any, place: Any, add: Any
    ) -> Leaf | None:
        slots = material_slots(shown, self.override)
        materials = tuple(material.as_pointer() if material else 0 for material in slots)
        place = shown.matrix_world if place is None else place
        color, frames = self._seen_from(place, shown, host, slots, materials)
        key = (data, materials, color, frames, look)
        if key not in self._found:
            self._place = place
            leaf = add(shown, owner, slots, color, look)
            if leaf is not None:
                settled, glow = color is None and frames is None, None
                if not look.holdout:
                    looks = [self._materials.look(material, color) for material in slots]
                    glow = glow_of(shown, slots, looks, add == self._add_data)
                if glow is not None or not settled:
                    leaf = replace(leaf, settled=settled, glow=glow)
            self._found[key] = leaf
        return self._found[key]

    def _seen_from(
        self, place: Any, shown: Any, host: Any, slots: list, materials: tuple
    ) -> tuple[Color | None, tuple | None]:
        """The values of the object that its materials show: its color and Random, and where it is
        seen from others."""
        if materials not in self._varying:
            wanted = [self._materials.wanted(material) for material in slots]
            varying = [self._materials.varies(material) for material in slots]
            self._varying[materials] = (
                any(by_color for by_color, _ in varying),
                any(by_random for _, by_random in varying),
                wanted if mesh_uvs.depend_on_place(wanted) else None,
            )
        colored, random, wanted = self._varying[materials]
        color = tuple((host or shown).color) if colored else None
        if random:
            color = (*(color or WHITE), _random_of(shown, host))
        return color, mesh_uvs.frames(place, wanted) if wanted else None

    # ---- What they are made of ----

    def _add_data(
        self, shown: Any, owner: Any, slots: list, color: Color | None, look: Look
    ) -> Leaf | None:
        indices = self._indices(slots, color, look)
        try:
            if shown.type == "CURVES":
                buffers = hair_strands.curves(shown.data)
                size = 0 if buffers is None else len(buffers.counts)
            else:
                wanted = [self._materials.wanted(material, color) for material in slots]
                wanted = mesh_uvs.placed(wanted, self._place)
                buffers = mesh_buffers.extract(shown, wanted, self._in_place)
                if shown.type == "MESH":
                    self._in_place = max(0, self._in_place - len(shown.data.loops))
                size = 0 if buffers is None else buffers.triangle_count
        except RuntimeError as error:
            return self._unreadable(owner, error)
        if buffers is None:
            return None
        base, name = self._name(shown, owner, slots)
        uid = self._uid(base, color, look)
        add = self._model.add_strands if shown.type == "CURVES" else self._model.add_faces
        try:
            item = add(
                uid,
                name,
                buffers,
                indices,
                datablock_ids.role(look.environment, look.ordinary),
                look.deforms,
            )
        except native.LodestoneError as error:
            if error.status != native.Status.INVALID_ARGUMENT:
                raise
            return self._unreadable(owner, error)  # a file may hold faces of what is not there
        leaf = Leaf(item, uid, _data_name(shown, owner), _names(slots), size, look.deforms)
        return leaf if shown.type == "CURVES" else replace(leaf, loose=look.loose)

    def _unreadable(self, owner: Any, error: Exception) -> None:
        text = f'Object "{name_of(owner)}" cannot be read and is left out: {error}'
        self._problems.add(name_of(owner), ERROR, "mesh_unreadable", text)

    def _add_hair(
        self, shown: Any, owner: Any, slots: list, color: Color | None, look: Look
    ) -> Leaf | None:
        indices = self._indices(slots, color, look)
        textured = any(self._materials.textured(material) for material in slots)
        buffers = hair_strands.hair(shown, len(slots), textured)
        if buffers is None:
            return None
        uid = self._uid(
            stable_ids.stable_id(datablock_ids.uid_of("object", owner), HAIR), color, look
        )
        name, role = f"{name_of(owner)} {HAIR}", datablock_ids.role(look.environment, look.ordinary)
        item = self._model.add_strands(uid, name, buffers, indices, role, look.deforms)
        name = f"{name_of(shown)} {HAIR}"
        return Leaf(item, uid, name, _names(slots), len(buffers.counts), look.deforms)

    def _add_point(
        self, shown: Any, owner: Any, slots: list, color: Color | None, look: Look
    ) -> Leaf:
        # A point shows its first material only
        indices = self._indices(slots[:1], color, look)
        uid = self._uid(
            stable_ids.stable_id(datablock_ids.uid_of("object", owner), POINT), color, look
        )
        name, role = f"{name_of(owner)} {POINT}", datablock_ids.role(
            look.environment, look.ordinary
        )
        item = self._model.add_mesh(uid, name, mesh_buffers.ball(), indices, role)
        return Leaf(item, uid, f"{name_of(shown.data)} {POINT}", _names(slots), 1)

    # ---- Materials ----

    def _indices(self, slots: list, color: Color | None, look: Look) -> list[int]:
        if look.holdout:
            if self._black is None:
                black = (0.0, 0.0, 0.0)
                self._black = self._model.add_material(
                    "Holdout", base_color=black, roughness=1.0, specular=0.0
                )
            return [self._black] * max(1, len(slots))
        return [self._materials.index(material, color) for material in slots]

    # ---- Names ----

    def _uid(self, base: str, color: Color | None, look: Look) -> str:
        if color is not None:
            base = stable_ids.stable_id(base, "color", *color)
        if look.environment:
            base = stable_ids.stable_id(base, "environment")
        elif look.ordinary:
            base = stable_ids.stable_id(base, "ordinary")
        if look.holdout:
            base = stable_ids.stable_id(base, "holdout")
        if look.deforms:
            base = stable_ids.stable_id(base, "deforms")
        if look.loose != datablock_ids.AUTOMATIC:
            base = stable_ids.stable_id(base, "loose", look.loose)
        return self._uids.claim(base)

    def _name(self, shown: Any, owner: Any, slots: list) -> tuple[str, str]:
        """The uid and name of a leaf: a shared mesh's own, else those of the object that shows
        it."""
        if shown.type != "MESH" or owner.type != "MESH":
            return datablock_ids.uid_of("object", owner), name_of(owner)
        if shown.data.as_pointer() != owner.data.as_pointer():  # made by nodes
            base = stable_ids.stable_id(
                datablock_ids.uid_of("object", owner), "nodes", name_of(shown.data)
            )
            return base, f"{name_of(owner)}: {name_of(shown.data)}"
        if owner.is_modified(self._scene, "RENDER"):
            return datablock_ids.uid_of("object", owner), name_of(owner)
        base = datablock_ids.uid_of("mesh", shown.data)
        if slots != list(shown.data.materials):
            own = [datablock_ids.named_id_of(m) for m in shown.data.materials]
            linked = [datablock_ids.named_id_of(m) for m in slots]
            if own != linked:  # materials linked to the object
                base = stable_ids.stable_id(base, *linked)
        return base, name_of(shown.data)


def material_slots(shown: Any, override: Any = None) -> list[Any]:
    """Resolved materials by slot, those linked to the object included; `override` in all of them,
    and in one where there is none."""
    if shown.data is None:  # material_slots of an evaluated empty crash Blender 3.4
        return []
    if override is not None:
        return [override] * max(1, len(shown.material_slots))
    return list(map(MATERIAL, shown.material_slots))


def override_of(depsgraph: Any) -> Any | None:
    """The evaluated material that a view layer puts on everything, as Cycles does; or None."""
    material = depsgraph.view_layer_eval.material_override
    return None if material is None else material.evaluated_get(depsgraph)


def _data_name(shown: Any, owner: Any) -> str:
    """The name of the data as the designer knows it: what is subdivided on the GPU has no name of
    its own."""
    own = shown.type == "MESH" and shown.data.as_pointer() == owner.data.as_pointer()
    return name_of(owner.original.data if own else shown.data)


def _names(slots: list) -> tuple[str, ...]:
    return tuple(name_of(material) if material else "" for material in slots)
