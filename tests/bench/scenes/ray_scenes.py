# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for bench_rays.py: in each, much of what the picture shows is a mirror's image, a shadow
or light that other things send; and what that comes from has levels."""

import math
import os
import random
from array import array
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy
from bench.scenes import crowd_groups, light_scenes
from bench.scenes.mesh_materials import materials
from bench.scenes.mesh_shapes import Filler, placed

DATA = Path(
    os.environ.get("LODESTONE_DATA") or Path(__file__).resolve().parents[4] / "shared" / "data"
)
# Of the data: which axis is up, and how high they are
FIGURES = {"beetle_open": ("y", 0.7), "fandisk": ("z", 1.0)}
KINDS = (*FIGURES, "tree")
TREE = 0.24  # its scale as a figure
CONTACT = 1e-3  # metres above what a figure stands on: its vertices below are its contact
GRAY, WARM, WHITE = (0.5, 0.5, 0.5), (0.55, 0.45, 0.35), (0.8, 0.8, 0.78)


@dataclass
class Scene:
    """What a view looks at. `contacts`: points where things touch."""

    name: str
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    width: float  # of the frame at distance 1
    contacts: numpy.ndarray | None = None  # [n][3]
    radiosity: bool = False
    lamps: bool = False  # many: approximated lights are looked at, too


def read_ply(path: Path) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Points [n][3] and triangles [m][3] of one of the data's binary files."""
    data = path.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    counts = [int(line.split()[2]) for line in head.splitlines() if line.startswith(b"element")]
    points = numpy.frombuffer(body, "<f4", 3 * counts[0]).reshape(-1, 3)
    row = numpy.dtype([("corners", "u1"), ("at", "<i4", 3)])
    faces = numpy.frombuffer(body, row, counts[1], points.nbytes)
    if set(faces["corners"]) != {3}:
        raise ValueError(f"{path.name} is not of triangles")
    return points.astype(float), faces["at"].astype(numpy.int32)


def stood(points: numpy.ndarray, up: str, high: float) -> numpy.ndarray:
    """Of that height, its lowest point at z = 0, its middle on the axis."""
    turned = points if up == "z" else points[:, [0, 2, 1]] * (1, -1, 1)
    low, top = turned.min(0), turned.max(0)
    scale = high / (top[2] - low[2])
    return (turned - ((low[0] + top[0]) / 2, (low[1] + top[1]) / 2, low[2])) * scale


def ball(rows: int) -> tuple[numpy.ndarray, numpy.ndarray]:
    """A smooth unit ball of 4 rows^2 triangles."""
    points, triangles = light_scenes.ball(2 * rows, rows)
    return 2 * numpy.array(points).reshape(-1, 3), numpy.array(triangles).reshape(-1, 3)


class Maker(light_scenes.Maker):
    """Boxes as there, figures of real scans, trees; placed in groups, one group a row of them."""

    def __init__(self, native) -> None:
        super().__init__(native)
        self.meshes: dict = {}
        self.filler = Filler(native, self.model, materials(native, self.model))
        self.touching: list[numpy.ndarray] = []
        self.group = self.root

    def rows(self, name: str) -> None:
        """What is placed from here on belongs to a group of its own."""
        self.group = self.model.add_group(name, name)
        self.model.add_placement(self.root, self.group, placed(), name)

    def material(self, name: str, **fields) -> int:
        if name not in self.filler.materials:
            self.filler.materials[name] = self.model.add_material(name, **fields)
        return self.filler.materials[name]

    def mesh(self, name: str, slot: str, points: numpy.ndarray, triangles: numpy.ndarray):
        """A smooth mesh in one material."""
        buffers = self.native.FaceBuffers(
            array("f", points.astype(numpy.float32).tobytes()),
            array("i", triangles.astype(numpy.int32).tobytes()),
            face_smooth=array("b", b"\1" * len(triangles)),
        )
        return self.model.add_faces(name, name, buffers, [self.filler.materials[slot]])

    def figure(self, kind: str, slot: str, by) -> None:
        """One of FIGURES, or a tree of crowd_groups.py."""
        key = (kind, "" if kind == "tree" else slot)
        if key not in self.meshes:
            if kind == "tree":
                self.meshes[key] = self.filler.put(crowd_groups.tree(3000)), None
            else:
                points, triangles = read_ply(DATA / "models" / f"{kind}.ply")
                points = stood(points, *FIGURES[kind])
                item = self.mesh(f"{kind} {slot}", slot, points, triangles)
                self.meshes[key] = item, points[points[:, 2] < CONTACT]
        item, below = self.meshes[key]
        self.model.add_placement(self.group, item, by, kind)
        if below is not None:
            rows = numpy.array(by).reshape(3, 4)
            self.touching.append(below @ rows[:, :3].T + rows[:, 3])

    def solid(self, name: str, slot: str, points: numpy.ndarray, triangles: numpy.ndarray, by):
        """Something that stays as it is: what bends rays shows far smaller errors than its own."""
        self.model.add_placement(self.group, self.mesh(name, slot, points, triangles), by, name)
        last = self.model.object_summary(self.group).child_count - 1
        self.model.decide_placement(self.group, last, 1.0, 0)

    def lanterns(self, slot: str, places, radius: float) -> None:
        """Round-cornered cubes of 14,400 triangles that hang in the air: convex, but no ball."""
        points, triangles = ball(60)
        points /= (points**4).sum(1, keepdims=True) ** 0.25
        item = self.mesh(f"lantern {slot}", slot, points, triangles)
        for place in places:
            self.model.add_placement(self.group, item, placed(*place, 0, radius), "lantern")

    def block(self, slot: str, low, high, touches: bool = False) -> None:
        """A box in a material by name; `touches`: with what is below it."""
        _, triangles = light_scenes.cube()
        by = numpy.subtract(high, low)
        points = numpy.array(light_scenes.CORNERS) * by + numpy.add(low, high) / 2
        name = f"{slot} {low} {high}"
        flat = array("f", points.astype(numpy.float32).tobytes())
        buffers = self.native.FaceBuffers(flat, array("i", triangles))
        item = self.model.add_faces(name, name, buffers, [self.filler.materials[slot]])
        self.model.add_placement(self.group, item, placed(), name)
        if touches:
            along = numpy.linspace(low[:2], high[:2], 60)
            sides = [(along[:, 0], at * numpy.ones(60)) for at in (low[1], high[1])]
            sides += [(at * numpy.ones(60), along[:, 1]) for at in (low[0], high[0])]
            rim = [numpy.column_stack([x, y, low[2] * numpy.ones(60)]) for x, y in sides]
            self.touching.append(numpy.concatenate(rim))

    def plain(self, color) -> str:
        name = f"plain {color}"
        self.material(name, base_color=color, roughness=0.9, specular=0.0)
        return name

    def sun(self, way, power: float = 3.0, angle: float = 0.0) -> None:
        kind = self.native.LightKind.SUN
        self.model.add_light(
            self.native.Light("sun", kind, power=power, direction=way, angle=angle)
        )

    def panel(self, center, side: float, power: float) -> None:
        """An area lamp that looks down."""
        self.model.add_light(
            self.native.Light(
                "panel",
                self.native.LightKind.AREA,
                power=power,
                position=center,
                direction=(0.0, 0.0, -1.0),
                edge_u=(side, 0.0, 0.0),
                edge_v=(0.0, side, 0.0),
            )
        )

    def done(self, world, scene: Scene) -> tuple:
        self.model.set_root(self.root)
        self.model.set_world(world)
        if self.touching:
            scene.contacts = numpy.concatenate(self.touching)
        return self.model, scene


class HouseMaker(Maker):
    """Fan disks in place of balls."""

    def _shape(self, kind: str, color: tuple[float, float, float]):
        if kind != "ball":
            return super()._shape(kind, color)
        if "disk" not in self.shapes:
            points, triangles = read_ply(DATA / "models" / "fandisk.ply")
            points = stood(points, "z", 1.0) - (0, 0, 0.5)
            self.shapes["disk"] = self.mesh("disk", self.plain(WARM), points, triangles)
        return self.shapes["disk"]


def crowd(make: Maker, dice: random.Random, places, slots=("wood", "red", "blue", "white")) -> None:
    """Figures at places (x, y), each turned in its own way."""
    for number, (x, y) in enumerate(places):
        kind = KINDS[number % 3]
        size = dice.uniform(0.9, 1.2) * (TREE if kind == "tree" else 1)
        by = placed(x, y, 0, dice.uniform(0, 6.3), size)
        make.figure(kind, slots[number // 3 % len(slots)], by)


def grid(columns, rows) -> list[tuple[float, float]]:
    return [(x, y) for y in rows for x in columns]


def mirror(native) -> tuple:
    """A hall of which most is seen in the mirror on its far wall; lit by a panel."""
    make, dice = Maker(native), random.Random(1)
    make.material("silver", base_color=(0.9, 0.9, 0.92), metallic=1.0, roughness=0.0)
    for low, high, color in (
        ((-9, -16, -0.2), (9, 4.2, 0), WARM),
        ((-9.2, -16, 0), (-9, 4.2, 5), WHITE),
        ((9, -16, 0), (9.2, 4.2, 5), WHITE),
        ((-9, 4, 0), (9, 4.2, 5), GRAY),
        ((-9, -16.2, 0), (9, -16, 5), (0.4, 0.5, 0.6)),
        ((-9.2, -16.2, 5), (9.2, 4.2, 5.2), WHITE),
    ):
        make.block(make.plain(color), low, high)
    make.block("silver", (-6, 3.9, 0.1), (6, 3.99, 4))
    for row, y in enumerate((1.5, -3.5, -8.0, -10.0, -12.0, -14.0)):
        make.rows(f"row {row}")
        crowd(make, dice, grid([x for x in range(-7, 8, 2) if y < 0 or abs(x) > 2], (y,)))
    make.rows("lanterns")
    make.lanterns("yellow", [(x, y, 3.2) for x, y in grid((-5, -2, 2, 5), (2.2, -1, -8, -12))], 0.3)
    make.panel((0, -5, 4.9), 3.0, 900)
    return make.done((0.12, 0.12, 0.13), Scene("mirror", (-1.5, -5.4, 1.7), (0.4, 4, 1.3), 1.2))


def curved(native) -> tuple:
    """A ball and a column of metal in a crowd that stands around the camera too."""
    make, dice = Maker(native), random.Random(2)
    make.material("chrome", base_color=(0.85, 0.85, 0.88), metallic=1.0, roughness=0.0)
    make.block(make.plain(WARM), (-30, -30, -0.2), (30, 30, 0))
    make.solid("ball", "chrome", *ball(100), placed(-1.1, 0, 1.3, 0, 1.3))
    around = 200
    turns = 2 * numpy.pi * numpy.arange(around) / around
    ring = numpy.stack([0.8 * numpy.cos(turns), 0.8 * numpy.sin(turns)], 1)
    points = numpy.concatenate(
        [numpy.column_stack([ring, numpy.full(around, z)]) for z in (0.0, 3.2)]
    )
    k = (numpy.arange(around) + 1) % around
    i = numpy.arange(around)
    sides = numpy.concatenate(
        [numpy.stack([i, k, k + around], 1), numpy.stack([i, k + around, i + around], 1)]
    )
    make.solid("column", "chrome", points, sides, placed(1.8, 0.6))
    make.block("chrome", (1.2, 0.0, 3.2), (2.4, 1.2, 3.3))
    for ring_of in range(4):
        make.rows(f"ring {ring_of}")
        number, radius = 10 + 4 * ring_of, 4.0 + 2.5 * ring_of
        turned = [2 * math.pi * (n + 0.3 * ring_of) / number for n in range(number)]
        places = [(radius * math.cos(a), radius * math.sin(a)) for a in turned]
        crowd(make, dice, [p for p in places if math.dist(p, (0, -6.5)) > 1.6])
    make.rows("lanterns")
    turned = [2 * math.pi * n / 12 for n in range(12)]
    make.lanterns("yellow", [(5 * math.cos(a), 5 * math.sin(a), 2.4) for a in turned], 0.3)
    make.sun((-0.4, 0.5, -0.7), angle=0.01)
    return make.done((0.4, 0.45, 0.55), Scene("curved mirror", (0, -6.5, 1.9), (0.2, 0, 1.3), 1.1))


def glass(native) -> tuple:
    """Bodies and a pane of glass before and among figures."""
    make, dice = Maker(native), random.Random(3)
    make.material("crystal", base_color=(0.95, 0.97, 0.97), transmission=1.0, roughness=0.0)
    make.block(make.plain(WHITE), (-14, -8, -0.2), (14, 14, 0))
    make.solid("ball", "crystal", *ball(80), placed(-1.4, -1.6, 0.9, 0, 0.9))
    points, triangles = read_ply(DATA / "models" / "fandisk.ply")
    make.solid("disk", "crystal", stood(points, "z", 1.2), triangles, placed(0.7, -2.2, 0, 0.5))
    make.block("crystal", (1.6, -0.9, 0), (3.4, -0.82, 2.2))
    for row, y in enumerate((0.6, 2.5, 4.5, 7.0, 10.0)):
        make.rows(f"row {row}")
        crowd(make, dice, grid((-5.5, -3.6, -1.8, 0.0, 1.8, 3.6, 5.5), (y,)))
    make.sun((0.5, 0.6, -0.8), angle=0.01)
    return make.done((0.5, 0.55, 0.6), Scene("glass", (0, -7.5, 1.7), (0.1, 0, 0.9), 1.0))


def contact(native) -> tuple:
    """Things that stand, lie on each other, lean and hang, near and far, under a low sun."""
    make, dice = Maker(native), random.Random(4)
    make.block(make.plain((0.7, 0.68, 0.62)), (-60, -12, -0.2), (60, 110, 0))
    make.block(make.plain(WHITE), (4.5, -2, 0), (4.7, 9, 3))
    make.rows("near")
    crowd(
        make, dice, [(-2.2, -1.2), (-0.9, 0.3), (0.5, -0.9), (1.9, 0.9), (-2.9, 1.9), (3.0, -0.3)]
    )
    make.rows("piles")
    for x, y, count in ((-0.1, 2.6, 3), (2.6, 3.4, 4)):
        for step in range(count):
            half = 0.42 - 0.07 * step
            low = (x - half, y - half, 0.4 * step)
            make.block("wood", low, (x + half, y + half, 0.4 * step + 0.4), touches=True)
        by = placed(x, y, 0.4 * count, dice.uniform(0, 6.3), 0.6)
        make.figure("fandisk", "red", by)
    make.rows("hanging")
    for n in range(3):
        make.figure("beetle_open", "white", placed(3.2, -1.2 + 1.5 * n, 1.6, n, 0.7))
    make.rows("lanterns")
    places = grid((-3.2, -1.4, 0.4, 2.2), (0.6, 2.2, 4.0, 6.5))
    make.lanterns("yellow", [(x, y, 1.9 + 0.2 * (n % 3)) for n, (x, y) in enumerate(places)], 0.22)
    for row in range(4):
        make.rows(f"far {row}")
        crowd(make, dice, grid([2.2 * x for x in range(-9, 3)], (7 + 5 * row * (1 + row),)))
    make.rows("trees")
    for n in range(9):
        make.figure("tree", "", placed(-16 + 5 * n, 26 + 7 * (n % 3), 0, n, 0.8))
    make.sun((0.8, 0.45, -0.55), 3.0, 0.009)
    return make.done(
        (0.35, 0.4, 0.5), Scene("contact shadows", (-1.2, -6.0, 2.1), (0.6, 2.0, 0.7), 1.0)
    )


def radiosity(native) -> tuple:
    """A room lit through an opening, by what its walls and figures hand on."""
    make, dice = Maker(native), random.Random(5)
    red, green = (0.65, 0.1, 0.08), (0.12, 0.45, 0.15)
    for low, high, color in (
        ((-4, -7, -0.2), (4, 5, 0), WHITE),
        ((-4, -7, 4), (4, 5, 4.2), WHITE),
        ((-4.2, -7, 0), (-4, 5, 4), red),
        ((-4, 5, 0), (4, 5.2, 4), WHITE),
        ((-4, -7.2, 0), (4, -7, 4), WHITE),
        ((4, -7, 0), (4.2, -1.5, 4), green),
        ((4, 2.5, 0), (4.2, 5, 4), green),
        ((4, -1.5, 0), (4.2, 2.5, 0.8), green),
        ((4, -1.5, 3.4), (4.2, 2.5, 4), green),
    ):
        make.block(make.plain(color), low, high)
    for row, y in enumerate((-0.8, 0.8, 2.4, 4.0)):
        make.rows(f"row {row}")
        crowd(make, dice, grid((-3.1, -1.6, 0.0, 1.6, 3.0), (y,)), ("white", "paper", "yellow"))
    make.sun((-0.75, 0.12, -0.55), 30.0, 0.009)
    return make.done(
        (0.6, 0.7, 0.9),
        Scene("radiosity", (0.2, -6.3, 2.0), (0, 1.5, 1.2), 1.15, radiosity=True),
    )


def below(native) -> tuple:
    """Figures on a grating, lit by a sun under the horizon; their shadows are on a roof."""
    make, dice = Maker(native), random.Random(6)
    make.rows("bars")
    for n in range(-30, 31):
        make.block("steel", (0.2 * n - 0.03, -2, -0.06), (0.2 * n + 0.03, 8, 0))
    make.rows("roof")
    make.block(make.plain(WHITE), (-8, -2, 4.6), (8, 10, 4.8))
    for x in (-6, 6):
        for y in (-1, 8):
            make.block("wood", (x - 0.15, y - 0.15, -3), (x + 0.15, y + 0.15, 4.6))
    make.block(make.plain(WARM), (-8, 9.8, -1), (8, 10, 4.6))
    for row, y in enumerate((0.0, 2.0, 4.0, 6.0)):
        make.rows(f"row {row}")
        crowd(make, dice, grid((-5, -3, -1, 1, 3, 5), (y,)))
    make.rows("lanterns")
    make.lanterns("white", [(x, y, 2.6) for x, y in grid((-4, -2, 0, 2, 4), (0, 2, 4, 6))], 0.3)
    make.sun((0.25, 0.35, 0.7), 3.0, 0.009)
    return make.done((0.25, 0.25, 0.3), Scene("sun below", (0.6, -7.5, 1.2), (0, 3, 2.4), 1.2))


def lamps(native) -> tuple:
    """The house of 100 rooms and 400 lamps of light_scenes.py, a figure on each table."""
    make = HouseMaker(native)
    model, house = light_scenes.house(native, make)
    return model, Scene("400 lamps", house.eye, house.target, house.width, lamps=True)


SCENES: dict[str, Callable] = {
    "mirror": mirror,
    "curved": curved,
    "glass": glass,
    "contact": contact,
    "radiosity": radiosity,
    "below": below,
    "lamps": lamps,
}
