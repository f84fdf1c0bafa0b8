# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside Blender: saves a scene of a few frames in which nothing but the camera moves.

    blender -b --factory-startup --python tests/end_to_end/make_camera_flight.py -- FILE
"""

import sys

import bpy

FRAMES = 4


def main(path):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.frame_start, scene.frame_end = 1, FRAMES
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=0.4)
    stone = bpy.context.object.data
    for i in range(5):
        item = bpy.data.objects.new(f"Stone {i}", stone)
        item.location = (i - 2, 2, 0)
        scene.collection.objects.link(item)
    bpy.ops.mesh.primitive_torus_add(major_segments=64, minor_segments=24)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.rotation_euler.x = 1.5708
    for frame, y in ((1, -80.0), (FRAMES, -6.0)):
        camera.location = (0, y, 0.5)
        camera.keyframe_insert("location", frame=frame)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.collection.objects.link(bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN")))
    bpy.ops.wm.save_as_mainfile(filepath=path)


main(sys.argv[-1])
