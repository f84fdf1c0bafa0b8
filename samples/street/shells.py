# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells: the outside of a house (walls, roof, gutters, porch) and its floors and partitions.

House coordinates: the front wall's outer face is y = 0 and faces -y; x = 0 is the body's middle.
"""

import math

from mathutils import Matrix

import roofs
import rooms
import walls
from mesh_builder import MeshBuilder

THICK = 0.32
PLINTH = 0.3
STOREY = 2.75
SLAB = 0.25
DOOR = (1.05, 2.2)


def body_walls(builder, design, low, high, height, openings, skip=()):
    """Four outer walls around a rectangle; openings per side, in that side's own coordinates."""
    (x0, y0), (x1, y1) = low, high
    sides = {
        "front": (x0, y0, 0, x1 - x0),
        "right": (x1, y0 + THICK, 90, y1 - y0 - 2 * THICK),
        "back": (x1, y1, 180, x1 - x0),
        "left": (x0, y1 - THICK, 270, y1 - y0 - 2 * THICK),
    }
    for side, (x, y, degrees, width) in sides.items():
        if side in skip:
            continue
        holes = openings.get(side, [])
        with builder.at(x, y, 0, degrees):
            base = "Mortar" if design.cladding == "bricks" else design.wall
            walls.wall(builder, width, height, THICK, holes, base, "Interior Wall", "Trim White")
            long = degrees in (90, 270)
            with builder.at(-THICK if long else 0, 0, 0):
                full = width + (2 * THICK if long else 0)
                shifted = [
                    (a + THICK, b, c + THICK, d) if long else (a, b, c, d) for a, b, c, d in holes
                ]
                if design.cladding == "bricks":
                    walls.bricks(builder, full, height, shifted, design.wall, design.rng())
                elif design.cladding == "boards":
                    walls.boards(builder, full, height, shifted, design.wall, start=PLINTH)
                for a, b in walls.free_spans(full, 0, 0.28, shifted, 0.0):
                    builder.box((a - 0.025, -0.04, 0), (b + 0.025, 0.01, 0.28), "Stone")
    if design.cladding == "quoins":
        for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)):
            sx, sy = (1 if x == x0 else -1), (1 if y == y0 else -1)
            for k in range(int((height - 0.3) / 0.3)):
                a, b = (0.5, 0.28) if k % 2 else (0.28, 0.5)
                z = 0.3 + 0.3 * k
                corners = sorted((x - sx * 0.03, x + sx * a)), sorted((y - sy * 0.03, y + sy * b))
                (xa, xb), (ya, yb) = corners
                builder.rounded_box((xa, ya, z + 0.01), (xb, yb, z + 0.29), 0.02, "Stone", 1)


def main_roof(design, wing):
    """Roof of the main body, with its gables, and the chimney: one mesh; gutters: another."""
    roof, pipes = MeshBuilder(), MeshBuilder()
    height = PLINTH + design.storeys * STOREY
    w, d = design.width, design.depth
    if design.roof == "flat":
        with roof.at(0, d / 2, height):
            roofs.flat(roof, w, d, design.wall, design.rng())
        roofs.downpipe(pipes, w / 2 - 0.4, -0.1, -0.06, height + 0.2, "Trim Dark")
        return roof, pipes
    turned = design.ridge == "y"
    length, depth = (d, w) if turned else (w, d)
    pitch = math.radians(design.pitch)
    over = 0.5
    with roof.at(0, d / 2, height, 90 if turned else 0):
        rise, eave = roofs.pitched(
            roof, design.roof, length, depth, pitch, over, design.tiles, design.tile_style
        )
        if design.roof == "gable":
            tip = depth / 2 * math.tan(pitch)
            for x, y, degrees in ((length / 2, -depth / 2, 90), (-length / 2, depth / 2, 270)):
                with roof.at(x, y, 0, degrees):
                    boarded = design.cladding != "quoins"
                    walls.gable(roof, depth, tip, THICK, design.gable_wall, boarded)
        for x, side in ((length * 0.27, 0.5), (-length * 0.3, 0.4))[: design.chimneys]:
            top = rise + (0.9 if design.roof == "gable" else 0.8)
            roofs.chimney(
                roof, x if design.roof == "gable" else x * 0.3, side, 0, top, design.rng()
            )
    reach = depth / 2 + over
    half = length / 2 + (0.4 if design.roof == "gable" else over)
    with pipes.at(0, d / 2, height, 90 if turned else 0):
        z = eave - 0.02
        stop = wing.x0 - 0.55 if wing and wing.roof == "gable" else None
        if stop is None:
            roofs.gutter(pipes, -half, half, -reach - 0.07, z)
        else:
            roofs.gutter(pipes, -half, stop, -reach - 0.07, z)
            if wing.x1 + 0.55 < half - 0.3:
                roofs.gutter(pipes, wing.x1 + 0.55, half, -reach - 0.07, z)
        roofs.gutter(pipes, -half, half, reach + 0.07, z)
        if design.roof == "hip":
            with pipes.at(0, 0, 0, 90):
                side = length / 2 + over + 0.07
                for y in (-side, side):
                    roofs.gutter(pipes, -reach, reach, y, z)
    spots = [(-w / 2 + 0.3, -1), (w / 2 - 0.3, 1)] if not turned else []
    for x, side in spots:
        outer = -over - 0.07 if side < 0 else d + over + 0.07
        roofs.downpipe(pipes, x, outer, -0.06 if side < 0 else d + 0.06, height + eave - 0.05)
    if turned:
        with pipes.at(0, d / 2, 0, 90):
            for x, side in ((-d / 2 + 0.3, 1), (d / 2 - 0.3, -1)):
                outer = side * (w / 2 + over + 0.07)
                roofs.downpipe(pipes, x, outer, side * (w / 2 + 0.06), height + eave - 0.05)
    return roof, pipes


def wing_roof(design, wing):
    """Roof of the wing in front of the body: gable with its ridge along y, or a flat terrace."""
    roof = MeshBuilder()
    height = PLINTH + STOREY
    width, middle = wing.x1 - wing.x0, (wing.x0 + wing.x1) / 2
    if wing.roof == "gable":
        pitch = math.radians(design.pitch)
        deep = -wing.y0 + width / 2
        with roof.at(middle, wing.y0 + deep / 2, height, 90):
            roofs.pitched(roof, "gable", deep, width, pitch, 0.4, design.tiles, design.tile_style)
        with roof.at(wing.x0, wing.y0, height):
            walls.gable(roof, width, width / 2 * math.tan(pitch), THICK, design.gable_wall, True)
        return roof
    roof.box((wing.x0, wing.y0, height), (wing.x1, 0, height + 0.2), "Paving")
    roof.rounded_box(
        (wing.x0 - 0.15, wing.y0 - 0.15, height + 0.0),
        (wing.x1 + 0.15, -0.02, height + 0.16),
        0.04,
        "Stone",
    )
    rail = [
        (wing.x0 + 0.1, -0.1),
        (wing.x0 + 0.1, wing.y0 + 0.1),
        (wing.x1 - 0.1, wing.y0 + 0.1),
        (wing.x1 - 0.1, -0.1),
    ]
    for a, b in zip(rail, rail[1:]):
        span = math.hypot(b[0] - a[0], b[1] - a[1])
        count = max(3, round(span / 0.24))
        for k in range(count + 1):
            x, y = a[0] + (b[0] - a[0]) * k / count, a[1] + (b[1] - a[1]) * k / count
            profile = [(0.05, 0.2), (0.03, 0.26), (0.06, 0.42), (0.03, 0.62), (0.05, 0.68)]
            roof.lathe(profile, "Trim White", 10, (x, y, height))
        low = (min(a[0], b[0]) - 0.08, min(a[1], b[1]) - 0.08, height + 0.68)
        roof.rounded_box(
            low, (max(a[0], b[0]) + 0.08, max(a[1], b[1]) + 0.08, height + 0.76), 0.02, "Trim White"
        )
    return roof


def porch(design, door_x):
    """Platform, steps, two or four posts and a lean-to roof over the front door."""
    b = MeshBuilder()
    wide = design.porch == "veranda"
    x0, x1 = (
        (-design.width / 2 + 0.25, design.width / 2 - 0.25)
        if wide
        else (door_x - 0.55, door_x + 1.6)
    )
    deep = 1.9 if wide else 1.5
    b.rounded_box((x0, -deep, 0), (x1, -0.045, 0.26), 0.03, "Stone")
    b.rounded_box((door_x - 0.2, -deep - 0.35, 0), (door_x + 1.25, -deep, 0.13), 0.03, "Stone")
    posts = [x0 + 0.15, x1 - 0.15]
    if wide:
        posts = [x0 + 0.15 + (x1 - x0 - 0.3) * k / 4 for k in range(5)]
    for x in posts:
        profile = [
            (0.12, 0.26),
            (0.12, 0.34),
            (0.075, 0.38),
            (0.085, 1.2),
            (0.07, 2.36),
            (0.11, 2.4),
            (0.11, 2.48),
        ]
        b.lathe(profile, "Trim White", 16, (x, -deep + 0.15, 0))
    b.rounded_box(
        (x0 + 0.02, -deep + 0.05, 2.48), (x1 - 0.02, -deep + 0.25, 2.62), 0.015, "Trim White"
    )
    if wide:
        for a, c in zip(posts, posts[1:]):
            if a < door_x + 0.5 < c:
                continue
            for k in range(1, 12):
                x = a + (c - a) * k / 12
                b.rounded_box(
                    (x - 0.02, -deep + 0.13, 0.3),
                    (x + 0.02, -deep + 0.17, 1.1),
                    0.006,
                    "Trim White",
                    1,
                )
            b.rounded_box((a, -deep + 0.1, 1.1), (c, -deep + 0.2, 1.16), 0.015, "Trim White")
    tilt = math.radians(10)
    frame = Matrix.Translation(((x0 + x1) / 2, -deep - 0.15, 2.72)) @ Matrix.Rotation(tilt, 4, "X")
    half = (x1 - x0) / 2 + 0.15
    with b.moved(frame):
        roofs.plane(b, half, half, (deep + 0.13) / math.cos(tilt), design.tiles, design.tile_style)
    return b


def stairs(x, y):
    """Straight flight along +y, one storey high."""
    b = MeshBuilder()
    for k in range(13):
        z = STOREY * (k + 1) / 14
        b.rounded_box(
            (x, y + 0.25 * k, z - 0.04), (x + 0.9, y + 0.25 * k + 0.29, z), 0.012, "Wood Light"
        )
        b.box(
            (x + 0.02, y + 0.25 * k + 0.03, z - 0.2),
            (x + 0.88, y + 0.25 * k + 0.05, z - 0.04),
            "Trim White",
        )
    for k in range(0, 13, 2):
        z = STOREY * (k + 1) / 14
        b.tube(
            [(x + 0.87, y + 0.25 * k + 0.15, z), (x + 0.87, y + 0.25 * k + 0.15, z + 0.9)],
            0.018,
            "Wood Dark",
            8,
        )
    top = STOREY * 13 / 14 + 0.9
    b.tube([(x + 0.87, y + 0.1, 1.05), (x + 0.87, y + 3.2, top)], 0.03, "Wood Dark", 10)
    return b


def partitions(parts_walls, floor):
    """Inner walls of one storey with their doorways."""
    b = MeshBuilder()
    width, height = rooms.DOORWAY
    for p in parts_walls:
        holes = [(o, 0.0, o + width, height) for o in p.doorways]
        degrees = 0 if p.along == "x" else 90
        with b.at(p.x, p.y, floor, degrees):
            args = ("Interior Wall", "Interior Wall", "Trim White")
            walls.wall(b, p.length, STOREY - SLAB, rooms.PARTITION, holes, *args)
    return b
