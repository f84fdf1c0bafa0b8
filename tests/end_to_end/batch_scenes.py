# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: writes the files of test_batch_many.py into the folder named last."""

import sys
from pathlib import Path

import bpy

FOLDER = Path(sys.argv[-1])
NAMES = [f"plain{i}" for i in range(9)] + ["q\"uo'te <b>", "-dash", "名 é", "new\nline"]


def place(name, data, location=(0, 0, 0)):
    item = bpy.data.objects.new(name, data)
    item.location = location
    bpy.context.scene.collection.objects.link(item)
    return item


def scene():
    """Empty but for camera and sun."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    made = bpy.context.scene
    made.render.resolution_x, made.render.resolution_y = 32, 18
    made.lodestone.antialias = "OFF"
    made.camera = place("Camera", bpy.data.cameras.new("Camera"), (0, 0, 10))
    place("Sun", bpy.data.lights.new("Sun", "SUN")).data.energy = 3


def ball(subdivisions=2):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions)
    bpy.context.object.name = "Ball"
    return bpy.context.object


def save(name, **options):
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / f"{name}.blend"), copy=True, **options)


def main():
    scene()
    ball()
    for name in NAMES:
        save(name)
    save("crashes", compress=False)
    save("newer", compress=False)

    item = bpy.context.object
    for frame in (1, 6):
        item.location.x = frame - 3.5
        item.keyframe_insert("location", frame=frame)
    save("animated")

    scene()
    ball()
    text = bpy.data.texts.new("rig.py")
    text.write("import time\nwhile True:\n    time.sleep(1)\n")
    text.use_module = True
    save("hangs")

    scene()
    ball()
    curve = bpy.context.object.driver_add("location", 0)
    curve.driver.expression = "__import__('math').sin(frame) * 2"
    save("driven")

    scene()
    grow = ball().modifiers.new("Grow", "SUBSURF")
    grow.render_levels = 9  # 320 * 3 * 4^8 faces
    save("greedy")

    scene()
    meshes = []
    for i in range(25):
        mesh = bpy.data.meshes.new(f"Leaf {i}")
        mesh.from_pydata([(0, 0, i * 0.01), (0.1, 0, 0), (0, 0.1, 0)], [], [(0, 1, 2)])
        meshes.append(mesh)
    for i in range(5000):
        place(f"Leaf {i}", meshes[i % 25], (i % 100 * 0.08 - 4, i // 100 * 0.08 - 2, 0))
    save("forest")

    scene()
    ball()
    save("library")
    scene()
    with bpy.data.libraries.load(str(FOLDER / "library.blend"), link=True) as (held, wanted):
        wanted.objects = ["Ball"]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    bpy.ops.mesh.primitive_cube_add(location=(2, 0, 0))
    save("lacks")
    (FOLDER / "library.blend").unlink()


main()
