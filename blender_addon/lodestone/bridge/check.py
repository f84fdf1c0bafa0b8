# SPDX-License-Identifier: GPL-3.0-or-later
"""Proof of an extraction: its occurrences against a fresh walk of the depsgraph, one to one."""

from collections import defaultdict
from typing import Any

from .leaves import DRAWN, material_slots
from .scene import Extraction

TOLERANCE = 1e-5  # of the largest number in a transform

Key = tuple[str, tuple[str, ...], int]  # data, materials by slot, triangles


def shown_instances(depsgraph: Any) -> dict[Key, list[tuple[float, ...]]]:
    """World transforms of everything with faces that the depsgraph shows, by what it shows.

    Written without the extraction's code: Blender's own list, meshes as to_mesh() gives them.
    Curves and their like are listed twice by Blender, themselves and their mesh; one counts.
    """
    found: dict[Key, list[tuple[float, ...]]] = defaultdict(list)
    triangles: dict[int, int] = {}
    for instance in depsgraph.object_instances:
        shown = instance.object
        if not instance.show_self or shown.type not in DRAWN or shown.type != "MESH":
            continue
        pointer = shown.data.as_pointer()
        if pointer not in triangles:
            triangles[pointer] = sum(len(p.vertices) - 2 for p in shown.data.polygons)
        if triangles[pointer]:
            names = tuple(m.name if m else "" for m in material_slots(shown))
            matrix = instance.matrix_world
            rows = (*matrix[0], *matrix[1], *matrix[2])
            found[(shown.data.name, names, triangles[pointer])].append(rows)
    return found


def compare_occurrences(depsgraph: Any, extraction: Extraction) -> list[str]:
    """A sentence for every instance that is missing, extra, elsewhere or of another material."""
    expected = shown_instances(depsgraph)
    by_object = {leaf.object.key: leaf for leaf in extraction.leaves}
    actual: dict[Key, list[tuple[float, ...]]] = defaultdict(list)
    differences = []
    for item, world in extraction.model.occurrences():
        leaf = by_object.get(item.key)
        if leaf is None:
            differences.append(f"an occurrence of an unknown object {item}")
            continue
        actual[(leaf.data, leaf.materials, leaf.triangles)].append(world)
    for key in sorted(set(expected) | set(actual)):
        differences += _compare(key, expected.get(key, []), actual.get(key, []))
    return differences


def _compare(key: Key, expected: list, actual: list) -> list[str]:
    name = f'"{key[0]}" ({key[2]} triangles, materials {list(key[1])})'
    if len(expected) != len(actual):
        return [f"{name}: Blender shows {len(expected)}, the model has {len(actual)}"]
    left: dict[tuple, list] = defaultdict(list)
    for world in actual:
        left[_cell(world)].append(world)
    missing = []
    for world in expected:
        if not _take(left.get(_cell(world), []), world):
            missing.append(world)
    rest = [world for worlds in left.values() for world in worlds]
    return [  # those at a cell's edge are looked for everywhere
        f"{name}: nothing is at {_place(world)}" for world in missing if not _take(rest, world)
    ]


def _cell(world: tuple[float, ...]) -> tuple[int, ...]:
    return tuple(round(world[i]) for i in (3, 7, 11))


def _take(worlds: list, wanted: tuple[float, ...]) -> bool:
    limit = TOLERANCE * max(1.0, *(abs(v) for v in wanted))
    for at, world in enumerate(worlds):
        if all(abs(a - b) <= limit for a, b in zip(world, wanted)):
            worlds.pop(at)
            return True
    return False


def _place(world: tuple[float, ...]) -> str:
    return f"({world[3]:.3f}, {world[7]:.3f}, {world[11]:.3f})"
