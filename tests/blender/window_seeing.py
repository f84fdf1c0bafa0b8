# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): false colors over the viewport, Compare, and screen
lenses that are dragged."""

import math
import sys
from pathlib import Path

import addon_utils
import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402

FOLDER = Path(sys.argv[-1])
PLACES = 5


def row_of_balls():
    """Away from the camera, so that they have every level."""
    scene = scenes.fresh()
    scene.render.engine = "LODESTONE_POVRAY"
    scene.render.resolution_x, scene.render.resolution_y = 160, 90
    scenes.sun()
    mesh = scenes.bumpy_mesh(subdivisions=3)
    for place in range(PLACES):
        away = 3.0 * 1.6**place if place else 0.0
        scenes.cube(f"Ball {place}", ((place % 3) * 2.5 - 2.5, away, 0.0), data=mesh)
    scene.camera.location = (0.0, -9.0, 5.0)
    scene.camera.rotation_euler = (math.radians(70), 0.0, 0.0)
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "seeing.blend"))


def overlay():
    from lodestone.viewport import false_color_overlay

    return false_color_overlay


def shown():
    return overlay().drawn().shown._batch is not None


def colors_are_drawn_and_follow_the_camera():
    from lodestone.core.session.addon_session import addon_session

    row_of_balls()
    with steps.window():
        bpy.ops.lodestone.update_levels()
        bpy.ops.lodestone.read_levels("INVOKE_DEFAULT")

    def read():
        return addon_session().kept_models.get("Scene") is not None

    yield from steps.wait_until(read)
    chosen = bpy.context.window_manager.lodestone_overlay
    painted = {item.name: tuple(item.color) for item in bpy.data.objects}
    for mode in ("LEVEL", "ERROR", "COST"):
        chosen.mode = mode

        def drawn():
            return shown() and overlay().drawn().shown.key[2] == mode

        yield from steps.wait_until(drawn)
        assert chosen.mode == mode, "an exception while it was drawn turns it off"
        assert painted == {item.name: tuple(item.color) for item in bpy.data.objects}
    before = overlay().drawn().shown._batch
    with steps.window():
        bpy.ops.ed.undo_push(message="Before")
    bpy.context.scene.camera.location.y = -40.0

    def follows():
        return shown() and overlay().drawn().shown._batch is not before

    yield from steps.wait_until(follows)
    with steps.window():
        bpy.ops.ed.undo_push(message="Camera")
        bpy.ops.ed.undo()
        bpy.ops.ed.redo()
    for _ in range(4):
        yield
    assert addon_session().kept_models.get("Scene").outdated
    assert bpy.context.window_manager.lodestone_overlay.mode == "COST"


def it_is_off_when_another_file_is_opened():
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "seeing.blend"))
    yield
    assert bpy.context.window_manager.lodestone_overlay.mode == "NONE"
    assert not shown()


def compare_fills_the_slots():
    from lodestone.core.session.addon_session import addon_session
    from lodestone.engines import render_engine

    scene = bpy.context.scene
    scene.lodestone.pixel_error_render = 4.0
    before = scene.render.use_compositing
    with steps.window():
        assert bpy.ops.lodestone.compare("INVOKE_DEFAULT") == {"RUNNING_MODAL"}

    def compared():  # Blender refuses to change anything until its job is over, a little later
        ended = "Scene" in addon_session().comparisons and not render_engine.is_comparing()
        return ended and not bpy.app.is_job_running("RENDER")

    yield from steps.wait_until(compared, 120.0)
    yield from steps.wait_until(steps.takes_operators)
    assert bpy.data.images["Render Result"].render_slots.active_index == 2
    assert scene.render.use_compositing == before
    assert addon_session().comparisons.get("Scene").pixels > 100


def a_screen_lens_is_dragged_in_the_camera_view():
    from lodestone.operators import screen_lenses

    context = bpy.context
    first = context.window_manager.windows[0]
    camera = context.scene.camera.data
    with steps.window():
        bpy.context.region_data.view_perspective = "CAMERA"
        bpy.ops.lodestone.screen_lens_add()
    lens = camera.lodestone.screen_lenses[0]
    for _ in range(4):
        yield

    def to(x, y, kind="MOUSEMOVE", value="NOTHING"):
        region, (left, bottom, right, top) = screen_lenses.camera_region(context, camera)
        at = (region.x + left + x * (right - left), region.y + bottom + y * (top - bottom))
        first.event_simulate(type=kind, value=value, x=round(at[0]), y=round(at[1]))

    def begin():
        with steps.window():
            found = bpy.ops.lodestone.screen_lens_drag("INVOKE_DEFAULT")
        assert found == {"RUNNING_MODAL"}

    begin()
    to(0.25, 0.75)
    yield from steps.wait_until(lambda: abs(lens.x - 0.25) < 0.02)
    assert abs(lens.y - 0.75) < 0.02
    before = lens.radius
    to(0.25, 0.75, "WHEELUPMOUSE", "PRESS")
    yield from steps.wait_until(lambda: lens.radius > before)
    to(0.25, 0.75, "LEFTMOUSE", "PRESS")
    to(0.25, 0.75, "LEFTMOUSE", "RELEASE")
    for _ in range(4):
        yield
    begin()
    to(0.6, 0.4)
    yield from steps.wait_until(lambda: abs(lens.x - 0.6) < 0.02)
    to(0.6, 0.4, "ESC", "PRESS")
    to(0.6, 0.4, "ESC", "RELEASE")
    yield from steps.wait_until(lambda: abs(lens.x - 0.25) < 0.02)
    assert lens.radius > before


def disabling_the_add_on_takes_the_colors_away():
    with steps.window():
        bpy.ops.lodestone.read_levels()
    bpy.context.window_manager.lodestone_overlay.mode = "LEVEL"
    yield from steps.wait_until(shown)
    addon_utils.disable("lodestone", default_set=True)
    for _ in range(4):
        yield
    assert not hasattr(bpy.context.window_manager, "lodestone_overlay")


STEPS = (
    colors_are_drawn_and_follow_the_camera,
    it_is_off_when_another_file_is_opened,
    compare_fills_the_slots,
    a_screen_lens_is_dragged_in_the_camera_view,
    disabling_the_add_on_takes_the_colors_away,
)
if __name__ == "__main__":
    steps.run(STEPS)
