# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): a render begins while a panel is drawn."""

import sys
import threading
import time
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402

LONGER_S = 2 * (0.02, 0.05, 0.1, 0.2, 0.3)  # a call of the engine lies otherwise beside each
_begins = threading.Event()  # the render calls its handlers, and the engine next


class TEST_PT_slow(bpy.types.Panel):
    """Drawn until the render begins and a little longer."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_label = "Slow"
    waits = False
    longer_s = 0.0
    amid = 0  # how often the render began amid it

    def draw(self, context):
        kind = type(self)
        if not kind.waits:
            return
        kind.waits = False
        end = time.perf_counter() + 2.0
        while not _begins.is_set():
            if time.perf_counter() > end:
                return
        kind.amid += 1
        end = time.perf_counter() + kind.longer_s
        while time.perf_counter() < end:
            pass


def writing_is_allowed_after_a_render_that_began_amid_a_panel():
    scene = scenes.fresh()
    yield
    scene.render.engine = "LODESTONE_POVRAY"
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scenes.sun()
    scenes.cube()
    bpy.utils.register_class(TEST_PT_slow)
    bpy.app.handlers.render_pre.insert(0, lambda *_: _begins.set())
    first = bpy.context.window_manager.windows[0]
    shown = next(area for area in first.screen.areas if area.type == "PROPERTIES")
    shown.spaces[0].context = "RENDER"
    yield
    usual = sys.getswitchinterval()

    def ended():
        return not bpy.app.is_job_running("RENDER")

    for longer_s in LONGER_S:
        _begins.clear()
        TEST_PT_slow.longer_s = longer_s
        TEST_PT_slow.waits = True
        with steps.window():
            bpy.ops.render.render("INVOKE_DEFAULT")
        shown.tag_redraw()
        yield
        yield from steps.wait_until(ended)
        yield from steps.wait_until(steps.takes_operators)
        assert sys.getswitchinterval() == usual
    assert TEST_PT_slow.amid > 0


steps.run([writing_is_allowed_after_a_render_that_began_amid_a_panel])
