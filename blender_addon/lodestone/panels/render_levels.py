# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Render > Levels of Detail: one number, and what is built for it."""

import bpy
from bpy.types import Panel

from . import presets


class LODESTONE_RENDER_PT_levels(Panel):
    bl_label = "Levels of Detail"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.lodestone, "use_levels", text="")

    def draw_header_preset(self, context):
        presets.LODESTONE_PT_levels_presets.draw_panel_header(self.layout)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        settings = context.scene.lodestone
        used = layout.column()
        used.active = settings.use_levels
        column = used.column(align=True)
        column.prop(settings, "pixel_error_render", text="Pixel Error")
        column.prop(settings, "pixel_error_viewport", text="Viewport")
        column = used.column(align=True)
        column.prop(settings, "budget_render", text="Budget (MB)")
        column.prop(settings, "budget_viewport", text="Viewport (M Tris)")
        column = used.column(heading="Coarser When")
        column.prop(settings, "coarser_moving_dark", text="Moving or Dark")
        layout.use_property_decorate = False
        layout.prop(settings, "deforming")
        layout.prop(settings, "build_on_render")
        layout.prop(settings, "structure")
        layout.prop(settings, "scope")
        row = layout.row(align=True)
        row.operator("lodestone.update_levels", icon="FILE_REFRESH")
        row.operator("lodestone.clear_levels", text="", icon="X")


_register, _unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_levels,))


def register():
    presets.register()
    try:
        _register()
    except Exception:
        presets.unregister()
        raise


def unregister():
    _unregister()
    presets.unregister()
