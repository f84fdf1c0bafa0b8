# SPDX-License-Identifier: GPL-3.0-or-later
"""Proof of an extraction: its occurrences against a fresh walk of the depsgraph, one to one."""

from collections import defaultdict
from typing import Any

from mathutils import Matrix

from ..datablock_ids import name_of
from ..scene.leaf_objects import DRAWN, material_slots, override_of, undrawn
from ..scene.scene_extraction import Extraction

TOLERANCE = 1e-5  # a share of the largest number in a transform

# Data, materials by slot, size: triangles of a mesh, strands of hair, 1 of a point
Key = tuple[str, tuple[str, ...], int]


def shown_instances(depsgraph: Any) -> dict[Key, list[tuple[float, ...]]]:
    """World transforms of everything with faces, hairs or points that the depsgraph shows, by what
    it shows.

    Written without the extraction's code: Blender's own list, meshes as to_mesh() gives them.
    Curves and their like are listed twice by Blender, themselves and their mesh; one counts.
    """
    found: dict[Key, list[tuple[float, ...]]] = defaultdict(list)
    triangles: dict[int, int] = {}
    override = override_of(depsgraph)
    for instance in depsgraph.object_instances:
        shown = instance.object
        if shown.type not in DRAWN or undrawn(shown):
            continue
        names = tuple(name_of(m) if m else "" for m in material_slots(shown, override))
        matrix = instance.matrix_world
        if instance.show_particles and shown.type == "MESH":
            hairs = _hairs(shown)
            if hairs:
                found[(f"{name_of(shown)} hair", names, hairs)].append(_rows(matrix))
        if not instance.show_self:
            continue
        if shown.type == "POINTCLOUD":
            for point in shown.data.points:
                if point.radius > 0.0:
                    place = matrix @ Matrix.Translation(point.co) @ Matrix.Scale(point.radius, 4)
                    found[(f"{name_of(shown.data)} point", names, 1)].append(_rows(place))
            continue
        size = 0
        if shown.type == "CURVES":
            size = len(shown.data.curves)
        elif shown.type == "MESH":
            pointer = shown.data.as_pointer()
            if pointer not in triangles:
                triangles[pointer] = sum(len(p.vertices) - 2 for p in shown.data.polygons)
            size = triangles[pointer]
        if size:
            found[(name_of(shown.data), names, size)].append(_rows(matrix))
    return found


def _hairs(shown: Any) -> int:
    """Hairs that render: of each system its children, or else its particles."""
    count = 0
    for system in shown.particle_systems:
        settings = system.settings
        rendered = any(
            m.type == "PARTICLE_SYSTEM"
            and m.show_render
            and name_of(m.particle_system) == name_of(system)
            for m in shown.modifiers
        )
        if rendered and settings.type == "HAIR" and settings.render_type == "PATH":
            grown = len(system.child_particles) if settings.child_type != "NONE" else 0
            count += grown or len(system.particles)
    return count


def _rows(matrix: Matrix) -> tuple[float, ...]:
    return (*matrix[0], *matrix[1], *matrix[2])


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
        actual[(leaf.data, leaf.materials, leaf.size)].append(world)
    for key in sorted(set(expected) | set(actual)):
        differences += _compare(key, expected.get(key, []), actual.get(key, []))
    return differences


def _compare(key: Key, expected: list, actual: list) -> list[str]:
    name = f'"{key[0]}" (size {key[2]}, materials {list(key[1])})'
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
