# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the selected objects what was decided about the active one."""

import bpy

from ..bridge import object_decisions
from .polled_operator import Polled


class LODESTONE_OT_copy_decisions(Polled, bpy.types.Operator):
    bl_idname = "lodestone.copy_decisions"
    bl_label = "Copy to Selected"
    bl_description = "Give the other selected objects this one's Use, Importance, Role and pins"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refused(cls, context):
        if context.object is None or len(context.selected_objects) < 2:
            return "Select other objects too"
        return ""

    def execute(self, context):
        linked = 0
        for item in context.selected_objects:
            if item.library is not None:
                linked += 1
            elif item != context.object:
                object_decisions.copy(context.object, item)
        if linked:
            self.report({"WARNING"}, f"{linked} linked objects keep what their library decides")
        return {"FINISHED"}


_CLASSES = (LODESTONE_OT_copy_decisions,)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
