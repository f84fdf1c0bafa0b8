# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows levels in a viewport, or what it showed before."""

import bpy

from ..core.session.addon_session import addon_session
from ..viewport import levels_preview
from .polled_operator import Polled


class ShadingBefore(dict):
    """The shading by area, for as long as the window is open; part of the session."""


class LODESTONE_OT_show_levels(Polled, bpy.types.Operator):
    bl_idname = "lodestone.show_levels"
    bl_label = "Show Levels"
    bl_description = (
        "Draw levels instead of originals in this viewport (its Rendered shading). Nothing in the "
        "file changes and renders are not affected"
    )

    @classmethod
    def refused(cls, context):
        if context.space_data is None or context.space_data.type != "VIEW_3D":
            return "Point at a 3D Viewport"
        if context.scene.render.engine != levels_preview.ENGINE:
            return "Choose the render engine Lodestone POV-Ray"
        return ""

    def execute(self, context):
        before = addon_session().part(ShadingBefore)
        shading, key = context.space_data.shading, context.area.as_pointer()
        if shading.type == "RENDERED":
            shading.type = before.pop(key, "SOLID")
        else:
            before[key] = shading.type
            shading.type = "RENDERED"
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((LODESTONE_OT_show_levels,))
