# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera that sees a whole scene from outside, with the scene camera in it (dissertation 5.5)."""

import math
from dataclasses import replace

from ..native import lodestone_native as native

_TILT = math.radians(35)  # how far from above the horizon it looks down
_HALF_FOV = math.radians(20)

Vector = tuple[float, float, float]


def overview(
    camera: native.Camera, center: Vector, radius: float, size: tuple[int, int]
) -> native.Camera:
    """Looks the way `camera` does, from behind it and above, at the sphere (center, radius) grown
    until the camera is in it."""
    center, radius = _with_point(center, max(radius, 1e-3), camera.position)
    ahead = _level(camera.direction)
    direction = (
        ahead[0] * math.cos(_TILT),
        ahead[1] * math.cos(_TILT),
        -math.sin(_TILT),
    )
    right = (ahead[1], -ahead[0], 0.0)
    up = (ahead[0] * math.sin(_TILT), ahead[1] * math.sin(_TILT), math.cos(_TILT))
    # The narrower side of the picture holds the sphere
    short = 2.0 * math.tan(_HALF_FOV)
    width, height = size[0] / min(size) * short, size[1] / min(size) * short
    away = radius / math.sin(_HALF_FOV)
    position = tuple(c - away * d for c, d in zip(center, direction))
    return replace(
        camera,
        name="Overview",
        orthographic=False,
        position=position,
        direction=direction,
        right=tuple(width * value for value in right),
        up=tuple(height * value for value in up),
        near_clip=min(camera.near_clip, 0.1 * away),
        aperture=0.0,
    )


def bound_of(cut: native.Cut) -> tuple[Vector, float]:
    """Center and radius of a sphere around all that a cut draws; what is marked as Environment,
    which may go on for ever, only where there is nothing else."""
    known: dict[tuple[int, int], native.records.ObjectSummary] = {}
    boxes: dict[bool, list[tuple[list[float], list[float]]]] = {True: [], False: []}
    for choice in cut.choices():
        summary = known.get(choice.object.key)
        if summary is None:
            summary = known[choice.object.key] = cut.model.object_summary(choice.object)
        rows = [choice.world[4 * axis : 4 * axis + 4] for axis in range(3)]
        middle = [sum(a * b for a, b in zip(row, (*summary.center, 1.0))) for row in rows]
        stretch = max(math.sqrt(sum(row[column] ** 2 for row in rows)) for column in range(3))
        reach = summary.radius * stretch
        box = ([m - reach for m in middle], [m + reach for m in middle])
        boxes[summary.role == native.Role.ENVIRONMENT].append(box)
    shown = boxes[False] or boxes[True]
    if not shown:
        return (0.0, 0.0, 0.0), 1.0
    low = [min(box[0][axis] for box in shown) for axis in range(3)]
    high = [max(box[1][axis] for box in shown) for axis in range(3)]
    center = [0.5 * (a + b) for a, b in zip(low, high)]
    return (center[0], center[1], center[2]), 0.5 * math.dist(low, high)


def _with_point(center: Vector, radius: float, point: Vector) -> tuple[Vector, float]:
    away = math.dist(center, point)
    if away <= radius:
        return center, radius
    grown = 0.5 * (away + radius)
    share = (grown - radius) / away
    moved = [c + share * (p - c) for c, p in zip(center, point)]
    return (moved[0], moved[1], moved[2]), grown


def _level(direction: Vector) -> tuple[float, float]:
    """Along the ground; along Y for a camera that looks straight down."""
    length = math.hypot(direction[0], direction[1])
    if length <= 1e-6 * abs(direction[2]) or length == 0.0:
        return 0.0, 1.0
    return direction[0] / length, direction[1] / length
