# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be seen and explained: why a level is used, what a picture took, how far it is off."""

import bpy
from bpy.types import Panel

from ..bridge import kept_view
from ..core import compare_plan, kept_model, last_render, progress
from ..core.native import lodestone_native as native
from . import EnginePanel


class LODESTONE_OBJECT_PT_why(Panel):
    bl_label = "Why This Level"
    bl_parent_id = "LODESTONE_OBJECT_PT_levels"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"

    def draw(self, context):
        layout = self.layout
        scene = context.scene
        kept = kept_model.get(scene.name)
        if kept is None:
            layout.label(text="Known after a picture, or when the scene was read")
            layout.operator("lodestone.read_levels", icon="FILE_REFRESH")
            return
        try:
            found = kept_view.explained(scene, context.evaluated_depsgraph_get(), context.object)
        except native.LodestoneError as error:
            layout.label(text=str(error), icon="ERROR")
            return
        if found is None:
            layout.label(text="Busy with a picture", icon="SORTTIME")
            return
        column = layout.column(align=True)
        column.label(text=found.title, icon="OUTLINER_OB_MESH")
        for line in found.lines:
            column.label(text=line)
        if kept.outdated or kept.frame != scene.frame_current:
            row = layout.row()
            row.label(text="The scene has changed since", icon="INFO")
            row.operator("lodestone.read_levels", text="", icon="FILE_REFRESH")


class LODESTONE_RENDER_PT_cost(EnginePanel, Panel):
    bl_label = "Time and Memory"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        render = last_render.get(context.scene.name)
        if render is None or not render.actual_s:
            layout.label(text="Render a picture to see what it takes")
            return
        split = layout.split(factor=0.4)
        names, values = split.column(align=True), split.column(align=True)
        names.label(text="POV-Ray's Time")
        expected, took = seconds(render.predicted_s), seconds(render.actual_s)
        values.label(text=f"expected {expected}, took {took}")
        names.label(text="Its Memory")
        expected = progress.memory(render.predicted_bytes)
        values.label(text=f"expected {expected}, took {progress.memory(render.actual_bytes)}")


class LODESTONE_RENDER_PT_compare(EnginePanel, Panel):
    bl_label = "Comparison"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.operator("lodestone.compare", icon="IMAGE_REFERENCE")
        found = compare_plan.get(context.scene.name)
        if found is None:
            return
        split = layout.split(factor=0.4)
        names, values = split.column(align=True), split.column(align=True)
        names.label(text="Pixel Error")
        values.label(
            text=f"{found.pixel_error:g} px, {progress.count(found.pixels)} pixels covered"
        )
        names.label(text="Mean, Largest")
        values.label(text=f"{255 * found.mean:.2f}, {255 * found.max:.0f} of 255")
        names.label(text="SSIM")
        values.label(text=f"{found.ssim:.4f}")
        for place, (path, share) in enumerate(found.worst):
            names.label(text="" if place else "Differ Most")
            text = f"{progress.percent(share, 1.0)}   {path.rsplit('/', 1)[-1]}"
            values.operator("lodestone.select_object", text=text, emboss=False).path = path


def seconds(value):
    """0.8 s, 12 s, 2:05."""
    if value < 10.0:
        return f"{value:.1f} s"
    return f"{value:.0f} s" if value < 60.0 else progress.clock(value)


_CLASSES = (LODESTONE_OBJECT_PT_why, LODESTONE_RENDER_PT_cost, LODESTONE_RENDER_PT_compare)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
