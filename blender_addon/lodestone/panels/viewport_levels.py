# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the 3D Viewport's popover Levels that is about what the viewport draws."""

from .. import preview


def draw_levels(layout, context):
    shown = preview.shows_levels(context)
    text = "Levels Are Shown" if shown else "Show Levels"
    layout.operator("lodestone.show_levels", text=text, icon="MOD_DECIM", depress=shown)
    settings = context.scene.lodestone
    column = layout.column()
    column.active = settings.use_levels
    column.prop(settings, "pixel_error_viewport", text="Pixel Error")
    column.prop(settings, "budget_viewport", text="Budget (M Triangles)")
    if not shown:
        return
    for line in preview.lines(context):
        layout.label(text=line)
