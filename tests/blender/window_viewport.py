# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): levels in the 3D Viewport."""

import sys
from pathlib import Path

import addon_utils
import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402

FOLDER = Path(sys.argv[-1])
PLACES = 6


def row_of_balls():
    scene = scenes.fresh()
    scene.render.engine = "LODESTONE_POVRAY"
    scenes.sun()
    mesh = scenes.bumpy_mesh(subdivisions=4)
    mesh.materials.append(scenes.material("Red", (0.8, 0.05, 0.05)))
    row = scenes.collection("Row", scene.collection)
    for place in range(PLACES):
        scenes.cube(f"Ball {place}", (3.0 * place - 7.5, 0.0, 0.0), data=mesh, collection=row)
    bpy.context.view_layer.update()
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "viewport.blend"))


def areas():
    return [a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D"]


def state(area=None):
    from lodestone.viewport import levels_preview

    return levels_preview.state_of(area or areas()[0])


def picture(area=None):
    found = state(area)
    return None if found is None else found.view.shown


def settled(area=None, since=None):
    """Until a final picture (another than `since`) is shown and nothing is on its way."""

    def there():
        found = state(area)
        if found is None or found.source is None or found.view.shown is None:
            return False
        waiting = found.view.next is not None or found.source.scene.stale
        shown = found.view.shown
        fresh = shown.wanted.key() == found.view.asked and shown is not since
        return shown.final and fresh and not waiting and not found.source.worker.busy

    yield from steps.wait_until(there, 90.0)
    assert not state(area).view.problem, state(area).view.problem


def look(area, distance):
    region = area.spaces.active.region_3d
    region.view_perspective = "PERSP"
    region.view_location = (0.0, 0.0, 0.0)
    region.view_rotation = (1.0, 0.0, 0.0, 0.0)
    region.view_distance = distance


def of_user():
    """Everything in the file that a preview could have touched."""
    found = []
    for kind in ("objects", "meshes", "materials", "collections", "scenes", "cameras", "images"):
        for item in getattr(bpy.data, kind):
            found.append((kind, item.name, item.users, tuple(sorted(item.keys()))))
    for item in bpy.data.objects:
        place = tuple(value for row in item.matrix_world for value in row)
        hidden = (item.hide_viewport, item.hide_render, item.hide_get(), tuple(item.color))
        found.append((item.name, item.data and item.data.name, place, hidden, item.display_type))
    return found


def levels_are_drawn_and_the_file_stays_as_it_is():
    row_of_balls()
    with steps.window():
        bpy.ops.lodestone.update_levels()
    area = areas()[0]
    look(area, 40.0)
    before = of_user()
    with steps.window():
        assert bpy.ops.lodestone.show_levels() == {"FINISHED"}
    assert area.spaces.active.shading.type == "RENDERED"
    yield from settled()
    shown = picture()
    assert 0 < shown.triangles < shown.triangles_before == PLACES * 1280, shown
    assert shown.things.number == 0 and state().batches > 0
    assert of_user() == before
    pixels_are_red(area)


def pixels_are_red(area):
    """What was drawn last, somewhere: the balls' color, and the background elsewhere."""
    from lodestone.viewport import levels_preview

    region = next(r for r in area.regions if r.type == "WINDOW")
    texture = levels_preview.preview().canvases[region.as_pointer()]._offscreen.texture_color
    pixels = texture.read()
    pixels.dimensions = len(pixels) * len(pixels[0]) * 4
    values = list(pixels)
    reds = sum(1 for r, g in zip(values[0::4], values[1::4]) if r > 4 * g and r > 0.05)
    assert 50 < reds < len(values) / 8, (reds, len(values))


def it_refines_when_one_comes_near():
    far = picture()
    look(areas()[0], 8.0)
    yield from settled(since=far)
    assert picture().triangles > far.triangles


def two_viewports_have_levels_of_their_own():
    with steps.window():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    for _ in range(3):
        yield
    first, second = areas()[:2]
    look(first, 8.0)
    look(second, 200.0)
    second.spaces.active.shading.type = "RENDERED"
    yield from settled(second)
    yield from settled(first)
    assert picture(second).triangles < picture(first).triangles
    first.spaces.active.shading.type = "SOLID"
    look(second, 40.0)
    yield from settled(second)


def area_now():
    return next(a for a in areas() if a.spaces.active.shading.type == "RENDERED")


def moved_hidden_and_new_things_follow():
    area = area_now()
    with steps.window():
        bpy.ops.ed.undo_push(message="Before")
    shown = picture(area)
    bpy.data.objects["Ball 0"].location.y = 5.0
    yield from settled(area, shown)
    boxes = [preview_pool()._there[key].box for key in picture(area).keys]
    assert max(box[4] for box in boxes) > 5.5, boxes
    assert picture(area).things.number == 0, "what was only moved is still drawn by its levels"
    drawn = picture(area).drawn
    shown = picture(area)
    bpy.data.objects["Ball 1"].hide_set(True)
    yield from settled(area, shown)
    assert picture(area).drawn < drawn
    shown = picture(area)
    scenes.cube("New", (0.0, -4.0, 0.0))
    yield from settled(area, shown)
    assert picture(area).things.number == 1
    boxes = [preview_pool()._there[key].box for key in picture(area).keys]
    assert min(box[1] for box in boxes) < -4.4
    with steps.window():
        bpy.ops.ed.undo_push(message="After")


def preview_pool():
    from lodestone.viewport import levels_preview

    return levels_preview.preview().pool


def what_is_edited_is_drawn_as_it_is():
    def learned():
        return state(area_now()).source.scene.learned

    yield from steps.wait_until(learned)
    shown = picture(area_now())
    bpy.data.objects["Ball 2"].data.vertices[0].co.z += 4.0  # of all of them
    bpy.data.objects["Ball 2"].data.update()
    yield from settled(area_now(), shown)
    assert picture(area_now()).things.number == PLACES, picture(area_now()).things.number


def undo_and_redo_are_followed():
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo):
        with steps.window():
            step()
        for _ in range(4):
            yield
        yield from settled(area_now())


def a_pin_for_viewports_is_obeyed_and_renders_are_not_affected():
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "viewport.blend"))
    for _ in range(3):
        yield
    area = areas()[0]
    look(area, 300.0)
    area.spaces.active.shading.type = "RENDERED"
    yield from settled(area)
    shown = picture(area)
    assert shown.triangles < 1000, shown.triangles
    bpy.data.objects["Ball 3"].lodestone.use_pin_viewport = True
    yield from settled(area, shown)
    assert picture(area).triangles >= 1280
    assert picture(area).things.number == 0, "deciding about a thing is taken for another shape"
    from lodestone.bridge import datablock_ids

    assert datablock_ids.decision_of(bpy.data.objects["Ball 3"]) == datablock_ids.UNDECIDED
    shown = picture(area)
    bpy.context.window_manager.lodestone_overlay.seen_from = "VIEW"
    bpy.context.window_manager.lodestone_overlay.mode = "LEVEL"
    yield from settled(area, shown)
    assert set(picture(area).keys).isdisjoint(shown.keys)


def a_forced_level_is_one_viewports_and_no_files():
    area = area_now()
    chosen = bpy.context.window_manager.lodestone_overlay
    before = of_user()
    found = []
    for lod in (0, 1, 2):
        shown = picture(area)
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area):
            chosen.force_lod = lod
            chosen.use_force_lod = True
            assert (chosen.use_force_lod, chosen.force_lod) == (True, lod)
        assert not chosen.use_force_lod, "it is on where there is no viewport"
        yield from settled(area, shown)
        found.append(picture(area).triangles)
        assert f"LOD {lod}" in state(area).view.line()
    assert of_user() == before
    assert PLACES * 1280 == found[0] > found[1] > found[2] > 0, found
    assert all(triangles % PLACES == 0 for triangles in found), found
    shown = picture(area)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area):
        chosen.use_force_lod = False
    yield from settled(area, shown)


def an_exception_is_told_once_and_nothing_breaks():
    from lodestone.viewport import levels_preview

    area, before = area_now(), levels_preview._show
    printed = len(levels_preview.preview().told)

    def broken(*_):
        raise RuntimeError("broken on purpose")

    levels_preview._show = broken
    try:
        for _ in range(5):
            area.tag_redraw()
            yield
        assert "broken on purpose" in state(area).view.problem
        assert len(levels_preview.preview().told) == printed + 1
    finally:
        levels_preview._show = before


def disabling_the_add_on_ends_it():
    import threading

    from lodestone.viewport import levels_preview

    addon_utils.disable("lodestone", default_set=True)
    for _ in range(5):
        yield
    assert not [t for t in threading.enumerate() if t.name == "Lodestone viewport"]
    assert levels_preview._on_change not in bpy.app.handlers.depsgraph_update_post
    assert not levels_preview.preview().canvases and not levels_preview.preview().sources


STEPS = (
    levels_are_drawn_and_the_file_stays_as_it_is,
    it_refines_when_one_comes_near,
    two_viewports_have_levels_of_their_own,
    moved_hidden_and_new_things_follow,
    what_is_edited_is_drawn_as_it_is,
    undo_and_redo_are_followed,
    a_pin_for_viewports_is_obeyed_and_renders_are_not_affected,
    a_forced_level_is_one_viewports_and_no_files,
    an_exception_is_told_once_and_nothing_breaks,
    disabling_the_add_on_ends_it,
)
if __name__ == "__main__":
    steps.run(STEPS)
