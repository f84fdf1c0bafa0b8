# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes whose shading tells their shape, made in Blender: two terrains and a still life.

    blender -b --factory-startup --python-exit-code 1 --python tests/bench/scenes/smooth_scenes.py
        -- KIND OUT.blend [HEIGHTS.png]

KIND is "ridges", "dunes", "heights" (a gray picture of at least 512 x 512) or "still_life". Every
terrain has 522,242 triangles on a kilometre. The same scene every time.
"""

import math
import random
import sys

import bpy
from mathutils import Vector, noise

SIDE = 512  # vertices along a side of a terrain
WIDTH = 1000.0  # metres
KERNEL = (1, 4, 6, 4, 1)  # a binomial blur, for pictures have steps
MARGIN = len(KERNEL) // 2


def link(item):
    bpy.context.scene.collection.objects.link(item)
    return item


def material(name, color, roughness=0.6, transmission=0.0):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    values = made.node_tree.nodes["Principled BSDF"].inputs
    values["Base Color"].default_value = (*color, 1)
    values["Roughness"].default_value = roughness
    values["Transmission"].default_value = transmission
    return made


def camera(name, eye, target, degrees):
    data = bpy.data.cameras.new(name)
    data.angle, data.clip_end = math.radians(degrees), 1e5
    made = link(bpy.data.objects.new(name, data))
    made.location = eye
    way = Vector(target) - Vector(eye)
    made.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = made


def light(height, turn):
    """A sun so many degrees above the horizon, and half a sky."""
    data = bpy.data.lights.new("Sun", "SUN")
    data.energy = 3
    made = link(bpy.data.objects.new("Sun", data))
    made.rotation_euler = (math.radians(90 - height), 0, math.radians(turn))
    world = bpy.context.scene.world = bpy.data.worlds.new("World")
    world.use_nodes = True
    values = world.node_tree.nodes["Background"].inputs
    values["Color"].default_value, values["Strength"].default_value = (0.4, 0.5, 0.7, 1), 0.5


def grid_mesh(name, points, columns, rows, closed=False):
    """A smooth mesh of rows of points; `closed`: the last column meets the first."""
    faces = [
        (j * columns + i, j * columns + k, (j + 1) * columns + k, (j + 1) * columns + i)
        for j in range(rows - 1)
        for i, k in ((i, (i + 1) % columns) for i in range(columns - (0 if closed else 1)))
    ]
    made = bpy.data.meshes.new(name)
    made.from_pydata(points, [], faces)
    made.polygons.foreach_set("use_smooth", [True] * len(faces))
    return made


def ridges(x, y):
    place = Vector((x, y, 0)) * 4
    return 250 * noise.ridged_multi_fractal(place, 1.0, 2.1, 7, 0.9, 2.0) / 3


def dunes(x, y):
    place = Vector((3 * x, 9 * y, 4.0))
    return 60 * noise.hetero_terrain(place, 1.2, 2.0, 5, 0.6)


def heights_of(picture):
    """Heights by column and row, of the middle of a picture."""
    image = bpy.data.images.load(picture)
    (width, height), channels, values = image.size, image.channels, list(image.pixels)
    if min(width, height) < SIDE:
        raise SystemExit(f"{picture}: {width} x {height} is less than {SIDE} x {SIDE}")
    left, low = (width - SIDE) // 2, (height - SIDE) // 2

    def raw(i, j):
        i, j = min(max(left + i, 0), width - 1), min(max(low + j, 0), height - 1)
        return values[(j * width + i) * channels]

    span = range(-MARGIN, SIDE + MARGIN)
    across = [
        [sum(k * raw(i + d - MARGIN, j) for d, k in enumerate(KERNEL)) / 16 for i in range(SIDE)]
        for j in span
    ]
    return [
        [sum(k * across[j + d][i] for d, k in enumerate(KERNEL)) / 16 for i in range(SIDE)]
        for j in range(SIDE)
    ]


def terrain(kind, picture):
    if kind == "heights":
        rows = heights_of(picture)
        z = [250 * rows[j][i] for j in range(SIDE) for i in range(SIDE)]
    else:
        height = {"ridges": ridges, "dunes": dunes}[kind]
        z = [height(i / SIDE, j / SIDE) for j in range(SIDE) for i in range(SIDE)]
    step = WIDTH / (SIDE - 1)
    points = [
        (k % SIDE * step - WIDTH / 2, k // SIDE * step - WIDTH / 2, up) for k, up in enumerate(z)
    ]
    mesh = grid_mesh("Terrain", points, SIDE, SIDE)
    mesh.materials.append(material("Rock", (0.35, 0.3, 0.25), 0.9))
    link(bpy.data.objects.new("Terrain", mesh))
    light(30, 40)
    camera("Camera", (0, -1600, 900), (0, 0, 50), 45)


def add(operator, of, place, smooth=True, **values):
    operator(location=place, **values)
    made = bpy.context.object
    made.data.materials.append(of)
    if smooth:
        bpy.ops.object.shade_smooth()
    return made


def bumpy_ball(name, rows):
    points = []
    for j in range(rows):
        for i in range(2 * rows):
            turn, tilt = math.pi * i / rows, math.pi * (j + 0.5) / rows
            way = Vector(
                (
                    math.cos(turn) * math.sin(tilt),
                    math.sin(turn) * math.sin(tilt),
                    math.cos(tilt),
                )
            )
            points.append(way * (1.2 + 0.25 * noise.fractal(2 * way, 1.0, 2.0, 5)))
    return grid_mesh(name, points, 2 * rows, rows, closed=True)


def stones(of):
    rng = random.Random(7)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=0.12, location=(0, 0, -50))
    first = bpy.context.object
    first.data.materials.append(of)
    bpy.ops.object.shade_smooth()
    for vertex in first.data.vertices:
        vertex.co *= 1 + 0.5 * noise.noise(vertex.co * 12)
    for number in range(1500):
        stone = link(bpy.data.objects.new(f"Stone {number}", first.data))
        stone.location = (rng.uniform(-14, 14), rng.uniform(-7, 14), 0.05)
        size = rng.uniform(0.4, 1.6)
        stone.scale = (size, size, size * rng.uniform(0.5, 1))
        stone.rotation_euler = [rng.uniform(0, 2 * math.pi) for _ in range(3)]


def still_life():
    """Monkeys, a torus, a ball of glass, bevelled blocks, a word, an import, and stones."""
    ground = bpy.data.meshes.new("Ground")
    ground.from_pydata([(-30, -30, 0), (30, -30, 0), (30, 30, 0), (-30, 30, 0)], [], [(0, 1, 2, 3)])
    ground.materials.append(material("Ground", (0.4, 0.38, 0.35)))
    link(bpy.data.objects.new("Ground", ground))
    red, blue = material("Red", (0.6, 0.1, 0.08), 0.4), material("Blue", (0.1, 0.2, 0.6), 0.3)
    gray, gold = material("Gray", (0.5, 0.5, 0.5)), material("Gold", (0.8, 0.6, 0.2), 0.3)
    row = add(bpy.ops.mesh.primitive_cube_add, gray, (-4, 2, 0.5), smooth=False, size=1)
    array = row.modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 5, (1.4, 0, 0)
    bevel = row.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.08, 3
    for number, color in enumerate((red, blue, gold, gray)):
        monkey = add(bpy.ops.mesh.primitive_monkey_add, color, (3 * number - 4.5, -1, 1))
        monkey.rotation_euler = (0, 0, 0.5 * number)
        fine = monkey.modifiers.new("Subdivision", "SUBSURF")
        fine.levels = fine.render_levels = 3
    glass = material("Glass", (1, 1, 1), 0, 1)
    add(bpy.ops.mesh.primitive_uv_sphere_add, glass, (5.5, -3, 1), segments=64, ring_count=32)
    sizes = {"major_radius": 1.3, "minor_radius": 0.45, "major_segments": 96, "minor_segments": 48}
    add(bpy.ops.mesh.primitive_torus_add, gold, (0, -4, 0.5), **sizes)
    bpy.ops.object.text_add(location=(-5, -5, 0.01))
    word = bpy.context.object
    word.data.body, word.data.size, word.data.extrude = "LODESTONE", 1.3, 0.15
    word.data.bevel_depth, word.rotation_euler = 0.02, (1.2, 0, 0)
    word.data.materials.append(blue)
    ball = bumpy_ball("Import", 212)
    ball.materials.append(gray)
    link(bpy.data.objects.new("Import", ball)).location = (-6, 4, 1.2)
    stones(gray)
    light(40, 30)
    camera("Camera", (0, -14, 6), (0, 0, 0.5), 45)


def main():
    kind, out, *picture = sys.argv[sys.argv.index("--") + 1 :]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if kind == "still_life":
        still_life()
    else:
        terrain(kind, *picture or [None])
    bpy.ops.wm.save_as_mainfile(filepath=out)


main()
