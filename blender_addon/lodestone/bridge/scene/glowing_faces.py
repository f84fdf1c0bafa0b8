# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that glow, as lights: POV-Ray lets only lights shine on other things.

Flat faces become area lights just above themselves, on both sides as in Cycles (on the outside of
closed bodies); small round bodies become points of the same power in their middles. Both give what
Cycles gives of a surface of radiance L: areas have 4 A L watts in Blender's units, a convex body of
surface A sends as much in the mean over all directions as a point of pi A L watts. A lantern, whose
sides are all around its middle, is one such point. Anything else glows without shining, which is
named.
"""

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

from mathutils import Matrix, Vector

from ...core.native import lodestone_native as native
from ...core.problems import WARNING, Problems, Subject
from .. import blender_versions, datablock_ids

MOST_FACES = 4096  # a mesh with more is not looked at
MOST_FLAT = 6  # sides of a body
MOST_LIGHTS = 20_000  # with all lamps of a scene: more cannot be looked through (light_plan.cpp)
LEAST = 0.01  # radiance that lights something
NAMED = 1.0  # things that glow brighter, and shine on nothing, are named
_SAME_PLANE = 0.9994  # cosine of 2 degrees
_FULL = 0.8  # a rectangle is 1, a disk 1.05, a triangle 0.87 of the rectangle of its inertia
_ROUND = 0.4  # 36 pi V^2 / A^3: a ball is 1, a cube 0.52
_ABOVE = 2e-3  # a share of a light's size, from the faces that it stands for
_LANTERN = 0.5  # the least extent over the largest of what shines alike all around: a cube is 1
_LANTERN_SIDES = 4  # fewer sides shine into some directions only
_COVERED = 0.2  # of the box around it shine all sides of a lantern; windows of a house do not
_ASIDE = 0.3  # in extents: sides this far from the middle keep in what they send to it
_SIMILAR = 1e-4  # how much the axes of a place may differ in length, and their cosines from 0
Triangle = tuple[Vector, Vector, Vector]


@dataclass(frozen=True, eq=False)
class Part:
    """Connected faces of one material, in the object's own frame."""

    material: Subject
    radiance: tuple[float, float, float]
    sides: tuple[tuple[Triangle, ...], ...]  # by plane; () when they are too many to be lights
    closed: bool


@dataclass(frozen=True, eq=False)
class Glow:
    """The part of an object that glows."""

    parts: tuple[Part, ...]
    others: tuple[Subject, ...] = ()  # materials that glow on what is never a light


def glow_of(shown: Any, slots: list[Any], looks: Iterable[Any], faces: bool = True) -> Glow | None:
    """The glow of what an evaluated object shows; `looks` by slot. None: nothing glows. Without
    `faces` it shows hairs or points."""
    radiances = [look.radiance for look in looks] or [(0.0, 0.0, 0.0)]
    if max(map(max, radiances)) < LEAST:
        return None
    keys = [datablock_ids.key_of("material", m) if m else ("material", "", "") for m in slots]
    bright = tuple(key for key, radiance in zip(keys, radiances) if max(radiance) > NAMED)
    mesh = shown.data
    if not faces or shown.type != "MESH" or shown.mode == "EDIT":
        return Glow((), bright)
    if len(mesh.polygons) > MOST_FACES:
        return Glow((), bright)
    return Glow(tuple(_parts(mesh, keys, radiances)))


def _parts(mesh: Any, keys: list[Subject], radiances: list[Any]) -> Iterable[Part]:
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    corners, slots = blender_versions.buffer("i", 3 * count), blender_versions.buffer("i", count)
    mesh.loop_triangles.foreach_get("vertices", corners)
    mesh.loop_triangles.foreach_get("material_index", slots)
    by_slot: dict[int, list[tuple[int, int, int]]] = defaultdict(list)
    for number, slot in enumerate(slots):
        slot = min(max(slot, 0), len(radiances) - 1)
        if max(radiances[slot]) >= LEAST:
            by_slot[slot].append(tuple(corners[3 * number : 3 * number + 3]))
    for slot, found in by_slot.items():
        for part in _connected(found, lambda a, b: True):
            points = {i: mesh.vertices[i].co.copy() for triangle in part for i in triangle}
            edges = _edges(part)
            closed = all(len(sharing) == 2 for sharing in edges.values())
            normals = {t: _normal(tuple(points[i] for i in t)) for t in part}

            def flat(a: Any, b: Any, normals: Any = normals) -> bool:
                return abs(normals[a].dot(normals[b])) > _SAME_PLANE

            sides = _connected(part, flat)
            if len(sides) > MOST_FLAT:
                sides = [part]
            solid = tuple(
                tuple(tuple(points[i] for i in triangle) for triangle in side) for side in sides
            )
            yield Part(keys[slot] if keys else ("material", "", ""), radiances[slot], solid, closed)


def _edges(triangles: Iterable[tuple]) -> dict[tuple[int, int], list[tuple]]:
    found: dict[tuple[int, int], list[tuple]] = defaultdict(list)
    for triangle in triangles:
        for edge in combinations(sorted(triangle), 2):
            found[edge].append(triangle)
    return found


def _connected(triangles: list[tuple], joined: Any) -> list[list[tuple]]:
    """Sets of triangles that share edges, where joined(a, b)."""
    neighbors: dict[tuple, list[tuple]] = defaultdict(list)
    for sharing in _edges(triangles).values():
        for a, b in combinations(sharing[:4], 2):
            if joined(a, b):
                neighbors[a].append(b)
                neighbors[b].append(a)
    left, found = dict.fromkeys(triangles), []
    while left:
        waiting = [next(iter(left))]
        del left[waiting[0]]
        group = []
        while waiting:
            triangle = waiting.pop()
            group.append(triangle)
            for other in neighbors[triangle]:
                if other in left:
                    del left[other]
                    waiting.append(other)
        found.append(group)
    return found


def _normal(triangle: Triangle) -> Vector:
    a, b, c = triangle
    return (b - a).cross(c - a).normalized()


class Glows:
    """The glows of one scene."""

    def __init__(self) -> None:
        self._made: dict[Glow, list[tuple[Part, list[native.Light]]]] = {}  # in their own frames
        self._lights: list[tuple[Part, native.Light]] = []
        self._lit: dict[Subject, None] = {}
        self._dark: dict[Subject, None] = {}

    def add(self, glow: Glow, world: Matrix, name: str) -> int:
        """Adds a glow as it is placed. Returns the ray classes that must not see it: what shines by
        a light must not do so once more (nor be part of a group's stand-in, which would hide the
        light), and a ball must not keep in the light in its middle."""
        hidden = 0
        self._dark.update(dict.fromkeys(glow.others))
        for part, made in self._placed(glow, world):
            for light in made:
                most = max(part.radiance)
                color = tuple(value / most for value in part.radiance)
                light = replace(light, name=name, color=color, power=light.power * most)
                self._lights.append((part, light))
                hidden |= native.RayClass.RADIOSITY
                if light.kind == native.LightKind.POINT:
                    hidden |= native.RayClass.SHADOW
            if made:
                self._lit[part.material] = None
            elif max(part.radiance) > NAMED:
                self._dark[part.material] = None
        return hidden

    def _placed(self, glow: Glow, world: Matrix) -> list[tuple[Part, list[native.Light]]]:
        """The lights of radiance 1 of each part. What is placed often is fitted once, unless its
        place distorts it."""
        scale = _scale(world)
        if scale is None:
            return _fitted_parts(glow, world)
        if glow not in self._made:
            self._made[glow] = _fitted_parts(glow, Matrix())
        turn = world.to_3x3()

        def moved(light: native.Light) -> native.Light:
            return replace(
                light,
                power=light.power * scale * scale,
                position=tuple(world @ Vector(light.position)),
                direction=tuple((turn @ Vector(light.direction)) / scale),
                edge_u=tuple(turn @ Vector(light.edge_u)),
                edge_v=tuple(turn @ Vector(light.edge_v)),
                radius=light.radius * scale,
            )

        return [(part, list(map(moved, made))) for part, made in self._made[glow]]

    def lights(
        self, eye: Vector | None, problems: Problems, most: int = MOST_LIGHTS
    ) -> list[native.Light]:
        """The strongest, and those that are small as the camera sees them; at most so many."""
        kept: list[native.Light] = []
        self._lights.sort(key=lambda pair: -pair[1].power)
        for part, light in self._lights:
            far = eye is None or (eye - Vector(light.position)).length > 2.0 * light.radius
            if far and len(kept) < most:
                kept.append(light)
            elif max(part.radiance) > NAMED:
                self._dark[part.material] = None
        for subject in self._dark:
            _, library, name = subject
            text = "it glows, but its light falls on nothing else"
            if subject in self._lit:
                text = "it glows, but the light of some of it falls on nothing else"
            text = f'Material "{name}": {text}; put a lamp in its place'
            problems.add(name, WARNING, "glow", text, "material", library)
        return kept


def _scale(world: Matrix) -> float | None:
    """The factor by which a place scales everything; None: it is another one along each axis."""
    axes = [column.to_3d() for column in world.col[:3]]
    lengths = [axis.length for axis in axes]
    largest = max(lengths)
    if not largest > 0.0 or not math.isfinite(largest):
        return None
    if min(lengths) < (1.0 - _SIMILAR) * largest:
        return None
    if any(abs(a.dot(b)) > _SIMILAR * largest**2 for a, b in combinations(axes, 2)):
        return None
    return largest


def _fitted_parts(glow: Glow, world: Matrix) -> list[tuple[Part, list[native.Light]]]:
    """The lights of radiance 1 of each part as it is placed; one for all parts of a lantern."""
    found, lantern = [], []
    for part in glow.parts:
        sides = [[tuple(world @ p for p in t) for t in side] for side in part.sides]
        made = _areas(sides, part.closed) or _point(sides, part.closed) or []
        found.append((part, made))
        if any(light.kind == native.LightKind.AREA for light in made):
            lantern.append((part, sides))
    if len({part.radiance for part, _ in lantern}) == 1:
        light = _lantern([side for _, sides in lantern for side in sides])
        if light is not None:
            first, others = lantern[0][0], {part for part, _ in lantern[1:]}
            return [
                (part, [light] if part is first else made)
                for part, made in found
                if part not in others
            ]
    return found


def _lantern(sides: list[list[Triangle]]) -> native.Light | None:
    """The light of radiance 1 in the middle of sides that are all around it. None: they are few, or
    rather in a plane or a row, or much else is between them."""
    if len(sides) < _LANTERN_SIDES:
        return None
    triangles = [t for side in sides for t in side]
    middle = _center(triangles)
    total, moments = 0.0, [[0.0] * 3 for _ in range(3)]
    for triangle in triangles:
        a, b, c = (p - middle for p in triangle)
        weight = (b - a).cross(c - a).length / 24.0
        total += 12.0 * weight
        for p in (a, b, c, a + b + c):  # exact for squares of linear functions
            for i in range(3):
                for k in range(3):
                    moments[i][k] += weight * p[i] * p[k]
    least, largest = _ends(moments)
    points = [p for triangle in triangles for p in triangle]
    x, y, z = (max(p[i] for p in points) - min(p[i] for p in points) for i in range(3))
    if total < _COVERED * 2.0 * (x * y + y * z + z * x):
        return None
    if not total > 0.0 or not math.isfinite(total) or least < _LANTERN**2 * largest:
        return None
    extent = math.sqrt(largest / total)
    shines = 0.0
    for side in sides:
        area = sum((b - a).cross(c - a).length / 2.0 for a, b, c in side)
        aside = abs(_normal(side[0]).dot(_center(side) - middle)) > _ASIDE * extent
        shines += area if aside else 2.0 * area
    return _point_of(middle, shines)


def _ends(m: list[list[float]]) -> tuple[float, float]:
    """The least and the largest eigenvalue of a symmetric matrix of 3 x 3."""
    mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0
    off = m[0][1] ** 2 + m[0][2] ** 2 + m[1][2] ** 2
    size = math.sqrt((sum((m[i][i] - mean) ** 2 for i in range(3)) + 2.0 * off) / 6.0)
    if not size > 0.0:
        return mean, mean
    b = [[(m[i][k] - (mean if i == k else 0.0)) / size for k in range(3)] for i in range(3)]
    half = Matrix(b).determinant() / 2.0
    turn = math.acos(min(1.0, max(-1.0, half))) / 3.0
    least = mean + 2.0 * size * math.cos(turn + 2.0 * math.pi / 3.0)
    return least, mean + 2.0 * size * math.cos(turn)


def _areas(sides: list[list[Triangle]], closed: bool) -> list[native.Light] | None:
    """Lights of radiance 1 above both sides of faces, or outside those of a body; None: they are
    bent, or no shape that a light can have."""
    made: list[native.Light] = []
    middle = _center(t for side in sides for t in side)
    for side in sides:
        found = _fitted(side)
        if found is None:
            return None
        center, normal, u, v, is_round = found
        area = u.length * v.length * (math.pi / 4.0 if is_round else 1.0)
        away = _ABOVE * math.sqrt(area)
        ways = (normal, -normal)
        if closed:
            ways = (normal if normal.dot(center - middle) > 0.0 else -normal,)
        for way in ways:
            made.append(
                native.Light(
                    "",
                    native.LightKind.AREA,
                    power=4.0 * area,
                    position=tuple(center + away * way),
                    direction=tuple(way),
                    edge_u=tuple(u),
                    edge_v=tuple(v),
                    round=is_round,
                )
            )
    return made


def _fitted(side: list[Triangle]) -> tuple[Vector, Vector, Vector, Vector, bool] | None:
    """A rectangle or an ellipse with the area and the inertia of flat faces: (center, normal, edge
    u, edge v, round)."""
    areas = [((b - a).cross(c - a)).length / 2.0 for a, b, c in side]
    area = sum(areas)
    if not area > 0.0 or not math.isfinite(area):
        return None
    normal = _normal(side[max(range(len(side)), key=areas.__getitem__)])
    center = _center(side)
    limit = 0.01 * math.sqrt(area)
    if any(abs(normal.dot(p - center)) > limit for t in side for p in t):
        return None
    x = normal.orthogonal().normalized()
    y = normal.cross(x)
    xx = yy = xy = 0.0
    for (a, b, c), weight in zip(side, areas):
        points = [(x.dot(p - center), y.dot(p - center)) for p in (a, b, c)]
        middle = [sum(p[i] for p in points) for i in (0, 1)]
        for p in (*points, middle):  # exact for squares of linear functions
            xx += weight * p[0] * p[0] / 12.0
            yy += weight * p[1] * p[1] / 12.0
            xy += weight * p[0] * p[1] / 12.0
    turn = 0.5 * math.atan2(2.0 * xy, xx - yy)
    mean, half = (xx + yy) / 2.0, math.hypot((xx - yy) / 2.0, xy)
    large, small = math.sqrt((mean + half) / area), math.sqrt(max(mean - half, 0.0) / area)
    if not small > 0.0:
        return None
    full = area / (12.0 * large * small)
    if full < _FULL:  # with holes, of separate pieces, or with arms
        return None
    is_round = full > 1.02
    edges = area * (4.0 / math.pi if is_round else 1.0)  # their product
    times = math.sqrt(edges / (large * small))
    u = x * math.cos(turn) + y * math.sin(turn)
    return center, normal, u * large * times, normal.cross(u) * small * times, is_round


def _point(sides: list[list[Triangle]], closed: bool) -> list[native.Light] | None:
    """The light of radiance 1 in the middle of a small body."""
    triangles = [t for side in sides for t in side]
    if not closed:
        return None
    area = sum(((b - a).cross(c - a)).length / 2.0 for a, b, c in triangles)
    center = _center(triangles)
    volume = sum((a - center).dot((b - center).cross(c - center)) / 6.0 for a, b, c in triangles)
    if not area > 0.0 or 36.0 * math.pi * volume * volume < _ROUND * area**3:
        return None
    return [_point_of(center, area)]


def _point_of(center: Vector, area: float) -> native.Light:
    """The light of a convex body of radiance 1."""
    return native.Light(
        "",
        native.LightKind.POINT,
        power=math.pi * area,
        position=tuple(center),
        radius=math.sqrt(area / (4.0 * math.pi)),
    )


def _center(triangles: Iterable[Triangle]) -> Vector:
    total, sum_ = 0.0, Vector((0.0, 0.0, 0.0))
    for a, b, c in triangles:
        area = ((b - a).cross(c - a)).length
        total += area
        sum_ += (area / 3.0) * (a + b + c)
    return sum_ / total if total > 0.0 else sum_
