# SPDX-License-Identifier: GPL-3.0-or-later
"""Furniture: meshes with their back at y = 0, facing -y, centered in x, standing on z = 0."""

import functools
import math
import random
from collections import namedtuple

from mesh_builder import MeshBuilder

# data: a mesh, or a collection for a set; width along x and depth along -y in meters
Model = namedtuple("Model", "data width depth")


def model(name, width, depth):
    """Decorator: a function that fills a MeshBuilder becomes a cached maker of a Model."""

    def wrap(fill):
        @functools.lru_cache(maxsize=None)
        def make(*options):
            builder = MeshBuilder()
            fill(builder, *options)
            full = name + "".join(f" {o}" for o in options)
            return Model(builder.to_mesh(full), width, depth)

        return make

    return wrap


@model("Dining Table", 1.8, 1.0)
def dining_table(b):
    b.rounded_box((-0.9, -1.0, 0.72), (0.9, 0, 0.76), 0.018, "Wood Light", 1)
    for x in (-0.8, 0.8):
        for y in (-0.9, -0.1):
            b.lathe(
                [(0.025, 0), (0.03, 0.1), (0.042, 0.5), (0.035, 0.6), (0.045, 0.72)],
                "Wood Light",
                14,
                (x, y, 0),
            )
    b.box((-0.8, -0.92, 0.64), (0.8, -0.89, 0.72), "Wood Light")
    b.box((-0.8, -0.11, 0.64), (0.8, -0.08, 0.72), "Wood Light")
    b.lathe(
        [(0.06, 0.76), (0.15, 0.82), (0.17, 0.85), (0.16, 0.85), (0.05, 0.79)],
        "Ceramic",
        24,
        (0, -0.5, 0),
    )


@model("Chair", 0.46, 0.5)
def chair(b):
    b.rounded_box((-0.22, -0.5, 0.43), (0.22, -0.03, 0.47), 0.018, "Wood Dark", 1)
    for x in (-0.19, 0.19):
        b.tube([(x, -0.46, 0), (x, -0.46, 0.43)], [0.016, 0.02], "Wood Dark", 10)
        b.tube(
            [(x, -0.0, 0), (x, -0.05, 0.45), (x, -0.02, 0.92)],
            [0.016, 0.02, 0.015],
            "Wood Dark",
            10,
        )
    for z in (0.62, 0.74, 0.86):
        b.rounded_box((-0.2, -0.05, z), (0.2, -0.03, z + 0.06), 0.008, "Wood Dark", 1)


@model("Bed", 1.6, 2.1)
def bed(b, cover="Fabric Blue"):
    b.rounded_box((-0.8, -0.06, 0.1), (0.8, 0, 1.05), 0.04, "Wood Light", 1)
    b.rounded_box((-0.8, -2.08, 0.12), (0.8, -0.05, 0.32), 0.04, "Wood Light", 2)
    b.rounded_box((-0.77, -2.05, 0.3), (0.77, -0.08, 0.54), 0.08, "Linen", 3)
    b.rounded_box((-0.81, -2.09, 0.36), (0.81, -0.75, 0.6), 0.1, cover, 3)
    for x in (-0.4, 0.4):
        with b.at(x, -0.34, 0.6, 0):
            b.blob((0, 0, 0), (0.34, 0.22, 0.1), 6, "Linen", lambda v: 1 + 0.25 * abs(v.x * v.y))
        for y in (-1.95, -0.15):
            b.box((x * 1.8 - 0.03, y - 0.03, 0), (x * 1.8 + 0.03, y + 0.03, 0.13), "Wood Light")


@model("Sofa", 2.1, 0.95)
def sofa(b, cover="Fabric Grey"):
    b.rounded_box((-1.05, -0.95, 0.12), (1.05, 0, 0.34), 0.05, cover, 2)
    b.rounded_box((-1.05, -0.25, 0.3), (1.05, 0, 0.84), 0.09, cover, 2)
    for side in (-1, 1):
        x0, x1 = sorted((side * 1.05, side * 0.85))
        b.rounded_box((x0, -0.95, 0.2), (x1, -0.05, 0.62), 0.08, cover, 2)
    for k in range(3):
        x = -0.85 + k * 0.567
        b.rounded_box((x + 0.005, -0.93, 0.33), (x + 0.56, -0.22, 0.48), 0.06, cover, 2)
        b.rounded_box((x + 0.005, -0.4, 0.47), (x + 0.56, -0.2, 0.88), 0.08, cover, 2)
    b.rounded_box((0.45, -0.55, 0.5), (0.8, -0.4, 0.82), 0.06, "Fabric Red", 3)
    for x in (-0.95, 0.95):
        for y in (-0.88, -0.08):
            b.lathe([(0.02, 0), (0.03, 0.13)], "Wood Dark", 10, (x, y, 0))


@model("Armchair", 0.86, 0.9)
def armchair(b, cover="Fabric Red"):
    b.rounded_box((-0.43, -0.9, 0.14), (0.43, 0, 0.36), 0.06, cover, 3)
    b.rounded_box((-0.43, -0.24, 0.3), (0.43, 0, 0.95), 0.1, cover, 3)
    for side in (-1, 1):
        x0, x1 = sorted((side * 0.43, side * 0.27))
        b.rounded_box((x0, -0.9, 0.2), (x1, -0.05, 0.6), 0.07, cover, 2)
    b.rounded_box((-0.27, -0.88, 0.34), (0.27, -0.2, 0.5), 0.07, cover, 3)
    for x in (-0.36, 0.36):
        for y in (-0.82, -0.08):
            b.lathe([(0.02, 0), (0.03, 0.15)], "Wood Dark", 10, (x, y, 0))


@model("Coffee Table", 1.1, 0.6)
def coffee_table(b):
    b.rounded_box((-0.55, -0.6, 0.38), (0.55, 0, 0.42), 0.018, "Wood Dark", 1)
    b.rounded_box((-0.5, -0.55, 0.15), (0.5, -0.05, 0.17), 0.008, "Wood Dark")
    for x in (-0.48, 0.48):
        for y in (-0.53, -0.07):
            b.tube([(x, y, 0), (x, y, 0.38)], 0.025, "Wood Dark", 10)
    b.rounded_box((-0.3, -0.42, 0.42), (-0.05, -0.22, 0.45), 0.006, "Book Blue")
    b.lathe([(0.05, 0.42), (0.08, 0.5), (0.05, 0.58), (0.06, 0.6)], "Ceramic", 20, (0.25, -0.3, 0))


@model("Bookshelf", 1.2, 0.34)
def bookshelf(b, seed=0):
    rng = random.Random(seed)
    for x in (-0.6, 0.57):
        b.rounded_box((x, -0.34, 0), (x + 0.03, 0, 2.0), 0.006, "Wood Light", 1)
    b.box((-0.57, -0.015, 0.05), (0.57, -0.005, 1.99), "Wood Light")
    for k in range(6):
        z = 0.06 + 0.385 * k
        b.rounded_box((-0.57, -0.33, z), (0.57, -0.02, z + 0.025), 0.006, "Wood Light", 1)
        if k == 5:
            break
        x = -0.55
        while x < 0.45:
            w, h, d = rng.uniform(0.022, 0.055), rng.uniform(0.2, 0.32), rng.uniform(0.16, 0.24)
            color = rng.choice(["Book Red", "Book Blue", "Book Green", "Linen", "Wood Dark"])
            b.box((x, -0.04 - d, z + 0.025), (x + w - 0.002, -0.04, z + 0.025 + h), color)
            x += w + (0.12 if rng.random() < 0.06 else 0)


@model("Floor Lamp", 0.44, 0.44)
def floor_lamp(b):
    b.lathe(
        [(0.14, 0), (0.15, 0.02), (0.03, 0.04), (0.012, 0.06), (0.012, 1.5)],
        "Brass",
        20,
        (0, -0.22, 0),
    )
    b.lathe(
        [(0.2, 1.35), (0.21, 1.36), (0.15, 1.67), (0.14, 1.68)], "Lamp Shade", 28, (0, -0.22, 0)
    )


@model("Table Lamp", 0.3, 0.3)
def table_lamp(b):
    b.lathe(
        [(0.07, 0), (0.08, 0.02), (0.05, 0.08), (0.075, 0.16), (0.02, 0.26), (0.015, 0.3)],
        "Ceramic",
        20,
        (0, -0.15, 0),
    )
    b.lathe(
        [(0.14, 0.28), (0.15, 0.29), (0.1, 0.47), (0.09, 0.48)], "Lamp Shade", 24, (0, -0.15, 0)
    )


@model("Nightstand", 0.5, 0.42)
def nightstand(b):
    b.rounded_box((-0.25, -0.42, 0.08), (0.25, 0, 0.52), 0.015, "Wood Light")
    for z in (0.13, 0.32):
        b.rounded_box((-0.21, -0.435, z), (0.21, -0.41, z + 0.16), 0.008, "Wood Light", 1)
        b.blob((0, -0.445, z + 0.08), (0.015, 0.015, 0.015), 3, "Brass")


@model("Wardrobe", 1.6, 0.6)
def wardrobe(b):
    b.rounded_box((-0.8, -0.57, 0.06), (0.8, 0, 2.1), 0.015, "Wood Dark")
    b.rounded_box((-0.84, -0.62, 2.1), (0.84, 0.0, 2.18), 0.03, "Wood Dark", 1)
    for k in range(3):
        x = -0.78 + k * 0.52
        b.rounded_box((x + 0.01, -0.6, 0.1), (x + 0.51, -0.56, 2.06), 0.01, "Wood Dark")
        for z in (0.2, 1.1):
            b.rounded_box((x + 0.08, -0.61, z), (x + 0.44, -0.59, z + 0.8), 0.01, "Wood Dark", 1)
        b.tube([(x + 0.46, -0.62, 0.98), (x + 0.46, -0.62, 1.12)], 0.008, "Brass", 8)


@model("Kitchen Units", 2.4, 0.62)
def kitchen(b):
    for k in range(4):
        x = -1.2 + 0.6 * k
        b.rounded_box((x + 0.003, -0.6, 0.1), (x + 0.597, 0, 0.86), 0.006, "Trim White", 1)
        b.rounded_box((x + 0.02, -0.62, 0.13), (x + 0.58, -0.59, 0.83), 0.01, "Fabric Blue", 1)
        b.rounded_box((x + 0.09, -0.628, 0.2), (x + 0.51, -0.61, 0.76), 0.008, "Fabric Blue", 1)
        b.tube([(x + 0.2, -0.64, 0.8), (x + 0.4, -0.64, 0.8)], 0.008, "Steel", 8)
        b.rounded_box((x + 0.003, -0.34, 1.45), (x + 0.597, 0, 2.1), 0.006, "Trim White", 1)
        b.rounded_box((x + 0.02, -0.36, 1.48), (x + 0.58, -0.33, 2.07), 0.01, "Fabric Blue", 1)
    b.rounded_box((-1.2, -0.64, 0.86), (1.2, 0, 0.9), 0.012, "Wood Light", 1)
    b.box((-1.18, -0.54, 0), (1.18, -0.02, 0.1), "Trim Dark")
    for x, y in ((0.45, -0.42), (0.75, -0.42), (0.45, -0.18), (0.75, -0.18)):
        b.lathe([(0.09, 0.9), (0.1, 0.91), (0.085, 0.915)], "Iron", 20, (x, y, 0))
    b.rounded_box((-0.9, -0.52, 0.895), (-0.35, -0.1, 0.91), 0.006, "Steel", 3)
    tap = [(-0.62, -0.08, 0.9), (-0.62, -0.08, 1.15)]
    tap += [
        (-0.62, -0.08 - 0.09 * (1 - math.cos(t)), 1.15 + 0.09 * math.sin(t))
        for t in (0.6, 1.2, 1.8, 2.4, 3.1)
    ]
    b.tube(tap, 0.012, "Steel", 10)


@model("Fridge", 0.62, 0.65)
def fridge(b):
    b.rounded_box((-0.31, -0.6, 0.03), (0.31, 0, 1.85), 0.02, "Steel", 3)
    b.rounded_box((-0.31, -0.65, 0.05), (0.31, -0.6, 0.68), 0.02, "Steel", 1)
    b.rounded_box((-0.31, -0.65, 0.7), (0.31, -0.6, 1.84), 0.02, "Steel", 1)
    b.tube([(-0.26, -0.68, 0.8), (-0.26, -0.68, 1.3)], 0.012, "Trim Dark", 8)


@model("Television", 1.5, 0.45)
def television(b):
    b.rounded_box((-0.75, -0.45, 0.1), (0.75, 0, 0.5), 0.02, "Wood Light", 1)
    b.rounded_box((-0.55, -0.24, 0.6), (0.55, -0.2, 1.25), 0.015, "Trim Dark", 3)
    b.box((-0.53, -0.245, 0.62), (0.53, -0.238, 1.23), "Window Glass")
    b.rounded_box((-0.2, -0.32, 0.5), (0.2, -0.14, 0.52), 0.008, "Trim Dark")
    b.box((-0.05, -0.23, 0.5), (0.05, -0.2, 0.62), "Trim Dark")
    for x in (-0.68, 0.62):
        b.box((x, -0.4, 0), (x + 0.06, -0.05, 0.11), "Wood Dark")


@model("Potted Plant", 0.6, 0.6)
def plant(b, seed=0):
    rng = random.Random(seed)
    b.lathe(
        [(0.13, 0), (0.18, 0.3), (0.2, 0.32), (0.2, 0.36), (0.17, 0.36), (0.15, 0.3)],
        "Tile Terracotta",
        24,
        (0, -0.3, 0),
    )
    b.lathe([(0.16, 0.3), (0.1, 0.32)], "Soil", 16, (0, -0.3, 0))
    for k in range(9):
        turn, reach = k * 2.4, rng.uniform(0.12, 0.28)
        high = rng.uniform(0.75, 1.3)
        dx, dy = math.cos(turn), math.sin(turn)
        top = (dx * reach, -0.3 + dy * reach, high)
        b.tube(
            [(0, -0.3, 0.3), (dx * reach * 0.3, -0.3 + dy * reach * 0.3, high * 0.7), top],
            0.007,
            "Leaves Linden",
            6,
        )
        b.blob(
            top,
            (0.12, 0.12, 0.05),
            3,
            "Leaves Linden",
            lambda v: 1 + 0.3 * math.sin(5 * v.x + turn),
        )


@model("Bathtub", 1.7, 0.75)
def bathtub(b):
    def ring(x, y, z):
        corners = []
        for k in range(32):
            t = 2 * math.pi * k / 32
            c, s = math.cos(t), math.sin(t)
            corners.append(
                (
                    x * math.copysign(abs(c) ** 0.5, c),
                    -0.375 + y * math.copysign(abs(s) ** 0.5, s),
                    z,
                )
            )
        return corners

    rings = [(0.8, 0.33, 0.0), (0.83, 0.36, 0.5), (0.85, 0.375, 0.55), (0.84, 0.365, 0.58)]
    rings += [(0.76, 0.29, 0.57), (0.72, 0.26, 0.45), (0.66, 0.22, 0.15), (0.55, 0.16, 0.11)]
    b.loft([ring(*r) for r in rings], "Ceramic")


@model("Toilet", 0.4, 0.7)
def toilet(b):
    b.rounded_box((-0.2, -0.2, 0.38), (0.2, 0, 0.8), 0.04, "Ceramic", 2)
    b.lathe(
        [(0.12, 0), (0.11, 0.2), (0.19, 0.4), (0.2, 0.42), (0.17, 0.42), (0.1, 0.3)],
        "Ceramic",
        18,
        (0, -0.42, 0),
    )
    b.rounded_box((-0.1, -0.4, 0), (0.1, -0.02, 0.38), 0.04, "Ceramic", 3)


@model("Washbasin", 0.6, 0.48)
def basin(b):
    b.lathe([(0.09, 0), (0.07, 0.1), (0.07, 0.7)], "Ceramic", 20, (0, -0.22, 0))
    b.lathe(
        [(0.08, 0.68), (0.23, 0.82), (0.235, 0.86), (0.2, 0.86), (0.05, 0.75)],
        "Ceramic",
        18,
        (0, -0.24, 0),
    )
    b.tube([(0, -0.03, 0.8), (0, -0.03, 0.98), (0, -0.14, 1.0)], 0.014, "Steel", 10)
    b.rounded_box((-0.28, -0.03, 1.2), (0.28, 0, 1.8), 0.01, "Steel", 3)


@model("Desk", 1.4, 0.7)
def desk(b):
    b.rounded_box((-0.7, -0.7, 0.71), (0.7, 0, 0.75), 0.015, "Wood Light", 1)
    b.rounded_box((0.2, -0.65, 0.08), (0.66, -0.03, 0.71), 0.012, "Wood Light")
    for z in (0.12, 0.32, 0.52):
        b.rounded_box((0.23, -0.67, z), (0.63, -0.64, z + 0.17), 0.01, "Wood Light")
    for y in (-0.65, -0.05):
        b.tube([(-0.65, y, 0), (-0.65, y, 0.71)], 0.025, "Steel", 10)
    b.rounded_box((-0.3, -0.3, 0.85), (0.3, -0.27, 1.22), 0.01, "Trim Dark", 3)
    b.lathe([(0.12, 0.75), (0.11, 0.76), (0.02, 0.77), (0.02, 0.9)], "Trim Dark", 16, (0, -0.25, 0))
    b.rounded_box((-0.25, -0.6, 0.75), (0.25, -0.44, 0.775), 0.008, "Trim Dark")


@model("Rug", 2.2, 1.5)
def rug(b, color="Fabric Red"):
    b.rounded_box((-1.1, -1.5, 0.0), (1.1, 0, 0.015), 0.006, color)
    b.rounded_box((-0.95, -1.35, 0.012), (0.95, -0.15, 0.018), 0.003, "Linen", 1)
