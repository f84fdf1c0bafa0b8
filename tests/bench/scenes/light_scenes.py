# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of 400 lamps for bench_lights.py: a building seen through its missing front, a corridor
with doors to closed rooms, a market in the open."""

import math
import random
from array import array
from dataclasses import dataclass, field

COLUMNS, STOREYS = 10, 10
WIDTH, HEIGHT, DEPTH = 4.0, 3.0, 4.0
WALL = 0.2
CORNERS = [(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


@dataclass
class Scene:
    """What a view looks at, and the parts of its picture (left, top, right, bottom; 0 to 1) that
    are one room each."""

    name: str
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    width: float  # of the frame at distance 1
    rooms: list[tuple[float, float, float, float]] = field(default_factory=list)


class Maker:
    """Boxes and balls of a few colors, placed in one group."""

    def __init__(self, native) -> None:
        self.native = native
        self.model = native.Model()
        self.root = self.model.add_group("root", "root")
        self.shapes: dict = {}
        self.lamps = 0

    def _shape(self, kind: str, color: tuple[float, float, float]):
        if (kind, color) not in self.shapes:
            name = f"{kind} {color}"
            material = self.model.add_material(name, base_color=color, specular=0.0)
            points, triangles = cube() if kind == "box" else ball(16, 12)
            mesh = self.native.MeshBuffers(array("f", points), array("I", triangles))
            self.shapes[kind, color] = self.model.add_mesh(name, name, mesh, [material])
        return self.shapes[kind, color]

    def place(self, kind: str, low, high, color=(0.7, 0.7, 0.7)) -> None:
        size = [b - a for a, b in zip(low, high)]
        middle = [(a + b) / 2 for a, b in zip(low, high)]
        rows = [size[0], 0, 0, middle[0], 0, size[1], 0, middle[1], 0, 0, size[2], middle[2]]
        self.model.add_placement(self.root, self._shape(kind, color), rows, kind)

    def lamp(self, position, color, power: float) -> None:
        kind = self.native.LightKind.POINT
        self.lamps += 1
        self.model.add_light(self.native.Light(f"lamp {self.lamps}", kind, color, power, position))

    def finish(self):
        self.model.set_root(self.root)
        self.model.set_world((0.0, 0.0, 0.0))
        return self.model


def cube() -> tuple[list[float], list[int]]:
    triangles = [i for a, b, c, d in FACES for i in (a, b, c, a, c, d)]
    return [value for corner in CORNERS for value in corner], triangles


def ball(around: int, up: int) -> tuple[list[float], list[int]]:
    points, triangles = [], []
    for j in range(up + 1):
        for i in range(around):
            a, b = 2 * math.pi * i / around, math.pi * j / up
            points += [
                0.5 * math.sin(b) * math.cos(a),
                0.5 * math.sin(b) * math.sin(a),
                -0.5 * math.cos(b),
            ]
    for j in range(up):
        for i in range(around):
            k = (i + 1) % around
            a, b, c, d = j * around + i, j * around + k, (j + 1) * around + k, (j + 1) * around + i
            triangles += [a, b, c, a, c, d]
    return points, triangles


def furnish(make: Maker, dice: random.Random, x: float, y: float, z: float) -> None:
    """A table, a cupboard and a ball in the room whose floor's middle is (x, y, z)."""
    color = (dice.uniform(0.2, 0.8), dice.uniform(0.2, 0.8), dice.uniform(0.2, 0.8))
    make.place("box", (x - 0.9, y - 0.4, z + 0.7), (x + 0.4, y + 0.4, z + 0.78), color)
    for i, j in ((-0.8, -0.3), (0.3, -0.3), (-0.8, 0.3), (0.3, 0.3)):
        make.place("box", (x + i, y + j, z), (x + i + 0.06, y + j + 0.06, z + 0.7), color)
    make.place("box", (x + 0.9, y + 0.9, z), (x + 1.7, y + 1.5, z + 1.8), (0.4, 0.3, 0.2))
    make.place("ball", (x - 0.5, y - 0.2, z + 0.78), (x - 0.1, y + 0.2, z + 1.18), color[::-1])


def light_room(make: Maker, dice: random.Random, x: float, y: float, z: float) -> None:
    """Four lamps below the ceiling of the room whose floor's middle is (x, y, z)."""
    warm = dice.random()
    color = (1.0, 0.75 + 0.2 * warm, 0.5 + 0.5 * warm)
    power = dice.uniform(10, 40)
    for i in (-1.0, 1.0):
        for j in (-1.0, 1.0):
            make.lamp((x + i, y + j, z + 2.5), color, power)


def house(native, make: Maker | None = None):
    """Ten storeys of ten rooms without a front; walls, floors and the back are shared."""
    make, dice = make or Maker(native), random.Random(5)
    wide, high = COLUMNS * WIDTH, STOREYS * HEIGHT
    for column in range(COLUMNS + 1):
        x = column * WIDTH
        make.place("box", (x - WALL / 2, 0, 0), (x + WALL / 2, DEPTH, high))
    for storey in range(STOREYS + 1):
        z = storey * HEIGHT
        make.place("box", (0, 0, z - WALL / 2), (wide, DEPTH, z + WALL / 2), (0.6, 0.55, 0.5))
    make.place("box", (0, DEPTH, 0), (wide, DEPTH + WALL, high), (0.75, 0.75, 0.7))
    make.place("box", (-40, -60, -0.3), (wide + 40, DEPTH, -WALL / 2), (0.3, 0.4, 0.3))
    scene = Scene("house", (wide / 2, -44, high / 2), (wide / 2, 0, high / 2), 1.15)
    for storey in range(STOREYS):
        for column in range(COLUMNS):
            x, z = (column + 0.5) * WIDTH, storey * HEIGHT + WALL / 2
            furnish(make, dice, x, DEPTH / 2, z)
            light_room(make, dice, x, DEPTH / 2, z)
            # The opening, by the pinhole at the eye.
            step = 1 / (1.15 * 44)
            left = 0.5 + (column * WIDTH + WALL - wide / 2) * step
            top = 0.5 - ((storey + 1) * HEIGHT - WALL - high / 2) * step * 16 / 9
            scene.rooms.append(
                (
                    left,
                    top,
                    left + (WIDTH - 2 * WALL) * step,
                    top + (HEIGHT - 2 * WALL) * step * 16 / 9,
                )
            )
    return make.finish(), scene


def corridor(native):
    """Fifty rooms on each side of a corridor without lamps, a door to each."""
    make, dice = Maker(native), random.Random(6)
    rooms, half, door = 50, 1.0, 0.5
    long = rooms * WIDTH
    deep = half + DEPTH
    make.place("box", (0, -deep, -WALL), (long, deep, 0), (0.5, 0.45, 0.4))
    make.place("box", (0, -deep, HEIGHT), (long, deep, HEIGHT + WALL), (0.8, 0.8, 0.8))
    for end in (-WALL, long):
        make.place("box", (end, -deep, 0), (end + WALL, deep, HEIGHT))
    for side in (-1, 1):
        outer = sorted((side * deep, side * (deep + WALL)))
        make.place("box", (0, outer[0], 0), (long, outer[1], HEIGHT), (0.7, 0.75, 0.8))
        inner = sorted((side * half, side * (half + WALL / 2)))
        for room in range(rooms):
            x = (room + 0.5) * WIDTH
            for low, high in ((room * WIDTH, x - door), (x + door, (room + 1) * WIDTH)):
                make.place("box", (low, inner[0], 0), (high, inner[1], HEIGHT))
            make.place("box", (x - door, inner[0], 2.1), (x + door, inner[1], HEIGHT))
            wall = sorted((side * (half + WALL / 2), side * deep))
            make.place(
                "box",
                (room * WIDTH - WALL / 2, wall[0], 0),
                (room * WIDTH + WALL / 2, wall[1], HEIGHT),
            )
            y = side * (half + DEPTH / 2 + WALL / 4)
            furnish(make, dice, x, y, 0)
            light_room(make, dice, x, y, 0)
    return make.finish(), Scene("corridor", (61, -0.3, 1.6), (80, 0.1, 1.3), 1.4)


def market(native):
    """Twenty stalls with a string of twenty bulbs each, under the moon and a last glow."""
    make, dice = Maker(native), random.Random(7)
    for row in range(-4, 12):
        for column in range(-8, 8):
            shade = dice.uniform(0.3, 0.4)
            low = (column * 5.0, row * 5.0, -0.1)
            make.place("box", low, (low[0] + 5, low[1] + 5, 0), (round(shade, 1), 0.35, 0.33))
    for stall in range(20):
        x, y = (stall % 5 - 2) * 7.0, (stall // 5) * 8.0
        color = (dice.uniform(0.3, 0.9), dice.uniform(0.1, 0.4), 0.2)
        make.place("box", (x - 1.5, y - 0.6, 0), (x + 1.5, y + 0.6, 0.9), (0.4, 0.25, 0.15))
        make.place("box", (x - 1.8, y - 1.2, 2.4), (x + 1.8, y + 1.2, 2.5), color)
        for i in (-1.6, 1.6):
            make.place("box", (x + i, y - 1, 0), (x + i + 0.1, y - 0.9, 2.4), (0.3, 0.2, 0.1))
        for i in range(6):
            at = x - 1.2 + 0.4 * i
            make.place("ball", (at, y - 0.2, 0.9), (at + 0.3, y + 0.1, 1.2), color[::-1])
        for i in range(20):
            t = i / 19
            place = (x - 1.8 + 3.6 * t, y - 1.3, 2.35 - 0.4 * (4 * t * (1 - t)))
            make.lamp(place, (1.0, 0.8, 0.5), 1.6)
    kind = native.LightKind.SUN
    for name, color, power, way in (
        ("moon", (0.6, 0.7, 1.0), 0.05, (0.3, 0.4, -1.0)),
        ("glow", (1.0, 0.5, 0.3), 0.03, (-1.0, 0.2, -0.3)),
    ):
        make.model.add_light(native.Light(name, kind, color, power, direction=way))
    return make.finish(), Scene("market", (0, -16, 7), (0, 8, 0), 1.3)


SCENES = {"house": house, "corridor": corridor, "market": market}
