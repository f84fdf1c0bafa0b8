# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets a control of quality back to what it inherits."""

import bpy
from bpy.props import StringProperty

from ..bridge import quality_settings
from ..core.picture import quality_tree
from .polled_operator import Polled


class LODESTONE_OT_inherit_control(Polled, bpy.types.Operator):
    bl_idname = "lodestone.inherit_control"
    bl_label = "Inherit"
    bl_description = "Take the value from Pixel Error again"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    key: StringProperty(options={"HIDDEN"})  # "": all of them

    @classmethod
    def refused(cls, context):
        if not quality_settings.overrides(context.scene.lodestone):
            return "Everything inherits already"
        return ""

    def execute(self, context):
        keys = [self.key] if self.key else list(quality_tree.CONTROL)
        if not set(keys) <= set(quality_tree.CONTROL):
            self.report({"ERROR"}, f'There is no control called "{self.key}"')
            return {"CANCELLED"}
        for key in keys:
            quality_settings.inherit(context.scene.lodestone, key)
        return {"FINISHED"}


_CLASSES = (LODESTONE_OT_inherit_control,)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
