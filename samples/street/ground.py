# SPDX-License-Identifier: GPL-3.0-or-later
"""Ground: fields, lawns, road, kerbs, pavement, markings and driveways; all of it Environment."""

import math
import random

import bpy

from mesh_builder import MeshBuilder

HALF = 300.0
ROAD = 4.5
KERB = 4.65
VERGE = 6.0
PAVEMENT = 8.0
BACK = 42.0
LANE = 3.2
LANES = (-100.0, 100.0)
# Blocks of plots along x, the same on both sides
BLOCKS = ((-300.0, -104.0), (-96.0, 96.0), (104.0, 300.0))
ROAD_TOP = -0.12


def fields(rng):
    """Patchwork of meadows and fields as one sheet, lower than the lawns."""
    b = MeshBuilder()
    xs = [
        -1500,
        -1100,
        -800,
        -610,
        -480,
        -360,
        -230,
        -120,
        0,
        130,
        220,
        350,
        470,
        620,
        820,
        1100,
        1500,
    ]
    ys = [
        -1500,
        -1000,
        -700,
        -500,
        -380,
        -290,
        -210,
        -140,
        -60,
        60,
        130,
        220,
        300,
        420,
        560,
        800,
        1100,
        1500,
    ]
    points = [(x, y, -0.16) for y in ys for x in xs]
    n = len(xs)
    for j in range(len(ys) - 1):
        for i in range(n - 1):
            street = ys[j] == -60
            crops = ["Meadow", "Field Green", "Field Wheat", "Meadow", "Soil"]
            material = "Meadow" if street else rng.choice(crops)
            face = (j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i)
            b.faces.append(face)
            b.face_slots.append(b.slot(material))
            b.face_smooth.append(False)
    b.points = points
    return b


def kerb_line(b, a, c, y, side):
    """Chamfered kerb stones of a meter along x; side: where the road is (-1: towards -y)."""
    count = max(1, round((c - a)))
    for k in range(count):
        x0, x1 = a + (c - a) * k / count + 0.004, a + (c - a) * (k + 1) / count - 0.004
        section = [(y, -0.3), (y + 0.15, -0.3), (y + 0.15, 0.03), (y + 0.03, 0.03), (y, 0.0)]
        if side > 0:
            section = [(2 * y - p, z) for p, z in reversed(section)]
        b.loft([[(x, p, z) for p, z in section] for x in (x0, x1)], "Kerb", smooth=False)


def sheets():
    """Road, lawns, verges, pavement and kerbs."""
    road, lawn, pavement, kerbs = (MeshBuilder() for _ in range(4))
    road.box((-1500, -ROAD, -0.4), (1500, ROAD, ROAD_TOP), "Asphalt")
    for x in LANES:
        for side in (-1, 1):
            y0, y1 = sorted((side * ROAD, side * 700))
            road.box((x - LANE, y0, -0.4), (x + LANE, y1, ROAD_TOP), "Asphalt")
    for a, c in BLOCKS:
        for side in (-1, 1):
            y0, y1 = sorted((side * PAVEMENT, side * (BACK + 1.5)))
            lawn.box((a, y0, -0.4), (c, y1, 0.0), "Lawn")
            y0, y1 = sorted((side * KERB, side * VERGE))
            lawn.box((a, y0, -0.4), (c, y1, 0.0), "Lawn")
            y0, y1 = sorted((side * VERGE, side * PAVEMENT))
            pavement.box((a, y0, -0.4), (c, y1, 0.005), "Mortar")
            for k in range(int(c - a)):
                for j in range(2):
                    y0, y1 = sorted((side * (VERGE + j + 0.006), side * (VERGE + j + 0.994)))
                    pavement.box((a + k + 0.006, y0, -0.02), (a + k + 0.994, y1, 0.02), "Paving")
            kerb_line(kerbs, a, c, side * ROAD, -side)
    return {"Road": road, "Lawns": lawn, "Pavement": pavement, "Kerbs": kerbs}


def markings():
    """Center dashes, edge lines, zebra crossings at the lanes."""
    b = MeshBuilder()
    low, high = ROAD_TOP - 0.01, ROAD_TOP + 0.008
    x = -600.0
    while x < 600:
        if not any(abs(x + 1.5 - lane) < 9 for lane in LANES):
            b.box((x, -0.06, low), (x + 3, 0.06, high), "Road Paint")
        x += 7.5
    for a, c in BLOCKS:
        for side in (-1, 1):
            b.box((a, side * 2.35 - 0.05, low), (c, side * 2.35 + 0.05, high), "Road Paint")
    for lane in LANES:
        for offset in (-7.0, 7.0):
            for k in range(9):
                y = -4.2 + 0.98 * k
                b.box(
                    (lane + offset - 1.4, y, low),
                    (lane + offset + 1.4, y + 0.5, high),
                    "Road Paint",
                )
    return b


def mark_environment(obj):
    """Mark as Environment in the add-on's property, or as an ID property without the add-on."""
    if hasattr(bpy.types.Object, "lodestone"):
        obj.lodestone.role = "ENVIRONMENT"
    else:
        obj["lodestone_environment"] = True


def build(collection, drives, seed):
    """All ground objects; drives: the builder that holds the driveways and paths."""
    rng = random.Random(f"ground {seed}")
    builders = {"Fields": fields(rng), **sheets(), "Markings": markings(), "Driveways": drives}
    for name, builder in builders.items():
        obj = bpy.data.objects.new(name, builder.to_mesh(name))
        collection.objects.link(obj)
        mark_environment(obj)


def drive(drives, matrix, low, high, material="Drive", paved=True):
    """Driveway or path of slabs in plot coordinates."""
    (x0, x1), (y0, y1) = sorted((low[0], high[0])), sorted((low[1], high[1]))
    with drives.moved(matrix):
        drives.box((x0, y0, -0.1), (x1, y1, 0.012), "Mortar" if paved else material)
        if paved:
            columns, rows = max(1, round((x1 - x0) / 0.7)), max(1, math.floor((y1 - y0) / 0.5))
            for i in range(columns):
                for j in range(rows):
                    a, c = x0 + (x1 - x0) * i / columns, y0 + (y1 - y0) * j / rows
                    w, d = (x1 - x0) / columns - 0.02, (y1 - y0) / rows - 0.02
                    drives.box((a + 0.01, c + 0.01, -0.05), (a + w, c + d, 0.03), material)
