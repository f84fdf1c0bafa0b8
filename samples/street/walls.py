# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls and slabs with openings, and the bricks and boards on them.

A wall stands along x from 0 to its width, rises along z, faces -y: its outer face is y = 0, its
inner face y = thickness. An opening is (x0, z0, x1, z1).
"""

import math

from mathutils import Matrix

FLAT = Matrix.Rotation(-math.pi / 2, 4, "X")


def wall(builder, width, height, thickness, openings, outer, inner, reveal):
    """Closed slab with rectangular holes, as one grid of cells without T-junctions."""
    xs = sorted({0.0, width, *(o[0] for o in openings), *(o[2] for o in openings)})
    zs = sorted({0.0, height, *(o[1] for o in openings), *(o[3] for o in openings)})

    def solid(i, j):
        if not (0 <= i < len(xs) - 1 and 0 <= j < len(zs) - 1):
            return False
        x, z = (xs[i] + xs[i + 1]) / 2, (zs[j] + zs[j + 1]) / 2
        return not any(a < x < c and b < z < d for a, b, c, d in openings)

    numbers, points = {}, []
    faces = {outer: [], inner: [], reveal: []}

    def number(i, j, back):
        key = (i, j, back)
        if key not in numbers:
            numbers[key] = len(points)
            points.append((xs[i], thickness if back else 0.0, zs[j]))
        return numbers[key]

    for i in range(len(xs) - 1):
        for j in range(len(zs) - 1):
            if not solid(i, j):
                continue
            f = [number(i, j, 0), number(i + 1, j, 0), number(i + 1, j + 1, 0), number(i, j + 1, 0)]
            b = [number(i, j, 1), number(i + 1, j, 1), number(i + 1, j + 1, 1), number(i, j + 1, 1)]
            faces[outer].append(tuple(f))
            faces[inner].append(tuple(reversed(b)))
            sides = ((0, -1, 0, 1), (1, 0, 1, 2), (0, 1, 2, 3), (-1, 0, 3, 0))
            for di, dj, k, m in sides:
                if not solid(i + di, j + dj):
                    faces[reveal].append((f[m], f[k], b[k], b[m]))
    first = len(builder.points)
    builder.points.extend(points)
    for material, quads in faces.items():
        builder.faces.extend([tuple(first + v for v in quad) for quad in quads])
        builder.face_slots.extend([builder.slot(material)] * len(quads))
        builder.face_smooth.extend([False] * len(quads))


def floor(builder, low, high, thickness, openings, top, bottom):
    """Horizontal slab: low and high are (x, y) corners of its top; thickness hangs down."""
    holes = [(a - low[0], b - low[1], c - low[0], d - low[1]) for a, b, c, d in openings]
    with builder.moved(Matrix.Translation((low[0], low[1], 0)) @ FLAT):
        wall(builder, high[0] - low[0], high[1] - low[1], thickness, holes, top, bottom, bottom)


def free_spans(width, low, high, openings, margin):
    """Stretches of 0..width that no opening touches between two heights."""
    taken = sorted(
        (a - margin, c + margin)
        for a, b, c, d in openings
        if b - margin < high and d + margin > low
    )
    spans, x = [], 0.0
    for a, c in taken:
        if a > x + 0.02:
            spans.append((x, a))
        x = max(x, c)
    if width > x + 0.02:
        spans.append((x, width))
    return spans


def bricks(builder, width, height, openings, material, rng, size=(0.48, 0.15), start=0.0):
    """Stretcher bond of closed boxes that stand a little out of the wall."""
    length, course = size
    joint = 0.012
    rows = int((height - start) / course)
    for row in range(rows):
        low = start + row * course
        high = low + course - joint
        for a, b in free_spans(width, low, high, openings, 0.02):
            x = a - (a % length) - (length / 2 if row % 2 else 0)
            while x < b:
                x0, x1 = max(x, a), min(x + length - joint, b)
                if x1 - x0 > 0.03:
                    builder.box(
                        (x0, -0.012 - 0.006 * rng.random(), low), (x1, 0.01, high), material
                    )
                x += length


def boards(builder, width, height, openings, material, course=0.16, start=0.0):
    """Clapboards: closed wedges, thick at their lower edge."""
    for row in range(int((height - start) / course)):
        low = start + row * course
        high = low + course
        for a, b in free_spans(width, low, high, openings, 0.02):
            section = [(-0.030, low), (0.004, low), (0.004, high), (-0.006, high)]
            rings = [[(x, y, z) for y, z in section] for x in (a, b)]
            builder.loft(rings, material, smooth=False)


def gable(builder, width, rise, thickness, material, boarded):
    """Closed triangle over a wall's width, up to the ridge; boarded: with clapboards on it."""
    builder.prism([(0, 0), (width, 0), (width / 2, rise)], 0, thickness, material)
    if not boarded:
        return
    course = 0.16
    for row in range(int(rise / course)):
        low, high = row * course, (row + 1) * course
        inset = high / rise * width / 2 + 0.02
        if width - 2 * inset > 0.1:
            section = [(-0.030, low), (0.004, low), (0.004, high), (-0.006, high)]
            rings = [[(x, y, z) for y, z in section] for x in (inset, width - inset)]
            builder.loft(rings, material, smooth=False)
