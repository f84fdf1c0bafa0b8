# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside Blender: saves a scene of 20 frames in which things walk, wave, grow, drive and rest.

    blender -b --factory-startup --python tests/end_to_end/make_animation.py -- FILE

Walker: skinned to an armature whose bones swing, while the armature moves. Flag: a wave modifier.
Plant: geometry nodes that read the scene's time. Car: moves as a whole; its driver is its child.
House: a collection of balls that rest; one of them is keyed, but never moves.
"""

import math
import sys

import bpy
from mathutils import Vector

FRAMES = 20


def collection(name, parent=None):
    made = bpy.data.collections.new(name)
    (parent or bpy.context.scene.collection).children.link(made)
    return made


def place(home, name, data, location=(0, 0, 0)):
    item = bpy.data.objects.new(name, data)
    item.location = location
    home.objects.link(item)
    return item


def material(name, color):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    return made


def ball(name, radius, color, subdivisions=6):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, radius=radius)
    item = bpy.context.object
    mesh = item.data
    bpy.data.objects.remove(item)
    mesh.name = name
    mesh.materials.append(material(name, color))
    return mesh


def grid(name, width, height, columns, rows, color):
    corners = [
        (width * (x / columns - 0.5), 0.0, height * y / rows)
        for y in range(rows + 1)
        for x in range(columns + 1)
    ]
    faces = [
        (i, i + 1, i + columns + 2, i + columns + 1)
        for y in range(rows)
        for i in range(y * (columns + 1), y * (columns + 1) + columns)
    ]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    mesh.materials.append(material(name, color))
    return mesh


def walker(home):
    rig = place(home, "Rig", bpy.data.armatures.new("Rig"), (-3, 0, 0))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for side, x in (("left", -0.3), ("right", 0.3)):
        bone = rig.data.edit_bones.new(side)
        bone.head, bone.tail = (x, 0, 1.2), (x, 0, 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    for side, way in (("left", 1), ("right", -1)):
        bone = rig.pose.bones[side]
        bone.rotation_mode = "XYZ"
        for frame in range(1, FRAMES + 1, 3):
            bone.rotation_euler.x = way * 0.6 * math.sin(frame)
            bone.keyframe_insert("rotation_euler", frame=frame)
    for frame, x in ((1, -4.0), (FRAMES, -2.0)):
        rig.location.x = x
        rig.keyframe_insert("location", frame=frame)
    body = place(home, "Walker", ball("Walker", 1.0, (0.8, 0.5, 0.3)))
    for vertex in body.data.vertices:
        vertex.co = Vector((vertex.co.x * 0.6, vertex.co.y * 0.4, 1.2 + vertex.co.z * 1.2))
    for side, way in (("left", -1), ("right", 1)):
        group = body.vertex_groups.new(name=side)
        legs = [v.index for v in body.data.vertices if v.co.z < 1.2 and v.co.x * way >= 0]
        group.add(legs, 1.0, "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = rig
    body.parent = rig


def flag(home):
    item = place(home, "Flag", grid("Flag", 2.0, 1.2, 80, 48, (0.7, 0.05, 0.05)), (0, 0, 2))
    item.modifiers.new("Wave", "WAVE").height = 0.3
    item.modifiers["Wave"].width = 0.5
    item.rotation_euler.x = 0.3


def plant(home):
    item = place(home, "Plant", ball("Plant", 0.7, (0.1, 0.5, 0.1)), (3, 0, 0))
    nodes = item.modifiers.new("Grow", "NODES")
    tree = bpy.data.node_groups.new("Grow", "GeometryNodeTree")
    nodes.node_group = tree
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    given, shown = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    moved = tree.nodes.new("GeometryNodeTransform")
    time, size = tree.nodes.new("GeometryNodeInputSceneTime"), tree.nodes.new("ShaderNodeMath")
    size.operation = "MULTIPLY_ADD"
    size.inputs[1].default_value, size.inputs[2].default_value = 0.05, 0.4
    vector = tree.nodes.new("ShaderNodeCombineXYZ")
    vector.inputs[0].default_value = vector.inputs[1].default_value = 1.0
    link = tree.links.new
    link(time.outputs["Frame"], size.inputs[0])
    link(size.outputs[0], vector.inputs[2])
    link(vector.outputs[0], moved.inputs["Scale"])
    link(given.outputs[0], moved.inputs[0])
    link(moved.outputs[0], shown.inputs[0])


def car(home):
    item = place(home, "Car", ball("Car", 0.5, (0.1, 0.2, 0.7)), (-4, -2, 0.5))
    driver = place(home, "Driver", ball("Driver", 0.2, (0.9, 0.8, 0.2)), (0, 0, 0.6))
    driver.parent = item
    for frame, x in ((1, -4.0), (FRAMES, 4.0)):
        item.location.x = x
        item.keyframe_insert("location", frame=frame)


def house(home):
    mesh = ball("Stone", 0.3, (0.5, 0.5, 0.5))
    for i in range(12):
        place(home, f"Stone {i}", mesh, (-4 + 0.7 * i, 2, 0.3))
    last = place(home, "Keyed Stone", mesh, (4.5, 2, 0.3))
    last.keyframe_insert("location", frame=1)
    last.keyframe_insert("location", frame=FRAMES)


def main(path):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 128, 72
    scene.render.film_transparent = True  # pictures tell what they cover
    scene.frame_start, scene.frame_end = 1, FRAMES
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0.3, 0.35, 0.4)
    actors = collection("Actors")
    walker(actors)
    flag(actors)
    plant(actors)
    car(actors)
    house(collection("House"))
    sun = place(scene.collection, "Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy = 3
    sun.rotation_euler = (0.6, 0.3, 0)
    camera = place(scene.collection, "Camera", bpy.data.cameras.new("Camera"), (0, -14, 4))
    camera.rotation_euler = (math.radians(78), 0, 0)
    scene.camera = camera
    bpy.ops.wm.save_as_mainfile(filepath=path)


main(sys.argv[sys.argv.index("--") + 1])
