# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): F12 with a POV-Ray that draws a rectangle and never
ends, until Esc. What is drawn stays."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402
from lodestone.core.native import lodestone_native as native  # noqa: E402

FOLDER = Path(sys.argv[-1])


def renders():
    return bpy.app.is_job_running("RENDER")


def has_ended():
    return not renders()


def pixel_of_the_result(x, y):
    """The linear RGBA of a pixel, y from the lowest row."""
    scene, path = bpy.context.scene, str(FOLDER / "result.exr")
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    bpy.data.images["Render Result"].save_render(path, scene=scene)
    image = native.image_read(path, bottom_up=True)
    start = 4 * (image.width * y + x)
    return list(image.pixels[start : start + 4])


def escape_stops_the_render():
    scene = scenes.fresh()
    scenes.cube()
    scene.render.engine = "LODESTONE_POVRAY"
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "render.blend"))
    with steps.window():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from steps.wait_until(renders)
    yield from steps.wait_until(has_ended)  # the test outside presses Esc
    assert pixel_of_the_result(0, 35) == [0.0, 0.5, 0.0, 1.0]
    assert pixel_of_the_result(63, 0) == [0.0, 0.0, 0.0, 0.0]
    levels, files = sorted((FOLDER / "lodestone").iterdir())  # the files wait for the next F12
    assert levels.name == "render" and files.name.startswith("render.scene-"), (levels, files)
    assert (files / "scene.pov").is_file()
    assert not list(files.glob("part-*")), list(files.iterdir())


def another_file_needs_none_of_the_old_ones():
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield
    left = sorted(path.name for path in (FOLDER / "lodestone").iterdir())
    assert left == ["render"], left  # the levels


steps.run((escape_stops_the_render, another_file_needs_none_of_the_old_ones))
