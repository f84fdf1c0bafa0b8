# SPDX-License-Identifier: GPL-3.0-or-later
"""Rooms: splits a storey into rooms, places doors, and furnishes each without collisions."""

import math
from collections import namedtuple

from mathutils import Matrix

import furniture

# An axis-aligned room in house coordinates; doors: (x, y) centers of its doorways
Room = namedtuple("Room", "name kind low high floor doors")
# A partition: from (x, y), along "x" or "y", length, doorway offsets
Partition = namedtuple("Partition", "x y along length doorways")

PARTITION = 0.12
DOORWAY = (0.85, 2.05)

GROUND = ("Hall", "Living Room", "Kitchen", "Bathroom")
UPPER = ("Study", "Bedroom Front", "Bedroom Back", "Bathroom Upstairs")


def split(low, high, floor, names, rng):
    """Four rooms: the storey is cut along x, each half along y; returns rooms and partitions."""
    (x0, y0), (x1, y1) = low, high
    half = PARTITION / 2
    y = y0 + (y1 - y0) * rng.uniform(0.50, 0.56)
    front = x0 + (x1 - x0) * rng.uniform(0.34, 0.40)
    back = x0 + (x1 - x0) * rng.uniform(0.58, 0.64)
    hall, living, kitchen, bath = names
    a = x0 + 1.25
    b = min(x1 - 1.4, back + 0.4)
    c = y0 + 0.4
    walls = [
        Partition(x0, y - half, "x", x1 - x0, (a - x0, b - x0)),
        Partition(front + half, y0, "y", y - half - y0, (c - y0,)),
        Partition(back + half, y + half, "y", y1 - y - half, ()),
    ]
    width = DOORWAY[0]
    door_a, door_b, door_c = (a + width / 2, y), (b + width / 2, y), (front, c + width / 2)
    rooms = [
        Room(hall, "hall", (x0, y0), (front - half, y - half), floor, [door_a, door_c]),
        Room(living, "living", (front + half, y0), (x1, y - half), floor, [door_b, door_c]),
        Room(kitchen, "kitchen", (x0, y + half), (back - half, y1), floor, [door_a]),
        Room(bath, "bath", (back + half, y + half), (x1, y1), floor, [door_b]),
    ]
    return rooms, walls


KINDS = {
    "Hall": "hall", "Living Room": "living", "Kitchen": "kitchen", "Bathroom": "bath",
    "Study": "study",
    "Bedroom Front": "bedroom", "Bedroom Back": "bedroom", "Bathroom Upstairs": "bath",
}  # fmt: skip


class Furnisher:
    """Places models along a room's walls or in its middle, keeping floor areas apart."""

    def __init__(self, room, keep_free):
        self.room = room
        self.parts = []
        self.taken = list(keep_free)
        for x, y in room.doors:
            self.taken.append((x - 0.75, y - 0.75, x + 0.75, y + 0.75))

    def free(self, rect):
        (x0, y0), (x1, y1) = self.room.low, self.room.high
        a, b, c, d = rect
        if a < x0 - 1e-6 or b < y0 - 1e-6 or c > x1 + 1e-6 or d > y1 + 1e-6:
            return False
        return not any(a < r and p < c and b < s and q < d for p, q, r, s in self.taken)

    def put(self, name, model, x, y, degrees, rect, height=0.0):
        turn = Matrix.Rotation(math.radians(degrees), 4, "Z")
        matrix = Matrix.Translation((x, y, self.room.floor + height)) @ turn
        self.parts.append((self.room.name, name, model.data, matrix))
        if rect:
            self.taken.append(rect)
        return matrix

    def wall(self, name, model, walls="back left right front", gap=0.03):
        """Back against the first wall with space, nearest its middle; None if there is none."""
        (x0, y0), (x1, y1) = self.room.low, self.room.high
        w, d = model.width, model.depth
        for side in walls.split():
            long = x1 - x0 if side in ("back", "front") else y1 - y0
            steps = int((long - w) / 0.2)
            for k in sorted(range(max(steps, 0) + 1), key=lambda k: abs(k - steps / 2)):
                t = w / 2 + k * 0.2 + 0.02
                if side == "back":
                    x, y, deg, rect = (
                        x0 + t,
                        y1 - gap,
                        0,
                        (x0 + t - w / 2, y1 - gap - d, x0 + t + w / 2, y1),
                    )
                elif side == "front":
                    x, y, deg, rect = (
                        x0 + t,
                        y0 + gap,
                        180,
                        (x0 + t - w / 2, y0, x0 + t + w / 2, y0 + gap + d),
                    )
                elif side == "left":
                    x, y, deg, rect = (
                        x0 + gap,
                        y0 + t,
                        90,
                        (x0, y0 + t - w / 2, x0 + gap + d, y0 + t + w / 2),
                    )
                else:
                    x, y, deg, rect = (
                        x1 - gap,
                        y0 + t,
                        270,
                        (x1 - gap - d, y0 + t - w / 2, x1, y0 + t + w / 2),
                    )
                if self.free(rect):
                    return self.put(name, model, x, y, deg, rect)
        return None

    def middle(self, name, model):
        """Free-standing, as near the room's middle as there is space."""
        (x0, y0), (x1, y1) = self.room.low, self.room.high
        w, d = model.width, model.depth
        spots = [(x0 + 0.2 * i, y0 + 0.2 * j) for i in range(40) for j in range(40)]
        mid = ((x0 + x1) / 2, (y0 + y1) / 2)
        spots.sort(key=lambda s: (s[0] - mid[0]) ** 2 + (s[1] - mid[1]) ** 2)
        for x, y in spots[:500]:
            rect = (x - w / 2, y - d / 2, x + w / 2, y + d / 2)
            if self.free(rect):
                return self.put(name, model, x, y + d / 2, 0, rect)
        return None


def furnish(room, sets, keep_free, rng):
    """List of (room name, object name, mesh or set collection, matrix) for one room."""
    f = Furnisher(room, keep_free)
    kind = KINDS.get(room.name, room.kind)
    fabric = rng.choice(["Fabric Blue", "Fabric Grey", "Fabric Red"])
    if kind == "living":
        f.wall("Sofa", furniture.sofa(fabric), "front right left back")
        f.wall("Television", furniture.television(), "back right left")
        f.wall("Bookshelf", furniture.bookshelf(rng.randrange(4)), "right left back front")
        f.wall("Reading Corner", sets["Reading Corner"], "left right back front")
        f.middle("Coffee Table", furniture.coffee_table())
        f.wall("Potted Plant", furniture.plant(rng.randrange(3)), "right left front")
    elif kind == "kitchen":
        f.wall("Kitchen Units", furniture.kitchen(), "back left right")
        f.wall("Fridge", furniture.fridge(), "back left right")
        f.middle("Dining Set", sets["Dining Set"])
    elif kind == "bath":
        f.wall("Bathtub", furniture.bathtub(), "back right left front")
        f.wall("Toilet", furniture.toilet(), "left right back front")
        f.wall("Washbasin", furniture.basin(), "right left back front")
    elif kind == "bedroom":
        f.wall("Bedroom Set", sets[f"Bedroom Set {fabric.split()[1]}"], "back right left front")
        f.wall("Wardrobe", furniture.wardrobe(), "left right front back")
        f.middle("Rug", furniture.rug(fabric))
    elif kind == "study":
        f.wall("Work Place", sets["Work Place"], "left back right front")
        f.wall("Bookshelf", furniture.bookshelf(rng.randrange(4)), "right back left front")
        f.wall("Floor Lamp", furniture.floor_lamp(), "right left front back")
    else:
        f.wall("Wardrobe", furniture.wardrobe(), "left right back")
        f.wall("Chair", furniture.chair(), "right left back front")
        f.wall("Floor Lamp", furniture.floor_lamp(), "back left right")
    return f.parts
