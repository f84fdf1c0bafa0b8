# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of bench_first_picture.py inside Blender: presses F12 and says what each picture took,
and Update Levels, for all levels at once, from none.

blender -b --factory-startup FILE --addons lodestone --python THIS -- COPY JSON
    WIDTH HEIGHT CAMERA PICTURE...
"""

import json
import resource
import sys
import time
from pathlib import Path

import bpy
from lodestone.core.session.addon_session import addon_session

PICTURES = (  # name, Pixel Error, Build on Render
    ("full", 0.0, "NONE"),
    ("first", 1.0, "HELPFUL"),
    ("second", 1.0, "HELPFUL"),
    ("third", 1.0, "HELPFUL"),
    ("whole", 1.0, None),  # Update Levels
    ("after", 1.0, "NONE"),
)


def cpu_seconds():
    """User and system, of Blender and of every POV-Ray that has ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def main():
    copy, report, width, height, camera, *wanted = sys.argv[sys.argv.index("--") + 1 :]
    bpy.ops.wm.save_as_mainfile(filepath=copy)  # so that no levels lie beside it
    scene = bpy.context.scene
    scene.render.engine = "LODESTONE_POVRAY"
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.render.resolution_percentage = 100
    scene.camera = scene.objects.get(camera or "far", scene.camera)
    # What only the first picture of a session pays for, such as loading the library, is no part
    scene.lodestone.pixel_error_render = 0.0
    bpy.ops.render.render()
    found = {}
    for name, pixel_error, build in PICTURES:
        if name not in wanted:
            continue
        scene.lodestone.pixel_error_render = pixel_error
        if build is None:
            bpy.ops.lodestone.clear_levels()
            press = bpy.ops.lodestone.update_levels
        else:
            scene.lodestone.build_on_render = build
            press = bpy.ops.render.render
        wall, cpu = time.perf_counter(), cpu_seconds()
        press()
        found[name] = {"cpu_s": cpu_seconds() - cpu, "wall_s": time.perf_counter() - wall}
        drawn = addon_session().renders.get(scene.name) if build is not None else None
        found[name]["triangles"] = drawn.triangles if drawn else None
    Path(report).write_text(json.dumps(found), "utf-8")


main()
