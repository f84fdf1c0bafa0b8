# SPDX-License-Identifier: GPL-3.0-or-later
"""Fittings of the street and the gardens: lamps, benches, bins, mailboxes, fences and hedges."""

import math
import random

from mathutils import Vector, noise

from mesh_builder import MeshBuilder


def street_lamp():
    """Cast post with a curved arm over the road (+x) and a lantern."""
    b = MeshBuilder()
    profile = [
        (0.16, 0),
        (0.17, 0.1),
        (0.12, 0.16),
        (0.1, 0.8),
        (0.13, 0.84),
        (0.13, 0.9),
        (0.07, 0.95),
        (0.055, 4.6),
    ]
    b.lathe(profile, "Iron", 20)
    arc = [math.pi * k / 14 for k in range(8)]
    path = (
        [(0, 0, 4.5)]
        + [(0.8 - 0.8 * math.cos(t), 0, 4.8 + 0.7 * math.sin(t)) for t in arc]
        + [(1.5, 0, 5.5)]
    )
    b.tube(path, 0.045, "Iron", 12)
    b.tube([(0.05, 0, 4.1), (0.35, 0, 4.55), (0.34, 0, 5.35)], 0.02, "Iron", 8)
    b.lathe(
        [(0.05, 5.5), (0.08, 5.46), (0.22, 5.36), (0.24, 5.28), (0.2, 5.27)][::-1],
        "Iron",
        24,
        (1.5, 0, 0),
    )
    b.lathe([(0.05, 5.14), (0.14, 5.18), (0.18, 5.275)], "Lamp Shade", 24, (1.5, 0, 0))
    return b.to_mesh("Street Lamp")


def bench():
    """Slatted bench with cast sides, its back at +y."""
    b = MeshBuilder()
    for k in range(5):
        b.rounded_box(
            (-0.9, -0.28 + 0.105 * k, 0.44), (0.9, -0.2 + 0.105 * k, 0.475), 0.012, "Wood Light", 2
        )
    for k in range(4):
        y, z = 0.27 + 0.025 * k, 0.55 + 0.1 * k
        b.rounded_box((-0.9, y, z), (0.9, y + 0.03, z + 0.08), 0.012, "Wood Light", 2)
    for x in (-0.75, 0.75):
        b.tube(
            [(x, -0.3, 0), (x, -0.26, 0.25), (x, -0.27, 0.43), (x, 0.24, 0.42), (x, 0.38, 0.95)],
            0.025,
            "Iron",
            10,
        )
        b.tube([(x, 0.3, 0), (x, 0.22, 0.25), (x, 0.24, 0.43)], 0.025, "Iron", 10)
        b.tube(
            [(x, -0.27, 0.43), (x, -0.3, 0.62), (x, 0.0, 0.68), (x, 0.3, 0.66)], 0.02, "Iron", 10
        )
    return b.to_mesh("Bench")


def litter_bin():
    """Round bin with vertical ribs and a lid."""
    b = MeshBuilder()
    b.lathe([(0.2, 0.05), (0.22, 0.75), (0.2, 0.76)], "Trim Dark", 24)
    for k in range(20):
        t = 2 * math.pi * k / 20
        c, s = 0.235 * math.cos(t), 0.235 * math.sin(t)
        b.tube([(c * 0.92, s * 0.92, 0.02), (c, s, 0.4), (c, s, 0.78)], 0.014, "Fence Wood", 6)
    b.lathe([(0.26, 0.78), (0.27, 0.82), (0.22, 0.88), (0.1, 0.93)], "Trim Dark", 28)
    return b.to_mesh("Litter Bin")


def mailbox():
    """Post box on a post, its slot towards -y."""
    b = MeshBuilder()
    b.rounded_box((-0.04, -0.04, 0), (0.04, 0.04, 1.0), 0.012, "Fence Wood")
    b.rounded_box((-0.13, -0.22, 1.0), (0.13, 0.22, 1.26), 0.1, "Post Red", 3)
    b.box((-0.09, -0.226, 1.12), (0.09, -0.2, 1.15), "Trim Dark")
    b.tube([(0.14, 0.05, 1.1), (0.14, 0.05, 1.32)], 0.01, "Steel", 6)
    return b.to_mesh("Mailbox")


def wheelie_bin():
    """Household bin with lid, handle and wheels."""
    b = MeshBuilder()
    rings = []
    for z, h in ((0.08, 0.22), (0.5, 0.26), (0.98, 0.29)):
        ring = []
        for k in range(20):
            t = 2 * math.pi * (k + 0.5) / 20
            c, s = math.cos(t), math.sin(t)
            ring.append(
                (h * math.copysign(abs(c) ** 0.35, c), h * math.copysign(abs(s) ** 0.35, s), z)
            )
        rings.append(ring)
    b.loft(rings, "Door Green")
    b.rounded_box((-0.31, -0.33, 0.97), (0.31, 0.31, 1.05), 0.03, "Door Green", 3)
    b.tube([(-0.22, 0.34, 0.95), (0.22, 0.34, 0.95)], 0.02, "Trim Dark", 8)
    for x in (-0.26, 0.2):
        b.tube([(x, 0.22, 0.1), (x + 0.06, 0.22, 0.1)], 0.1, "Rubber", 18)
    return b.to_mesh("Wheelie Bin")


def picket_fence(length, material="Fence White"):
    """Pointed pickets on two rails along x, posts every 2 m."""
    b = MeshBuilder()
    for z in (0.25, 0.72):
        b.box((0, 0.02, z), (length, 0.06, z + 0.07), material)
    count = int(length / 0.14)
    for k in range(count + 1):
        x = length * k / count
        outline = [
            (x - 0.045, 0.06),
            (x + 0.045, 0.06),
            (x + 0.045, 0.9),
            (x, 0.98),
            (x - 0.045, 0.9),
        ]
        b.prism(outline, -0.005, 0.02, material)
    posts = max(1, round(length / 2))
    for k in range(posts + 1):
        x = length * k / posts
        b.rounded_box((x - 0.05, 0.02, 0), (x + 0.05, 0.12, 1.05), 0.015, material)
    return b.to_mesh(f"Picket Fence {length:.1f}")


def board_fence(length):
    """Tall garden fence of upright boards."""
    b = MeshBuilder()
    count = int(length / 0.24)
    for k in range(count):
        x = length * k / count
        b.box(
            (x + 0.005, 0.0 if k % 2 else 0.015, 0.08),
            (x + length / count - 0.005, 0.03 if k % 2 else 0.045, 1.7),
            "Fence Wood",
        )
    for z in (0.3, 1.4):
        b.box((0, 0.045, z), (length, 0.09, z + 0.1), "Fence Wood")
    posts = max(1, round(length / 2.4))
    for k in range(posts + 1):
        x = length * k / posts
        b.rounded_box((x - 0.06, 0.03, 0), (x + 0.06, 0.15, 1.82), 0.015, "Fence Wood")
    return b.to_mesh(f"Board Fence {length:.1f}")


def hedge(length, height, seed):
    """Closed clipped hedge along x with a leafy surface."""
    rng = random.Random(f"hedge {seed}")
    shift = Vector((rng.uniform(0, 90), rng.uniform(0, 90), 0))
    b = MeshBuilder()
    n = 20
    count = max(4, int(length / 0.24))
    rings = []
    for k in range(count + 1):
        x = length * k / count
        edge = 1 - 0.25 * max(0, 1 - min(x, length - x) / 0.25) ** 2
        ring = []
        for i in range(n):
            t = 2 * math.pi * i / n
            c, s = math.cos(t), math.sin(t)
            y = 0.32 * edge * math.copysign(abs(c) ** 0.45, c)
            z = height / 2 + height / 2 * edge * math.copysign(abs(s) ** 0.45, s)
            p = Vector((x, y, z))
            bump = 0.07 * noise.noise(p * 6 + shift) + 0.05 * noise.noise(p * 14 + shift)
            ring.append(
                (x + 0.5 * bump * (0 < k < count), y + bump * c * 1.4, max(0.0, z + bump * s * 1.4))
            )
        rings.append(ring)
    b.loft(rings, "Hedge")
    return b.to_mesh(f"Hedge {length:.1f} {seed}")


def flower_bed(seed):
    """Bed of soil with small blossoms."""
    rng = random.Random(f"bed {seed}")
    b = MeshBuilder()
    b.rounded_box((-1.2, -0.4, -0.05), (1.2, 0.4, 0.06), 0.05, "Soil")
    for _ in range(18):
        x, y, z = rng.uniform(-1.1, 1.1), rng.uniform(-0.32, 0.32), rng.uniform(0.18, 0.36)
        b.tube([(x, y, 0.02), (x + 0.02, y, z)], 0.01, "Hedge", 4)
        color = rng.choice(["Flowers", "Plaster Ochre", "Linen"])
        b.blob((x + 0.02, y, z), (0.06, 0.06, 0.04), 2, color)
        b.blob((x, y, 0.08), (0.1, 0.1, 0.07), 2, "Hedge")
    return b.to_mesh(f"Flower Bed {seed + 1}")
