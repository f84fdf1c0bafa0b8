# SPDX-License-Identifier: GPL-3.0-or-later
"""Night scenes for bench_real.py, made inside Blender: a street of 400 lamps, a Christmas tree of
glowing balls, a hotel whose windows glow. Each has the cameras CamNear, CamFar and CamOver."""

import math
import random

import bpy
from mathutils import Vector


def _material(name, color, emission=0.0, roughness=0.7):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (*color, 1)
    surface.inputs["Roughness"].default_value = roughness
    surface.inputs["Emission"].default_value = (*color, 1)
    surface.inputs["Emission Strength"].default_value = emission
    return material


def _mesh(name, points, faces, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    mesh.materials.append(material)
    return mesh


def _place(data, at=(0, 0, 0), turn=0.0, scale=(1, 1, 1)):
    item = bpy.data.objects.new(data.name, data)
    item.location, item.rotation_euler, item.scale = at, (0, 0, turn), scale
    bpy.context.scene.collection.objects.link(item)
    return item


def _box(name, material):
    """A unit cube on the ground."""
    points = [(x, y, z) for z in (0, 1) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return _mesh(name, points, faces, material)


def _ball(name, material, rings=8):
    points, faces, around = [], [], 2 * rings
    for i in range(1, rings):
        a = math.pi * i / rings
        for k in range(around):
            b = 2 * math.pi * k / around
            points.append((math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)))
    top, bottom = len(points), len(points) + 1
    points += [(0, 0, 1), (0, 0, -1)]
    last = (rings - 2) * around
    for k in range(around):
        j = (k + 1) % around
        faces += [(top, k, j), (bottom, last + j, last + k)]
        faces += [
            (i * around + k, (i + 1) * around + k, (i + 1) * around + j, i * around + j)
            for i in range(rings - 2)
        ]
    return _mesh(name, points, faces, material)


def _ground(size, color):
    points = [(x * size, y * size, 0) for y in (-1, 1) for x in (-1, 1)]
    _place(_mesh("Ground", points, [(0, 1, 3, 2)], _material("Ground", color)))


def _begin(sky):
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    world = bpy.data.worlds.new("Night")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*sky, 1)
    bpy.context.scene.world = world


def _cameras(views):
    """{name: (from, at)}; the first is the scene's."""
    for name, (eye, at) in views.items():
        name = f"Cam{name.title()}"
        camera = bpy.data.objects.new(name, bpy.data.cameras.new(name))
        camera.location = eye
        way = Vector(at) - Vector(eye)
        camera.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
        camera.data.clip_end = 5000
        bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = bpy.data.objects[f"Cam{next(iter(views)).title()}"]


def street_lamps():
    """Four hundred spot and point lamps on posts along four streets between houses."""
    _begin((0.004, 0.006, 0.012))
    _ground(400, (0.1, 0.1, 0.11))
    rng = random.Random(1)
    walls = [
        _box(f"House {i}", _material(f"Wall {i}", color))
        for i, color in enumerate(((0.5, 0.42, 0.35), (0.35, 0.36, 0.4), (0.45, 0.3, 0.25)))
    ]
    post = _box("Post", _material("Iron", (0.05, 0.05, 0.05)))
    lamps = []
    for kind in ("SPOT", "POINT"):
        data = bpy.data.lights.new(kind.title(), kind)
        data.energy, data.shadow_soft_size = (900, 0.15) if kind == "SPOT" else (250, 0.15)
        data.color = (1, 0.75, 0.45) if kind == "SPOT" else (0.8, 0.9, 1)
        if kind == "SPOT":
            data.spot_size, data.spot_blend = 2.2, 0.5
        lamps.append(data)
    for street in range(4):
        x = (street - 1.5) * 60
        for i in range(100):
            y, side = (i // 2) * 8 - 200, 1 if i % 2 else -1
            _place(post, (x + side * 6, y, 0), 0, (0.15, 0.15, 6))
            _place(lamps[street % 2], (x + side * 5.2, y, 6))
        for i in range(40):
            y, side = (i // 2) * 20 - 195, 1 if i % 2 else -1
            size = (16, 14 + 4 * rng.random(), 6 + 10 * rng.random())
            _place(rng.choice(walls), (x + side * 18, y, 0), 0.02 * rng.random(), size)
    _cameras(
        {
            "near": ((-30, -190, 1.7), (-29, -120, 4)),
            "far": ((260, -330, 60), (0, -40, 0)),
            "over": ((0, -20, 260), (0, 0, 0)),
        }
    )


def christmas_tree():
    """A tree of cones with 400 small glowing balls, on a square with huts."""
    _begin((0.003, 0.004, 0.008))
    _ground(60, (0.3, 0.31, 0.33))
    rng = random.Random(2)
    needles = _material("Needles", (0.02, 0.08, 0.03))
    for i in range(6):
        points = [(math.cos(a), math.sin(a), 0) for a in (k * math.pi / 12 for k in range(24))]
        faces = [(k, (k + 1) % 24, 24) for k in range(24)]
        cone = _mesh(f"Tier {i}", [*points, (0, 0, 1)], faces, needles)
        width = 4.2 - 0.6 * i
        _place(cone, (0, 0, 1.5 + 1.7 * i), 0.3 * i, (width, width, 3))
    colors = ((1, 0.2, 0.1), (1, 0.7, 0.2), (0.2, 0.5, 1), (0.3, 1, 0.4))
    bulbs = [_ball(f"Bulb {i}", _material(f"Glow {i}", c, 25.0)) for i, c in enumerate(colors)]
    for i in range(400):
        tier, at = rng.randrange(6), rng.random()
        radius = (4.2 - 0.6 * tier) * (1 - at) + 0.08
        angle = 2 * math.pi * rng.random()
        place = (radius * math.cos(angle), radius * math.sin(angle), 1.5 + 1.7 * tier + 3 * at)
        _place(rng.choice(bulbs), place, 0, (0.05, 0.05, 0.05))
    hut = _box("Hut", _material("Planks", (0.35, 0.22, 0.12)))
    for i in range(14):
        angle = 2 * math.pi * i / 14
        _place(hut, (16 * math.cos(angle), 16 * math.sin(angle), 0), angle, (4, 5, 3.2))
    _cameras(
        {
            "near": ((7, -9, 2.2), (0, 0, 5)),
            "far": ((30, -50, 22), (0, 0, 3)),
            "over": ((3, -4, 34), (0, 0, 0)),
        }
    )


def hotel_windows():
    """A hotel of 12 floors; 180 of its windows are panes that glow, over a pool and a lawn."""
    _begin((0.006, 0.008, 0.016))
    _ground(150, (0.06, 0.09, 0.05))
    rng = random.Random(3)
    wall = _box("Wall", _material("Plaster", (0.6, 0.57, 0.5)))
    _place(wall, (0, 0, 0), 0, (60, 14, 40))
    pane = [(-0.5, 0, 0), (0.5, 0, 0), (0.5, 0, 1), (-0.5, 0, 1)]
    lit = [
        _mesh(f"Lit pane {i}", pane, [(0, 1, 2, 3)], _material(f"Room {i}", color, 6.0))
        for i, color in enumerate(((1, 0.75, 0.4), (1, 0.9, 0.7), (0.6, 0.75, 1)))
    ]
    dark = _mesh("Dark pane", pane, [(0, 1, 2, 3)], _material("Glass", (0.02, 0.02, 0.03), 0, 0.2))
    sill = _box("Sill", _material("Stone", (0.4, 0.4, 0.4)))
    chosen = set(rng.sample(range(12 * 24), 180))
    for floor in range(12):
        for k in range(24):
            x, z = (k - 11.5) * 2.4, 1 + floor * 3.2
            glows = floor * 24 + k in chosen
            _place(rng.choice(lit) if glows else dark, (x, -7.02, z), 0, (1.4, 1, 1.6))
            _place(sill, (x, -7.1, z - 0.15), 0, (1.8, 0.4, 0.1))
    tree = _ball("Crown", _material("Leaves", (0.05, 0.12, 0.04)))
    for _ in range(40):
        at = (rng.uniform(-60, 60), rng.uniform(-70, -14), 3)
        size = rng.uniform(1, 2.2)
        _place(tree, at, 0, (size, size, 1.6 * size))
    water = _mesh(
        "Water", [(-12, -30, 0.05), (12, -30, 0.05), (12, -18, 0.05), (-12, -18, 0.05)],
        [(0, 1, 2, 3)], _material("Water", (0.02, 0.05, 0.07), 0, 0.05),
    )  # fmt: skip
    _place(water)
    _cameras(
        {
            "near": ((-14, -40, 2), (4, -6, 12)),
            "far": ((-90, -140, 40), (0, 0, 14)),
            "over": ((0, -60, 110), (0, -20, 0)),
        }
    )


SCENES = {
    "night_street": street_lamps,
    "night_tree": christmas_tree,
    "night_hotel": hotel_windows,
}
