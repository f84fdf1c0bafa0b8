# SPDX-License-Identifier: GPL-3.0-or-later
"""The twelve groups of the sheet, made here; the same ones every time."""

import math
import random

from bench.scenes.mesh_shapes import Group, Shape, cross, lathe, placed


def _unit(rng: random.Random) -> list[float]:
    v = [rng.gauss(0, 1) for _ in range(3)]
    return [x / math.hypot(*v) for x in v]


def _sides(rng: random.Random, a: float, b: float) -> tuple:
    """Half sides of a sheet that lies anyhow."""
    u, w = _unit(rng), _unit(rng)
    v = cross(u, w)
    size = math.hypot(*v)
    return [a * x for x in u], [b * x / size for x in v]


def tree(leaves: int = 5000, seed: int = 5) -> Group:
    rng, out = random.Random(seed), Shape()
    lathe(out, "bark", [(0.18 * (1 - j / 14), 5.0 * j / 12) for j in range(13)], 12)
    for i in range(24):
        turn, z = 2.4 * i, 2.2 + 2.4 * i / 24
        end = (1.4 * math.cos(turn), 1.4 * math.sin(turn), z + 0.7)
        out.tube("bark", (0, 0, z), end, (0.06, 0.015), 6)
    for _ in range(leaves):
        way, radius = _unit(rng), 1.8 * rng.random() ** 0.45
        place = tuple(c + radius * x for c, x in zip((0, 0, 4.2), way))
        out.card("leaf" if rng.random() < 0.7 else "young leaf", place, *_sides(rng, 0.12, 0.07))
    group = Group("tree")
    group.put(out)
    return group


def hedge() -> Group:
    """Of cards with twigs painted on."""
    rng, group = random.Random(6), Group("hedge")
    for part in range(6):
        out = Shape()
        for _ in range(260):
            place = (rng.uniform(0, 1), rng.uniform(-0.35, 0.35), rng.uniform(0.1, 1.4))
            out.card("twig", place, *_sides(rng, 0.13, 0.2))
        for i in range(3):
            x = 0.2 + 0.3 * i
            out.tube("bark", (x, 0, 0), (x + 0.05, 0.05, 1.1), (0.03, 0.01), 6)
        group.put(out, placed(x=part - 3.0))
    return group


def bookcase() -> Group:
    rng, group, case = random.Random(2), Group("bookcase"), Shape()
    for shelf in range(5):
        case.box("wood", (0, 0, 0.5 * shelf), (1.6, 0.4, 0.5 * shelf + 0.04))
    for x in (0, 1.56):
        case.box("wood", (x, 0, 0), (x + 0.04, 0.4, 2.04))
    group.put(case)
    for shelf in range(4):
        x = 0.06
        while x < 1.5:
            book, wide, tall = Shape(), rng.uniform(0.02, 0.05), rng.uniform(0.25, 0.42)
            color = rng.choice(("red", "blue", "green", "yellow", "dark"))
            for side in (0, wide - 0.003):
                book.box(color, (side, 0, 0), (side + 0.003, 0.24, tall))
            book.box(color, (0.003, 0, 0), (wide - 0.003, 0.003, tall))
            book.box("paper", (0.003, 0.003, 0.005), (wide - 0.003, 0.235, tall - 0.005))
            group.put(book, placed(x, 0.05, 0.5 * shelf + 0.04))
            x += wide + 0.003
    return group


def _figure(color: str) -> Shape:
    out = Shape()
    out.ball(color, (0, 0, 1.05), (0.25, 0.17, 0.4), 10)
    for side in (-1, 1):
        out.ball("dark", (0.12 * side, 0, 0.4), (0.1, 0.12, 0.42))
        out.tube(color, (0.24 * side, 0, 1.3), (0.36 * side, 0.1, 0.85), (0.07, 0.05), 8)
        out.ball("skin", (0.37 * side, 0.11, 0.8), (0.05, 0.05, 0.07), 5)
    out.ball("skin", (0, 0, 1.62), (0.12, 0.13, 0.16), 10)
    out.ball("bark", (0, -0.02, 1.68), (0.125, 0.135, 0.13), 6)
    return out


def crowd() -> Group:
    rng, group = random.Random(8), Group("crowd")
    kinds = [_figure(color) for color in ("red", "blue", "green", "white", "yellow")]
    for number in range(80):
        x = 0.9 * (number % 10) + rng.uniform(-0.25, 0.25) - 4
        y = 0.9 * (number // 10) + rng.uniform(-0.25, 0.25) - 3.1
        by = placed(x, y, 0, rng.uniform(0, 6.3), rng.uniform(0.9, 1.1))
        group.put(rng.choice(kinds), by)
    return group


def fence() -> Group:
    group, picket, post, rail = Group("fence"), Shape(), Shape(), Shape()
    points = [(0, 0), (0.07, 0), (0.07, 1.0), (0.035, 1.08), (0, 1.0)]
    solid = [(x, y, z) for y in (0, 0.02) for x, z in points]
    faces = [(0, 1, 2, 3, 4), (9, 8, 7, 6, 5)]
    faces += [((i + 1) % 5, i, i + 5, (i + 1) % 5 + 5) for i in range(5)]
    picket.add("white", solid, faces)
    post.box("white", (0, 0, 0), (0.1, 0.1, 1.15))
    lathe(
        post, "white", [(0.03, 1.15), (0.06, 1.19), (0.05, 1.24), (0.0, 1.27)], 10, (0.05, 0.05, 0)
    )
    rail.box("white", (0, 0, 0), (6, 0.03, 0.08))
    for i in range(48):
        group.put(picket, placed(0.125 * i - 3.0, 0.0, 0.05))
    for i in range(5):
        group.put(post, placed(1.5 * i - 3.05, 0.04))
    for z in (0.25, 0.8):
        group.put(rail, placed(-3, 0.025, z))
    return group


def chair() -> Group:
    group, leg, spindle, rest = Group("chair"), Shape(), Shape(), Shape()
    profile = [(0.018 + 0.008 * math.sin(9 * z), 0.45 * z) for z in (i / 16 for i in range(17))]
    lathe(leg, "wood", profile, 12)
    lathe(spindle, "wood", [(0.008 + 0.006 * math.sin(3.14 * i / 8), i / 16) for i in range(9)], 10)
    rest.box("wood", (-0.22, -0.22, 0.45), (0.22, 0.22, 0.48))
    rest.box("wood", (-0.22, 0.19, 0.98), (0.22, 0.22, 1.05))
    for x in (-0.2, 0.2):
        rest.tube("wood", (x, 0.205, 0.48), (x, 0.205, 1.0), (0.018, 0.016), 10)
        rest.tube("wood", (x, -0.2, 0.2), (x, 0.2, 0.2), (0.01, 0.01), 8)
    rest.tube("wood", (-0.2, 0, 0.2), (0.2, 0, 0.2), (0.01, 0.01), 8)
    cushion, side = Shape(), 16
    grid = [(i / side, j / side) for j in range(side + 1) for i in range(side + 1)]
    swell = [(4 * u * (1 - u) * 4 * v * (1 - v)) ** 0.4 for u, v in grid]
    points = [(0.4 * u - 0.2, 0.4 * v - 0.2, 0.48 + 0.06 * s) for (u, v), s in zip(grid, swell)]
    starts = [j * (side + 1) + i for j in range(side) for i in range(side)]
    faces = [(k, k + 1, k + side + 2, k + side + 1) for k in starts]
    cushion.add("stripes", points, faces, True, [[grid[i] for i in face] for face in faces])
    for x, y in ((-0.19, -0.19), (0.19, -0.19), (-0.19, 0.19), (0.19, 0.19)):
        group.put(leg, placed(x, y))
    for i in range(7):
        group.put(spindle, placed(-0.15 + 0.05 * i, 0.205, 0.48))
    group.put(rest)
    group.put(cushion)
    return group


def house(wide: float = 6, deep: float = 5, walls: str = "brick") -> Group:
    group, body, window, tiles = Group("house"), Shape(), Shape(), [Shape(), Shape()]
    high, ridge = 3.0, 5.2
    body.box(walls, (-wide / 2, -deep / 2, 0), (wide / 2, deep / 2, high), 0.7)
    for x in (-wide / 2, wide / 2):
        gable = [(x, -deep / 2, high), (x, deep / 2, high), (x, 0, ridge)]
        uvs = [[(0, 0), (0.7 * deep, 0), (0.35 * deep, 0.7 * (ridge - high))]]
        body.add(walls, gable, [(0, 1, 2)], uvs=uvs)
    body.box("stone", (-wide / 2 + 0.8, 0.4, 4), (-wide / 2 + 1.4, 1.0, 6))
    body.box("bark", (-0.5, -deep / 2 - 0.05, 0), (0.5, -deep / 2, 2.1))
    for number, shape in enumerate(tiles):
        shape.box("old tile" if number else "tile", (0, 0, 0), (0.3, 0.42, 0.03))
    slope, rng = math.hypot(deep / 2, ridge - high), random.Random(3)
    c, s = deep / 2 / slope, (ridge - high) / slope
    for side in (1, -1):
        for row in range(int(slope / 0.3) + 1):
            for column in range(int(wide / 0.31) + 1):
                x, along = 0.31 * column - wide / 2, 0.3 * row - 0.15
                y, z = along * c - deep / 2, high + along * s + 0.02 * (row % 2)
                x0 = x if side > 0 else -x
                by = (side, 0, 0, x0, 0, side * c, -side * s, side * y, 0, s, c, z)
                group.put(rng.choice(tiles), by)
    window.box("pane", (-0.42, 0, 0.08), (0.42, 0.02, 1.12))
    window.box("dark", (-0.42, 0.1, 0.08), (0.42, 0.12, 1.12))
    for low, top in (
        ((-0.5, -0.03, 0), (0.5, 0.12, 0.08)),
        ((-0.5, -0.03, 1.12), (0.5, 0.12, 1.2)),
        ((-0.5, -0.03, 0), (-0.42, 0.12, 1.2)),
        ((0.42, -0.03, 0), (0.5, 0.12, 1.2)),
        ((-0.02, -0.03, 0), (0.02, 0.05, 1.2)),
    ):
        window.box("white", low, top)
    for x in (-wide / 2 + 1.2, wide / 2 - 1.2):
        group.put(window, placed(x, -deep / 2 - 0.13, 1))
        group.put(window, placed(x, deep / 2 + 0.13, 1, math.pi))
    group.put(window, placed(wide / 2 + 0.13, 0, 1, math.pi / 2))
    group.put(body)
    return group


def _lamp() -> Shape:
    out = Shape()
    profile = [(0.14, 0), (0.14, 0.1), (0.07, 0.25), (0.05, 0.4), (0.04, 2.8), (0.12, 2.9)]
    lathe(out, "dark", profile, 14)
    out.ball("bulb", (0, 0, 3.1), (0.08, 0.08, 0.1), 8)
    out.ball("glass", (0, 0, 3.1), (0.2, 0.2, 0.22), 12)
    lathe(out, "dark", [(0.22, 3.3), (0.16, 3.4), (0.02, 3.46)], 14)
    return out


def lamp_row() -> Group:
    group, lamp = Group("lamp row"), _lamp()
    for i in range(12):
        group.put(lamp, placed(1.4 * i - 7.7, 0.2 * (i % 2)))
    return group


def street_block() -> Group:
    group, lamp, ground = Group("street block"), _lamp(), Shape()
    ground.box("stone", (-16, -9, -0.15), (16, 9, 0))
    ground.box("dark", (-16, -2.5, 0), (16, 2.5, 0.02))
    for i in range(10):
        ground.box("white", (3.2 * i - 15.5, -0.08, 0.02), (3.2 * i - 14, 0.08, 0.03))
    group.put(ground)
    kinds = [house(5, 4, "white"), house(6, 4.4), house(4.6, 4.2, "yellow")]
    green = tree(900, 11)
    for i in range(5):
        group.put(kinds[i % 3], placed(6.3 * i - 12.7, 6.4))
        group.put(kinds[(i + 1) % 3], placed(6.3 * i - 12.7, -6.4, 0, math.pi))
        for side in (1, -1):
            group.put(lamp, placed(6.3 * i - 12, 3.1 * side))
            if i < 4:
                group.put(green, placed(6.3 * i - 9.5, 3.4 * side, 0, i + 2.0 * side, 0.7))
    return group


def car() -> Group:
    """A lofted body with panes, wheels with spokes, lights."""
    group, body, wheel = Group("car"), Shape(), Shape()
    rows, around = 28, 24
    points = []
    for j in range(rows + 1):
        t = j / rows
        x = 4.2 * t - 2.1
        half = 0.84 * (1 - abs(2 * t - 1) ** 6) ** 0.3 + 0.02
        cabin = max(0.0, 1 - (abs(t - 0.54) / 0.33) ** 4)
        high = 0.42 + 0.22 * (1 - abs(2 * t - 1) ** 4) + 0.52 * cabin
        for i in range(around):
            a = 2 * math.pi * i / around
            c, s = math.cos(a), math.sin(a)
            y = half * math.copysign(abs(c) ** 0.5, c)
            z = 0.42 + (high * abs(s) ** 0.6 if s > 0 else -0.2 * abs(s) ** 0.5)
            y *= 1 - 0.22 * max(0.0, z - 0.95) / 0.4
            points.append((x, y, z))
    painted, panes = [], []
    for j in range(rows):
        for i in range(around):
            k = (i + 1) % around
            face = (j * around + i, j * around + k, (j + 1) * around + k, (j + 1) * around + i)
            low = min(points[n][2] for n in face)
            roof = 4 <= i < 8 and 9 < j < 21
            (panes if low > 0.98 and not roof and j not in (12, 18) else painted).append(face)
    ends = [tuple(range(around)), tuple(range(rows * around, (rows + 1) * around))[::-1]]
    body.add("paint", list(points), painted + ends, True)
    body.add("pane", list(points), panes, True)
    body.box("dark", (-1.2, -0.6, 0.5), (1.2, 0.6, 0.75))
    for x, y in ((0.1, 0.32), (0.1, -0.32), (-0.8, 0.32), (-0.8, -0.32)):
        body.box("steel", (x - 0.1, y - 0.2, 0.7), (x + 0.05, y + 0.2, 1.15))
    for side in (1, -1):
        body.ball("bulb", (-2.05, 0.55 * side, 0.62), (0.08, 0.13, 0.08))
        body.box("red", (2.02, 0.6 * side - 0.1, 0.6), (2.12, 0.6 * side + 0.1, 0.68))
    group.put(body)
    tire = [(0.18, -0.1), (0.3, -0.1), (0.33, -0.06), (0.33, 0.06), (0.3, 0.1), (0.18, 0.1)]
    lathe(wheel, "dark", tire, 28)
    lathe(wheel, "steel", [(0.18, -0.1), (0.18, 0.1)], 20)
    for i in range(10):
        c, s = math.cos(0.628 * i), math.sin(0.628 * i)
        wheel.tube(
            "steel", (0.03 * c, 0.03 * s, 0.06), (0.18 * c, 0.18 * s, 0.07), (0.02, 0.015), 6
        )
    wheel.ball("steel", (0, 0, 0.05), (0.06, 0.06, 0.05), 5)
    for x in (-1.3, 1.3):
        for side in (1, -1):
            by = (1, 0, 0, x, 0, 0, side, 0.76 * side, 0, -side, 0, 0.33)
            group.put(wheel, by)
    return group


def book_pile() -> Group:
    """Textured covers, and sheets of paper between them."""
    rng, group = random.Random(9), Group("book pile")
    for pile in range(5):
        z = 0.0
        for _ in range(rng.randint(5, 12)):
            book, thick = Shape(), rng.uniform(0.02, 0.06)
            wide, tall = rng.uniform(0.14, 0.2), rng.uniform(0.2, 0.28)
            cover = rng.choice(("cover", "red", "green", "bark", "dark"))
            for low in (0, thick):
                book.box(cover, (0, 0, low), (wide, tall, low + 0.003))
                middle = (wide / 2, tall / 2, low + (0.0035 if low else -0.0005))
                book.card(cover, middle, (wide / 2, 0, 0), (0, tall / 2, 0))
            book.box(cover, (0, 0, 0), (0.003, tall, thick))
            for sheet in range(24):
                at = 0.003 + (thick - 0.003) * (sheet + 0.5) / 24
                middle = (wide / 2, tall / 2, at)
                book.card("paper", middle, (wide / 2 - 0.005, 0, 0), (0, tall / 2 - 0.005, 0))
            turn = rng.gauss(0, 0.25)
            group.put(book, placed(0.3 * pile - 0.7, 0.12 * (pile % 2), z, turn))
            z += thick + 0.004
    return group


def flock() -> Group:
    rng, bird, group = random.Random(4), Shape(), Group("flock")
    bird.ball("dark", (0, 0, 0), (0.22, 0.07, 0.07), 6)
    bird.ball("dark", (0.24, 0, 0.03), (0.07, 0.05, 0.05), 5)
    wing = [(0.1, 0, 0.03), (-0.1, 0, 0.03), (-0.05, 0.35, 0.12), (0.02, 0.35, 0.12)]
    wing += [(-0.08, 0.7, 0.06)]
    bird.add("steel", wing, [(0, 3, 2, 1), (3, 4, 2)])
    bird.add("steel", [(x, -y, z) for x, y, z in wing], [(0, 1, 2, 3), (3, 2, 4)])
    bird.add("dark", [(-0.15, 0, 0), (-0.42, 0.1, 0), (-0.42, -0.1, 0)], [(0, 1, 2)])
    for _ in range(220):
        x, y, z = (rng.gauss(0, s) for s in (3.2, 2.2, 1.2))
        group.put(bird, placed(x, y, z + 4, rng.gauss(0.4, 0.3), rng.uniform(0.8, 1.2)))
    return group


GROUPS = {
    "tree": tree,
    "hedge": hedge,
    "bookcase": bookcase,
    "crowd": crowd,
    "fence": fence,
    "chair": chair,
    "house": house,
    "street block": street_block,
    "car": car,
    "lamp row": lamp_row,
    "book pile": book_pile,
    "flock": flock,
}
