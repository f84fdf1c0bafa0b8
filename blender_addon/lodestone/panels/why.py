# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Object > Levels of Detail > Why This Level: the numbers a choice was made by."""

import bpy
from bpy.types import Panel

from ..bridge.live import kept_model_view
from ..core.native import lodestone_native as native
from ..core.session.addon_session import addon_session


class LODESTONE_OBJECT_PT_why(Panel):
    bl_label = "Why This Level"
    bl_parent_id = "LODESTONE_OBJECT_PT_levels"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"

    def draw(self, context):
        layout = self.layout
        scene = context.scene
        kept = addon_session().kept_models.get(scene.name)
        if kept is None:
            layout.label(text="Known after a picture or Read Scene")
            layout.operator("lodestone.read_levels", icon="FILE_REFRESH")
            return
        try:
            found = kept_model_view.explained(
                scene, context.evaluated_depsgraph_get(), context.object
            )
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
        if kept_model_view.old(kept, scene):
            row = layout.row()
            row.label(text="The scene has changed since", icon="INFO")
            row.operator("lodestone.read_levels", text="", icon="FILE_REFRESH")


register, unregister = bpy.utils.register_classes_factory((LODESTONE_OBJECT_PT_why,))
