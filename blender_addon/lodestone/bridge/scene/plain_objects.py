# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain objects: those of which nothing but their mesh, their materials and their place counts.

Most objects of large scenes are. They are read in columns, one question to all of a batch at a
stroke: object by object, with a call for each, it is most of what extracting many small objects
takes.
"""

from array import array
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, compress, count, repeat
from operator import attrgetter, is_, not_
from typing import Any

import bpy

from .. import datablock_ids
from ..listed_instances import Listed, Rows, gathered
from ..motion.motion_sampling import Motion
from .leaf_objects import MATERIAL
from .ray_visibility import SEEN_BY_ALL

_BATCH = 4096  # objects between two ticks
_OWN = {"library": None, "animation_data": None, "is_instancer": False}  # what plain objects have
_FREE = {"parent": None, "rigid_body": None, **_OWN}  # what most of them have: nothing moves them
_SEEN = {"is_holdout": False} | SEEN_BY_ALL
_DATA, _NAME, _ORIGINAL = attrgetter("data"), attrgetter("name"), attrgetter("original")
_MODIFIERS, _CONSTRAINTS = attrgetter("modifiers"), attrgetter("constraints")
_SLOTS, _ACTIVE_MATERIAL = attrgetter("material_slots"), attrgetter("active_material")


class Plain:
    """The plain objects of a scene, one row each, in the order they are listed."""

    def __init__(self) -> None:
        self.numbers: list[int] = []  # among what is listed
        self.names: list[str] = []
        self.originals: list[Any] = []
        self.places: Rows = array("f")  # 12 each
        self.kinds: list[list[int]] = []  # rows that are made of the same, each in order
        self.shows: list[Any] = []  # a Leaf, or None: nothing, or it is no row any more

    def settle(self, rows: list[int], leaf: Any) -> None:
        """Sets the leaf that these rows show."""
        for row in rows:
            self.shows[row] = leaf

    def rows(self) -> dict[Any, int]:
        """The rows by original, of those objects that show something."""
        kept = [leaf is not None for leaf in self.shows]
        return dict(compress(zip(self.originals, range(len(kept))), kept))


def find(listed: Listed, environment: set[Any], motion: Motion, tick: Callable[[], None]) -> Plain:
    """Meshes without modifiers (so without particles) that nothing moves, seen by all rays,
    instancing nothing, local, not decided upon. `environment`: originals of what is Environment."""
    found = Plain()
    wanted = _FREE
    kinds: defaultdict[tuple, list[int]] = defaultdict(list)  # rows, by what they are made of
    numbers, objects = listed.objects()
    try:
        if not _all_seen():
            wanted = _FREE | _SEEN
        for start in range(0, len(objects), _BATCH):
            tick()
            batch = objects[start : start + _BATCH]
            meshes = list(map(_DATA, batch))
            plain = _plain(batch, meshes, wanted, motion)
            batch, at = list(compress(batch, plain)), len(found.numbers)
            found.numbers += compress(numbers[start : start + _BATCH], plain)
            found.names += _names(batch)
            originals = list(map(_ORIGINAL, batch))
            found.originals += originals
            marked = map(environment.__contains__, originals) if environment else repeat(False)
            for made_of, rows in _made_of(batch, zip(compress(meshes, plain), marked)):
                kinds[made_of] += map(at.__add__, rows)
    except AttributeError:  # another Blender
        return Plain()
    found.kinds = list(kinds.values())
    found.places = gathered(listed.places, found.numbers)
    found.shows = [None] * len(found.numbers)
    return found


def _all_seen() -> bool:
    """Whether nothing in the file is hidden from any rays: asked of all at a stroke, in less than
    half the time. Evaluated objects differ in this from their originals only if animated."""
    objects = bpy.data.objects
    flags = [False] * len(objects)
    for name, seen in _SEEN.items():
        objects.foreach_get(name, flags)
        if (not seen) in flags:
            return False
    return True


def _plain(
    objects: list[Any], data: list[Any], wanted: dict[str, Any], motion: Motion
) -> list[bool]:
    """Whether each object is plain. The conditions that nearly all meet are asked in columns,
    `wanted` of each; the others one by one."""
    own = datablock_ids.have_settings(objects)
    free = tuple(wanted.values())
    plain = list(
        map(
            all,
            zip(
                map(is_, map(type, data), repeat(bpy.types.Mesh)),
                map(not_, own),
                map(not_, map(_MODIFIERS, objects)),
                map(free.__eq__, map(attrgetter(*wanted), objects)),
                map(not_, map(_CONSTRAINTS, objects)),
            ),
        )
    )
    for at in list(compress(count(), map(not_, plain))):
        item = objects[at]
        plain[at] = (
            all(getattr(item, name) == value for name, value in (_OWN | _SEEN).items())
            and type(data[at]) is bpy.types.Mesh
            and not own[at]
            and not item.modifiers
            and not motion.moves(item)
        )
    return plain


def _names(objects: list[Any]) -> list[str]:
    try:
        return list(map(_NAME, objects))
    except UnicodeDecodeError:
        return list(map(datablock_ids.name_of, objects))


def _made_of(
    objects: list[Any], looks: Iterable[tuple[Any, bool]]
) -> Iterator[tuple[tuple, Iterable[int]]]:
    """The kinds of objects whose meshes and marks are `looks`, as (mesh, whether marked,
    materials), with the positions of those that are made of these."""
    alike: defaultdict[tuple, list[int]] = defaultdict(list)
    for position, look in enumerate(looks):
        alike[look].append(position)
    for look, positions in alike.items():
        width = len(look[0].materials)  # as many slots has each object
        materials = _materials(list(map(objects.__getitem__, positions)), width)
        if materials == materials[:width] * len(positions):
            yield (*look, *materials[:width]), positions
        else:
            for position in positions:
                yield (*look, *map(MATERIAL, objects[position].material_slots)), (position,)


def _materials(objects: list[Any], width: int) -> list[Any]:
    """The materials of all their slots, `width` each. Where there is one, its material is the
    active one, and no list of slots is made."""
    if width == 1:
        materials = list(map(_ACTIVE_MATERIAL, objects))
        if None not in materials:
            return materials
    return list(map(MATERIAL, chain.from_iterable(map(_SLOTS, objects))))
