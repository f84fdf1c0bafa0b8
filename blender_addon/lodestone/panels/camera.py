# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Data of a camera > Depth of Field."""

import bpy
from bpy.types import Panel

from . import EnginePanel


class LODESTONE_CAMERA_PT_dof(EnginePanel, Panel):
    bl_label = "Depth of Field"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}
    shows = "camera"

    def draw_header(self, context):
        self.layout.prop(context.camera.dof, "use_dof", text="")

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        dof = context.camera.dof
        layout.active = dof.use_dof
        column = layout.column()
        column.prop(dof, "focus_object", text="Focus on Object")
        if dof.focus_object is not None and dof.focus_object.type == "ARMATURE":
            bones = dof.focus_object.data
            column.prop_search(dof, "focus_subtarget", bones, "bones", text="Focus on Bone")
        sub = column.column()
        sub.active = dof.focus_object is None
        sub.prop(dof, "focus_distance", text="Focus Distance")


class LODESTONE_CAMERA_PT_dof_aperture(EnginePanel, Panel):
    bl_label = "Aperture"
    bl_parent_id = "LODESTONE_CAMERA_PT_dof"
    bl_context = "data"
    shows = "camera"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        dof = context.camera.dof
        layout.active = dof.use_dof
        layout.prop(dof, "aperture_fstop")


_CLASSES = (LODESTONE_CAMERA_PT_dof, LODESTONE_CAMERA_PT_dof_aperture)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
