# SPDX-License-Identifier: GPL-3.0-or-later
"""Windows and doors as meshes for openings; they face -y, origin at the lower left."""

import functools

from mesh_builder import MeshBuilder


def sash(builder, x0, z0, x1, z1, y, material, bars):
    """Rounded frame, glazing bars and the dark pane."""
    f = 0.06
    builder.box((x0, y, z0), (x0 + f, y + 0.07, z1), material)
    builder.box((x1 - f, y, z0), (x1, y + 0.07, z1), material)
    builder.box((x0 + f, y, z0), (x1 - f, y + 0.07, z0 + f), material)
    builder.box((x0 + f, y, z1 - f), (x1 - f, y + 0.07, z1), material)
    builder.box((x0 + f, y + 0.03, z0 + f), (x1 - f, y + 0.045, z1 - f), "Window Glass")
    if bars:
        for k in (1, 2):
            z = z0 + (z1 - z0) * k / 3
            builder.box((x0 + f, y + 0.01, z - 0.014), (x1 - f, y + 0.06, z + 0.014), material)


@functools.lru_cache(maxsize=None)
def window(width, height, trim="Trim White", style="bars"):
    """Window mesh for an opening: sashes, sill, lintel; style "bars", "plain" or "shutters"."""
    b = MeshBuilder()
    leaves = 1 if width < 0.9 else 2 if width < 2.0 else 3
    for k in range(leaves):
        sash(
            b,
            width * k / leaves,
            0.0,
            width * (k + 1) / leaves,
            height,
            0.07,
            trim,
            style != "plain",
        )
    b.rounded_box((-0.10, -0.09, -0.07), (width + 0.10, 0.07, 0.0), 0.015, "Stone", 1)
    b.rounded_box((-0.12, -0.035, height), (width + 0.12, 0.06, height + 0.14), 0.012, trim, 1)
    b.rounded_box((-0.04, 0.2, -0.02), (width + 0.04, 0.42, 0.02), 0.012, "Trim White", 1)
    if style == "shutters":
        leaf = min(0.5, width / 2)
        for x in (-leaf - 0.06, width + 0.06):
            b.box((x, -0.055, 0), (x + 0.05, -0.02, height), "Door Green")
            b.box((x + leaf - 0.05, -0.055, 0), (x + leaf, -0.02, height), "Door Green")
            slats = int(height / 0.14)
            for k in range(slats):
                z = height * k / slats
                b.box(
                    (x + 0.04, -0.05, z + 0.01),
                    (x + leaf - 0.04, -0.025, z + height / slats - 0.01),
                    "Door Green",
                )
    return b.to_mesh(f"Window {width:.2f} x {height:.2f} {style.title()}")


def handle(builder, x, y, z, side):
    """Lever handle; side -1 puts it on the front."""
    path = [
        (x, y, z),
        (x, y + side * 0.05, z),
        (x - 0.02, y + side * 0.06, z),
        (x - 0.12, y + side * 0.06, z),
    ]
    builder.tube(path, 0.011, "Brass", 8)
    builder.tube([(x, y, z), (x, y + side * 0.008, z)], 0.028, "Brass", 14)


@functools.lru_cache(maxsize=None)
def door(width, height, color, trim="Trim White"):
    """Front door with frame, raised panels, a light, handle and threshold."""
    b = MeshBuilder()
    f = 0.07
    b.rounded_box((0, 0.05, 0), (f, 0.2, height), 0.012, trim)
    b.rounded_box((width - f, 0.05, 0), (width, 0.2, height), 0.012, trim)
    b.rounded_box((f, 0.05, height - f), (width - f, 0.2, height), 0.012, trim)
    b.rounded_box((-0.1, -0.05, height), (width + 0.1, 0.06, height + 0.14), 0.02, trim)
    b.rounded_box((f, 0.1, 0.01), (width - f, 0.15, height - f), 0.008, color)
    w = (width - 2 * f - 0.3) / 2
    for x in (f + 0.1, width - f - 0.1 - w):
        b.rounded_box((x, 0.08, 0.2), (x + w, 0.12, 0.95), 0.02, color, 1)
        b.rounded_box((x, 0.08, 1.05), (x + w, 0.12, 1.5), 0.02, color, 1)
    b.box((f + 0.1, 0.09, 1.6), (width - f - 0.1, 0.12, height - f - 0.12), "Window Glass")
    handle(b, width - f - 0.06, 0.1, 1.02, -1)
    b.rounded_box((-0.15, -0.5, -0.3), (width + 0.15, 0.05, -0.02), 0.03, "Stone")
    b.rounded_box((-0.15, -0.85, -0.3), (width + 0.15, -0.5, -0.15), 0.03, "Stone")
    return b.to_mesh(f"Front Door {color}")


@functools.lru_cache(maxsize=None)
def inner_door(width, height):
    """Room door with architrave on both sides of a 0.12 m wall."""
    b = MeshBuilder()
    for y0, y1 in ((-0.02, 0.01), (0.11, 0.14)):
        b.box((-0.07, y0, 0), (0, y1, height + 0.07), "Trim White")
        b.box((width, y0, 0), (width + 0.07, y1, height + 0.07), "Trim White")
        b.box((0, y0, height), (width, y1, height + 0.07), "Trim White")
    b.rounded_box((0.01, 0.04, 0.01), (width - 0.01, 0.08, height - 0.01), 0.006, "Trim White")
    for y0, y1 in ((0.03, 0.05), (0.07, 0.09)):
        b.rounded_box((0.13, y0, 0.2), (width - 0.13, y1, 0.9), 0.01, "Trim White", 1)
        b.rounded_box((0.13, y0, 1.05), (width - 0.13, y1, 1.85), 0.01, "Trim White", 1)
    handle(b, width - 0.07, 0.04, 1.0, -1)
    handle(b, width - 0.07, 0.08, 1.0, 1)
    return b.to_mesh("Room Door")


@functools.lru_cache(maxsize=None)
def garage_door(width, height, color):
    """Sectional garage door with relief panels."""
    b = MeshBuilder()
    b.box((0, 0.12, 0), (width, 0.18, height), "Trim White")
    columns, rows = 6, 4
    for i in range(columns):
        for j in range(rows):
            x0, z0 = width * i / columns + 0.04, height * j / rows + 0.04
            b.rounded_box(
                (x0, 0.095, z0),
                (x0 + width / columns - 0.08, 0.14, z0 + height / rows - 0.08),
                0.02,
                color,
                2,
            )
    return b.to_mesh(f"Garage Door {color}")
