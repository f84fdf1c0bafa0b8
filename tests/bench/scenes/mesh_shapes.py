# SPDX-License-Identifier: GPL-3.0-or-later
"""What the groups of the sheet are made of: meshes with slots by name, groups of placements."""

import math
from array import array
from dataclasses import dataclass, field

Point = tuple[float, float, float]
Matrix = tuple[float, ...]  # row-major 3x4
IDENTITY: Matrix = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)


def placed(x: float = 0, y: float = 0, z: float = 0, turn: float = 0, scale: float = 1) -> Matrix:
    """Turned about Z, scaled, moved."""
    c, s = scale * math.cos(turn), scale * math.sin(turn)
    return (c, -s, 0, x, s, c, 0, y, 0, 0, scale, z)


def product(a: Matrix, b: Matrix) -> Matrix:
    out = []
    for row in range(0, 12, 4):
        for column in range(4):
            value = sum(a[row + k] * b[4 * k + column] for k in range(3))
            out.append(value + (a[row + 3] if column == 3 else 0))
    return tuple(out)


def moved(m: Matrix, p: Point) -> Point:
    x, y, z = (m[r] * p[0] + m[r + 1] * p[1] + m[r + 2] * p[2] + m[r + 3] for r in (0, 4, 8))
    return (x, y, z)


def lathe(shape: "Shape", slot: str, profile: list, around: int, at: Point = (0, 0, 0)) -> None:
    """A surface of revolution about Z; profile: (radius, height) upwards along the outside."""
    turns = [2 * math.pi * i / around for i in range(around)]
    points = [
        (at[0] + r * math.cos(t), at[1] + r * math.sin(t), at[2] + z)
        for r, z in profile
        for t in turns
    ]
    faces = [
        (j * around + i, j * around + k, (j + 1) * around + k, (j + 1) * around + i)
        for j in range(len(profile) - 1)
        for i in range(around)
        for k in ((i + 1) % around,)
    ]
    shape.add(slot, points, faces, smooth=True)


@dataclass
class Shape:
    """A mesh of polygons."""

    points: list[Point] = field(default_factory=list)
    faces: list[tuple[int, ...]] = field(default_factory=list)
    slots: list[str] = field(default_factory=list)  # by face
    smooth: list[bool] = field(default_factory=list)  # by face
    uvs: list[list[tuple[float, float]]] = field(default_factory=list)  # by face and corner

    def add(self, slot: str, points: list, faces: list, smooth=False, uvs=None) -> None:
        first = len(self.points)
        self.points += points
        if not uvs:  # convex faces of many corners become fans
            faces = [
                part
                for face in faces
                for part in (
                    [face]
                    if len(face) <= 4
                    else [(face[0], face[i], face[i + 1]) for i in range(1, len(face) - 1)]
                )
            ]
        for number, face in enumerate(faces):
            self.faces.append(tuple(first + i for i in face))
            self.slots.append(slot)
            self.smooth.append(smooth)
            self.uvs.append(uvs[number] if uvs else [(0.0, 0.0)] * len(face))

    def box(self, slot: str, low: Point, high: Point, per_metre: float = 0) -> None:
        """per_metre: repeats of a texture, on the sides."""
        corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        points = [(x, y, z) for z in (low[2], high[2]) for x, y in corners]
        faces = [(3, 2, 1, 0), (4, 5, 6, 7)]
        uvs = [[(0.0, 0.0)] * 4, [(0.0, 0.0)] * 4]
        tall = per_metre * (high[2] - low[2])
        for i in range(4):
            k = (i + 1) % 4
            wide = per_metre * math.dist(corners[i], corners[k])
            faces.append((i, k, k + 4, i + 4))
            uvs.append([(0, 0), (wide, 0), (wide, tall), (0, tall)])
        self.add(slot, points, faces, uvs=uvs)

    def ball(self, slot: str, center: Point, radii: Point, rows: int = 8) -> None:
        around = 2 * rows
        points = []
        for j in range(1, rows):
            for i in range(around):
                a, b = math.pi * j / rows, 2 * math.pi * i / around
                unit = (math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a))
                points.append(tuple(c + r * u for c, r, u in zip(center, radii, unit)))
        top, bottom = len(points), len(points) + 1
        points += [(center[0], center[1], center[2] + s * radii[2]) for s in (1, -1)]
        faces = []
        for i in range(around):
            k = (i + 1) % around
            faces += [(top, i, k), (bottom, (rows - 2) * around + k, (rows - 2) * around + i)]
            faces += [
                (j * around + i, (j + 1) * around + i, (j + 1) * around + k, j * around + k)
                for j in range(rows - 2)
            ]
        self.add(slot, points, faces, smooth=True)

    def tube(self, slot: str, start: Point, end: Point, radii: tuple, around: int = 8) -> None:
        """Open at its ends; radii at the start and the end."""
        axis = [b - a for a, b in zip(start, end)]
        length = math.hypot(*axis)
        w = [x / length for x in axis]
        other = (0, 0, 1) if abs(w[2]) < 0.9 else (1, 0, 0)
        u = cross(other, w)
        size = math.hypot(*u)
        u = [x / size for x in u]
        v = cross(w, u)
        points = []
        for place, radius in zip((start, end), radii):
            for i in range(around):
                c, s = math.cos(2 * math.pi * i / around), math.sin(2 * math.pi * i / around)
                points.append(tuple(p + radius * (c * a + s * b) for p, a, b in zip(place, u, v)))
        faces = [
            (i, (i + 1) % around, (i + 1) % around + around, i + around) for i in range(around)
        ]
        self.add(slot, points, faces, smooth=True)

    def card(self, slot: str, center: Point, u: Point, v: Point) -> None:
        """A sheet of half sides u and v that shows one texture."""
        signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
        points = [tuple(c + a * x + b * y for c, x, y in zip(center, u, v)) for a, b in signs]
        self.add(slot, points, [(0, 1, 2, 3)], uvs=[[(0, 0), (1, 0), (1, 1), (0, 1)]])

    def join(self, other: "Shape", by: Matrix) -> None:
        first = len(self.points)
        self.points += [moved(by, point) for point in other.points]
        self.faces += [tuple(first + i for i in face) for face in other.faces]
        self.slots += other.slots
        self.smooth += other.smooth
        self.uvs += other.uvs


@dataclass
class Group:
    """Placements of shapes and groups; the same shape placed twice is shared."""

    name: str
    children: list = field(default_factory=list)  # of (Shape or Group, Matrix)

    def put(self, child, matrix: Matrix = IDENTITY) -> None:
        self.children.append((child, matrix))

    def joined(self) -> Shape:
        out = Shape()
        for child, matrix in self.children:
            out.join(child.joined() if isinstance(child, Group) else child, matrix)
        return out


def cross(a, b) -> list[float]:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


class Filler:
    """Puts shapes and groups into a model of the library."""

    def __init__(self, native, model, materials: dict) -> None:
        self.native, self.model = native, model
        self.materials = materials  # name -> index in the model
        self.known: dict = {}  # by identity, kept alive

    def put(self, item):
        if id(item) in self.known:
            return self.known[id(item)][0]
        uid = f"{len(self.known)}"
        if isinstance(item, Shape):
            out = self._leaf(item, uid)
        else:
            children = [(self.put(child), matrix) for child, matrix in item.children]
            out = self.model.add_group(uid + item.name, item.name)
            for number, (child, matrix) in enumerate(children):
                self.model.add_placement(out, child, matrix, f"{number}")
        self.known[id(item)] = (out, item)
        return out

    def _leaf(self, shape: Shape, uid: str):
        names = sorted(set(shape.slots))
        starts, corners = array("i"), array("i")
        uvs = array("f")
        for face, texture in zip(shape.faces, shape.uvs):
            starts.append(len(corners))
            corners.extend(face)
            for pair in texture:
                uvs.extend(pair)
        buffers = self.native.FaceBuffers(
            array("f", [x for point in shape.points for x in point]),
            corners,
            starts,
            face_smooth=array("b", [int(s) for s in shape.smooth]),
            face_slots=array("i", [names.index(slot) for slot in shape.slots]),
            corner_uvs=uvs if any(any(uv != (0, 0) for uv in face) for face in shape.uvs) else None,
        )
        slots = [self.materials[name] for name in names]
        return self.model.add_faces("leaf" + uid, "leaf", buffers, slots)
