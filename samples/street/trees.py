# SPDX-License-Identifier: GPL-3.0-or-later
"""Trees: trunk and branches as tubes, crowns of clumps, real leaf quads or needle skirts."""

import math
import random

from mathutils import Matrix, Vector, noise

from mesh_builder import MeshBuilder


def leafy(seed, strength=0.35, scale=2.2):
    """Displacement of a leaf clump: bumps of two sizes."""
    offset = Vector((seed * 3.7 % 97, seed * 1.3 % 89, seed * 2.9 % 83))

    def displace(v):
        return 1 + strength * (
            noise.noise(v * scale + offset) + 0.5 * noise.noise(v * scale * 2.7 + offset)
        )

    return displace


def skeleton(builder, rng, height, trunk, bark, start, count, reach, lift, sides=8):
    """Bent trunk and two levels of branches; returns the branches' outer ends with a length."""
    spine = []
    lean = Vector((rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05), 0))
    for k in range(9):
        t = k / 8
        wobble = Vector((rng.uniform(-1, 1), rng.uniform(-1, 1), 0)) * 0.06 * height * 0.1
        spine.append(Vector((0, 0, height * t)) + lean * height * t * t + wobble * (k > 0))
    radii = [trunk * (1.35 if k == 0 else 1 - 0.85 * k / 8) for k in range(9)]
    builder.tube(spine, radii, bark, sides + 4)
    ends = []
    for k in range(count):
        t = start + (0.97 - start) * (k + rng.random() * 0.6) / count
        base = spine[min(int(t * 8), 7)].lerp(spine[min(int(t * 8) + 1, 8)], t * 8 - int(t * 8))
        turn = k * 2.4 + rng.uniform(-0.4, 0.4)
        length = reach * (1.0 - 0.55 * max(0, t - 0.45) / 0.55) * rng.uniform(0.8, 1.1)
        out = Vector((math.cos(turn), math.sin(turn), lift + 0.5 * t)).normalized()
        path = [
            base,
            base + out * length * 0.5,
            base + out * length + Vector((0, 0, 0.12 * length)),
        ]
        thick = trunk * 0.42 * (1.1 - t)
        builder.tube(path, [thick, thick * 0.7, thick * 0.25], bark, sides)
        ends.append((path[2], length))
        for side in (-1, 1):
            turned = Matrix.Rotation(side * rng.uniform(0.5, 0.9), 3, "Z") @ out
            tip = path[1] + turned * length * 0.45 + Vector((0, 0, 0.1 * length))
            builder.tube(
                [path[1], path[1].lerp(tip, 0.5), tip],
                [thick * 0.5, thick * 0.35, thick * 0.12],
                bark,
                5,
            )
            ends.append((tip, length * 0.7))
    return ends, spine[-1]


def broadleaf(name, seed, height, leaves, reach, size, flat=0.8, start=0.34):
    """Round crown: a large and two small closed displaced clumps at every branch end."""
    rng = random.Random(f"{name} {seed}")
    b = MeshBuilder()
    ends, top = skeleton(b, rng, height * 0.82, 0.028 * height, "Bark", start, 9, reach, 0.15, 6)
    for k, (end, length) in enumerate(ends + [(top, reach)]):
        r = size * (0.75 + 0.3 * rng.random()) * (0.8 + 0.2 * length / reach)
        b.blob(end, (r, r, r * flat), 4, leaves, leafy(seed * 41 + k, 0.5))
        for _ in range(2 if k % 2 else 1):
            v = Vector((rng.gauss(0, 1), rng.gauss(0, 1), rng.gauss(0.3, 0.8))).normalized()
            q = r * rng.uniform(0.42, 0.6)
            b.blob(end + v * r * 0.85, (q, q, q * flat), 3, leaves, leafy(seed * 17 + k, 0.6, 1.6))
    return b.to_mesh(f"{name} {seed + 1}")


def column(name, seed, height):
    """Poplar: clumps stacked close to the trunk."""
    rng = random.Random(f"{name} {seed}")
    b = MeshBuilder()
    skeleton(b, rng, height * 0.95, 0.02 * height, "Bark", 0.15, 8, height * 0.07, 1.4)
    for k in range(26):
        t = 0.16 + 0.8 * k / 25
        wide = height * 0.085 * math.sin(math.pi * min(1, 0.14 + 0.92 * t)) + 0.12
        turn = k * 2.4
        center = (math.cos(turn) * wide * 0.45, math.sin(turn) * wide * 0.45, height * t)
        b.blob(center, (wide, wide, height * 0.075), 5, "Leaves Linden", leafy(seed * 57 + k, 0.5))
    return b.to_mesh(f"{name} {seed + 1}")


def conifer(name, seed, height):
    """Spruce: drooping skirts of closed needle fans around a straight trunk."""
    rng = random.Random(f"{name} {seed}")
    b = MeshBuilder()
    b.tube(
        [(0, 0, 0), (0, 0, height * 0.5), (0, 0, height * 0.98)],
        [0.022 * height, 0.013 * height, 0.02],
        "Bark",
        10,
    )
    layers = 12
    for layer in range(layers):
        t = layer / (layers - 1)
        z = height * (0.1 + 0.84 * t)
        r = height * 0.22 * (1 - t) ** 0.85 + 0.18
        fans = max(6, int(15 - 8 * t))
        for k in range(fans):
            turn = 2 * math.pi * (k + 0.5 * (layer % 2)) / fans + rng.uniform(-0.12, 0.12)
            reach = r * rng.uniform(0.85, 1.08)
            out = Vector((math.cos(turn), math.sin(turn), 0))
            side = Vector((-out.y, out.x, 0))
            rings = []
            for s in range(6):
                u = s / 5
                spine = out * (0.06 + reach * u) + Vector((0, 0, z - 0.32 * reach * u * u))
                half = (
                    reach
                    * (0.1 + 0.32 * math.sin(math.pi * min(0.96, 0.1 + 0.86 * u)))
                    * (1.12 if s % 2 else 0.86)
                )
                deep = 0.09 * height * 0.12 * (1 - 0.7 * u) + 0.02
                ring = [
                    spine + side * half,
                    spine + Vector((0, 0, deep)),
                    spine - side * half,
                    spine - Vector((0, 0, deep)),
                ]
                rings.append([tuple(p) for p in ring])
            b.loft(rings, "Needles")
    return b.to_mesh(f"{name} {seed + 1}")


def quad_leaves(name, seed, height, bark, leaves, reach, count):
    """Airy crown of single leaves: two-triangle quads around every branch."""
    rng = random.Random(f"{name} {seed}")
    b = MeshBuilder()
    ends, top = skeleton(b, rng, height * 0.9, 0.018 * height, bark, 0.3, 13, reach, 0.5)
    ends.append((top, reach))
    points, faces = [], []
    for k in range(count):
        end, length = ends[k % len(ends)]
        radius = 0.55 * length + 0.35
        v = Vector((rng.gauss(0, 1), rng.gauss(0, 1), rng.gauss(0, 0.8))).normalized()
        place = end + v * radius * rng.random() ** 0.45
        u = Vector((rng.gauss(0, 1), rng.gauss(0, 1), rng.gauss(0, 0.5))).normalized()
        w = u.cross(v + Vector((0.01, 0.02, 0.4))).normalized()
        a, c = rng.uniform(0.12, 0.2), rng.uniform(0.08, 0.13)
        first = len(points)
        points += [
            tuple(place - u * a),
            tuple(place - w * c),
            tuple(place + u * a),
            tuple(place + w * c),
        ]
        faces.append((first, first + 1, first + 2, first + 3))
    b.add(points, faces, leaves)
    return b.to_mesh(f"{name} {seed + 1}")


def shrub(seed, leaves="Hedge"):
    """Round garden shrub."""
    rng = random.Random(f"shrub {seed}")
    b = MeshBuilder()
    b.tube([(0, 0, 0), (0, 0, 0.4)], [0.06, 0.04], "Bark", 6)
    for k in range(6):
        turn = k * 1.1
        r = rng.uniform(0.3, 0.42)
        center = (
            0.26 * math.cos(turn) * (k > 0),
            0.26 * math.sin(turn) * (k > 0),
            0.36 + 0.22 * rng.random(),
        )
        b.blob(center, (r, r, r * 0.85), 4, leaves, leafy(seed * 11 + k, 0.3))
    return b.to_mesh(f"Shrub {leaves} {seed + 1}")


def models():
    """All tree meshes by species: at least two models each."""
    return {
        "Oak": [broadleaf("Oak", k, 10.5 + k, "Leaves Oak", 3.3, 1.55) for k in range(2)],
        "Maple": [broadleaf("Maple", k, 8.6 + k, "Leaves Maple", 2.4, 1.3, 0.95) for k in range(2)],
        "Linden": [
            broadleaf("Linden", k, 9.2 + k, "Leaves Linden", 2.2, 1.25, 1.1, 0.3) for k in range(2)
        ],
        "Poplar": [column("Poplar", k, 14.0 + 2 * k) for k in range(2)],
        "Spruce": [conifer("Spruce", k, 10.0 + 2.5 * k) for k in range(2)],
        "Birch": [
            quad_leaves("Birch", k, 9.0 + k, "Birch Bark", "Leaves Birch", 1.9, 2800)
            for k in range(2)
        ],
        "Cherry": [
            quad_leaves("Cherry", k, 5.6, "Bark", "Leaves Cherry", 1.9, 2800) for k in range(2)
        ],
    }
