# SPDX-License-Identifier: GPL-3.0-or-later
"""Street: plots with houses and gardens in blocks on both sides, trees, cars and fittings.

Plot coordinates: the road's axis is y = 0, the plot lies at y > 0 with its middle at x = 0.
"""

import functools
import math
import random

import bpy
from mathutils import Matrix

import fittings
import ground
import houses
import materials
import walls
from library import Library, place
from mesh_builder import MeshBuilder

PLOTS = 11
# How a house is made: own meshes, linked duplicates of a design's, or an instancing empty
MAKES = ("own", "instance", "duplicate", "instance", "own", "instance", "duplicate")
STREET_TREES = ("Linden", "Maple", "Cherry", "Oak", "Birch", "Linden")
GARDEN_TREES = ("Oak", "Birch", "Spruce", "Cherry", "Maple", "Linden", "Poplar", "Spruce")


@functools.lru_cache(maxsize=None)
def picket(length):
    return fittings.picket_fence(length)


@functools.lru_cache(maxsize=None)
def boarded(length):
    return fittings.board_fence(length)


@functools.lru_cache(maxsize=None)
def hedge(length, height, seed):
    return fittings.hedge(length, height, seed)


class Street:
    """Builds the whole street under one collection."""

    def __init__(self, scene, seed):
        self.seed = seed
        self.rng = random.Random(f"street {seed}")
        self.library = Library(scene)
        self.root = bpy.data.collections.new("Street")
        scene.collection.children.link(self.root)
        child = Library.child
        environment = child(self.root, "Environment")
        blocks = child(self.root, "Blocks")
        self.woods = child(self.root, "Street Trees")
        self.fittings = child(self.root, "Street Fittings")
        self.traffic = child(self.root, "Traffic")
        self.drives = MeshBuilder()
        self.counts = {"houses": 0, "trees": 0, "cars": 0, "lamps": 0, "benches": 0}
        number = 0
        for side, sign in (("North", 1), ("South", -1)):
            for index, (a, c) in enumerate(ground.BLOCKS):
                block = child(blocks, f"{side} {index + 1}")
                width = (c - a) / PLOTS
                for k in range(PLOTS):
                    x = a + width * (k + 0.5)
                    turn = Matrix.Rotation(0 if sign > 0 else math.pi, 4, "Z")
                    plot = Matrix.Translation((x, 0, 0)) @ turn
                    number += 1
                    self.plot(block, number, plot, width, index + (3 if sign < 0 else 0))
        self.drive_by()
        self.countryside()
        ground.build(environment, self.drives, seed)
        self.library.exclude(bpy.context.view_layer)

    def put(self, collection, name, data, plot, x, y, degrees=0.0, z=0.0, scale=(1, 1, 1)):
        """Object or instancing empty in plot coordinates."""
        obj = place(collection, name, data)
        turn = Matrix.Rotation(math.radians(degrees), 4, "Z")
        size = Matrix.Diagonal((*scale, 1))
        obj.matrix_basis = plot @ Matrix.Translation((x, y, z)) @ turn @ size
        return obj

    def tree(self, collection, species, plot, x, y, size=1.0):
        """A tree, every other one as an instancing empty; turned and a little stretched."""
        rng = self.rng
        mesh = rng.choice(self.library.trees[species])
        data = self.library.tree_collections[mesh.name] if self.counts["trees"] % 2 else mesh
        size *= rng.uniform(0.85, 1.1)
        scale = (size * rng.choice((-1, 1, 1)), size, size * rng.uniform(0.92, 1.12))
        self.put(collection, species, data, plot, x, y, rng.uniform(0, 360), 0, scale)
        self.counts["trees"] += 1

    def car(self, collection, plot, x, y, degrees, z):
        """A car: body with object-linked paint and parented wheels, or an instancing empty."""
        rng = self.rng
        kind = rng.randrange(len(self.library.cars))
        model = self.library.cars[kind]
        self.counts["cars"] += 1
        if self.counts["cars"] % 4 == 0:
            self.put(
                collection, model.name, self.library.car_collections[kind], plot, x, y, degrees, z
            )
            return
        body = self.put(collection, model.name, model.body, plot, x, y, degrees, z)
        paint = rng.choice(materials.CAR_PAINTS)
        body.material_slots[0].link = "OBJECT"
        body.material_slots[0].material = materials.get(paint)
        for wx, wy, wz, turn in model.places:
            wheel = place(collection, "Wheel", model.wheel, wx, wy, turn, wz)
            wheel.parent = body

    def plot(self, block, number, plot, width, block_index):
        """One plot: house, garden, drive, pavement trees and fittings."""
        rng, lib = self.rng, self.library
        home = Library.child(block, f"House {number}")
        # Neighbors differ: seven designs in a shuffled cycle
        index = (number * 3 + block_index) % len(houses.DESIGNS)
        make = MAKES[(number + number // 7) % len(MAKES)]
        house = lib.houses[index]
        if make == "own":
            house = houses.build(houses.variant(houses.DESIGNS[index], rng, number), lib.sets)
        m = -1 if rng.random() < 0.45 else 1
        half = width / 2
        hx = half - 1.1 - house.high[0]
        hy = ground.PAVEMENT + 5.6 + rng.uniform(0, 1.2)
        mirror = Matrix.Diagonal((m, 1, 1, 1))
        stretch = Matrix.Diagonal(
            (1, 1.0 if make != "instance" else rng.choice((1, 1, 1.04)), 1, 1)
        )
        matrix = plot @ mirror @ Matrix.Translation((hx, hy, 0)) @ stretch
        if make == "instance":
            empty = place(home, house.design.name, lib.house_collections[index])
            empty.matrix_basis = matrix
        else:
            houses.realize(house, home, matrix, f"House {number}")
        self.counts["houses"] += 1
        garden = Library.child(home, f"House {number} Garden")
        self.garden(garden, number, plot, m, half, house, hx, hy)
        species = STREET_TREES[block_index]
        self.tree(
            self.woods, species, plot, half, 5.35, 0.68 if species in ("Oak", "Maple") else 0.82
        )
        self.put(self.fittings, "Street Lamp", lib.lamp, plot, 0.0, 5.0, -90)
        self.counts["lamps"] += 1
        if number % 3 == 0:
            self.put(self.fittings, "Resting Place", lib.rest, plot, 3.6 * m, 5.45)
            self.counts["benches"] += 1

    def garden(self, garden, number, plot, m, half, house, hx, hy):
        """Fences, drive, path, mailbox, bins, flowers, trees and a car."""
        rng, lib = self.rng, self.library
        path = hx + house.door_x
        garage = house.design.garage
        drive = (
            (hx + house.high[0] - 3.1, hx + house.high[0] - 0.4)
            if garage
            else (-half + 0.5, -half + 3.4)
        )
        drive_end = hy + 1.2 if garage else hy + 3.0
        flat = plot @ Matrix.Diagonal((m, 1, 1, 1))
        ground.drive(self.drives, flat, (drive[0], ground.PAVEMENT), (drive[1], drive_end))
        ground.drive(
            self.drives, flat, (drive[0], ground.KERB), (drive[1], ground.VERGE), "Paving", False
        )
        veranda = house.design.porch == "veranda"
        porch = hy - (2.26 if veranda else 1.86 if house.design.porch else 0.86)
        ground.drive(
            self.drives, flat, (path - 0.6, ground.PAVEMENT), (path + 0.6, porch), "Paving"
        )
        gaps = sorted(((path - 0.75, path + 0.75), (drive[0] - 0.15, drive[1] + 0.15)))
        x, spans = -half + 0.15, []
        for a, c in gaps + [(half - 0.15, half)]:
            if a - x > 0.6:
                spans.append((x, a))
            x = c
        style = number % 3
        for a, c in spans:
            length = round(c - a - 0.05, 1)
            left = a if m > 0 else -(a + length)
            if style == 0:
                self.put(garden, "Picket Fence", picket(length), plot, left, 8.25)
            elif style == 1:
                self.put(
                    garden, "Hedge", hedge(length, 0.9, int(length * 10) % 3), plot, left, 8.55
                )
            else:
                self.put(garden, "Low Wall", low_wall(length), plot, left, 8.2)
        self.put(garden, "Board Fence", boarded(22.0), plot, half, hy + 3.0, 90)
        self.put(
            garden,
            "Back Hedge",
            hedge(round(2 * half - 0.3, 1), 1.6, number % 4),
            plot,
            -half + 0.1,
            ground.BACK,
        )
        self.put(garden, "Mailbox", lib.mailbox, plot, m * (path + 1.05), 8.9)
        if not garage:
            self.put(
                garden,
                "Wheelie Bin",
                lib.wheelie,
                plot,
                m * (hx + house.low[0] - 0.55),
                hy + 1.2,
                90 * m,
            )
        wing = bool(house.design.wing)
        if not garage and not wing:
            for k in range(2):
                bed = lib.beds[rng.randrange(3)]
                if not veranda and path + 2.0 + 2.6 * k + 2.3 < hx + house.high[0]:
                    self.put(garden, "Flower Bed", bed, plot, m * (path + 3.0 + 2.6 * k), hy - 0.7)
        right = half - 1.3
        if not garage:
            for k in range(3):
                shrub = lib.shrubs[rng.randrange(4)]
                spot = right - 1.4 * k
                if spot - 0.8 > path + 1.0:
                    size = rng.uniform(0.9, 1.3)
                    self.put(
                        garden,
                        "Shrub",
                        shrub,
                        plot,
                        m * spot,
                        9.6 + rng.uniform(0, 0.5),
                        rng.uniform(0, 360),
                        0,
                        (size, size, size),
                    )
            if not wing and rng.random() < 0.45:
                self.tree(
                    garden,
                    rng.choice(("Cherry", "Birch", "Maple")),
                    plot,
                    m * (right - 1.6),
                    10.6,
                    0.55,
                )
        for k in range(rng.choice((1, 2, 2))):
            spot = -half + 4.0 + (2 * half - 8.0) * (k + rng.random() * 0.5) / 1.6
            species = rng.choice(GARDEN_TREES)
            self.tree(
                garden, species, plot, spot, hy + house.high[1] + 6.5 + rng.uniform(0, 4.5), 0.85
            )
        if rng.random() < 0.6 and not (garage and drive_end - ground.PAVEMENT < 6):
            y = (ground.PAVEMENT + drive_end) / 2 + 0.6
            self.car(
                garden,
                plot,
                m * (drive[0] + drive[1]) / 2,
                y,
                rng.choice((90, -90)),
                0.03,
            )
        elif not garage and rng.random() < 0.75:
            self.car(self.traffic, plot, m * 1.5 + rng.uniform(-0.5, 0.5), 3.45, 0, ground.ROAD_TOP)

    def drive_by(self):
        """Cars on the move, each on its own lane."""
        for x in (-262, -171, -33, 58, 151, 238):
            self.car(self.traffic, Matrix(), x, 1.2, 180, ground.ROAD_TOP)
        for x in (-214, -78, 12, 204):
            self.car(self.traffic, Matrix(), x, -1.2, 0, ground.ROAD_TOP)

    def countryside(self):
        """Copses and field trees around the street."""
        rng = self.rng
        for x, y, count in (
            (-240, 150, 7),
            (60, 210, 9),
            (260, 130, 6),
            (-90, -130, 8),
            (190, -190, 8),
            (-330, -100, 6),
        ):
            for _ in range(count):
                species = rng.choice(("Oak", "Spruce", "Poplar", "Linden", "Spruce"))
                place_x, place_y = x + rng.gauss(0, 16), y + rng.gauss(0, 9)
                self.tree(
                    self.woods, species, Matrix.Translation((0, 0, -0.16)), place_x, place_y, 1.1
                )


@functools.lru_cache(maxsize=None)
def low_wall(length):
    """Garden wall of bricks with a coping."""
    b = MeshBuilder()
    rng = random.Random(f"wall {length}")
    b.box((0, 0.02, 0), (length, 0.22, 0.7), "Mortar")
    walls.bricks(b, length, 0.7, [], "Brick Brown", rng, (0.28, 0.1))
    with b.at(length, 0.24, 0, 180):
        walls.bricks(b, length, 0.7, [], "Brick Brown", rng, (0.28, 0.1))
    b.rounded_box((-0.03, -0.05, 0.7), (length + 0.03, 0.29, 0.77), 0.02, "Stone")
    return b.to_mesh(f"Low Wall {length:.1f}")
