# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh builder: closed shapes with outward faces, collected into one Blender mesh."""

import array
import contextlib
import functools
import itertools
import math

import bpy
from mathutils import Matrix, Vector

import materials

SMOOTH_ANGLE = math.radians(50)


@functools.lru_cache(maxsize=None)
def cube_lattice(cells):
    """Surface of a cube of cells^3: points as integer triples, quads wound outward."""
    numbers = {}
    points = []
    faces = []

    def number(point):
        if point not in numbers:
            numbers[point] = len(points)
            points.append(point)
        return numbers[point]

    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, cells):
            for i, j in itertools.product(range(cells), repeat=2):
                corners = []
                for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = [0, 0, 0]
                    corner[axis], corner[u], corner[v] = side, i + du, j + dv
                    corners.append(number(tuple(corner)))
                faces.append(tuple(corners if side else reversed(corners)))
    return tuple(points), tuple(faces)


@functools.lru_cache(maxsize=None)
def rounding(segments):
    """Per lattice point of a rounded box: its corner's signs and the direction from its center."""
    points, faces = cube_lattice(2 * segments + 1)
    result = []
    for point in points:
        signs = tuple(-1 if c <= segments else 1 for c in point)
        offset = [
            math.tan(math.pi / 4 * (1 - (c if c <= segments else 2 * segments + 1 - c) / segments))
            for c in point
        ]
        length = math.sqrt(sum(o * o for o in offset))
        result.append((signs, tuple(s * o / length for s, o in zip(signs, offset))))
    return tuple(result), faces


class MeshBuilder:
    """Collects points and faces; every face has a material name and is flat or smooth."""

    def __init__(self):
        self.points = []
        self.faces = []
        self.face_slots = []
        self.face_smooth = []
        self.slots = []

    def slot(self, material):
        """Index of the material's slot, made at first use."""
        if material not in self.slots:
            self.slots.append(material)
        return self.slots.index(material)

    def add(self, points, faces, material, smooth=False):
        """Add points and faces that index into them; returns the number of the first new face."""
        first = len(self.points)
        first_face = len(self.faces)
        self.points.extend(points)
        self.faces.extend([tuple([first + i for i in face]) for face in faces])
        self.face_slots.extend([self.slot(material)] * len(faces))
        self.face_smooth.extend([smooth] * len(faces))
        return first_face

    @contextlib.contextmanager
    def moved(self, matrix):
        """All that is added inside the block is transformed; a mirroring matrix flips the faces."""
        first, first_face = len(self.points), len(self.faces)
        yield self
        a, b, c, d = matrix[0]
        e, f, g, h = matrix[1]
        i, j, k, m = matrix[2]
        self.points[first:] = [
            (a * x + b * y + c * z + d, e * x + f * y + g * z + h, i * x + j * y + k * z + m)
            for x, y, z in self.points[first:]
        ]
        if matrix.to_3x3().determinant() < 0:
            self.faces[first_face:] = [face[::-1] for face in self.faces[first_face:]]

    def at(self, x, y, z, degrees=0.0):
        """Block moved by an offset and a turn about the vertical."""
        return self.moved(
            Matrix.Translation((x, y, z)) @ Matrix.Rotation(math.radians(degrees), 4, "Z")
        )

    def box(self, low, high, material):
        """Closed flat box."""
        (a, b, c), (d, e, f) = low, high
        points = [
            (a, b, c), (d, b, c), (d, e, c), (a, e, c),
            (a, b, f), (d, b, f), (d, e, f), (a, e, f),
        ]  # fmt: skip
        faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
        return self.add(points, faces, material)

    def rounded_box(self, low, high, radius, material, segments=1):
        """Closed box whose edges and corners are rounded; 6 (2 segments + 1)^2 quads."""
        half = [(h - low_) / 2 for low_, h in zip(low, high)]
        mid = [(h + low_) / 2 for low_, h in zip(low, high)]
        r = min(radius, *(0.98 * h for h in half))
        x, y, z = (h - r for h in half)
        corners, faces = rounding(segments)
        points = [
            (
                mid[0] + s[0] * x + r * d[0],
                mid[1] + s[1] * y + r * d[1],
                mid[2] + s[2] * z + r * d[2],
            )
            for s, d in corners
        ]
        return self.add(points, faces, material, True)

    def blob(self, center, radii, cells, material, displace=None):
        """Closed ellipsoid of 6 cells^2 quads; displace(unit direction) scales its radius."""
        points, faces = cube_lattice(cells)
        result = []
        for point in points:
            v = Vector([math.tan(math.pi / 4 * (2 * c / cells - 1)) for c in point]).normalized()
            k = displace(v) if displace else 1.0
            result.append(tuple(center[i] + k * radii[i] * v[i] for i in range(3)))
        return self.add(result, faces, material, True)

    def loft(self, rings, material, smooth=True, caps=True):
        """Skin over rings (counter-clockwise seen from the last one's side) with flat caps."""
        n = len(rings[0])
        faces = []
        for r in range(len(rings) - 1):
            a, b = r * n, (r + 1) * n
            faces += [(a + i, a + (i + 1) % n, b + (i + 1) % n, b + i) for i in range(n)]
        first = self.add([p for ring in rings for p in ring], faces, material, smooth)
        if caps:
            start = len(self.points) - n * len(rings)
            end = len(self.points) - n
            self.faces += [tuple(range(start + n - 1, start - 1, -1)), tuple(range(end, end + n))]
            self.face_slots += [self.slot(material)] * 2
            self.face_smooth += [False] * 2
        return first

    def tube(self, path, radii, material, sides=8):
        """Closed tube along a path; one radius for all or one per point."""
        path = [Vector(p) for p in path]
        if not isinstance(radii, (list, tuple)):
            radii = [radii] * len(path)
        side = None
        rings = []
        for i, p in enumerate(path):
            along = (path[min(i + 1, len(path) - 1)] - path[max(i - 1, 0)]).normalized()
            if side is None:
                side = along.orthogonal().normalized()
            side = (side - along * side.dot(along)).normalized()
            up = along.cross(side)
            ring = []
            for k in range(sides):
                angle = 2 * math.pi * k / sides
                ring.append(tuple(p + radii[i] * (math.cos(angle) * side + math.sin(angle) * up)))
            rings.append(ring)
        return self.loft(rings, material)

    def lathe(self, profile, material, sides=16, center=(0, 0, 0)):
        """Closed solid of revolution; profile: (radius > 0, height) from bottom to top."""
        turns = [2 * math.pi * k / sides for k in range(sides)]
        rings = [
            [
                (center[0] + r * math.cos(t), center[1] + r * math.sin(t), center[2] + z)
                for t in turns
            ]
            for r, z in profile
        ]
        return self.loft(rings, material)

    def prism(self, outline, low, high, material):
        """Closed prism along y; (x, z) outline counter-clockwise seen from the front (-y)."""
        back = [(x, high, z) for x, z in outline]
        front = [(x, low, z) for x, z in outline]
        return self.loft([back, front], material, smooth=False)

    def to_mesh(self, name):
        """New Blender mesh of all that was added, with one slot per material name."""
        mesh = bpy.data.meshes.new(name)
        sizes = [len(face) for face in self.faces]
        mesh.vertices.add(len(self.points))
        mesh.loops.add(sum(sizes))
        mesh.polygons.add(len(sizes))
        flat = itertools.chain.from_iterable
        mesh.vertices.foreach_set("co", array.array("f", flat(self.points)))
        mesh.loops.foreach_set("vertex_index", array.array("i", flat(self.faces)))
        starts = array.array("i", itertools.accumulate(sizes, initial=0))[:-1]
        mesh.polygons.foreach_set("loop_start", starts)
        mesh.polygons.foreach_set("loop_total", array.array("i", sizes))
        mesh.polygons.foreach_set("material_index", array.array("i", self.face_slots))
        mesh.polygons.foreach_set("use_smooth", array.array("b", self.face_smooth))
        for material in self.slots:
            mesh.materials.append(materials.get(material))
        mesh.update(calc_edges=True)
        if any(self.face_smooth):
            mesh.use_auto_smooth = True
            mesh.auto_smooth_angle = SMOOTH_ANGLE
        return mesh
