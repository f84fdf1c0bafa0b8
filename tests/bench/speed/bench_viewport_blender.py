# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of bench_viewport.py inside Blender: one way of drawing, one report."""

import json
import math
import os
import sys
import time
import traceback

import addon_utils
import bpy
from mathutils import Matrix

KIND, CAMERA, OUT, PICTURE = sys.argv[sys.argv.index("--") + 1 :][:4]
SHADING = {"levels": "RENDERED", "solid": "SOLID", "material": "MATERIAL"}[KIND.split()[0]]
STEPS = 5


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def viewport():
    window = bpy.context.window_manager.windows[0]
    area = max(window.screen.areas, key=lambda area: area.width * area.height)
    return window, area


def redraw(times=1):
    window, area = viewport()
    region = next(item for item in area.regions if item.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.wm.redraw_timer(type="DRAW_WIN", iterations=times)


def turn(degrees):
    _, area = viewport()
    place = bpy.data.objects[CAMERA].matrix_world @ Matrix.Rotation(math.radians(degrees), 4, "Y")
    area.spaces.active.region_3d.view_matrix = place.inverted()


def steps():
    window, area = viewport()
    area.type = "TEXT_EDITOR"  # nothing of the scene is drawn yet
    for item in window.screen.areas:
        if item.type == "VIEW_3D":
            item.type = "TEXT_EDITOR"
    yield
    bpy.context.scene.render.engine = "LODESTONE_POVRAY"
    redraw()
    yield
    before = resident()
    cpu, start = time.process_time(), time.monotonic()
    area.type = "VIEW_3D"
    space = area.spaces.active
    space.overlay.show_overlays = "overlays" in KIND
    space.region_3d.view_perspective = "PERSP"
    space.lens = bpy.data.objects[CAMERA].data.lens
    space.shading.type = SHADING
    turn(0.0)
    redraw()
    if SHADING == "RENDERED":
        from lodestone.viewport import levels_preview

        while True:
            yield
            state = levels_preview.state_of(area)
            if (
                state
                and state.view.shown
                and state.view.shown.final
                and not levels_preview._busy(state)
            ):
                break
        print(
            state.view.line(),
            state.batches,
            "batches",
            levels_preview.preview().pool.bytes,
            flush=True,
        )
    found = {
        "first_s": time.monotonic() - start,
        "first_cpu_s": time.process_time() - cpu,
        "memory": resident() - before,
    }
    redraw()
    cpu = time.process_time()
    for step in range(STEPS):
        turn(0.5 * step)
        redraw()
    found["redraw_cpu_s"] = (time.process_time() - cpu) / STEPS
    turn(0.0)
    for _ in range(20):
        yield
    redraw()
    if PICTURE:
        with bpy.context.temp_override(window=window, area=area):
            bpy.ops.screen.screenshot_area(filepath=PICTURE)
    with open(OUT, "w", encoding="utf-8") as file:
        json.dump(found, file)


addon_utils.enable("lodestone", default_set=True)
_steps = steps()


def tick():
    try:
        next(_steps)
    except StopIteration:
        sys.stdout.flush()
        os._exit(0)
    except BaseException:
        traceback.print_exc()
        sys.stdout.flush()
        os._exit(1)
    return 0.02


bpy.app.timers.register(tick, first_interval=1.0, persistent=True)
