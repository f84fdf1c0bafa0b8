# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > World > Surface: color and strength of what surrounds the scene."""

import bpy
from bpy.types import Panel

from . import EnginePanel
from .node_drawing import draw_node


class LODESTONE_WORLD_PT_surface(EnginePanel, Panel):
    bl_label = "Surface"
    bl_context = "world"
    shows = "world"

    def draw(self, context):
        layout = self.layout
        world = context.world
        layout.prop(world, "use_nodes", icon="NODETREE")
        layout.separator()
        layout.use_property_split = True
        if world.use_nodes and world.node_tree is not None:
            draw_node(layout, world.node_tree, world.node_tree.get_output_node("ALL"), "Surface")
        else:
            layout.prop(world, "color")


register, unregister = bpy.utils.register_classes_factory((LODESTONE_WORLD_PT_surface,))
