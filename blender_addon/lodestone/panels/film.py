# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Render > Film, Performance and Scene Files."""

import bpy
from bpy.types import Panel

from ..core.store import store_path
from . import EnginePanel


class LODESTONE_RENDER_PT_film(EnginePanel, Panel):
    bl_label = "Film"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        render = context.scene.render
        layout.prop(render, "film_transparent", text="Transparent")
        layout.prop(render, "filter_size")


class LODESTONE_RENDER_PT_performance(EnginePanel, Panel):
    bl_label = "Performance"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        pass


class LODESTONE_RENDER_PT_performance_threads(EnginePanel, Panel):
    bl_label = "Threads"
    bl_parent_id = "LODESTONE_RENDER_PT_performance"
    bl_context = "render"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        render = context.scene.render
        column = layout.column()
        column.prop(render, "threads_mode")
        sub = column.column(align=True)
        sub.enabled = render.threads_mode == "FIXED"
        sub.prop(render, "threads")


class LODESTONE_RENDER_PT_scene_files(EnginePanel, Panel):
    bl_label = "Scene Files"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(context.scene.lodestone, "keep_scene_files", text="Keep")
        folder = store_path.scene_folder(store_path.store_folder(bpy.data.filepath))
        split = layout.split(factor=0.4)
        label = split.row()
        label.alignment = "RIGHT"
        label.label(text="Folder")
        split.label(text=str(folder))


_CLASSES = (
    LODESTONE_RENDER_PT_film,
    LODESTONE_RENDER_PT_performance,
    LODESTONE_RENDER_PT_performance_threads,
    LODESTONE_RENDER_PT_scene_files,
)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
