# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Render > Sampling: how many samples POV-Ray takes in a pixel."""

import bpy
from bpy.types import Panel

from . import EnginePanel


class LODESTONE_RENDER_PT_sampling(EnginePanel, Panel):
    bl_label = "Sampling"
    bl_context = "render"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(context.scene.lodestone, "antialias")


register, unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_sampling,))
