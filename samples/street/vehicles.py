# SPDX-License-Identifier: GPL-3.0-or-later
"""Vehicles: lofted bodies with wheel arches and glass, and wheels with tires and spokes.

A car points along +x, its wheels stand on z = 0, the origin is below its middle.
"""

import bisect
import math
from collections import namedtuple

from mesh_builder import MeshBuilder

# mesh: body; wheel: wheel mesh; places: (x, y, z, degrees) of the wheels; paint slot is 0
Car = namedtuple("Car", "name body wheel places length")
# Roof line and belt line: (x, height) from the tail to the nose; axles: x of both
Shape = namedtuple("Shape", "length width roof belt axles radius glass pillars")

SHAPES = {
    "Sedan": Shape(
        4.6,
        1.80,
        (
            (-2.3, 0.72),
            (-2.22, 0.95),
            (-1.55, 1.02),
            (-0.95, 1.40),
            (-0.1, 1.46),
            (0.35, 1.40),
            (1.05, 0.98),
            (1.9, 0.84),
            (2.25, 0.68),
            (2.3, 0.55),
        ),
        ((-2.3, 0.70), (-2.2, 0.88), (1.0, 0.93), (1.9, 0.78), (2.3, 0.52)),
        (-1.36, 1.38),
        0.32,
        (-1.5, 1.0),
        (-0.92, -0.2, 0.42),
    ),
    "Hatchback": Shape(
        3.95,
        1.74,
        (
            (-1.97, 0.75),
            (-1.92, 1.0),
            (-1.6, 1.38),
            (-1.0, 1.50),
            (0.1, 1.52),
            (0.5, 1.42),
            (1.15, 1.00),
            (1.7, 0.86),
            (1.93, 0.70),
            (1.97, 0.55),
        ),
        ((-1.97, 0.72), (-1.9, 0.95), (1.1, 0.96), (1.7, 0.80), (1.97, 0.52)),
        (-1.2, 1.22),
        0.31,
        (-1.88, 1.12),
        (-1.2, -0.25, 0.5),
    ),
    "Estate": Shape(
        4.7,
        1.84,
        (
            (-2.35, 0.85),
            (-2.3, 1.1),
            (-2.0, 1.55),
            (-1.3, 1.66),
            (0.0, 1.68),
            (0.45, 1.58),
            (1.1, 1.12),
            (2.0, 0.98),
            (2.3, 0.80),
            (2.35, 0.6),
        ),
        ((-2.35, 0.80), (-2.25, 1.04), (1.05, 1.07), (2.0, 0.92), (2.35, 0.57)),
        (-1.42, 1.45),
        0.36,
        (-2.22, 1.05),
        (-1.35, -0.35, 0.45),
    ),
    "Van": Shape(
        5.0,
        1.94,
        (
            (-2.5, 0.9),
            (-2.48, 1.7),
            (-2.3, 1.98),
            (-1.0, 2.05),
            (0.6, 2.02),
            (1.1, 1.85),
            (1.85, 1.15),
            (2.3, 1.0),
            (2.47, 0.8),
            (2.5, 0.6),
        ),
        ((-2.5, 0.88), (-2.4, 1.12), (1.8, 1.10), (2.3, 0.95), (2.5, 0.57)),
        (-1.6, 1.6),
        0.34,
        (0.1, 1.8),
        (0.16, 1.1),
    ),
}


def curve(points, x):
    """Smoothed polyline height at x."""
    xs = [p[0] for p in points]
    k = min(max(bisect.bisect(xs, x) - 1, 0), len(points) - 2)
    (x0, z0), (x1, z1) = points[k], points[k + 1]
    t = min(max((x - x0) / (x1 - x0), 0.0), 1.0)
    return z0 + (z1 - z0) * t


def rounded(points, x):
    """The curve averaged over a short window: soft corners."""
    return (
        sum(
            curve(points, x + d) * w
            for d, w in ((-0.09, 1), (-0.04, 2), (0, 2), (0.04, 2), (0.09, 1))
        )
        / 8
    )


def half_section(shape, x):
    """Right half of the body's outline at x, from the sill's middle to the roof's: (y, z)."""
    end = abs(x) / (shape.length / 2)
    plan = (1 - 0.16 * end**4) * (1 - 0.35 * max(0, end - 0.94) / 0.06)
    half = shape.width / 2 * plan
    roof, belt = rounded(shape.roof, x), rounded(shape.belt, x)
    belt = min(belt, roof - 0.03)
    low = 0.2 + 0.12 * max(0, end - 0.9) / 0.1
    arch = 0.0
    for axle in shape.axles:
        reach = shape.radius + 0.07
        if abs(x - axle) < reach:
            arch = shape.radius + math.sqrt(reach**2 - (x - axle) ** 2)
    sill = min(max(low, arch), belt - 0.12)
    cabin = roof - belt
    tumble = half * (1 - 0.24 * min(cabin / 0.5, 1.0))
    mid = (sill + belt) / 2
    return [
        (half * 0.5, sill),
        (half * 0.93, sill),
        (half * 0.985, sill + 0.03),
        (half, sill + (mid - sill) * 0.6),
        (half * 1.0, mid + (belt - mid) * 0.3),
        (half * 0.985, belt - 0.03),
        (half * 0.955, belt),
        (half * 0.945 * 0.7 + tumble * 0.3, belt + cabin * 0.3),
        (half * 0.945 * 0.3 + tumble * 0.7, belt + cabin * 0.66),
        (tumble, belt + cabin * 0.86),
        (tumble * 0.9, belt + cabin * 0.96),
        (tumble * 0.6, roof),
        (tumble * 0.2, roof + 0.01),
    ]


GLASS_ROWS = range(6, 9)


def body(name, shape):
    """Body mesh: one closed loft with glass faces, plus lights, bumpers and mirrors."""
    b = MeshBuilder()
    b.slot("Paint Silver")
    b.slot("Window Glass")
    half = shape.length / 2
    xs = {-half, half}
    xs.update(-half + shape.length * k / 44 for k in range(45))
    for axle in shape.axles:
        reach = shape.radius + 0.07
        xs.update(axle + reach * s for s in (-1.001, -0.999, -0.97, 0.97, 0.999, 1.001))
    xs = sorted(xs)
    rings = []
    for x in xs:
        right = half_section(shape, x)
        ring = [(x, -y, z) for y, z in right]
        ring += [(x, y, z) for y, z in reversed(right)]
        rings.append(ring[::-1])
    first = b.loft(rings, "Paint Silver")
    n = len(rings[0])
    for k in range(len(xs) - 1):
        mid = (xs[k] + xs[k + 1]) / 2
        section = half_section(shape, mid)
        cabin = section[-1][1] - section[6][1] > 0.24
        steep = abs(section[-1][1] - half_section(shape, mid + 0.05)[-1][1]) > 0.02
        steep = steep or abs(section[-1][1] - half_section(shape, mid - 0.05)[-1][1]) > 0.02
        pillar = any(abs(mid - p) < 0.06 for p in shape.pillars)
        inside = shape.glass[0] < mid < shape.glass[1]
        for i in range(n):
            row = i if i < n // 2 else n - 2 - i
            side_face = row in GLASS_ROWS and cabin and inside and not pillar
            front_face = row >= 8 and steep and section[-1][1] > section[6][1] + 0.14
            if side_face or front_face:
                b.face_slots[first + k * n + i] = 1
    fittings(b, shape)
    return b.to_mesh(f"{name} Body")


def fittings(b, shape):
    """Lights, bumpers, grille, plates, mirrors, handles and the dark underside."""
    half, w = shape.length / 2, shape.width / 2
    b.rounded_box((-half + 0.25, -w * 0.8, 0.17), (half - 0.25, w * 0.8, 0.42), 0.03, "Trim Dark")
    for end, lamp in ((1, "Ceramic"), (-1, "Lamp Red")):
        x0, x1 = sorted((end * (half - 0.16), end * (half + 0.04)))
        b.rounded_box((x0, -w * 0.82, 0.3), (x1, w * 0.82, 0.46), 0.05, "Trim Dark", 2)
        z = 0.62 if end > 0 else 0.74
        for side in (-1, 1):
            y0, y1 = sorted((side * w * 0.48, side * w * 0.8))
            x0, x1 = sorted((end * (half - 0.2), end * (half + 0.012)))
            b.rounded_box((x0, y0, z - 0.07), (x1, y1, z + 0.06), 0.05, lamp, 2)
        x0, x1 = sorted((end * (half - 0.1), end * (half + 0.05)))
        b.rounded_box((x0, -0.26, 0.47), (x1, 0.26, 0.58), 0.01, "Road Paint", 1)
    belt = curve(shape.belt, 0.75)
    for side in (-1, 1):
        y0, y1 = sorted((side * w * 0.93, side * (w + 0.14)))
        b.rounded_box((0.62, y0, belt + 0.02), (0.74, y1, belt + 0.15), 0.05, "Paint Black", 2)
        for x in (shape.pillars[0] + 0.25, 0.1):
            y0, y1 = sorted((side * w * 0.97, side * (w + 0.025)))
            b.rounded_box((x - 0.1, y0, belt - 0.13), (x + 0.1, y1, belt - 0.09), 0.015, "Steel", 1)


def wheel(radius):
    """Tire, rim and five double spokes; the axle is y, the outer side faces -y."""
    b = MeshBuilder()
    r = radius
    tire = [
        (0.72 * r, -0.10),
        (0.93 * r, -0.105),
        (r, -0.07),
        (r, 0.07),
        (0.93 * r, 0.105),
        (0.72 * r, 0.10),
    ]
    rim = [(0.64 * r, -0.085), (0.74 * r, -0.10), (0.74 * r, 0.10), (0.64 * r, 0.085)]
    for profile, material, turns in ((tire, "Rubber", 20), (rim, "Steel", 20)):
        points, faces, n = [], [], len(profile)
        for k in range(turns):
            t = 2 * math.pi * k / turns
            points += [(q * math.cos(t), y, q * math.sin(t)) for q, y in profile]
            a, c = k * n, (k + 1) % turns * n
            faces += [(a + i, a + (i + 1) % n, c + (i + 1) % n, c + i) for i in range(n)]
        b.add(points, faces, material, True)
    b.tube([(0, 0.06, 0), (0, -0.02, 0)], 0.66 * r, "Iron", 28)
    b.tube(
        [(0, -0.02, 0), (0, -0.085, 0), (0, -0.092, 0)], [0.2 * r, 0.17 * r, 0.1 * r], "Steel", 20
    )
    for k in range(10):
        t = 2 * math.pi * (k // 2) / 5 + (0.13 if k % 2 else -0.13)
        c, s = math.cos(t), math.sin(t)
        path = [(q * r * c, y, q * r * s) for q, y in ((0.12, -0.075), (0.4, -0.08), (0.68, -0.07))]
        b.tube(path, [0.022, 0.018, 0.02], "Steel", 4)
    return b.to_mesh(f"Wheel {radius:.2f}")


def models():
    """All cars."""
    wheels = {}
    cars = []
    for name, shape in SHAPES.items():
        if shape.radius not in wheels:
            wheels[shape.radius] = wheel(shape.radius)
        y = shape.width / 2 - 0.13
        places = [
            (x, side * y, shape.radius, 0 if side < 0 else 180)
            for x in shape.axles
            for side in (-1, 1)
        ]
        cars.append(Car(name, body(name, shape), wheels[shape.radius], places, shape.length))
    return cars
