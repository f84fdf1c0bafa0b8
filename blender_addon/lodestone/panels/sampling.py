# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Render > Sampling: how many samples POV-Ray takes in a pixel."""

import bpy
from bpy.types import Panel

from ..bridge import quality_settings
from ..core.picture import quality_tree
from . import EnginePanel
from .overrides import draw_control


class LODESTONE_RENDER_PT_sampling(EnginePanel, Panel):
    bl_label = "Sampling"
    bl_context = "render"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.lodestone
        control = quality_tree.CONTROL["antialias"]
        draw_control(layout, settings, control, settings.antialias != quality_settings.AUTOMATIC)


register, unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_sampling,))
