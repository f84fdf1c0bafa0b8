# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of Detail > Not Seen Directly: how fine things are off screen, in shadows and in mirrors,
and what that saves."""

import bpy
from bpy.types import Panel

from ..bridge import quality_settings
from ..bridge.live import live_view
from ..core import progress_text
from ..core.native import lodestone_native as native
from ..core.picture import unseen_detail
from . import EnginePanel


class LODESTONE_RENDER_PT_unseen(EnginePanel, Panel):
    bl_label = "Not Seen Directly"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        settings = context.scene.lodestone
        exact = quality_settings.is_exact(settings)
        column = layout.column()
        column.active = not exact
        column.prop(settings, "off_screen")
        boxes = column.column(heading="Coarser In", align=True)
        for one in unseen_detail.CLASSES:
            boxes.prop(settings, one.key)
        if exact:
            why = "Pixel Error is 0" if settings.use_levels else "Levels are off"
            layout.label(text=f"{why}: everything is drawn as it is", icon="INFO")
        elif quality_settings.ray_classes(settings):
            _draw_found(layout, context)


def _draw_found(layout, context):
    try:
        found = live_view.statistics(context)
    except native.LodestoneError as error:
        layout.label(text=f"Nothing can be chosen: {error}")
        return
    if isinstance(found, str):
        layout.label(text=found)
        return
    if found.met is None:
        return
    split = layout.split(factor=0.4)
    names, values = split.column(align=True), split.column(align=True)
    for one in found.met.classes:
        for place, line in enumerate(lines_of(one, found.triangles)):
            names.label(text="" if place else one.ray_class.label)
            values.label(text=line)
    names.label(text="POV-Ray Keeps")
    values.label(text=f"{progress_text.count(found.met.triangles)} triangles for all of them")


def lines_of(numbers, seen):
    """What a class saves, its bound, and why not more. `seen`: triangles that the camera sees."""
    if not numbers.own:
        lines = ["Nothing coarser may be used"]
    else:
        met, of = progress_text.count(numbers.triangles), progress_text.count(seen)
        lines = [
            f"{met} of {of} triangles   {progress_text.percent(numbers.triangles, seen)}",
            f"Off by at most {bound(numbers.largest_error_px)}",
        ]
    for number, why in (
        (numbers.touching, "too near to others"),
        (numbers.shaped, "cover themselves"),
    ):
        if number:
            lines.append(f"{number:,} as seen: {why}")
    return lines


def bound(error_px):
    """Rounded up, as bounds are: 0.9 px, 1.0 px."""
    return f"{-(-error_px * 10 // 1) / 10:.1f} px"


register, unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_unseen,))
