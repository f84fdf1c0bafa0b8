# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras near, middle and far, the sun, a few lamps and the sky."""

import math

import bpy
from mathutils import Vector

import ground

SIZE = (640, 360)
AZIMUTH, ELEVATION, DISTANCE = math.radians(18), math.radians(42), 1500.0


def camera(collection, name, place, target, lens):
    """Camera looking from a place to a target."""
    data = bpy.data.cameras.new(name)
    data.lens = lens
    data.clip_start, data.clip_end = 0.1, 5000
    obj = bpy.data.objects.new(name, data)
    obj.location = place
    obj.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    collection.objects.link(obj)
    return obj


def far_lens(place, target, sensor):
    """Lens and aim's shift along x that put both ends of the street on the picture's edges."""
    forward = (target - place).normalized()
    right = forward.cross(Vector((0, 0, 1))).normalized()
    sides = []
    for x in (-ground.HALF, ground.HALF):
        way = Vector((x, 0, 0)) - place
        sides.append(way.dot(right) / way.dot(forward))
    return sensor / (sides[1] - sides[0]), (sides[0] + sides[1]) / 2 * DISTANCE


def footprint(camera_object, point):
    """Meters that one pixel covers at a point, across the picture."""
    matrix = camera_object.matrix_world
    depth = (matrix.inverted() @ Vector(point)).z * -1
    data = camera_object.data
    return depth * data.sensor_width / data.lens / SIZE[0]


def build(scene, collection):
    """Make all; returns the far camera's pixel footprints in meters."""
    render = scene.render
    render.resolution_x, render.resolution_y = SIZE
    render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    camera(collection, "near", (-50.4, -7.1, 1.65), (-26.0, 5.0, 2.9), 26)
    camera(collection, "middle", (-75.5, -3.6, 6.4), (-10.0, 6.5, 1.8), 28)
    target = Vector((0, 0, 0))
    back = Vector(
        (
            math.sin(AZIMUTH) * math.cos(ELEVATION),
            -math.cos(AZIMUTH) * math.cos(ELEVATION),
            math.sin(ELEVATION),
        )
    )
    for _ in range(4):
        place = target + back * DISTANCE
        lens, shift = far_lens(place, target, 36.0)
        right = (-back).cross(Vector((0, 0, 1))).normalized()
        target = target + right * shift
    far = camera(collection, "far", place, target, lens)
    scene.camera = far
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle, sun.color = 3.6, math.radians(0.6), (1.0, 0.95, 0.86)
    obj = bpy.data.objects.new("Sun", sun)
    obj.rotation_euler = Vector((-0.55, 0.62, -0.72)).to_track_quat("-Z", "Y").to_euler()
    collection.objects.link(obj)
    for x in (-58, 4):
        lamp = bpy.data.lights.new("Lantern", "POINT")
        lamp.energy, lamp.color, lamp.shadow_soft_size = 60, (1, 0.85, 0.6), 0.15
        obj = bpy.data.objects.new("Lantern", lamp)
        obj.location = (x, -3.5, 5.0)
        collection.objects.link(obj)
    world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.56, 0.72, 0.95, 1)
    background.inputs["Strength"].default_value = 0.75
    scene.world = world
    bpy.context.view_layer.update()
    half = ground.HALF
    points = {"near_end": (half, 0, 0), "middle": (0, 0, 0), "far_end": (-half, 0, 0)}
    result = {name: round(footprint(far, p), 4) for name, p in points.items()}
    result["lens_mm"] = round(lens, 2)
    return result
