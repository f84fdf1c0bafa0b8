# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits POV-Ray's finish to Cycles' principled surfaces.

povray_export/texture/surface_finish.cpp holds the result.

    blender -b --factory-startup --python tests/bench/peers/fit_finish.py -- FOLDER

Renders spheres of every roughness in Cycles (direct light only) under three suns and in a uniform
sky, and in POV-Ray a set of spheres with one highlight or one diffuse term each. Light adds up, so
a finish is a weighted sum of these: weights and exponents are those with the least squared
difference of the display-encoded pictures. Prints one row per roughness: the parameters, and the
root mean square that is left under the suns, in 255ths. Takes about 5 minutes; needs numpy.
"""

import math
import subprocess
import sys
from pathlib import Path

import bpy
import mathutils
import numpy as np

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])
CELL = 24  # pixels a sphere's cell is wide
ROUGHNESS = [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
COAT = [0.0, 0.03, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0]
# Angles between the directions to the eye and to the sun.
SUNS = [math.radians(angle) for angle in (15, 55, 100)]
EXPONENTS = [round(1.3**i, 2) for i in range(1, 45)]
BRILLIANCE = [0.6, 0.8, 0.9, 1.0, 1.1, 1.3, 1.7, 2.2, 3.0]
POWER = math.pi  # of a sun: a facing white surface shows 1


def sun_direction(angle):
    """To the sun; the eye is at +Z."""
    return (math.sin(angle) * 0.8, math.sin(angle) * 0.6, math.cos(angle))


# ---- Cycles ----


def cycles_materials():
    """(kind, roughness, changed inputs)"""
    black = {"Base Color": (0, 0, 0, 1), "Specular": 0.0}
    for roughness in ROUGHNESS:
        yield "diffuse", roughness, {"Base Color": (0.8, 0.8, 0.8, 1), "Specular": 0.0}
    for roughness in ROUGHNESS:
        yield "specular", roughness, {**black, "Specular": 0.5}
    for roughness in ROUGHNESS:
        yield "metal", roughness, {"Base Color": (0.9, 0.5, 0.1, 1), "Metallic": 1.0}
    for roughness in COAT:
        yield "coat", roughness, {**black, "Clearcoat": 1.0, "Clearcoat Roughness": roughness}


def build_cycles():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = False
    scene.cycles.samples = 256
    scene.cycles.seed = 1
    scene.cycles.max_bounces = 0
    scene.cycles.sample_clamp_direct = 0
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    materials = list(cycles_materials())
    scene.render.resolution_x, scene.render.resolution_y = CELL * len(materials), CELL
    scene.cycles.pixel_filter_type = "BOX"
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 2 * len(materials)
    camera.location = (0, 0, 10)
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.ops.mesh.primitive_uv_sphere_add(segments=192, ring_count=96, radius=0.95)
    ball = bpy.context.object.data
    bpy.ops.object.shade_smooth()
    bpy.data.objects.remove(bpy.context.object)
    for i, (_, roughness, inputs) in enumerate(materials):
        made = bpy.data.objects.new("Ball", ball.copy())
        made.location = (2 * i - len(materials) + 1, 0, 0)
        scene.collection.objects.link(made)
        material = bpy.data.materials.new("M")
        material.use_nodes = True
        node = material.node_tree.nodes["Principled BSDF"]
        node.inputs["Roughness"].default_value = roughness
        for name, value in inputs.items():
            node.inputs[name].default_value = value
        made.data.materials.append(material)
    return scene, materials


def pixels_of(path, width):
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(4 * width * CELL, dtype=np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(CELL, width, 4)[::-1, :, :3].astype(float)


def render_cycles():
    """light: array [row][column][3]; the last light is the sky."""
    scene, materials = build_cycles()
    lamp = bpy.data.lights.new("Sun", "SUN")
    lamp.energy = POWER
    lamp.angle = 0.00918
    lamp_object = bpy.data.objects.new("Sun", lamp)
    scene.collection.objects.link(lamp_object)
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    pictures = []
    for light in [*SUNS, None]:
        if light is None:
            lamp.energy = 0
            background.inputs["Color"].default_value = (1, 1, 1, 1)
            scene.cycles.max_bounces = 1
        else:
            background.inputs["Color"].default_value = (0, 0, 0, 1)
            direction = mathutils.Vector(sun_direction(light))
            lamp_object.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()
        scene.render.filepath = str(FOLDER / f"cycles_{len(pictures)}.exr")
        bpy.ops.render.render(write_still=True)
        pictures.append(pixels_of(scene.render.filepath, CELL * len(materials)))
    return materials, pictures


# ---- POV-Ray ----


def basis():
    for value in BRILLIANCE:
        yield "diffuse", value, "diffuse 1 brilliance %g" % value
    for value in EXPONENTS:
        yield "specular", value, "specular albedo 1 roughness %.9g" % (1 / value)
    for value in EXPONENTS:
        yield "phong", value, "phong albedo 1 phong_size %g" % value
    for value in BRILLIANCE:
        yield "metal_diffuse", value, "diffuse 1 brilliance %g" % value
    for value in EXPONENTS:
        yield "metal", value, "specular albedo 1 roughness %.9g metallic 1" % (1 / value)
    for value in EXPONENTS:
        yield "metal_phong", value, "phong albedo 1 phong_size %g metallic 1" % value


def render_povray():
    terms = list(basis())
    pictures = []
    for light in SUNS:
        text = "#version 3.7; global_settings{assumed_gamma 1 ambient_light 0}\n"
        text += (
            f"camera{{orthographic location <0,0,10> direction <0,0,-1> "
            f"right <{2 * len(terms)},0,0> up <0,2,0>}}\n"
        )
        x, y, z = (1e5 * value for value in sun_direction(light))
        text += f"light_source{{<{x},{y},{z}> rgb 1 parallel point_at 0}}\n"
        for i, (kind, _, finish) in enumerate(terms):
            color = ".9,.5,.1" if kind.startswith("metal") else "1,1,1"
            text += (
                f"sphere{{<{2 * i - len(terms) + 1},0,0>,.95 pigment{{rgb <{color}>}} "
                f"finish{{ambient 0 diffuse 0 {finish}}}}}\n"
            )
        name = FOLDER / f"povray_{len(pictures)}"
        name.with_suffix(".pov").write_text(text)
        command = ["povray", f"+I{name.name}.pov", f"+O{name.name}.exr", "+FE", "-D", "+A0.0"]
        command += ["+AM1", "+R4", "-J", f"+W{CELL * len(terms)}", f"+H{CELL}"]
        subprocess.run(command, cwd=FOLDER, check=True, capture_output=True)
        pictures.append(pixels_of(name.with_suffix(".exr"), CELL * len(terms)))
    return terms, pictures


# ---- Fitting ----


def cell(pictures, i):
    return np.stack([picture[:, CELL * i : CELL * (i + 1)] for picture in pictures])


def encoded(color):
    color = np.clip(color, 0, 1)
    return np.where(color <= 0.0031308, 12.92 * color, 1.055 * np.power(color, 1 / 2.4) - 0.055)


def left(target, color):
    return 255 * math.sqrt(np.mean((encoded(target) - encoded(color)) ** 2))


def best_weight(target, term):
    return best_weight_beside(target, term, 0.0)


def best_weight_beside(target, term, others, rounds=16):
    """The weight of a term with the least left: golden section from the linear one's scale."""
    low, high = 0.0, 4 * max(float(np.sum(target * term) / max(np.sum(term * term), 1e-12)), 1e-4)
    ratio = (math.sqrt(5) - 1) / 2
    for _ in range(rounds):
        a, b = high - ratio * (high - low), low + ratio * (high - low)
        if left(target, others + a * term) < left(target, others + b * term):
            high = b
        else:
            low = a
    return (low + high) / 2


def fit(target, terms, pictures, kind):
    """(left, parameter, weight) of the best single term of this kind."""
    found = []
    for i, (at, value, _) in enumerate(terms):
        if at == kind:
            term = cell(pictures, i)
            weight = best_weight(target, term)
            found.append((left(target, weight * term), value, weight))
    return min(found)


def fit_pair(target, terms, pictures, kinds):
    """The same for the best sum of two terms: (left, parameters, weights)."""
    found = []
    first = [i for i, term in enumerate(terms) if term[0] == kinds[0]]
    second = [i for i, term in enumerate(terms) if term[0] == kinds[1]]
    for i in first:
        a = cell(pictures, i)
        for j in second:
            b = cell(pictures, j)
            weights = [0.0, 0.0]
            for _ in range(3):  # by turns; the two hardly overlap
                weights[1] = best_weight_beside(target, b, weights[0] * a)
                weights[0] = best_weight_beside(target, a, weights[1] * b)
            rest = left(target, weights[0] * a + weights[1] * b)
            found.append((rest, (terms[i][1], terms[j][1]), weights))
    return min(found)


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    materials, cycles = render_cycles()
    terms, povray = render_povray()
    disc = np.hypot(*np.meshgrid(*2 * [(np.arange(CELL) + 0.5) / CELL * 2 - 1])) < 0.85
    singles = {
        "diffuse": ["diffuse"],
        "specular": ["specular"],
        "metal": ["metal"],
        "coat": ["specular", "phong"],
    }
    pairs = {"metal": ["metal_diffuse", "metal"]}
    for i, (kind, roughness, _) in enumerate(materials):
        target = cell(cycles[:-1], i)
        sky = cell(cycles[-1:], i)[0][disc].mean(axis=0)
        facing = cell(cycles[-1:], i)[0][CELL // 2, CELL // 2]
        head = f"FIT {kind:9}{roughness:5.2f}"
        print(f"{head} sky {sky.round(4)} facing {facing.round(4)}")
        for term in singles[kind]:
            rest, value, weight = fit(target, terms, povray, term)
            print(f"{head} {term:10} {value:9.2f} weight {weight:8.5f} left {rest:6.2f}")
        if kind == "diffuse":
            plain = next(j for j, t in enumerate(terms) if t[:2] == ("diffuse", 1.0))
            print(f"{head} plain left {left(target, 0.8 * cell(povray, plain)):6.2f}")
        if kind in pairs:
            rest, values, weights = fit_pair(target, terms, povray, pairs[kind])
            print(
                f"{head} {'+'.join(pairs[kind])} {values} "
                f"weights {weights[0]:.5f} {weights[1]:.5f} left {rest:6.2f}"
            )


main()
