# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the 3D Viewport's popover Levels that is about what the viewport draws."""

from . import levels_preview


def draw_levels(layout, context):
    shown = levels_preview.shows_levels(context)
    text = "Levels Are Shown" if shown else "Show Levels"
    layout.operator("lodestone.show_levels", text=text, icon="MOD_DECIM", depress=shown)
    settings = context.scene.lodestone
    column = layout.column()
    column.active = settings.use_levels
    column.prop(settings, "pixel_error_viewport", text="Pixel Error")
    column.prop(settings, "budget_viewport", text="Budget (M Tris)")
    if not shown:
        return
    chosen = context.window_manager.lodestone_overlay
    column.active = settings.use_levels and not chosen.use_force_lod
    row = layout.row(heading="Force LOD")
    row.prop(chosen, "use_force_lod", text="")
    sub = row.row()
    sub.active = chosen.use_force_lod
    sub.prop(chosen, "force_lod", text="")
    told = layout.column(align=True)
    for line in levels_preview.lines(context):
        told.label(text=line)
