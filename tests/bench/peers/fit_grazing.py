# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits gloss by the angle of view to Cycles' principled surfaces.

povray_export/texture/grazing_gloss.cpp holds the result.

    blender -b --factory-startup --python tests/bench/peers/fit_grazing.py -- FOLDER

Renders black planes of every roughness in Cycles (direct light only), turned away from the eye by
every angle: in a uniform sky, whose reflection by angle is taken as it is, and under 25 suns. The
highlight of suns is Blinn's, times 1 + growth (sky by angle over that of facing - 1), which
POV-Ray's `metallic` makes of a pigment brighter than white; its albedo, exponent and growth are
those with the least squared difference of the display-encoded picture on a gray of 0.18. Prints a
row per roughness, what is left in 255ths, and what is left with the best highlight that does not
grow. The matte surface below changes by angle, too (Disney's diffuse term): `matte` is
its answer to the sky over that of facing. The layer of gloss lets that much through, so that it
covers less where the surface is bright, and its pigment is brighter by as much. Then the sky at
other values of specular, over that at 0.5.

LAMP rows are the gloss without a layer, on grays of 0.03 and 0.18: white in the pigment (`white`
times what the sky's reflection grows by the angle) and a highlight times 1 - metallic (1 - F). F is
POV-Ray's Fresnel term of the angle of the lamp: `metallic` fades the highlight of a pigment that is
nearly black. `bright` is the mean of the fitted pictures over Cycles', on both grays.
Takes 5 minutes; needs numpy.
"""

import itertools
import math
import sys
from pathlib import Path

import bpy
import mathutils
import numpy as np

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])
CELL = 6  # pixels a plane's cell is wide
ANGLES = [0, 20, 40, 50, 60, 65, 70, 75, 80, 83, 85, 87, 89]
WRITTEN = [0, 40, 50, 60, 70, 80, 89]  # those of the rows
ROUGHNESS = [0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
SUNS = list(
    itertools.product((20, 45, 60, 75, 85), (0, 30, 60, 90, 180))
)  # from the normal; around
EXPONENTS = 1.2 ** np.arange(1, 30)
GROWTHS = np.arange(0, 30.5, 1)
ALBEDOS = np.geomspace(0.003, 0.1, 24)
GRAY = 0.18
LAMP_GRAYS = (0.03, 0.18)
METALLICS = (0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.98)
HIGHLIGHTS = np.geomspace(0.02, 2, 30)
WHITES = np.linspace(0, 1, 9)
VEIL = 0.25  # the least share that the layer covers, as in texture_writer.cpp


def plain(roughness, specular, white):
    material = bpy.data.materials.new("M")
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (white, white, white, 1)
    node.inputs["Specular"].default_value = specular
    node.inputs["Roughness"].default_value = roughness
    return material


def build(specular, white=0.0):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.samples = 256
    scene.cycles.max_bounces = 1
    scene.cycles.blur_glossy = 0
    scene.cycles.sample_clamp_indirect = 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    wide, high = len(ANGLES), len(ROUGHNESS)
    scene.render.resolution_x, scene.render.resolution_y = CELL * wide, CELL * high
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", wide, 2000
    camera.location = (0, 0, 1000)
    scene.collection.objects.link(camera)
    scene.camera = camera
    for row, roughness in enumerate(ROUGHNESS):
        material = plain(roughness, specular, white)
        for column, degrees in enumerate(ANGLES):
            angle = math.radians(degrees)
            u = mathutils.Vector((0.45, 0, -0.45 * math.tan(angle)))
            v = mathutils.Vector((0, 0.45, 0))
            at = mathutils.Vector((column - wide / 2 + 0.5, row - high / 2 + 0.5, 0))
            mesh = bpy.data.meshes.new("Plane")
            mesh.from_pydata([at - u - v, at + u - v, at + u + v, at - u + v], [], [(0, 1, 2, 3)])
            mesh.materials.append(material)
            made = bpy.data.objects.new("Plane", mesh)
            made.visible_glossy = made.visible_shadow = made.visible_diffuse = False
            scene.collection.objects.link(made)
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    return scene


def picture(scene):
    """Radiance by roughness and angle."""
    scene.render.filepath = str(FOLDER / "grazing.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    image.colorspace_settings.name = "Non-Color"
    wide, high = len(ANGLES), len(ROUGHNESS)
    values = np.empty(4 * CELL * CELL * wide * high, dtype=np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    cells = values.reshape(high, CELL, wide, CELL, 4)[:, 2:4, :, 2:4, 1]
    return cells.mean(axis=(1, 3)).astype(float)


def sky_of(scene):
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    seen = picture(scene)
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    return seen


def suns_of(scene):
    """Radiance by sun, roughness and angle, where a facing white surface would show 1."""
    scene.cycles.samples = 4
    lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    lamp.data.energy, lamp.data.angle = math.pi, 0
    lamp.rotation_mode = "QUATERNION"
    scene.collection.objects.link(lamp)
    found = np.zeros((len(SUNS), len(ROUGHNESS), len(ANGLES)))
    for (number, (aside, around)), (column, degrees) in itertools.product(
        enumerate(SUNS), enumerate(ANGLES)
    ):
        angle, aside, around = (math.radians(value) for value in (degrees, aside, around))
        x = mathutils.Vector((math.cos(angle), 0, -math.sin(angle)))  # the mirrored eye's side
        z = mathutils.Vector((math.sin(angle), 0, math.cos(angle)))
        y = mathutils.Vector((0, 1, 0))
        way = math.sin(aside) * (math.cos(around) * x + math.sin(around) * y) + math.cos(aside) * z
        lamp.rotation_quaternion = way.to_track_quat("Z", "Y")
        found[number, :, column] = picture(scene)[:, column]
    return found


def encoded(color):
    color = np.clip(color, 0, 1)
    return np.where(color <= 0.0031308, 12.92 * color, 1.055 * np.power(color, 1 / 2.4) - 0.055)


def geometry():
    """By sun and angle: the cosine of the half vector; by sun: its cosine, and POV-Ray's measure of
    how far it is from the horizon, toward which `metallic` fades."""
    half = np.zeros((len(SUNS), len(ANGLES)))
    facing = np.zeros(len(SUNS))
    for number, (aside, around) in enumerate(SUNS):
        aside, around = math.radians(aside), math.radians(around)
        sun = np.array(
            [math.sin(aside) * math.cos(around), math.sin(aside) * math.sin(around)]
            + [math.cos(aside)]
        )
        facing[number] = sun[2]
        for column, degrees in enumerate(ANGLES):
            angle = math.radians(degrees)
            middle = sun + np.array([-math.sin(angle), 0, math.cos(angle)])
            half[number, column] = middle[2] / np.linalg.norm(middle)
    x = np.arccos(facing) / (math.pi / 2)
    fading = np.clip(0.014567225 / (x - 1.12) ** 2 - 0.011612903, 0, 1)
    return half, facing, 1 - fading


def pigment(sky, matte):
    """The pigment over that of facing, at every angle."""
    covers = 1 - (1 - VEIL) * matte / max(matte[ANGLES.index(angle)] for angle in WRITTEN)
    return sky / sky[0] * covers[0] / covers


def weights_of(facing):
    """How much each sun and angle of view counts."""
    angles = np.radians(ANGLES)
    ball = np.sin(angles) * np.cos(angles) + 0.05  # as often as a ball shows it, and all alike
    weights = ball / ball.sum() + 1 / len(angles)
    return weights[None, :] * np.where(facing < math.cos(math.radians(80)), 0.4, 1)[:, None]


def fit(white, suns):
    """(left, exponent, growth, albedo) of one roughness, and what is left without growth."""
    half, facing, kept = geometry()
    weights = weights_of(facing)
    base = GRAY * facing[:, None]
    target = encoded(base + suns)
    found = []
    for exponent, growth in itertools.product(EXPONENTS, GROWTHS):
        grown = 1 + growth * kept[:, None] * (white - 1)[None, :]
        unit = (exponent + 2) / 8 * half**exponent * grown
        for albedo in ALBEDOS:
            wrong = ((encoded(base + albedo * unit) - target) ** 2 * weights).sum() / weights.sum()
            found.append((255 * math.sqrt(wrong), exponent, growth, albedo))
    return min(found), min(one[0] for one in found if one[2] == 0)


def fit_lamps(sky, suns):
    """(left, exponent, metallic, albedo, white) of one roughness, and the brightness on both
    grays."""
    half, facing, kept = geometry()
    weights = weights_of(facing)
    weights /= weights.sum()
    bases = np.array(LAMP_GRAYS)[:, None, None] * facing[:, None]
    target = encoded(bases + suns)
    found = []
    for white in WHITES:
        under = bases + white * (sky - sky[0])[None, :] * facing[:, None]
        for exponent, metallic in itertools.product(EXPONENTS, METALLICS):
            unit = (exponent + 2) / 8 * half**exponent * (1 - metallic * kept)[:, None]
            for albedo in HIGHLIGHTS:
                wrong = ((encoded(under + albedo * unit) - target) ** 2 * weights).sum()
                left = 255 * math.sqrt(wrong / len(bases))
                found.append((left, exponent, metallic, albedo, white))
    best = min(found)
    _, exponent, metallic, albedo, white = best
    unit = (exponent + 2) / 8 * half**exponent * (1 - metallic * kept)[:, None]
    drawn = bases + white * (sky - sky[0])[None, :] * facing[:, None] + albedo * unit
    bright = (encoded(drawn) * weights).sum(axis=(1, 2)) / (target * weights).sum(axis=(1, 2))
    albedo *= 1 - 2 ** (-exponent / 2 - 1)  # POV-Ray's is (exponent + 2) / (8 - 4 / 2^(exponent/2))
    return (best[0], exponent, metallic, albedo, white), bright


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    scene = build(0.5)
    sky = sky_of(scene)
    suns = suns_of(scene)
    mattes = sky_of(build(0.0, 0.8))
    mattes /= mattes[:, :1]
    columns = [ANGLES.index(angle) for angle in WRITTEN]
    for row, roughness in enumerate(ROUGHNESS):
        (left, exponent, growth, albedo), plain = fit(pigment(sky[row], mattes[row]), suns[:, row])
        print(
            f"FIT {roughness:4.2f} exponent {exponent:6.1f} albedo {albedo:.4f} growth {growth:g} "
            f"sky {sky[row][columns].round(3)} matte {mattes[row][columns].round(3)} "
            f"left {left:5.2f}, without growth {plain:5.2f}"
        )
    for row, roughness in enumerate(ROUGHNESS):
        (left, exponent, metallic, albedo, white), bright = fit_lamps(sky[row], suns[:, row])
        print(
            f"LAMP {roughness:4.2f} exponent {exponent:6.1f} albedo {albedo:.4f} "
            f"metallic {metallic:g} white {white:.3f} left {left:5.2f} bright {bright.round(3)}"
        )
    for specular in (0.2, 1.0):
        ratio = sky_of(build(specular)) / sky
        for row, roughness in enumerate(ROUGHNESS):
            print(f"SPECULAR {specular} {roughness:4.2f} {ratio[row][columns].round(2)}")


main()
