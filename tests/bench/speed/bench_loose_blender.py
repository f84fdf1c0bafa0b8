# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of bench_loose.py inside Blender: makes a kit-bashed city, all in one mesh object.

blender -b --factory-startup --addons lodestone --python THIS -- SIDE FILE...

SIDE x SIDE plots of 30 m with one to four parts of a small kit each (blocks with rounded edges,
columns, domes, rings), every fourth row a street. Each FILE (NAME_one.blend, NAME_automatic.blend)
decides on the loose parts by its name.
"""

import math
import random
import sys

import bmesh
import bpy
from mathutils import Matrix

PLOT = 30.0  # metres
BLOCK = 4  # every so many plots a street
COLORS = (
    (0.55, 0.5, 0.45),
    (0.35, 0.4, 0.5),
    (0.6, 0.3, 0.2),
    (0.75, 0.72, 0.65),
    (0.2, 0.3, 0.25),
)


def block(made):
    bmesh.ops.create_cube(made, size=1.0, matrix=Matrix.Translation((0, 0, 0.5)))
    bmesh.ops.bevel(made, geom=made.edges[:], offset=0.04, segments=4, affect="EDGES", profile=0.5)


def column(made):
    place = Matrix.Translation((0, 0, 0.5))
    bmesh.ops.create_cone(
        made, cap_ends=True, segments=64, radius1=0.5, radius2=0.5, depth=1.0, matrix=place
    )
    rims = [e for e in made.edges if abs(e.verts[0].co.z - e.verts[1].co.z) < 1e-6]
    bmesh.ops.bevel(made, geom=rims, offset=0.04, segments=3, affect="EDGES", profile=0.5)


def dome(made):
    bmesh.ops.create_uvsphere(made, u_segments=40, v_segments=20, radius=0.5)
    for vertex in made.verts:
        vertex.co.z = max(0.0, 2 * vertex.co.z)


def ring(made):
    for i in range(48):
        for k in range(10):
            around, along = 2 * math.pi * k / 10, 2 * math.pi * i / 48
            radius = 0.42 + 0.08 * math.cos(around)
            place = (radius * math.cos(along), radius * math.sin(along), 0.5 + math.sin(around) / 2)
            made.verts.new(place)
    made.verts.ensure_lookup_table()
    for i in range(48):
        for k in range(10):
            ends = ((i, k), ((i + 1) % 48, k), ((i + 1) % 48, (k + 1) % 10), (i, (k + 1) % 10))
            made.faces.new([made.verts[10 * a + b] for a, b in ends])


def city_mesh(side):
    """All of the city in one mesh, and its number of parts."""
    kit = []
    for make in (block, block, column, dome, ring):
        made = bmesh.new()
        make(made)
        made.verts.index_update()
        corners = [tuple(vertex.co) for vertex in made.verts]
        kit.append((corners, [[vertex.index for vertex in face.verts] for face in made.faces]))
        made.free()
    chance = random.Random(1)
    vertices, faces, colors, parts = [], [], [], 0

    def add(piece, at, size, turn):
        nonlocal parts
        first, (corners, own) = len(vertices), kit[piece]
        c, s = math.cos(turn), math.sin(turn)
        for x, y, z in corners:
            x, y = size[0] * x, size[1] * y
            vertices.append((at[0] + c * x - s * y, at[1] + s * x + c * y, at[2] + size[2] * z))
        faces.extend([first + i for i in face] for face in own)
        colors.extend([chance.randrange(len(COLORS))] * len(own))
        parts += 1

    for x in range(side):
        for y in range(side):
            if x % BLOCK == 0 or y % BLOCK == 0:
                continue
            middle = (PLOT * (x - side / 2), PLOT * (y - side / 2))
            wide, top = chance.uniform(18, 27), 0.0
            for number in range(chance.randint(2, 6)):
                tall = chance.uniform(6, 25)
                piece = chance.randrange(2) if number == 0 else chance.randrange(len(kit))
                add(piece, (*middle, top), (wide, wide, tall), chance.randrange(4) * math.pi / 2)
                wide, top = wide * chance.uniform(0.6, 0.95), top + tall
    mesh = bpy.data.meshes.new("City")
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("material_index", colors)
    return mesh, parts


def main():
    side, *files = sys.argv[sys.argv.index("--") + 1 :]
    side = int(side)
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    mesh, parts = city_mesh(side)
    for number, color in enumerate(COLORS):
        material = bpy.data.materials.new(f"Color {number}")
        material.use_nodes = True
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
        mesh.materials.append(material)
    city = bpy.data.objects.new("City", mesh)
    scene.collection.objects.link(city)
    ground = bpy.data.meshes.new("Ground")
    far = PLOT * side
    corners = [(-far, -far, 0), (far, -far, 0), (far, far, 0), (-far, far, 0)]
    ground.from_pydata(corners, [], [(0, 1, 2, 3)])
    scene.collection.objects.link(bpy.data.objects.new("Ground", ground))
    print(f"City: {parts} parts, {sum(len(p.vertices) - 2 for p in mesh.polygons)} triangles")

    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3.0, (0.7, 0.2, 0.5)
    scene.collection.objects.link(sun)
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.5, 0.65, 0.9, 1)
    street = PLOT * (BLOCK * (side // 2 // BLOCK) - side / 2)
    for name, at, tilt, turn in (
        ("street", (street, street, 2), 95, 0),
        ("roof", (street, street, 90), 72, 20),
        ("outside", (0.7 * far, -0.7 * far, 0.3 * far), 72, 45),
    ):
        camera = bpy.data.objects.new(name, bpy.data.cameras.new(name))
        camera.data.lens = 28
        camera.data.clip_end = 10 * far
        camera.location = at
        camera.rotation_euler = (math.radians(tilt), 0, math.radians(turn))
        scene.collection.objects.link(camera)
        scene.camera = scene.camera or camera
    for file in files:
        city.lodestone.loose_parts = "ONE" if file.endswith("_one.blend") else "AUTOMATIC"
        bpy.ops.wm.save_as_mainfile(filepath=file)


main()
