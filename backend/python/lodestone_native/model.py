# SPDX-License-Identifier: GPL-3.0-or-later
"""A model: objects, placements, materials, lights, cameras; building and asking it."""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

from . import records, structs
from .base import pointer_to, text_in, text_out
from .bake import BakeStep, bake
from .buffers import FaceBuffers, MeshBuffers, StrandBuffers, count
from .handle import Handle
from .enums import ANY_LEVEL, Channel, Extension, Role
from .job import Job
from .library import check, library
from .options import (
    BuildOptions,
    LooseOptions,
    MeasureOptions,
    StructureOptions,
    changed,
)
from .structs import Object
from .view import Camera, Light, Vector

IDENTITY_MAPPING = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def texture(
    picture: int,
    channel: int = Channel.COLOR,
    extension: int = Extension.REPEAT,
    closest: bool = False,
    to_picture: Sequence[float] = IDENTITY_MAPPING,
    scale: Vector = (1.0, 1.0, 1.0),
    offset: Vector = (0.0, 0.0, 0.0),
) -> structs.Texture:
    """A picture (its index in the model) on a surface: the value at texture coordinates (u, v) is
    offset + scale * texel(to_picture (u, v, 1))."""
    return structs.Texture(
        picture=picture + 1,
        channel=channel,
        extension=extension,
        closest=int(closest),
        to_picture=tuple(to_picture),
        scale=tuple(scale),
        offset=tuple(offset),
    )


class Model(Handle):
    """One thread at a time; close it (or leave the `with` block) to free its memory."""

    _destroy = "lds_model_destroy"

    def __init__(self, handle: ctypes.c_void_p | None = None) -> None:
        made = handle or ctypes.c_void_p()
        self._handle = made
        if handle is None:
            check(library().lds_model_create(made))

    @classmethod
    def read(cls, path: str) -> Model:
        """A .obj, .ply, .glb or .gltf file, or a store."""
        handle = ctypes.c_void_p()
        check(library().lds_model_read(text_in(path), handle))
        return cls(handle)

    def write(self, path: str) -> None:
        check(library().lds_model_write(self.handle, text_in(path)))

    # ---- Filling ----

    def add_picture(
        self,
        name: str,
        path: str | None = None,
        data: bytes | None = None,
        pixels: array[float] | None = None,
        size: tuple[int, int] = (0, 0),
        linear: bool = False,
    ) -> int:
        """A PNG, JPEG or EXR by path or content, or pixels [height][width][4] (array 'f', lowest
        row first, straight alpha). linear: linear color or data, else sRGB. Its index."""
        if pixels is not None and count("pixels", pixels, 4) != size[0] * size[1]:
            raise ValueError("the pixels do not fit the size of the picture")
        picture = structs.Picture(
            name=text_in(name),
            path=text_in(path),
            bytes=None if data is None else ctypes.cast(ctypes.c_char_p(data), ctypes.c_void_p),
            byte_count=len(data) if data is not None else 0,
            pixels=pointer_to(pixels, ctypes.c_float),
            width=size[0],
            height=size[1],
            linear=int(linear),
        )
        index = ctypes.c_uint32()
        check(library().lds_model_add_picture(self.handle, picture, index))
        return index.value

    def bake_picture(
        self,
        name: str,
        steps: Sequence[BakeStep],
        textures: Sequence[structs.Texture],
        size: tuple[int, int] = (0, 0),
        linear: bool = False,
    ) -> int:
        """A picture computed from others, as large as the largest of them when no size is given;
        linear as in add_picture(). Its index."""
        given = bake(name, steps, textures, size, linear)
        index = ctypes.c_uint32()
        check(library().lds_model_bake_picture(self.handle, given, None, index))
        return index.value

    def texture_mean(self, given: structs.Texture) -> tuple[float, float, float]:
        """Over its whole picture; of a single number the first counts."""
        out = (ctypes.c_double * 3)()
        check(library().lds_model_texture_mean(self.handle, given, out))
        return (out[0], out[1], out[2])

    def add_material(self, name: str, **fields: Any) -> int:
        """`fields`: those of lodestone.h's lds_material, textures as texture() makes them; the
        rest keeps its default. Its index."""
        made = structs.Material()
        check(library().lds_material_default(made))
        changed(made, {"name": text_in(name), **fields})
        index = ctypes.c_uint32()
        check(library().lds_model_add_material(self.handle, made, index))
        return index.value

    def add_mesh(
        self,
        uid: str,
        name: str,
        mesh: MeshBuffers,
        materials: Sequence[int] = (),
        role: int = Role.AUTOMATIC,
        deforms: bool = False,
    ) -> Object:
        info = _info(uid, name, role, deforms)
        return self._add_leaf(library().lds_model_add_mesh, info, mesh.struct(), materials)

    def add_faces(
        self,
        uid: str,
        name: str,
        faces: FaceBuffers,
        materials: Sequence[int] = (),
        role: int = Role.AUTOMATIC,
        deforms: bool = False,
    ) -> Object:
        info = _info(uid, name, role, deforms)
        return self._add_leaf(library().lds_model_add_faces, info, faces.struct(), materials)

    def add_strands(
        self,
        uid: str,
        name: str,
        strands: StrandBuffers,
        materials: Sequence[int] = (),
        role: int = Role.AUTOMATIC,
        deforms: bool = False,
    ) -> Object:
        """One mesh of a tapered tube for each strand."""
        info = _info(uid, name, role, deforms)
        return self._add_leaf(library().lds_model_add_strands, info, strands.struct(), materials)

    def _add_leaf(
        self, add: Any, info: structs.ObjectInfo, shape: Any, materials: Sequence[int]
    ) -> Object:
        out = Object()
        slots = (ctypes.c_uint32 * len(materials))(*materials)
        check(add(self.handle, info, shape, slots, len(materials), out))
        return out

    def add_group(
        self, uid: str, name: str, role: int = Role.AUTOMATIC, deforms: bool = False
    ) -> Object:
        out = Object()
        info = _info(uid, name, role, deforms)
        check(library().lds_model_add_group(self.handle, info, out))
        return out

    def add_placement(
        self,
        group: Object,
        child: Object,
        transform: Sequence[float],
        name: str,
        hidden: int = 0,
    ) -> None:
        """transform: row-major 3x4, child to group; hidden: bits of RayClass that do not see it."""
        rows = (ctypes.c_double * 12)(*transform)
        check(library().lds_model_add_placement(self.handle, group, child, rows, text_in(name)))
        if hidden:
            check(library().lds_model_hide_placement(self.handle, group, hidden))

    def add_placements(
        self,
        group: Object,
        children: Sequence[Object],
        transforms: Sequence[float],
        names: Sequence[str],
        hidden: Sequence[int],
    ) -> None:
        """In columns what add_placement() takes, 12 numbers a transform; all or none. Fast where
        transforms are an array "f"."""
        number = len(children)
        if (len(transforms), len(names), len(hidden)) != (12 * number, number, number):
            raise ValueError("columns of placements differ in length")
        if isinstance(transforms, array) and transforms.typecode == "f":
            rows: array[Any] = transforms
        else:
            rows = array("f", transforms)
        texts = text_in("\0".join(names)) or b""  # all at a stroke
        if texts.count(0) != max(0, number - 1):
            raise ValueError("a name holds NUL")
        check(
            library().lds_model_add_placements(
                self.handle,
                group,
                number,
                (Object * number).from_buffer_copy(_packed(children)),
                pointer_to(rows, ctypes.c_float),
                texts,
                (ctypes.c_uint32 * number)(*hidden) if any(hidden) else None,
            )
        )

    def decide_placement(
        self, group: Object, position: int, importance: float, coarsest: int = ANY_LEVEL
    ) -> None:
        """Of the child at `position`: how many times finer it is drawn than elsewhere, 1/64 to 64,
        and the largest LOD number it is drawn with."""
        decide = library().lds_model_decide_placement
        check(decide(self.handle, group, position, importance, coarsest))

    def pin_placement(self, group: Object, position: int, lod: int) -> None:
        """Always that LOD number; ANY_LEVEL: no pin."""
        check(library().lds_model_pin_placement(self.handle, group, position, lod))

    def move_placement(
        self, group: Object, position: int, closing: tuple[float, ...] | None
    ) -> None:
        """Where the child at `position` is when the shutter closes, 3 x 4 by rows in the group's
        frame; None: it rests."""
        rows = None if closing is None else (ctypes.c_double * 12)(*closing)
        check(library().lds_model_move_placement(self.handle, group, position, rows))

    def group_by_position(self, group: Object, most_children: int = 64) -> int:
        """Gives a group of more children groups of neighbors; returns how many were added."""
        added = ctypes.c_size_t()
        check(library().lds_model_group_by_position(self.handle, group, most_children, added))
        return added.value

    def structure(
        self,
        groups: Sequence[Object] | None = None,
        options: structs.StructureOptions | None = None,
        job: Job | None = None,
    ) -> records.StructureReport:
        """Gives flat groups (None: all below the root) small groups of what is near and alike."""
        given = None if groups is None else (Object * len(groups))(*groups)
        out = structs.StructureReport()
        check(
            library().lds_model_structure(
                self.handle,
                given,
                len(groups or ()),
                options or StructureOptions(),
                job,
                out,
            )
        )
        return out.record()

    def split_loose_parts(
        self,
        objects: Sequence[Object] | None = None,
        options: structs.LooseOptions | None = None,
        job: Job | None = None,
    ) -> records.LooseReport:
        """Makes meshes of many loose parts (None: all below the root) groups of clusters of them,
        in place: each stays one object and one occurrence."""
        given = None if objects is None else (Object * len(objects))(*objects)
        out = structs.LooseReport()
        check(
            library().lds_model_split_loose_parts(
                self.handle,
                given,
                len(objects or ()),
                options or LooseOptions(),
                job,
                out,
            )
        )
        return out.record()

    def set_root(self, root: Object) -> None:
        check(library().lds_model_set_root(self.handle, root))

    def add_light(self, light: Light) -> None:
        check(library().lds_model_add_light(self.handle, light.struct()))

    def add_camera(self, camera: Camera) -> None:
        check(library().lds_model_add_camera(self.handle, camera.struct()))

    def set_world(
        self,
        color: Vector,
        transparent: bool = False,
        environment: int | None = None,
        turn: Sequence[float] = (1, 0, 0, 0, 1, 0, 0, 0, 1),
        strength: Vector = (1.0, 1.0, 1.0),
    ) -> None:
        """environment: index of a picture seen all around instead of color (equirectangular, +Z
        up); turn: row-major, directions in the world to those in the picture."""
        world = structs.World(
            color=color,
            transparent=int(transparent),
            environment=0 if environment is None else environment + 1,
            environment_turn=tuple(turn),
            environment_strength=strength,
        )
        check(library().lds_model_set_world(self.handle, world))

    # ---- Asking ----

    def totals(self) -> records.Totals:
        out = structs.Totals()
        check(library().lds_model_totals(self.handle, out))
        return out.record()

    def objects(self) -> Iterator[Object]:
        for position in range(library().lds_model_object_count(self.handle)):
            out = Object()
            check(library().lds_model_object_at(self.handle, position, out))
            yield out

    def find_object(self, uid: str) -> Object | None:
        out = Object()
        check(library().lds_model_find_object(self.handle, text_in(uid), out))
        return out or None

    def object_summary(self, item: Object) -> records.ObjectSummary:
        out = structs.ObjectSummary()
        check(library().lds_model_object_summary(self.handle, item, out))
        return out.record()

    def children(self, group: Object) -> Iterator[tuple[Object, tuple[float, ...], str, int]]:
        """Of a group, as add_placements() takes them."""
        for position in range(self.object_summary(group).child_count):
            out = self._child(group, position)
            placed = Object(*out.object.key)
            yield placed, tuple(out.transform), text_out(out.name), out.hidden

    def decided(self, group: Object) -> list[tuple[float, int]]:
        """Importance and coarsest level of each child, as decide_placement() takes them."""
        count = self.object_summary(group).child_count
        found = (self._child(group, position) for position in range(count))
        return [(child.importance, child.coarsest) for child in found]

    def _child(self, group: Object, position: int) -> structs.Placement:
        out = structs.Placement()
        check(library().lds_model_child(self.handle, group, position, out))
        return out

    def representation(self, item: Object, lod: int) -> records.Representation:
        """lod 0 is the finest."""
        out = structs.Representation()
        check(library().lds_model_representation(self.handle, item, lod, out))
        return out.record()

    def occurrences(self) -> list[tuple[Object, tuple[float, ...]]]:
        """Leaves reached along each path of placements, depth first: (object, world transform)."""
        count = ctypes.c_size_t()
        check(library().lds_model_occurrence_count(self.handle, count))
        buffer = (structs.Occurrence * count.value)()
        check(library().lds_model_occurrence_copy(self.handle, buffer, count.value))
        return [(Object(*item.object.key), tuple(item.world)) for item in buffer]

    def occurrences_hidden(self) -> list[int]:
        """In the order of occurrences(): bits of the RayClasses that do not see them."""
        count = ctypes.c_size_t()
        check(library().lds_model_occurrence_count(self.handle, count))
        buffer = (ctypes.c_uint32 * count.value)()
        check(library().lds_model_occurrence_hidden(self.handle, buffer, count.value))
        return list(buffer)

    def light_count(self) -> int:
        return library().lds_model_light_count(self.handle)

    def cameras(self) -> list[Camera]:
        found = []
        for position in range(library().lds_model_camera_count(self.handle)):
            out = structs.Camera()
            check(library().lds_model_camera(self.handle, position, out))
            values = out.record()._asdict()
            values["orthographic"] = bool(values["orthographic"])
            found.append(Camera(**values))
        return found

    def problems(self) -> list[records.Problem]:
        found = []
        for position in range(library().lds_model_problem_count(self.handle)):
            out = structs.Problem()
            check(library().lds_model_problem(self.handle, position, out))
            found.append(out.record())
        return found

    # ---- Long calls ----

    def measure(
        self,
        item: Object,
        options: structs.MeasureOptions | None = None,
        job: Job | None = None,
    ) -> records.Attributes:
        out = structs.Attributes()
        check(library().lds_model_measure(self.handle, item, options or MeasureOptions(), job, out))
        return out.record()

    def simplify(
        self, options: structs.SimplifyOptions, job: Job | None = None
    ) -> records.SimplifyReport:
        out = structs.SimplifyReport()
        check(library().lds_model_simplify(self.handle, options, job, out))
        return out.record()

    def build_estimate(
        self, store: str, options: structs.BuildOptions | None = None
    ) -> records.BuildReport:
        out = structs.BuildReport()
        check(
            library().lds_model_build_estimate(
                self.handle, text_in(store), options or BuildOptions(), out
            )
        )
        return out.record()

    def build(
        self,
        store: str,
        options: structs.BuildOptions | None = None,
        job: Job | None = None,
    ) -> records.BuildReport:
        """Gives every object its stand-ins and brings the store (a folder) up to date."""
        out = structs.BuildReport()
        check(
            library().lds_model_build(
                self.handle, text_in(store), options or BuildOptions(), job, out
            )
        )
        return out.record()


def _info(uid: str, name: str, role: int, deforms: bool) -> structs.ObjectInfo:
    return structs.ObjectInfo(uid=text_in(uid), name=text_in(name), role=role, deforms=int(deforms))


def _packed(items: Sequence[Object]) -> bytes:
    """One after the other. Many are followed by the same one."""
    alike = [list(same) for _, same in groupby(items, id)]
    return b"".join(bytes(same[0]) * len(same) for same in alike)
