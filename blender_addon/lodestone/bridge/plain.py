# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain objects: those of which nothing but their mesh, their materials and their place counts.

Most objects of large scenes are. They are read in columns, one question to all of a batch at a
stroke: object by object, with a call for each, it is most of what extracting many small objects
takes.
"""

from array import array
from collections.abc import Callable
from itertools import compress, count, repeat
from operator import attrgetter
from typing import Any

import bpy

from . import ids
from .leaves import MATERIAL
from .listed import Listed, Rows, gathered
from .motion import Motion

_BATCH = 4096  # objects between two ticks
_ASKED = attrgetter(
    "parent",
    "rigid_body",
    "library",
    "animation_data",
    "instance_type",
    "is_holdout",
    "is_shadow_catcher",
    "visible_camera",
    "visible_glossy",
    "visible_shadow",
    "visible_diffuse",
    "visible_transmission",
)
_PLAIN = (None, None, "NONE", False, False, True, True, True, True, True)
_LOOSE = (None, None, *_PLAIN)
_DATA, _NAME, _ORIGINAL = attrgetter("data"), attrgetter("name"), attrgetter("original")


class Plain:
    """The plain objects of a scene, one row each, in the order they are listed."""

    def __init__(self) -> None:
        self.numbers: list[int] = []  # among what is listed
        self.names: list[str] = []
        self.keys: list[ids.Key] = []
        self.originals: list[Any] = []
        self.places: Rows = array("f")  # 12 each
        self.kinds: list[list[int]] = []  # rows that are made of the same, each in order
        self.shows: list[Any] = []  # a Leaf, or None: nothing, or it is no row any more

    def settle(self, rows: list[int], leaf: Any) -> None:
        """What these rows show."""
        for row in rows:
            self.shows[row] = leaf

    def rows(self) -> dict[Any, int]:
        """By original, of those that show something."""
        kept = [leaf is not None for leaf in self.shows]
        return dict(compress(zip(self.originals, range(len(kept))), kept))


def find(listed: Listed, environment: set[Any], motion: Motion, tick: Callable[[], None]) -> Plain:
    """Meshes without modifiers (so without particles) that nothing moves, seen by all rays,
    instancing nothing, local, not decided upon. `environment`: originals of what is Environment."""
    found = Plain()
    first: dict[tuple, int] = {}  # rows, by what they are made of
    alike: list[int] = []  # the first row that is made of the same
    numbers, objects = listed.objects()
    try:
        for start in range(0, len(objects), _BATCH):
            tick()
            batch = objects[start : start + _BATCH]
            meshes = list(map(_DATA, batch))
            plain = _plain(batch, meshes, motion)
            batch, at = list(compress(batch, plain)), len(found.numbers)
            found.numbers += compress(numbers[start : start + _BATCH], plain)
            found.names += _names(batch)
            originals = list(map(_ORIGINAL, batch))
            found.originals += originals
            made_of = _made_of(batch, list(compress(meshes, plain)))
            if environment:
                made_of = list(zip(made_of, map(environment.__contains__, originals)))
            alike += map(first.setdefault, made_of, count(at))
    except AttributeError:  # another Blender
        return Plain()
    found.keys = list(zip(repeat("object"), repeat(""), found.names))
    kinds: dict[int, list[int]] = {row: [] for row in first.values()}
    for row, kind in enumerate(alike):
        kinds[kind].append(row)
    found.kinds = list(kinds.values())
    found.places = gathered(listed.places, found.numbers)
    found.shows = [None] * len(found.numbers)
    return found


def _plain(objects: list[Any], data: list[Any], motion: Motion) -> list[bool]:
    decided, moves = ids.have_settings(objects), motion.moves
    return [
        (answer == _LOOSE or answer[2:] == _PLAIN)
        and kind is bpy.types.Mesh
        and not own
        and not item.modifiers
        and (answer == _LOOSE and not item.constraints or not moves(item))
        for item, kind, answer, own in zip(objects, map(type, data), map(_ASKED, objects), decided)
    ]


def _names(objects: list[Any]) -> list[str]:
    try:
        return list(map(_NAME, objects))
    except UnicodeDecodeError:
        return list(map(ids.name_of, objects))


def _made_of(objects: list[Any], meshes: list[Any]) -> list[tuple]:
    """Their meshes and materials. Where there is one slot (there are as many as the mesh has) its
    material is the active one, and no list of slots is made."""
    single = {mesh for mesh in set(meshes) if len(mesh.materials) == 1}
    return [
        (mesh, material)
        if mesh in single and (material := item.active_material) is not None
        else (mesh, *map(MATERIAL, item.material_slots))
        for item, mesh in zip(objects, meshes)
    ]
