# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of real_scenes.py that runs inside Blender: makes every scene a .blend that renders.

    blender -b --factory-startup --python-exit-code 1 --python samples/real_scenes_in_blender.py \\
        -- JOBS.json

JOBS.json: a list of {"files": [one .blend, or glTF files], "out": a .blend}. Several glTF files are
set out on a grid. A scene without camera gets one that frames it all, one without light a sun (a
lamp below the ceiling, when one object holds all others), one without world a sky.
"""

import json
import math
import sys

import bpy
from mathutils import Vector

DIRECTION = Vector((0.55, -1.0, 0.5)).normalized()  # to the camera
MARGIN = 0.05  # of the scene's size: air around what is framed
MOST = 0.9  # of the objects are framed
CELL = 1.15  # of the largest part
CORNER = Vector((0.9, -0.6, 0.3))  # of a room's half size: where the camera stands


def main(path):
    with open(path, encoding="utf-8") as file:
        for job in json.load(file):
            make(job["files"], job["out"])


def make(files, out):
    if files[0].endswith(".blend"):
        bpy.ops.wm.open_mainfile(filepath=files[0], load_ui=False, use_scripts=False)
    else:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        parts = [import_gltf(file) for file in files]
        if len(parts) > 1:
            set_out(parts)
    complete(bpy.context.scene)
    bpy.ops.wm.save_as_mainfile(filepath=out, check_existing=False, relative_remap=True)


def import_gltf(file):
    """The objects without parent of a glTF file."""
    try:
        import numpy
    except ImportError:
        raise SystemExit(
            "Blender's glTF importer needs Debian's python3-numpy; call /usr/bin/python3"
        )
    if "bool" not in numpy.__dict__:  # Blender 3.4's importer still uses the name
        numpy.bool = bool
    before = set(bpy.data.objects)
    materials = list(bpy.data.materials)
    bpy.ops.import_scene.gltf(filepath=file)
    share_materials(materials)
    return [item for item in bpy.data.objects if item not in before and item.parent is None]


def share_materials(known):
    """Parts of one kit bring the same materials again, which Blender calls NAME.001."""
    for material in [m for m in bpy.data.materials if m not in known]:
        first = next((m for m in known if m.name == material.name.rsplit(".", 1)[0]), None)
        if first is not None:
            material.user_remap(first)
            bpy.data.materials.remove(material)


def set_out(parts):
    """Every part in a cell of its own."""
    bpy.context.view_layer.update()
    largest = max(max(high - low for low, high in zip(*bounds(below(part)))) for part in parts)
    columns = math.ceil(math.sqrt(len(parts)))
    for number, part in enumerate(parts):
        row, column = divmod(number, columns)
        for item in part:
            item.location.x += CELL * largest * column
            item.location.y += CELL * largest * row


def below(roots):
    return [item for root in roots for item in (root, *root.children_recursive)]


def corners_of(item):
    return [item.matrix_world @ Vector(corner) for corner in item.bound_box]


def bounds(objects):
    """Corners of the box around meshes and their like; None without any."""
    kinds = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
    points = [corner for item in objects if item.type in kinds for corner in corners_of(item)]
    if not points:
        return None
    low, high = ([pick(p[i] for p in points) for i in range(3)] for pick in (min, max))
    return Vector(low), Vector(high)


def room_of(objects, whole):
    """True when one object is as large as everything, and there is more within."""
    around = [item for item in objects if bounds([item]) == whole]
    return len(around) == 1 and len(objects) > 1


def complete(scene):
    """Adds the camera, the light and the world that a scene lacks."""
    bpy.context.view_layer.update()
    shown = [
        item
        for item in scene.objects
        if not item.hide_render and item.visible_get() and bounds([item]) is not None
    ]
    found = bounds(shown)
    if found is None:
        raise SystemExit(f"nothing to frame in {bpy.data.filepath or scene.name}")
    low, high = found
    inside = room_of(shown, found)
    if scene.camera is None:
        add_camera(scene, shown, (low + high) / 2, (high - low) / 2, inside)
    lights = [item for item in scene.objects if item.type == "LIGHT" and not item.hide_render]
    if not lights:
        add_light(scene, (low + high) / 2, (high - low) / 2, inside)
    if scene.world is None:
        scene.world = bpy.data.worlds.new("Sky")
        scene.world.use_nodes = True
        sky = scene.world.node_tree.nodes["Background"]
        sky.inputs["Color"].default_value = (0.5, 0.6, 0.75, 1.0)
        sky.inputs["Strength"].default_value = 0.5
    scene.view_settings.view_transform = "Standard"


def add_camera(scene, shown, center, half, inside):
    data = bpy.data.cameras.new("Framing")
    item = bpy.data.objects.new("Framing", data)
    scene.collection.objects.link(item)
    scene.camera = item
    if inside:
        data.lens = 20.0
        item.location = center + Vector(h * c for h, c in zip(half, CORNER))
        way = item.location - (center - 0.5 * Vector(h * c for h, c in zip(half, CORNER)))
        item.rotation_euler = way.to_track_quat("Z", "Y").to_euler()
        return
    item.rotation_euler = DIRECTION.to_track_quat("Z", "Y").to_euler()
    bpy.context.view_layer.update()
    corners = [c for part in most(shown) for c in corners_of(part)]
    flat = [value for corner in corners for value in corner]
    place, _ = item.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), flat)
    item.location = place + MARGIN * half.length * DIRECTION
    data.clip_end = 10 * ((item.location - center).length + half.length)
    data.clip_start = data.clip_end / 1e5


def most(objects):
    """Those nearest to the middle one: a few far away would make all the others tiny."""
    places = [sum(corners_of(item), Vector()) / 8 for item in objects]
    middle = Vector(sorted(p[i] for p in places)[len(places) // 2] for i in range(3))
    order = sorted(range(len(objects)), key=lambda i: (places[i] - middle).length)
    return [objects[i] for i in order[: math.ceil(MOST * len(objects))]]


def add_light(scene, center, half, inside):
    data = bpy.data.lights.new("Light", "POINT" if inside else "SUN")
    item = bpy.data.objects.new("Light", data)
    scene.collection.objects.link(item)
    item.location = center + Vector((0.0, 0.0, 0.8 * half.z))
    if inside:
        data.energy = 8.0 * half.length_squared
    else:
        data.energy = 3.0
        item.rotation_euler = (math.radians(45.0), 0.0, math.radians(35.0))


main(sys.argv[sys.argv.index("--") + 1])
