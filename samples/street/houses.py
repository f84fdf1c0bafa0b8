# SPDX-License-Identifier: GPL-3.0-or-later
"""Houses: seven designs, each assembled into parts that become objects in nested collections."""

import dataclasses
import random
from collections import namedtuple

import bpy
from mathutils import Matrix

import openings
import rooms
import shells
import walls
from mesh_builder import MeshBuilder
from shells import DOOR, PLINTH, SLAB, STOREY, THICK

# data: a mesh, or a collection (then the object is an instancing empty); group: child collection
Part = namedtuple("Part", "group name data matrix")
House = namedtuple("House", "design parts low high door_x")
Wing = namedtuple("Wing", "x0 y0 x1 roof")


@dataclasses.dataclass(frozen=True)
class Design:
    """What an architect would decide."""

    name: str
    width: float
    depth: float
    storeys: int
    roof: str
    pitch: float
    tiles: str
    tile_style: str
    wall: str
    cladding: str
    gable_wall: str = "Siding White"
    ridge: str = "x"
    chimneys: int = 1
    windows: str = "bars"
    trim: str = "Trim White"
    door: str = "Door Red"
    porch: str = "canopy"
    wing: str = ""
    garage: bool = False
    seed: int = 0

    def rng(self):
        """A fresh stream of random numbers for this design."""
        return random.Random(f"{self.name} {self.seed}")


DESIGNS = (
    Design(
        "Cottage",
        10.4,
        8.8,
        1,
        "gable",
        44,
        "Tile Terracotta",
        "pantile",
        "Brick Red",
        "bricks",
        door="Door Green",
    ),
    Design(
        "Townhouse",
        9.4,
        9.4,
        2,
        "hip",
        33,
        "Slate",
        "slate",
        "Plaster Ochre",
        "quoins",
        windows="shutters",
    ),
    Design(
        "Bungalow",
        11.6,
        9.2,
        1,
        "hip",
        27,
        "Tile Rust",
        "pantile",
        "Brick Sand",
        "bricks",
        porch="veranda",
        door="Door Blue",
    ),
    Design(
        "Modern House",
        9.4,
        9.2,
        2,
        "flat",
        0,
        "Roof Gravel",
        "slate",
        "Plaster White",
        "plain",
        windows="plain",
        trim="Trim Dark",
        porch="",
        garage=True,
        door="Door Blue",
    ),
    Design(
        "Farmhouse",
        11.4,
        8.8,
        1,
        "gable",
        38,
        "Slate Brown",
        "shingle",
        "Siding White",
        "boards",
        wing="gable",
        chimneys=2,
    ),
    Design(
        "Gable House",
        8.6,
        10.4,
        2,
        "gable",
        46,
        "Slate",
        "shingle",
        "Siding Blue",
        "boards",
        "Siding Blue",
        ridge="y",
        windows="bars",
        door="Door Red",
    ),
    Design(
        "Villa",
        11.6,
        9.6,
        2,
        "hip",
        30,
        "Tile Terracotta",
        "pantile",
        "Plaster Rose",
        "quoins",
        windows="shutters",
        wing="terrace",
        door="Door Green",
        chimneys=2,
    ),
)

WALLS = {
    "bricks": ("Brick Red", "Brick Brown", "Brick Sand"),
    "quoins": ("Plaster Ochre", "Plaster Rose", "Plaster Sage", "Plaster White"),
    "boards": ("Siding Blue", "Siding White", "Siding Yellow", "Siding Green"),
    "plain": ("Plaster White", "Plaster Sage", "Stone"),
}


def variant(design, rng, seed):
    """The same design as another owner would have built it."""
    wall = rng.choice(WALLS[design.cladding])
    tiles = {
        "pantile": ("Tile Terracotta", "Tile Rust"),
        "slate": ("Slate", "Slate Brown"),
        "shingle": ("Slate", "Slate Brown", "Tile Rust"),
    }[design.tile_style]
    return dataclasses.replace(
        design,
        width=design.width + rng.choice((-0.6, -0.3, 0.3)),
        depth=design.depth + rng.choice((-0.4, 0.3, 0.6)),
        pitch=design.pitch + rng.choice((-3, 0, 3)),
        tiles=design.tiles if design.roof == "flat" else rng.choice(tiles),
        wall=wall,
        gable_wall=wall if design.cladding == "boards" else rng.choice(WALLS["boards"]),
        door=rng.choice(("Door Red", "Door Green", "Door Blue")),
        seed=seed,
    )


def spread(low, high, width, most=2):
    """Left edges of one or more windows spread evenly over a span."""
    count = max(1, min(most, int((high - low) / (width + 0.75))))
    gap = (high - low - count * width) / (count + 1)
    return [low + gap * (k + 1) + width * k for k in range(count)] if gap > 0.15 else []


class Assembly:
    """Collects a house's parts and its outer walls' openings."""

    def __init__(self, design):
        self.design = design
        self.parts = []
        self.holes = {"front": [], "right": [], "back": [], "left": []}
        w, d = design.width, design.depth
        self.origins = {
            "front": ((-w / 2, 0.0), 0, 0.0),
            "right": ((w / 2, THICK), 90, 0.0),
            "back": ((w / 2, d), 180, 0.0),
            "left": ((-w / 2, d - THICK), 270, 0.0),
        }

    def mesh(self, group, name, builder):
        self.parts.append(
            Part(group, name, builder.to_mesh(f"{self.design.name} {name}"), Matrix())
        )

    def opening(self, side, x, z, width, height, mesh, group, name):
        """A hole in a wall of the main body and what fills it; x from the wall's left end."""
        (ox, oy), degrees, _ = self.origins[side]
        self.holes[side].append((x, z, x + width, z + height))
        if mesh:
            turn = Matrix.Rotation(degrees * 3.141592653589793 / 180, 4, "Z")
            at = Matrix.Translation((ox, oy, 0)) @ turn @ Matrix.Translation((x, 0, z))
            self.parts.append(Part(group, name, mesh, at))

    def windows(self, room, storey, door_x, wing):
        """Windows of one room: on every outer wall it touches."""
        design = self.design
        (x0, y0), (x1, y1) = room.low, room.high
        w, d = design.width, design.depth
        z = PLINTH + storey * STOREY
        modern = design.windows == "plain"
        bath = "Bath" in room.name
        size = (0.8, 0.9) if bath else ((2.2, 1.7) if modern else (1.1, 1.45))
        sill = z + (1.2 if bath else 0.55 if modern else 0.8)
        side_size = (0.8, 0.9) if bath else ((0.8, 1.7) if modern else (1.0, 1.25))
        spans = []
        if y0 < THICK + 0.01:
            low, high = x0 + w / 2, x1 + w / 2
            if storey == 0 and room.kind == "hall":
                low = door_x + w / 2 + DOOR[0] + 0.2
            if not (wing and storey == 0 and wing.x0 < (x0 + x1) / 2 < wing.x1):
                spans.append(("front", low, high, size))
        if y1 > d - THICK - 0.01:
            spans.append(("back", w / 2 - x1, w / 2 - x0, size))
        if x0 < -w / 2 + THICK + 0.01 and not (
            storey == 0 and room.kind == "hall" and design.storeys > 1
        ):
            spans.append(("left", d - THICK - y1, d - THICK - y0, side_size))
        if x1 > w / 2 - THICK - 0.01 and not (design.garage and storey == 0):
            spans.append(("right", y0 - THICK, y1 - THICK, side_size))
        for side, low, high, (width, height) in spans:
            if high - low < width + 0.4:
                width, height = 0.6, 1.2
                if high - low < 0.9:
                    continue
            mesh = openings.window(width, height, design.trim, design.windows)
            for x in spread(low, high, width, 1 if bath else 2):
                self.opening(side, x, sill, width, height, mesh, "Shell", "Window")


def build(design, sets):
    """Assemble one house: a House whose parts are in its own coordinates."""
    a = Assembly(design)
    rng = design.rng()
    w, d = design.width, design.depth
    low, high = (-w / 2 + THICK, THICK), (w / 2 - THICK, d - THICK)
    door_x = low[0] + 1.35
    height = PLINTH + design.storeys * STOREY
    wing = None
    stairs_at = (low[0] + 0.05, low[1] + 0.35)
    for storey in range(design.storeys):
        z = PLINTH + storey * STOREY
        names = rooms.GROUND if storey == 0 else rooms.UPPER
        plan, partitions = rooms.split(low, high, z, names, rng)
        keep = []
        if design.storeys > 1:
            keep = [(stairs_at[0], low[1], stairs_at[0] + 1.0, stairs_at[1] + 3.5)]
        if storey == 0:
            plan[0].doors.append((door_x + 0.5, low[1]))
            living = plan[1]
            if design.wing:
                wing = Wing(living.low[0] + 0.2, -2.6, w / 2 - 0.02, design.wing)
                span = (wing.x0 + wing.x1) / 2 + w / 2
                living.doors.append(((wing.x0 + wing.x1) / 2, low[1]))
                a.opening("front", span - 0.7, z, 1.4, 2.1, None, "", "")
            leaf = openings.door(*DOOR, design.door, design.trim)
            a.opening("front", door_x + w / 2, z, *DOOR, leaf, "Shell", "Front Door")
        for room in plan:
            a.windows(room, storey, door_x, wing)
            a.parts += [Part(*part) for part in rooms.furnish(room, sets, keep, rng)]
        inner = MeshBuilder()
        hole = (
            [(stairs_at[0], stairs_at[1] + 0.5, stairs_at[0] + 0.95, stairs_at[1] + 3.35)]
            if storey
            else []
        )
        with inner.at(0, 0, z):
            walls.floor(
                inner,
                low,
                high,
                SLAB if storey else PLINTH - 0.01,
                hole,
                "Oak Floor",
                "Interior Wall",
            )
        a.mesh("Shell", ("Ground Floor", "Upper Floor")[storey], inner)
        a.mesh(
            "Shell", ("Partitions", "Partitions Upstairs")[storey], shells.partitions(partitions, z)
        )
        leaf = openings.inner_door(*rooms.DOORWAY)
        for p in partitions:
            for offset in p.doorways:
                turn = Matrix.Rotation(0 if p.along == "x" else 1.5707963267948966, 4, "Z")
                at = Matrix.Translation((p.x, p.y, z)) @ turn @ Matrix.Translation((offset, 0, 0))
                a.parts.append(Part(plan[0].name, "Room Door", leaf, at))
    if design.storeys > 1:
        flight = shells.stairs(*stairs_at)
        a.parts.append(
            Part(
                "Hall",
                "Stairs",
                flight.to_mesh(f"{design.name} Stairs"),
                Matrix.Translation((0, 0, PLINTH)),
            )
        )
    ceiling = MeshBuilder()
    with ceiling.at(0, 0, height):
        walls.floor(ceiling, low, high, SLAB, [], "Interior Wall", "Interior Wall")
    a.mesh("Shell", "Ceiling", ceiling)
    outer = MeshBuilder()
    shells.body_walls(outer, design, (-w / 2, 0.0), (w / 2, d), height, a.holes)
    a.mesh("Shell", "Walls", outer)
    roof, pipes = shells.main_roof(design, wing)
    a.mesh("Shell", "Roof", roof)
    a.mesh("Shell", "Gutters", pipes)
    if design.porch:
        a.mesh("Shell", "Porch", shells.porch(design, door_x))
    right = w / 2
    if wing:
        add_wing(a, wing, sets, rng)
    if design.garage:
        add_garage(a, rng)
        right += 3.5
    front = wing.y0 if wing else (-1.9 if design.porch == "veranda" else -1.5)
    return House(design, a.parts, (-w / 2, front), (right, d), door_x + DOOR[0] / 2)


def add_wing(a, wing, sets, rng):
    """One-storey sun room in front of the living room."""
    design = a.design
    builder = MeshBuilder()
    width = wing.x1 - wing.x0
    height = PLINTH + STOREY
    size = (1.1, 1.45)
    holes = {"front": [], "right": [], "left": []}
    mesh = openings.window(*size, design.trim, design.windows)
    for x in spread(0.3, width - 0.3, size[0]):
        holes["front"].append((x, 1.1, x + size[0], 1.1 + size[1]))
        at = Matrix.Translation((wing.x0 + x, wing.y0, 1.1))
        a.parts.append(Part("Shell", "Window", mesh, at))
    deep = -wing.y0
    side = openings.window(0.8, 1.25, design.trim, "bars")
    x = deep / 2 - THICK - 0.4
    holes["right"].append((x, 1.2, x + 0.8, 2.45))
    turn = Matrix.Rotation(1.5707963267948966, 4, "Z")
    at = Matrix.Translation((wing.x1, wing.y0 + THICK, 0)) @ turn @ Matrix.Translation((x, 0, 1.2))
    a.parts.append(Part("Shell", "Window", side, at))
    # The wing's side walls run up to the main body: it ends a wall's thickness inside.
    shells.body_walls(
        builder, design, (wing.x0, wing.y0), (wing.x1, THICK), height, holes, ("back",)
    )
    with builder.at(0, 0, PLINTH):
        low, high = (wing.x0 + THICK, wing.y0 + THICK), (wing.x1 - THICK, 0.0)
        walls.floor(builder, low, high, PLINTH - 0.01, [], "Oak Floor", "Interior Wall")
    a.mesh("Shell", "Wing Walls", builder)
    a.mesh("Shell", "Wing Roof", shells.wing_roof(design, wing))
    door = ((wing.x0 + wing.x1) / 2, 0.0)
    room = rooms.Room("Sun Room", "hall", low, high, PLINTH, [door])
    a.parts += [Part(*p) for p in rooms.furnish(room, sets, [], rng)]


def add_garage(a, rng):
    """Flat-roofed garage on the right."""
    design = a.design
    x0, x1, y0, y1, height = design.width / 2, design.width / 2 + 3.5, 1.2, 7.4, 2.75
    builder = MeshBuilder()
    holes = {"front": [(0.5, 0.06, 3.0, 2.2)]}
    shells.body_walls(builder, design, (x0 - THICK, y0), (x1, y1), height, holes, ("left",))
    with builder.at((x0 + x1) / 2, (y0 + y1) / 2, height):
        builder.box((-1.74, -3.1, 0), (1.74, 3.1, 0.2), "Roof Gravel")
        builder.rounded_box((-1.72, -3.18, 0.05), (1.85, 3.18, 0.32), 0.03, design.trim)
    builder.box((x0, y0 + THICK, 0.0), (x1 - THICK, y1 - THICK, 0.05), "Drive")
    a.mesh("Shell", "Garage", builder)
    leaf = openings.garage_door(2.5, 2.14, "Trim Dark")
    at = Matrix.Translation((x0 - THICK + 0.5, y0, 0.06))
    a.parts.append(Part("Shell", "Garage Door", leaf, at))
    del rng


def realize(house, collection, matrix, title):
    """Objects of a house in child collections: the shell, and one per room."""
    groups = {}
    for part in house.parts:
        if part.group not in groups:
            groups[part.group] = bpy.data.collections.new(f"{title} {part.group}")
            collection.children.link(groups[part.group])
        is_set = isinstance(part.data, bpy.types.Collection)
        obj = bpy.data.objects.new(part.name, None if is_set else part.data)
        if is_set:
            obj.instance_type = "COLLECTION"
            obj.instance_collection = part.data
            obj.empty_display_size = 0.3
        obj.matrix_basis = matrix @ part.matrix
        groups[part.group].objects.link(obj)
