# SPDX-License-Identifier: GPL-3.0-or-later
"""Detail Lens in Properties > Data of an Empty; Screen Lenses and Levels of Detail in those of a
camera."""

import bpy
from bpy.types import Panel, UIList

from ..bridge import datablock_ids
from ..bridge.scene import quality_lenses
from ..operators import screen_lenses


class LODESTONE_EMPTY_PT_lens(Panel):
    bl_label = "Detail Lens"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "EMPTY"

    def draw_header(self, context):
        if quality_lenses.is_lens(context.object):
            self.layout.prop(context.object.lodestone.lens, "enabled", text="")

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        item = context.object
        if not quality_lenses.is_lens(item):
            layout.operator("lodestone.detail_lens_enable", icon="ZOOM_SELECTED")
            return
        layout.enabled = item.library is None
        lens = item.lodestone.lens
        column = layout.column()
        column.prop(lens, "strength")
        column.prop(lens, "falloff")
        column.prop(item, "empty_display_type", text="Shape")
        column.prop(item, "empty_display_size", text="Radius")
        if item.empty_display_type not in quality_lenses.DISPLAY:
            layout.label(text="Neither sphere nor cube: counts as a sphere", icon="INFO")
        column.prop(lens, "filter")
        if lens.filter != "ALL":
            column.prop(lens, "collection")
            if lens.collection is None:
                layout.label(text="Choose a collection: the lens has no effect", icon="ERROR")


class LODESTONE_UL_screen_lenses(UIList):
    bl_idname = "LODESTONE_UL_screen_lenses"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property):
        row = layout.row(align=True)
        row.prop(item, "name", text="", emboss=False, icon="ZOOM_SELECTED")
        row.prop(item, "strength", text="", emboss=False)
        row.prop(item, "enabled", text="")


class CameraButtonsPanel:
    """A panel of a camera's Data tab."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return getattr(context, "camera", None) is not None


class LODESTONE_CAMERA_PT_screen_lenses(CameraButtonsPanel, Panel):
    bl_label = "Screen Lenses"

    def draw(self, context):
        layout = self.layout
        camera = context.camera
        if not screen_lenses.lens_count(camera):  # looking must store nothing
            layout.operator("lodestone.screen_lens_add", icon="ADD")
            return
        row = layout.row()
        row.template_list(
            "LODESTONE_UL_screen_lenses",
            "",
            camera.lodestone,
            "screen_lenses",
            camera.lodestone,
            "active_screen_lens",
            rows=3,
        )
        buttons = row.column(align=True)
        buttons.operator("lodestone.screen_lens_add", text="", icon="ADD")
        buttons.operator("lodestone.screen_lens_remove", text="", icon="REMOVE")
        lens = screen_lenses.active_lens(camera)
        if lens is None:
            return
        layout.use_property_split = True
        column = layout.column()
        column.active = lens.enabled
        for name in ("x", "y", "radius", "strength", "falloff"):
            column.prop(lens, name)
        layout.operator("lodestone.screen_lens_drag", icon="VIEW_PAN")


class LODESTONE_CAMERA_PT_levels(CameraButtonsPanel, Panel):
    bl_label = "Levels of Detail"

    def draw(self, context):
        layout = self.layout
        settings, dof = datablock_ids.settings_of(context.camera), context.camera.dof
        if settings is None:  # looking must store nothing
            layout.operator("lodestone.depth_exaggerate", icon="FULLSCREEN_ENTER")
            return
        layout.use_property_split = True
        layout.enabled = context.camera.library is None
        layout.prop(settings, "depth_exaggeration")
        column = layout.column()
        column.active = settings.depth_exaggeration != 1.0
        column.prop(dof, "focus_object", text="Focus on Object")
        sub = column.column()
        sub.active = dof.focus_object is None
        sub.prop(dof, "focus_distance")


_CLASSES = (
    LODESTONE_EMPTY_PT_lens,
    LODESTONE_UL_screen_lenses,
    LODESTONE_CAMERA_PT_screen_lenses,
    LODESTONE_CAMERA_PT_levels,
)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
