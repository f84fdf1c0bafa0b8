# SPDX-License-Identifier: GPL-3.0-or-later
"""Selects an object that a panel names."""

import bpy
from bpy.props import StringProperty

from .polled import InObjectMode


def select_object(context, name):
    """Makes it the only selected and active object. False when the view layer has no such one."""
    found = context.view_layer.objects.get(name)
    if found is None or not found.visible_get():
        return False
    for other in context.selected_objects:
        other.select_set(False)
    found.select_set(True)
    context.view_layer.objects.active = found
    return True


class LODESTONE_OT_select_object(InObjectMode, bpy.types.Operator):
    bl_idname = "lodestone.select_object"
    bl_label = "Select"
    bl_description = "Object whose stand-in differs most on screen; click to select it"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    path: StringProperty(options={"HIDDEN"})

    def execute(self, context):
        # A path of placements: the innermost name that is an object here
        for name in reversed(self.path.split("/")):
            if select_object(context, name):
                return {"FINISHED"}
        self.report({"WARNING"}, f'"{self.path}" is not in this view layer')
        return {"CANCELLED"}


_CLASSES = (LODESTONE_OT_select_object,)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
