# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): Auto-Structure, its numbers, OK, undo, Esc."""

import math
import sys
from pathlib import Path

import bmesh
import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import blender_test_auto_structure as auto  # noqa: E402
import window_steps as steps  # noqa: E402

FOLDER = Path(sys.argv[-1])


def make(subdivisions=3):
    scene = scenes.fresh()
    scene.camera.location = (50, 50, 900)
    scene.camera.data.clip_end = 2000
    bpy.data.collections.remove(auto.flat())
    for item in list(bpy.data.objects):
        if item.type == "MESH":
            bpy.data.objects.remove(item)
    yard = auto.flat()
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=subdivisions, radius=0.7)
    for vertex in ball.verts:  # a ball itself would be an ellipsoid at once
        vertex.co *= 1 + 0.1 * math.sin(9 * vertex.co.z) * math.cos(7 * vertex.co.x)
    ball.to_mesh(yard.objects[0].data)  # which all share
    ball.free()
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "yard.blend"))
    layer = bpy.context.view_layer.layer_collection
    bpy.context.view_layer.active_layer_collection = layer.children[yard.name]
    with steps.window():
        bpy.ops.ed.undo_push(message="Made")


def running():
    from lodestone.operators import window_run

    return window_run.current()


def is_idle():
    return running() is None and not bpy.app.is_job_running("RENDER")


def asks():
    return running() is not None and running().preview is not None


def measures():
    return running() is not None and running()._thread is not None


def made():
    return [item.name for item in bpy.data.collections if " Group" in item.name]


def start():
    with steps.window():
        assert bpy.ops.lodestone.auto_structure.poll()
        outcome = bpy.ops.lodestone.auto_structure("INVOKE_DEFAULT")
        assert outcome == {"RUNNING_MODAL"}, outcome
        assert not bpy.ops.lodestone.auto_structure.poll(), "a second one must wait"


def ok_makes_collections_and_the_store_stays():
    make()
    start()
    yield from steps.wait_until(asks)
    preview = running().preview
    assert 0 < preview.bytes_after < preview.bytes_before, preview
    assert len(preview.lines()) == 3, preview.lines()
    assert not made(), made()
    for _ in range(20):  # until the dialog is drawn
        yield
    with steps.window():
        bpy.ops.screen.screenshot(filepath=str(FOLDER / "auto_structure.png"))
    steps.press("RET")
    yield from steps.wait_until(is_idle, 20)
    assert len(made()) == preview.groups, (made(), preview)
    assert not list((FOLDER / "lodestone").glob("*/tileset.json")), "measuring wrote levels"


def one_undo_takes_it_back():
    with steps.window():
        bpy.ops.ed.undo()
    yield
    assert not made(), made()
    assert len(bpy.data.collections["Yard"].objects) == auto.HEAPS * auto.EACH


def escape_while_measuring_changes_nothing():
    make(subdivisions=6)  # takes long enough for the key to come while it measures
    start()
    yield from steps.wait_until(measures)
    steps.press("ESC")
    yield from steps.wait_until(is_idle, 20)
    assert not made(), made()


steps.run(
    [
        ok_makes_collections_and_the_store_stays,
        one_undo_takes_it_back,
        escape_while_measuring_changes_nothing,
    ]
)
