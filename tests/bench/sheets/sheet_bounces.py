# SPDX-License-Identifier: GPL-3.0-or-later
"""Indirect light beside Cycles with as many diffuse bounces: pictures, differences and seconds.

    BLENDER_USER_SCRIPTS=build/release/stage blender -b --factory-startup \\
        --python tests/bench/sheets/sheet_bounces.py -- [--bounces 3] [--scenes cornell room street]
        [--size 320 180] [--samples 256] [--errors 1] [--png OUT] [--write]

A Cornell box, a room behind a window (sun and sky), a street. From left to right: Cycles, Lodestone
with direct light alone, with bounces, four times the difference of the latter to Cycles.
"""

import argparse
import math
import sys
import tempfile
import time
from array import array
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
import blender_scenes as scenes  # noqa: E402

SHOWN = 4
MARGIN = 4


def block(name, low, high, material, bevel=None):
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    points = [[a + t * (b - a) for a, b, t in zip(low, high, corner)] for corner in corners]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    data = scenes.mesh(name, points, faces)
    data.materials.append(material)
    return scenes.link(bpy.data.objects.new(name, data))


def ball(name, middle, radius, material):
    data = scenes.bumpy_mesh(name, 5)
    data.materials.append(material)
    data.polygons.foreach_set("use_smooth", [True] * len(data.polygons))
    made = scenes.link(bpy.data.objects.new(name, data))
    made.location, made.scale = middle, (radius,) * 3
    return made


def look(scene, eye, target, lens):
    camera = scene.camera
    camera.location = eye
    way = [b - a for a, b in zip(eye, target)]
    flat = math.hypot(way[0], way[1])
    camera.rotation_euler = (math.atan2(flat, -way[2]), 0, math.atan2(way[1], way[0]) - math.pi / 2)
    camera.data.lens = lens


def light(kind, power, place=(0, 0, 0), turn=(0, 0, 0), **values):
    data = bpy.data.lights.new(kind, kind)
    data.energy = power
    for name, value in values.items():
        setattr(data, name, value)
    made = scenes.link(bpy.data.objects.new(kind, data))
    made.location, made.rotation_euler = place, turn


def world(scene, color):
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    node = scene.world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value = (*color, 1)


def cornell(scene):
    white, red, green = (
        scenes.matte(name, color)
        for name, color in (
            ("white", (0.73, 0.73, 0.73)),
            ("red", (0.65, 0.05, 0.05)),
            ("green", (0.12, 0.45, 0.15)),
        )
    )
    for name, low, high, material in (
        ("floor", (-1, -1, -0.1), (1, 1, 0), white),
        ("ceiling", (-1, -1, 2), (1, 1, 2.1), white),
        ("back", (-1, 1, -0.1), (1, 1.1, 2.1), white),
        ("left", (-1.1, -1, -0.1), (-1, 1.1, 2.1), red),
        ("right", (1, -1, -0.1), (1.1, 1.1, 2.1), green),
    ):
        block(name, low, high, material)
    tall = block("tall", (-0.3, -0.3, 0), (0.3, 0.3, 1.2), white)
    tall.location, tall.rotation_euler = (-0.35, 0.35, 0), (0, 0, 0.3)
    ball("ball", (0.4, -0.3, 0.38), 0.35, white)
    light("AREA", 40, (0, 0, 1.98), size=0.5)
    scene.world = None
    look(scene, (0, -3.6, 1.0), (0, 0, 1.0), 40)


def room(scene):
    wall = scenes.matte("wall", (0.75, 0.72, 0.68))
    wood = scenes.matte("wood", (0.4, 0.25, 0.12))
    blue = scenes.matte("blue", (0.1, 0.2, 0.5))
    for name, low, high, material in (
        ("floor", (-3.1, -3.1, -0.2), (3.1, 3.1, 0), wood),
        ("ceiling", (-3.1, -3.1, 2.8), (3.1, 3.1, 3), wall),
        ("left", (-3.2, -3, -0.2), (-3, 3, 3), wall),
        ("back", (-3.2, 3, -0.2), (3.2, 3.2, 3), wall),
        ("front", (-3.2, -3.2, -0.2), (3.2, -3, 3), wall),
        ("right below", (3, -3, -0.2), (3.2, 3, 0.9), wall),
        ("right above", (3, -3, 2.3), (3.2, 3, 3), wall),
        ("right near", (3, -3, 0.9), (3.2, -0.2, 2.3), wall),
        ("right far", (3, 1.8, 0.9), (3.2, 3, 2.3), wall),
        ("table", (-1.2, 0.4, 0.7), (0.6, 1.4, 0.76), wood),
        ("cupboard", (-2.9, 1.6, 0), (-2.2, 2.9, 1.9), blue),
    ):
        block(name, low, high, material)
    for x in (-1.15, 0.5):
        for y in (0.45, 1.3):
            block("leg", (x, y, 0), (x + 0.06, y + 0.06, 0.7), wood)
    ball("ball", (-0.3, 0.9, 1.02), 0.25, wall)
    light("SUN", 12, turn=(0, math.radians(55), math.radians(-10)), angle=math.radians(0.5))
    world(scene, (0.5, 0.6, 0.8))
    look(scene, (1.2, -2.7, 1.6), (-0.6, 1.5, 1.1), 24)


def street(scene):
    asphalt = scenes.matte("asphalt", (0.2, 0.2, 0.2))
    paints = [
        scenes.matte(f"paint {i}", color)
        for i, color in enumerate(
            ((0.7, 0.6, 0.45), (0.6, 0.3, 0.2), (0.75, 0.75, 0.7), (0.5, 0.55, 0.6))
        )
    ]
    block("ground", (-40, -20, -0.2), (40, 120, 0), asphalt)
    for side in (-1, 1):
        for number in range(6):
            y, high = 12 * number - 4, 8 + 3 * ((number * 7 + side) % 4)
            x = sorted((side * 6, side * 16))
            paint = paints[(number + side) % 4]
            block("house", (x[0], y, 0), (x[1], y + 11.5, high), paint)
            for storey in range(int(high // 3)):
                z = 3 * storey + 1
                balcony = sorted((side * 5, side * 6))
                block("balcony", (balcony[0], y + 3, z + 2), (balcony[1], y + 8, z + 2.2), paint)
    for number in range(5):
        ball("tree", (-4.2, 6 + 9 * number, 2.6), 1.3, scenes.matte("leaf", (0.1, 0.3, 0.05)))
        block("trunk", (-4.3, 5.9 + 9 * number, 0), (-4.1, 6.1 + 9 * number, 2), paints[1])
    light("SUN", 4, turn=(math.radians(40), math.radians(35), 0), angle=math.radians(0.5))
    world(scene, (0.45, 0.6, 0.9))
    look(scene, (1.5, -6, 1.8), (-0.5, 20, 4), 24)


SCENES = {"cornell": cornell, "room": room, "street": street}


def encoded(value):
    value = min(1.0, max(0.0, value))
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def decoded(value):
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def render(scene, engine, folder):
    """(display values RGB, top row first; seconds of the clock)."""
    scene.render.engine = engine
    scene.render.filepath = str(folder / f"{engine}.exr")
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    wall = time.perf_counter() - start
    image = bpy.data.images.load(scene.render.filepath)
    width, height = image.size
    pixels = list(image.pixels)
    bpy.data.images.remove(image)
    rows = [
        [encoded(pixels[4 * (y * width + x) + i]) for x in range(width) for i in range(3)]
        for y in reversed(range(height))
    ]
    return rows, wall


def mean(rows, others, change=abs):
    found = [change(a - b) for row, other in zip(rows, others) for a, b in zip(row, other)]
    return 255 * sum(found) / len(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bounces", type=int, nargs="+", default=[3])
    parser.add_argument("--scenes", nargs="+", default=list(SCENES), choices=list(SCENES))
    parser.add_argument("--size", type=int, nargs=2, default=[320, 180])
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--errors", type=float, nargs="+", default=[1.0], help="Pixel Errors")
    parser.add_argument("--png", type=Path)
    benching.add_write(parser, "povray_export")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    sheet = []
    told, busy = benching.Told(), benching.load()
    told.tell(
        "| scene | bounces | Pixel Error | direct: mean | with: mean, brighter by "
        "| s: Cycles, direct, with |\n|" + "---|" * 6
    )
    for name in options.scenes:
        with tempfile.TemporaryDirectory() as made:
            folder = Path(made)
            scene = scenes.fresh()
            SCENES[name](scene)
            bpy.ops.wm.save_as_mainfile(filepath=str(folder / "file.blend"))
            scene.render.resolution_x, scene.render.resolution_y = options.size
            scene.render.image_settings.file_format = "OPEN_EXR"
            cycles = scene.cycles
            cycles.device, cycles.samples = "CPU", options.samples
            cycles.use_denoising = cycles.use_adaptive_sampling = False
            cycles.sample_clamp_indirect = 0.0
            cycles.pixel_filter_type, scene.render.filter_size = "BOX", 0.01
            cycles.glossy_bounces = cycles.transmission_bounces = 0
            for bounces in options.bounces:
                cycles.max_bounces = cycles.diffuse_bounces = bounces
                theirs, cycles_s = render(scene, "CYCLES", folder)
                for error in options.errors:
                    settings = scene.lodestone
                    settings.pixel_error_render = error
                    settings.own_bounces = -1
                    direct, direct_s = render(scene, "LODESTONE_POVRAY", folder)
                    settings.own_bounces = bounces
                    ours, ours_s = render(scene, "LODESTONE_POVRAY", folder)
                    told.tell(
                        f"| {name} | {bounces} | {error:g} | {mean(direct, theirs):.1f} | "
                        f"{mean(ours, theirs):.1f}, {mean(ours, theirs, float):+.1f} | "
                        f"{cycles_s:.1f}, {direct_s:.1f}, {ours_s:.1f} |"
                    )
                    off = [
                        [min(1.0, SHOWN * abs(a - b)) for a, b in zip(row, other)]
                        for row, other in zip(ours, theirs)
                    ]
                    gap = [1.0] * (3 * MARGIN)
                    for parts in zip(theirs, direct, ours, off):
                        row = [value for part in parts for value in (*part, *gap)]
                        sheet.append(row[: -len(gap)])
                    sheet += [[1.0] * len(sheet[-1])] * MARGIN
    page = benching.results_path(options, "bounces")
    data = {"load_before": busy, "lines": list(told)}
    benching.write_results(page, "Indirect light beside Cycles", told, data)
    if options.png:
        from lodestone.core.native import lodestone_native as native

        rows = sheet[:-MARGIN]
        flat = array("f")
        for row in rows:
            for at in range(0, len(row), 3):
                flat.extend([decoded(value) for value in row[at : at + 3]] + [1.0])
        width = len(rows[0]) // 3
        native.image_write_png(str(options.png), native.Image(width, len(rows), flat))


if __name__ == "__main__":
    main()
