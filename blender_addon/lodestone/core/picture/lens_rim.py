# SPDX-License-Identifier: GPL-3.0-or-later
"""The rim of a lens, towards which it fades, for drawing it. The factor itself is the backend's."""

import math

_STEPS = 48


def half_way(falloff: float) -> float:
    """The place where half of its effect is left, as a share of its radius: 1 for a hard rim."""
    if not falloff > 0.0:
        return 1.0
    return 2.0 / math.pi * math.acos(0.5 ** (1.0 / falloff))


def circles(radius: float) -> list[tuple[float, float, float]]:
    """Three circles around the axes, as pairs of points."""
    points = []
    for axis in range(3):
        for step in range(_STEPS):
            for end in (step, step + 1):
                angle = 2.0 * math.pi * end / _STEPS
                place = [0.0, 0.0, 0.0]
                place[(axis + 1) % 3] = radius * math.cos(angle)
                place[(axis + 2) % 3] = radius * math.sin(angle)
                points.append((place[0], place[1], place[2]))
    return points


def box(half: float) -> list[tuple[float, float, float]]:
    """The edges of a cube, as pairs of points."""
    points = []
    for axis in range(3):
        for u in (-half, half):
            for v in (-half, half):
                for w in (-half, half):
                    place = [0.0, 0.0, 0.0]
                    place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = w, u, v
                    points.append((place[0], place[1], place[2]))
    return points


def disc(x: float, y: float, radius: float) -> list[tuple[float, float, float]]:
    """A circle in the plane, as pairs of points."""
    points = []
    for step in range(_STEPS):
        for end in (step, step + 1):
            angle = 2.0 * math.pi * end / _STEPS
            points.append((x + radius * math.cos(angle), y + radius * math.sin(angle), 0.0))
    return points
