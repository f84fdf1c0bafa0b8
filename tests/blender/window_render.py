# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): F12 with a POV-Ray that never ends, until Esc."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402

FOLDER = Path(sys.argv[-1])


def renders():
    return bpy.app.is_job_running("RENDER")


def has_ended():
    return not renders()


def escape_stops_the_render():
    scene = scenes.fresh()
    scenes.cube()
    scene.render.engine = "LODESTONE_POVRAY"
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "render.blend"))
    with steps.window():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from steps.wait_until(renders)
    yield from steps.wait_until(has_ended)  # the test outside presses Esc
    left = sorted(path.name for path in (FOLDER / "lodestone").iterdir())
    assert left == ["render"], left  # the levels; no scene files


steps.run((escape_stops_the_render,))
