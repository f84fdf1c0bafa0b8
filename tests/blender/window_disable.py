# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): the add-on is disabled while it renders with a
POV-Ray that never ends, and while it reads the scene."""

import sys
from pathlib import Path

import addon_utils
import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402

FOLDER = Path(sys.argv[-1])


def renders():
    return bpy.app.is_job_running("RENDER")


def has_ended():
    return not renders()


def povray_runs():
    return any(FOLDER.glob("lodestone/disable.scene-*/scene.ini"))


def fresh():
    scene = scenes.fresh()
    scenes.cube()
    scene.render.engine = "LODESTONE_POVRAY"
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "disable.blend"))
    return scene


def disabling_ends_a_render():
    fresh()
    with steps.window():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from steps.wait_until(povray_runs)
    addon_utils.disable("lodestone")
    yield from steps.wait_until(has_ended)
    yield
    assert not povray_runs()


def it_renders_when_it_is_enabled_in_between():
    fresh()
    with steps.window():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from steps.wait_until(povray_runs)
    addon_utils.disable("lodestone")
    addon_utils.enable("lodestone")
    assert renders()
    addon_utils.disable("lodestone")
    yield from steps.wait_until(has_ended)


def disabling_ends_reading_and_leaves_the_scene_as_it_was():
    scene = fresh()
    before = (len(bpy.data.objects), scene.render.use_compositing)
    with steps.window():
        bpy.ops.lodestone.update_levels("INVOKE_DEFAULT")
    assert scene.render.engine == "LODESTONE_EXTRACT"
    addon_utils.disable("lodestone")
    yield from steps.wait_until(has_ended)

    def is_put_back():
        return scene.render.engine != "LODESTONE_EXTRACT"

    yield from steps.wait_until(is_put_back)
    assert (len(bpy.data.objects), scene.render.use_compositing) == before


steps.run(
    (
        disabling_ends_a_render,
        it_renders_when_it_is_enabled_in_between,
        disabling_ends_reading_and_leaves_the_scene_as_it_was,
    )
)
