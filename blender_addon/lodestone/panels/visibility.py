# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Object > Visibility > Ray Visibility: the rays POV-Ray can hide an object from."""

import bpy
from bpy.types import Panel

from ..bridge.scene import ray_visibility
from . import EnginePanel

_SEEN = {"MESH", "CURVE", "SURFACE", "FONT", "META", "CURVES", "POINTCLOUD"}


class LODESTONE_OBJECT_PT_ray_visibility(EnginePanel, Panel):
    bl_label = "Ray Visibility"
    bl_parent_id = "OBJECT_PT_visibility"
    bl_context = "object"
    shows = "object"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object.type in _SEEN

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        for switch in ray_visibility.SWITCHES:
            column.prop(context.object, switch.name, text=switch.label)


register, unregister = bpy.utils.register_classes_factory((LODESTONE_OBJECT_PT_ray_visibility,))
