# SPDX-License-Identifier: GPL-3.0-or-later
"""Roofs: decks, tiles, ridges, gutters and chimneys.

A roof is built over a rectangle of length (along x) and depth (along y) centered at the origin,
whose wall tops are at z = 0.
"""

import math

from mathutils import Matrix, Vector

import walls

DECK = 0.14


def tile(builder, low, high, arch, material):
    """One closed tile between two edges ((x0, x1), y, lift), arched across by `arch` meters."""
    rings = []
    for (x0, x1), y, lift in (low, high):
        top = lift + 0.03
        if arch:
            ring = [(x0, y, lift), (x1, y, lift), (x1, y, top)]
            ring += [
                (x1 + (x0 - x1) * t, y, top + arch * (1 - (2 * t - 1) ** 2)) for t in (0.33, 0.67)
            ]
            ring.append((x0, y, top))
        else:
            ring = [(x0, y, lift), (x1, y, lift), (x1, y, top), (x0, y, top)]
        rings.append(ring[::-1])
    builder.loft(rings, material, smooth=bool(arch))


def plane(builder, bottom, top, length, material, style):
    """One roof plane in its own frame: x along the eave, y up the slope; half widths given."""
    outline_low = [(-bottom, 0), (bottom, 0)]
    outline_high = [(top, length), (-top, length)] if top > 0.01 else [(0, length)]
    outline = outline_low + outline_high
    rings = [[(x, y, z) for x, y in outline] for z in (-DECK, 0.0)]
    builder.loft(rings, "Fence Wood", smooth=False)
    width, course, arch = {
        "pantile": (0.42, 0.48, 0.06),
        "slate": (0.40, 0.32, 0.0),
        "shingle": (0.50, 0.34, 0.0),
    }[style]
    rows = max(1, round(length / course))
    course = length / rows

    def half(y):
        return bottom + (top - bottom) * min(y, length) / length

    for row in range(rows):
        y0, y1 = row * course - 0.05, min((row + 1) * course, length)
        h0, h1 = half(max(y0, 0)), half(y1)
        shift = (0.5 if row % 2 and not arch else 0.0) * width
        x = -math.ceil(bottom / width) * width - shift
        while x < bottom:
            low = (max(x, -h0), min(x + width - 0.008, h0))
            high = (min(max(low[0], -h1), h1 - 0.004), max(min(low[1], h1), -h1 + 0.004))
            if low[1] - low[0] > 0.03 and h1 > 0.02:
                tile(builder, (low, y0, 0.025), (high, y1, 0.0), arch, material)
            x += width


def ridge(builder, start, end, material):
    """Half-buried round cap tiles along a ridge or hip."""
    start, end = Vector(start), Vector(end)
    count = max(1, round((end - start).length / 0.42))
    for k in range(count):
        a, b = start.lerp(end, k / count), start.lerp(end, (k + 1.06) / count)
        builder.tube([a, b], [0.12, 0.10], material, sides=8)


def pitched(builder, kind, length, depth, pitch, overhang, material, style):
    """Gable or hip roof; the ridge runs along x. Returns the ridge's and the eave's height."""
    slope = math.tan(pitch)
    lift = DECK / math.cos(pitch)
    run = depth / 2 + overhang
    eave = lift - overhang * slope
    rise = lift + depth / 2 * slope
    sloped = run / math.cos(pitch)
    tilt = Matrix.Rotation(pitch, 4, "X")
    bottom = length / 2 + overhang
    if kind == "gable":
        bottom = length / 2 + 0.45
        half_ridge = bottom
    else:
        half_ridge = length / 2 - depth / 2
    for turn in (0, math.pi):
        frame = Matrix.Rotation(turn, 4, "Z") @ Matrix.Translation((0, -run, eave)) @ tilt
        with builder.moved(frame):
            plane(builder, bottom, half_ridge, sloped, material, style)
        if kind == "hip":
            frame = Matrix.Rotation(turn + math.pi / 2, 4, "Z")
            frame = frame @ Matrix.Translation((0, -bottom, eave)) @ tilt
            with builder.moved(frame):
                plane(builder, run, 0.0, sloped, material, style)
            for side in (-1, 1):
                direction = -1 if turn == 0 else 1
                low = (side * bottom, direction * run, eave + 0.03)
                ridge(builder, low, (side * half_ridge, 0, rise + 0.03), material)
    ridge(builder, (-half_ridge, 0, rise + 0.03), (half_ridge, 0, rise + 0.03), material)
    return rise, eave


def gutter(builder, x0, x1, y, z, material="Zinc"):
    """Half-round gutter along x, with real thickness."""
    arc = [math.pi + math.pi * k / 8 for k in range(9)]
    section = [(0.075 * math.cos(t), 0.075 * math.sin(t)) for t in arc]
    section += [(0.062 * math.cos(t), 0.062 * math.sin(t)) for t in reversed(arc)]
    count = max(2, round((x1 - x0) / 1.5))
    rings = []
    for k in range(count + 1):
        x = x0 + (x1 - x0) * k / count
        rings.append([(x, y + a, z + b) for a, b in section])
    builder.loft(rings, material)


def downpipe(builder, x, eave_y, wall_y, z, material="Zinc"):
    """Pipe from the gutter back to the wall and down to the ground."""
    path = [(x, eave_y, z), (x, eave_y, z - 0.12), (x, wall_y, z - 0.5), (x, wall_y, 0.12)]
    path.append((x, wall_y + (0.12 if eave_y > wall_y else -0.12), 0.04))
    builder.tube(path, 0.045, material, sides=10)
    for height in (0.6, z * 0.55):
        builder.tube([(x, wall_y, height), (x, wall_y, height + 0.06)], 0.06, material, sides=10)


def flat(builder, length, depth, material, rng):
    """Flat roof: slab, parapet with coping, skylights and vents. Returns the parapet's height."""
    a, b = length / 2, depth / 2
    builder.box((-a, -b, 0), (a, b, 0.25), "Roof Gravel")
    for low, high in (
        ((-a, -b), (a, -b + 0.25)), ((-a, b - 0.25), (a, b)),
        ((-a, -b + 0.25), (-a + 0.25, b - 0.25)), ((a - 0.25, -b + 0.25), (a, b - 0.25)),
    ):  # fmt: skip
        builder.box((*low, 0.25), (*high, 0.7), material)
        builder.rounded_box(
            (low[0] - 0.05, low[1] - 0.05, 0.7),
            (high[0] + 0.05, high[1] + 0.05, 0.76),
            0.02,
            "Trim Dark",
        )
    for k in range(2):
        x, y = rng.uniform(-a + 1.2, a - 1.2), (k - 0.5) * depth / 2
        builder.rounded_box((x - 0.6, y - 0.5, 0.25), (x + 0.6, y + 0.5, 0.5), 0.03, "Trim White")
        builder.rounded_box(
            (x - 0.52, y - 0.42, 0.48), (x + 0.52, y + 0.42, 0.56), 0.05, "Window Glass", 3
        )
    for _ in range(3):
        x, y = rng.uniform(-a + 0.8, a - 0.8), rng.uniform(-0.6, 0.6)
        builder.lathe(
            [(0.08, 0.25), (0.08, 0.6), (0.14, 0.62), (0.14, 0.7), (0.04, 0.76)],
            "Zinc",
            16,
            (x, y, 0),
        )
    step = 0.8
    for i in range(int((length - 1.4) / step)):
        for j in range(int((depth - 1.4) / step)):
            if rng.random() < 0.55:
                x, y = -a + 0.7 + i * step, -b + 0.7 + j * step
                builder.rounded_box(
                    (x, y, 0.24), (x + 0.74, y + 0.74, 0.28), 0.015, "Roof Gravel", 1
                )
    return 0.76


def chimney(builder, x, y, low, high, rng, material="Brick Brown"):
    """Brick stack with a crown and two pots."""
    w, d = 0.9, 0.6
    builder.box((x - w / 2, y - d / 2, low), (x + w / 2, y + d / 2, high), "Mortar")
    for turn, width, reach in ((0, w, d), (90, d, w), (180, w, d), (270, d, w)):
        with builder.at(x, y, low, turn), builder.at(-width / 2, -reach / 2, 0):
            walls.bricks(builder, width, high - low, [], material, rng, (0.28, 0.1))
    builder.rounded_box(
        (x - 0.53, y - 0.38, high), (x + 0.53, y + 0.38, high + 0.12), 0.03, "Stone"
    )
    pot = [(0.13, 0.1), (0.12, 0.4), (0.15, 0.42), (0.15, 0.5), (0.1, 0.52)]
    for side in (-0.22, 0.22):
        builder.lathe(pot, "Tile Terracotta", 16, (x + side, y, high))
