# SPDX-License-Identifier: GPL-3.0-or-later
"""Run by a second Blender: a sky texture, and its sun, drawn by Cycles into two files.

blender -b --factory-startup --python-exit-code 1 --python THIS -- JSON

JSON: `node` (the values of the texture's node, by identifier), `to_sun` (the direction to its sun;
null: it has none), `width`, `height`, `sky` (OpenEXR, all around as an environment texture is),
`sun` (a file of numbers: its irradiance in W/m^2 of red, green and blue, square to it; 0 of a sky
without one).
"""

import json
import math
import sys
from pathlib import Path
from typing import Any

import bpy
from mathutils import Vector

_AROUND_SUN = 1.5  # Taste: the width of its picture, in suns
_SUN_PIXELS = 32  # Taste: more tell the disk's edge finer
_SUN_SAMPLES = 16  # Taste: as _SUN_PIXELS
_SKY_SAMPLES = 4  # Taste: more tell the mean of a pixel better


def _sky_node(values: dict[str, Any], world: Any) -> Any:
    world.use_nodes = True
    world.cycles.sampling_method = "NONE"  # else Cycles looks at two million places of it
    tree = world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 1.0
    for name, value in values.items():
        setattr(sky, name, value)
    return sky


def _rendered(scene: Any, path: str, width: int, height: int, samples: int) -> None:
    scene.cycles.samples = samples
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True, scene=scene.name)


def _scene(world: Any) -> Any:
    scene = bpy.data.scenes.new("Sky")
    scene.world = world
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    return scene


def _draw_sky(scene: Any, given: dict[str, Any]) -> None:
    camera = scene.camera
    camera.data.type = "PANO"
    camera.data.cycles.panorama_type = "EQUIRECTANGULAR"
    camera.rotation_euler = (math.pi / 2, 0.0, -math.pi / 2)  # its middle looks along X
    _rendered(scene, given["sky"], given["width"], given["height"], _SKY_SAMPLES)


def _sun_without_sky(scene: Any, sky: Any, to_sun: Vector, picture: str) -> list[float]:
    """The irradiance of its sun; the sky before and around it does not count."""
    if not sky.sun_elevation + sky.sun_size / 2 > 0.0:  # it has set
        return [0.0, 0.0, 0.0]
    camera = scene.camera
    camera.data.type = "PERSP"
    camera.data.angle = min(math.radians(170), max(1e-3, _AROUND_SUN * sky.sun_size))
    camera.rotation_euler = to_sun.to_track_quat("-Z", "Y").to_euler()
    sky.sun_disc = True
    with_disc = _received(scene, picture)
    sky.sun_disc = False
    return [max(0.0, both - rest) for both, rest in zip(with_disc, _received(scene, picture))]


def _received(scene: Any, picture: str) -> list[float]:
    """The irradiance of all that the camera sees, on what faces it."""
    _rendered(scene, picture, _SUN_PIXELS, _SUN_PIXELS, _SUN_SAMPLES)
    image = bpy.data.images.load(picture)
    pixels = image.pixels[:]
    bpy.data.images.remove(image)
    Path(picture).unlink()
    step = 2.0 * math.tan(scene.camera.data.angle / 2) / _SUN_PIXELS
    sums = [0.0, 0.0, 0.0]
    for row in range(_SUN_PIXELS):
        for column in range(_SUN_PIXELS):
            x, y = ((at + 0.5 - _SUN_PIXELS / 2) * step for at in (column, row))
            square = 1.0 + x * x + y * y
            # Law: the solid angle of a pixel, times the cosine to the middle
            weight = step * step / (square * square)
            at = 4 * (row * _SUN_PIXELS + column)
            for channel in range(3):
                sums[channel] += weight * pixels[at + channel]
    return sums


def main() -> None:
    given = json.loads(sys.argv[sys.argv.index("--") + 1])
    world = bpy.data.worlds.new("Sky")
    sky = _sky_node(given["node"], world)
    scene = _scene(world)
    sun = [0.0, 0.0, 0.0]
    if given["to_sun"] is not None:
        sun = _sun_without_sky(scene, sky, Vector(given["to_sun"]), f"{given['sun']}.exr")
    sky.sun_disc = False
    _draw_sky(scene, given)
    Path(given["sun"]).write_text(json.dumps(sun), "utf-8")


main()
