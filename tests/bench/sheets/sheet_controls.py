# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of what controls do that no panel shows, with their numbers, for the add-on's pages.

    BLENDER_USER_SCRIPTS=build/release/stage blender -b --factory-startup \\
        --python tests/bench/sheets/sheet_controls.py -- [--sheets moving depth deforming build]
        [--out F] [--write]

moving: a crowd of which some are carried past or stand in the dark, without and with Coarser When
Moving or Dark. depth: false colors of rows of heads, without and with Depth Exaggeration.
deforming: a waving flag in three frames, with each choice of Deforming Objects. build: false
colors of the first and the second picture, with each choice of Build on Render.
"""

import argparse
import math
import resource
import sys
import tempfile
from array import array
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
import blender_scenes as scenes  # noqa: E402

MARGIN = 4
COLORS = ((0.7, 0.12, 0.1), (0.12, 0.3, 0.7), (0.15, 0.5, 0.2), (0.75, 0.6, 0.12))


def head(name, paint, divided=3):
    """A monkey's head of 968 * 4^divided triangles."""
    bpy.ops.mesh.primitive_monkey_add()
    made = bpy.context.object
    made.name = made.data.name = name
    smoother = made.modifiers.new("Subdivision", "SUBSURF")
    smoother.levels = smoother.render_levels = divided
    made.data.materials.append(scenes.matte(name, paint))
    for face in made.data.polygons:
        face.use_smooth = True
    return made


def look(scene, eye, target, lens=50):
    scene.camera.location = eye
    way = [b - a for a, b in zip(eye, target)]
    flat = math.hypot(way[0], way[1])
    turn = (math.atan2(flat, -way[2]), 0, math.atan2(way[1], way[0]) - math.pi / 2)
    scene.camera.rotation_euler, scene.camera.data.lens = turn, lens


def floor(scene, color=(0.5, 0.5, 0.5), sky=(0.02, 0.025, 0.035)):
    dark(scene, sky)
    plane = scenes.mesh(
        "Floor", [(-40, -40, 0), (40, -40, 0), (40, 60, 0), (-40, 60, 0)], [(0, 1, 2, 3)]
    )
    plane.materials.append(scenes.matte("floor", color))
    scenes.link(bpy.data.objects.new("Floor", plane)).lodestone.role = "ENVIRONMENT"


def dark(scene, sky=(0.02, 0.025, 0.035)):
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    node = scene.world.node_tree.nodes["Background"]
    node.inputs["Color"].default_value = (*sky, 1)


def started(folder, width, height):
    scene = scenes.fresh()
    scene.render.engine = "LODESTONE_POVRAY"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(folder / "picture.exr")
    return scene


def saved(folder):
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "controls.blend"))


def used():
    """CPU seconds of Blender and of every POV-Ray that has ended."""
    every = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in every)


def rows_of(image):
    """Linear [[r, g, b, ...]], top row first."""
    width, height = image.size
    pixels = array("f", image.pixels[:])
    return [
        [pixels[4 * (y * width + x) + i] for x in range(width) for i in range(3)]
        for y in reversed(range(height))
    ]


def render(scene):
    """(rows, CPU seconds, what last_render knows)"""
    from lodestone.core.session.addon_session import addon_session

    before = used()
    bpy.ops.render.render(write_still=True)
    took = used() - before
    image = bpy.data.images.load(scene.render.filepath)
    rows = rows_of(image)
    bpy.data.images.remove(image)
    return rows, took, addon_session().renders.get(scene.name)


def beside(cells):
    """One row of a sheet."""
    gap = [1.0] * (3 * MARGIN)
    return [[v for part in parts for v in (*part, *gap)][: -len(gap)] for parts in zip(*cells)]


def write(lines, out):
    from lodestone.core.native import lodestone_native as native

    rows = []
    for line in lines:
        rows += [*line, *([[1.0] * len(line[0])] * MARGIN)]
    rows = rows[:-MARGIN]
    flat = array("f")
    for row in rows:
        for at in range(0, len(row), 3):
            flat.extend((*row[at : at + 3], 1.0))
    native.image_write_png(str(out), native.Image(len(rows[0]) // 3, len(rows), flat))


def moving(folder, out, results):
    """A lamp on the left, the dark on the right; the second row is carried past."""
    scene = started(folder, 400, 225)
    floor(scene, (0.3, 0.3, 0.3), (0.002, 0.002, 0.003))
    heads = [head(f"head {i}", color) for i, color in enumerate(COLORS)]
    number = 0
    for row, y in enumerate((0.0, 3.2, 6.4)):
        for column in range(-2, 3):
            source = heads[number % len(heads)]
            item = source if number < len(heads) else source.copy()
            if item is not source:
                scenes.link(item)
            item.location = (2.6 * column, y, 1.0)
            if row == 1:
                item.keyframe_insert("location", frame=1)
                item.location.x += 3.0
                item.keyframe_insert("location", frame=2)
                for curve in item.animation_data.action.fcurves:
                    for key in curve.keyframe_points:
                        key.interpolation = "LINEAR"
            number += 1
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy = 1500
    scenes.link(bpy.data.objects.new("Lamp", lamp)).location = (-7, -4, 4)
    look(scene, (0, -11.5, 4.2), (0, 2.4, 0.6), 42)
    scene.frame_set(1)
    saved(folder)
    settings = scene.lodestone
    settings.pixel_error_render, settings.antialias = 1.0, "FINAL"
    settings.build_on_render = "ALL"
    cells = []
    for on in (False, True):
        settings.coarser_moving_dark = on
        rows, _, told = render(scene)
        cells.append(rows)
        results.tell(f"- moving {'on' if on else 'off'}: {told.triangles:,} triangles")
    write([beside(cells)], out / "moving.png")


def depth(folder, out, results):
    """Rows of heads that go away from the camera, the second of them in focus."""
    scene = started(folder, 400, 225)
    source = head("head", COLORS[0])
    for row in range(8):
        for column in range(-2, 3):
            item = source if (row, column) == (0, -2) else scenes.link(source.copy())
            item.location = (3.0 * column, 5.0 * row, 1.0)
    scenes.sun()
    look(scene, (0, -11, 6), (0, 8, 0), 35)
    scene.camera.data.dof.focus_distance = 16.0
    scene.lodestone.pixel_error_render = 0.25
    saved(folder)
    bpy.ops.lodestone.update_levels()
    cells = []
    for exaggeration in (1.0, 3.0):
        scene.camera.data.lodestone.depth_exaggeration = exaggeration
        bpy.context.view_layer.update()
        bpy.ops.lodestone.false_color_picture(seen_from="CAMERA", mode="LEVEL")
        cells.append(rows_of(bpy.data.images["Lodestone False Colors"]))
        _, _, told = render(scene)
        results.tell(f"- depth {exaggeration:g}: {told.triangles:,} triangles")
    write([beside(cells)], out / "depth.png")


def deforming(folder, out, results):
    """Frames 1, 9 and 17 of a flag, one line for each choice."""
    scene = started(folder, 240, 160)
    floor(scene)
    scenes.sun(energy=4.0).rotation_euler = (math.radians(40), math.radians(-25), 0)
    side = 180
    points = [
        (3.0 * i / side, 0.0, 1.0 + 2.0 * j / side)
        for j in range(side + 1)
        for i in range(side + 1)
    ]
    faces = [
        (k, k + 1, k + side + 2, k + side + 1)
        for k in (j * (side + 1) + i for j in range(side) for i in range(side))
    ]
    cloth = scenes.mesh("Flag", points, faces)
    cloth.materials.append(scenes.matte("cloth", COLORS[0]))
    flag = scenes.link(bpy.data.objects.new("Flag", cloth))
    flag.rotation_euler = (0, 0, math.radians(12))
    wave = flag.modifiers.new("Wave", "WAVE")
    wave.use_y, wave.height, wave.width, wave.narrowness = False, 0.35, 1.1, 1.4
    wave.use_normal, wave.speed, wave.time_offset = True, 0.12, -60
    for axis in "xyz":
        setattr(wave, f"use_normal_{axis}", axis == "y")
    look(scene, (1.2, -6.5, 2.2), (1.4, 0, 1.9), 50)
    scene.frame_start, scene.frame_end = 1, 24
    saved(folder)
    settings = scene.lodestone
    settings.pixel_error_render, settings.antialias = 2.0, "FINAL"
    settings.build_on_render = "ALL"
    lines = []
    for choice in ("ORIGINAL", "FOLLOW", "FRAME"):
        settings.deforming = choice
        cells, said = [], []
        for frame in (1, 9, 17):
            scene.frame_set(frame)
            rows, took, told = render(scene)
            cells.append(rows)
            said.append(f"{told.triangles:,} triangles, {took:.1f} CPU s")
        lines.append(beside(cells))
        results.tell(f"- deforming {choice}: {'; '.join(said)}")
    write(lines, out / "deforming.png")


def build(folder, out, results):
    """First and second picture, a line for each choice."""
    from lodestone.operators import false_color_picture

    lines = []
    for choice in ("NONE", "HELPFUL", "ALL"):
        scene = started(folder, 300, 170)
        dark(scene)  # a floor has the gray of originals
        scenes.sun(energy=3.0).rotation_euler = (math.radians(35), math.radians(-30), 0)
        number = 0
        for y in (0, 5, 12, 24):
            for column in range(-2, 3):
                divided = 3 if number % 4 == 1 else 1
                item = head(f"head {number}", COLORS[number % 4], divided)
                item.data.vertices[0].co.x += 1e-3 * number  # each a mesh of its own
                item.location = (3.2 * column * (1 + y / 20), y, 1.0)
                number += 1
        look(scene, (0, -10, 5.0), (0, 5, 0.4), 40)
        saved(folder / choice)
        settings = scene.lodestone
        settings.pixel_error_render, settings.antialias = 1.0, "FINAL"
        settings.build_on_render = choice
        cells = []
        for picture in ("first", "second"):
            _, took, told = render(scene)
            bpy.ops.lodestone.false_color_picture(mode="LEVEL")
            shown = bpy.data.images[false_color_picture.NAME]
            cells.append(rows_of(shown))
            results.tell(
                f"- build {choice}, {picture}: {took:.1f} CPU s, {told.triangles:,} triangles, "
                f"{told.without_levels} without levels"
            )
        lines.append(beside(cells))
    write(lines, out / "build_on_render.png")


SHEETS = {"moving": moving, "depth": depth, "deforming": deforming, "build": build}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sheets", nargs="+", default=list(SHEETS), choices=list(SHEETS))
    parser.add_argument("--out", type=Path, default=Path.cwd())
    benching.add_write(parser, "blender_addon")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    results, busy = benching.Told(), benching.load()
    for name in options.sheets:
        with tempfile.TemporaryDirectory() as made:
            folder = Path(made)
            for choice in ("NONE", "HELPFUL", "ALL"):
                (folder / choice).mkdir()
            SHEETS[name](folder, options.out, results)
    page = benching.results_path(options, "controls")
    data = {"load_before": busy, "lines": list(results)}
    benching.write_results(page, "What controls change", results, data)


if __name__ == "__main__":
    main()
