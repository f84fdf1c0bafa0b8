# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): Update Levels, its dialog, Esc, what comes back."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402

FOLDER = Path(sys.argv[-1])
DECIDED = "Ball.3"  # holds a decision: the one thing Update Levels stores an id on


def make(subdivisions=3):
    """Six balls. Who wants to interrupt what reads or builds them subdivides them more often."""
    scene = scenes.fresh()
    for i in range(6):
        ball = scenes.cube(f"Ball.{i}", (2 * i, 0, 0))
        ball.modifiers.new("Subdivision", "SUBSURF").render_levels = subdivisions
    bpy.data.objects[DECIDED].lodestone.role = "ENVIRONMENT"
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "window.blend"))
    with steps.window():
        bpy.ops.ed.undo_push(message="Made")
    return scene


def state():
    """What must be as before whatever happens. Blender's own Render Result may come into being."""
    render, preferences = bpy.context.scene.render, bpy.context.preferences
    result = bpy.data.images.get("Render Result")
    return (
        render.engine,
        render.use_compositing,
        render.use_sequencer,
        render.use_lock_interface,
        preferences.view.render_display_type,
        result.render_slots.active_index if result else 0,
        sorted(item.name for item in (*bpy.data.objects, *bpy.data.cameras)),
        hasattr(bpy.types, "LODESTONE_RE_extract"),
    )


def stored():
    """Names of the objects that have an id in the file."""
    return [item.name for item in bpy.data.objects if len(item.lodestone.uid) == 16]


def running():
    from lodestone.operators import window_run

    return window_run.current()


def is_idle():
    return running() is None and not bpy.app.is_job_running("RENDER")


def picture():
    """The pixels of the current Render Result, by way of a file."""
    path = str(FOLDER / "slot.png")
    bpy.data.images["Render Result"].save_render(path)
    return Path(path).read_bytes()


def levels_are_built_and_the_picture_stays():
    scene = make()
    scene.render.engine = "BLENDER_WORKBENCH"
    bpy.ops.render.render()
    before, seen = state(), picture()
    with steps.window():
        assert bpy.ops.lodestone.update_levels.poll()
        outcome = bpy.ops.lodestone.update_levels("INVOKE_DEFAULT", confirm=False)
        assert outcome == {"RUNNING_MODAL"}, outcome
        assert not bpy.ops.lodestone.update_levels.poll(), "a second one must wait"
    yield from steps.wait_until(is_idle)
    assert (FOLDER / "lodestone" / "window" / "tileset.json").is_file()
    assert stored() == [DECIDED], stored()
    assert state() == before, (state(), before)
    assert picture() == seen, "the picture in the render slot was lost"


def one_undo_takes_it_back():
    with steps.window():
        bpy.ops.ed.undo()
    yield
    assert stored() == [], stored()
    with steps.window():
        bpy.ops.ed.redo()
    yield
    assert stored() == [DECIDED], stored()
    bpy.ops.lodestone.clear_levels()


def escape_while_reading_changes_nothing():
    make(6)
    before = state()
    with steps.window():
        bpy.ops.lodestone.update_levels("INVOKE_DEFAULT", confirm=False)
    steps.press("ESC")
    yield from steps.wait_until(is_idle, 20)
    assert stored() == [], stored()
    assert state() == before, (state(), before)


def is_building():
    return running() is not None and running().working()


def escape_while_building_changes_nothing():
    from lodestone.operators import update_levels

    make(6)
    for i in range(30):
        item = scenes.cube(f"More.{i}", (0, 2 * i, 0), 1.0 + i / 100)
        item.modifiers.new("Subdivision", "SUBSURF").render_levels = 6
    before = state()
    told = []
    left_by = update_levels._InWindow.left_by
    update_levels._InWindow.left_by = lambda *of: told.append(left_by(*of)) or told[-1]
    with steps.window():
        bpy.ops.lodestone.update_levels("INVOKE_DEFAULT", confirm=False)
    yield from steps.wait_until(is_building)
    steps.press("ESC")
    yield from steps.wait_until(is_idle, 20)
    update_levels._InWindow.left_by = left_by
    assert told == [update_levels.STOPPED], told
    assert stored() == [], stored()
    assert state() == before, (state(), before)
    assert not (FOLDER / "lodestone" / "window" / "tileset.json").is_file()


def asks():
    return running() is not None and running().estimate is not None


def the_dialog_asks_before_it_builds():
    make()
    with steps.window():
        bpy.ops.lodestone.update_levels("INVOKE_DEFAULT")
    yield from steps.wait_until(asks)
    for _ in range(20):
        yield
    assert not is_building(), "it builds without being told to"
    steps.press("RET")
    yield from steps.wait_until(is_idle)
    assert (FOLDER / "lodestone" / "window" / "tileset.json").is_file()
    assert stored() == [DECIDED], stored()
    bpy.ops.lodestone.clear_levels()


def a_dialog_that_is_left_changes_nothing():
    make()
    before = state()
    with steps.window():
        bpy.ops.lodestone.update_levels("INVOKE_DEFAULT")
    yield from steps.wait_until(asks)
    for _ in range(20):
        yield
    steps.press("ESC")
    yield from steps.wait_until(is_idle)
    assert stored() == [], stored()
    assert state() == before, (state(), before)


def loading_a_file_stops_it():
    make(6)
    with steps.window():
        bpy.ops.lodestone.update_levels("INVOKE_DEFAULT", confirm=False)
    yield from steps.wait_until(is_building)
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "window.blend"))
    yield
    assert is_idle()
    assert stored() == [], stored()


def panels_draw():
    make()
    with steps.window():
        bpy.ops.lodestone.update_levels()
    area = next(
        a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "PROPERTIES"
    )
    for engine in ("LODESTONE_POVRAY", "BLENDER_EEVEE"):
        bpy.context.scene.render.engine = engine
        for context in ("RENDER", "OBJECT", "MATERIAL", "WORLD", "OUTPUT"):
            bpy.context.view_layer.objects.active = bpy.data.objects["Ball.1"]
            area.spaces[0].context = context
            area.tag_redraw()
            for _ in range(4):
                yield


steps.run(
    (
        levels_are_built_and_the_picture_stays,
        one_undo_takes_it_back,
        escape_while_reading_changes_nothing,
        escape_while_building_changes_nothing,
        the_dialog_asks_before_it_builds,
        a_dialog_that_is_left_changes_nothing,
        loading_a_file_stops_it,
        panels_draw,
    )
)
