# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of Detail > In This View: what the scene's camera would see of the levels, and of the last
picture what only a picture tells."""

import bpy
from bpy.types import Panel

from .. import handlers
from ..bridge.live import live_view
from ..bridge.scene import quality_lenses
from ..core import progress_text
from ..core.kind_words import DRAWN_KINDS, KIND_WORDS
from ..core.native import lodestone_native as native
from ..core.session.addon_session import addon_session

_ARROW = "\N{RIGHTWARDS ARROW}"


class LODESTONE_RENDER_PT_levels_view(Panel):
    bl_label = "In This View"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    def draw(self, context):
        layout = self.layout
        render = addon_session().renders.get(context.scene.name)
        try:
            found = live_view.statistics(context)
            viewport = live_view.viewport_statistics(context)
        except native.LodestoneError as error:
            found, viewport = f"Nothing can be chosen: {error}", None
        if not isinstance(found, str):
            _draw_live(layout, context, found)
            if viewport is not None:
                _draw_viewport(layout, viewport)
        elif render is not None:
            _draw_last(layout, render)
        else:
            layout.label(text=found)
        if render is not None and render.without_levels:
            text = f"{render.without_levels:,} without levels yet: Update Levels"
            layout.label(text=text, icon="INFO")


def _draw_live(layout, context, found):
    names, values = _columns(layout)
    _row(
        names,
        values,
        "Triangles",
        _change(progress_text.count, found.triangles_before, found.triangles),
    )
    _row(
        names,
        values,
        "POV-Ray Memory",
        _change(progress_text.memory, found.bytes_before, found.bytes),
    )
    _draw_kinds(names, values, found.kinds)
    _draw_largest(names, values, found.largest_error_px, found.largest_error_name)
    settings = context.scene.lodestone
    if settings.budget_render and settings.use_levels:
        _row(names, values, "Pixel Error", f"{found.pixel_error:.2f} px for the budget")
        if not found.fits:
            layout.label(text="The coarsest levels exceed the budget", icon="ERROR")


def _draw_viewport(layout, found):
    """What the 3D view's own Pixel Error and budget come to."""
    names, values = _columns(layout)
    text = _change(progress_text.count, found.triangles_before, found.triangles)
    _row(names, values, "Triangles in 3D View", text)
    _row(names, values, "Its Pixel Error", f"{found.pixel_error:.2f} px")
    if not found.fits:
        layout.label(text="The coarsest levels exceed the budget", icon="ERROR")


def _draw_last(layout, render):
    names, values = _columns(layout)
    _row(
        names, values, "Triangles",
        _change(progress_text.count, render.triangles_placed, render.triangles),
    )  # fmt: skip
    _draw_kinds(names, values, render.kinds)
    _draw_largest(names, values, render.largest_error_px, render.largest_error_name)


def _columns(layout):
    split = layout.split(factor=0.4)
    return split.column(align=True), split.column(align=True)


def _row(names, values, name, value):
    names.label(text=name)
    values.label(text=value)


def _change(written, before, after):
    return f"{written(before)} {_ARROW} {written(after)}   {progress_text.percent(after, before)}"


def _draw_kinds(names, values, kinds):
    for kind in DRAWN_KINDS:
        number = kinds[kind.name.lower()]
        if number:
            _row(names, values, KIND_WORDS[kind].occurrences, f"{number:,}")


def _draw_largest(names, values, error, name):
    names.label(text="Largest Error")
    if not name:
        values.label(text=f"{error:.2f} px")
        return
    row = values.row(align=True)
    short = name.rsplit("/", 1)[-1]
    row.label(text=f"{error:.2f} px   {short}")
    row.operator("lodestone.select_object", text="", icon="RESTRICT_SELECT_OFF").path = name


def _redraw():
    manager = bpy.context.window_manager
    for window in manager.windows if manager else ():
        for area in window.screen.areas:
            if area.type == "PROPERTIES" and area.spaces.active.context == "RENDER":
                area.tag_redraw()


@bpy.app.handlers.persistent
def _follow(scene, depsgraph):
    """Blender redraws this tab for the scene alone; the numbers also follow cameras and lenses."""
    if bpy.app.background:
        return
    for update in depsgraph.updates:
        item = update.id
        if isinstance(item, bpy.types.Camera):
            return _redraw()
        if isinstance(item, bpy.types.Object):
            if item.type == "CAMERA" or (
                item.type == "EMPTY" and quality_lenses.is_lens(item.original)
            ):
                return _redraw()


_HANDLERS = (("depsgraph_update_post", _follow),)
_register, _unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_levels_view,))


def register():
    _register()
    handlers.add(_HANDLERS)


def unregister():
    handlers.remove(_HANDLERS)
    live_view.forget()
    _unregister()
