# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Data of a light: what POV-Ray is told of it, as Cycles lays it out."""

import bpy
from bpy.types import Panel

from . import EnginePanel


class LODESTONE_LIGHT_PT_light(EnginePanel, Panel):
    bl_label = "Light"
    bl_context = "data"
    shows = "light"

    def draw(self, context):
        layout = self.layout
        light = context.light
        layout.row().prop(light, "type", expand=True)
        layout.use_property_split = True
        column = layout.column()
        column.prop(light, "color")
        column.prop(light, "energy")
        column.separator()
        if light.type in {"POINT", "SPOT"}:
            column.prop(light, "shadow_soft_size", text="Radius")
        elif light.type == "SUN":
            column.prop(light, "angle")
        elif light.type == "AREA":
            column.prop(light, "shape", text="Shape")
            sub = column.column(align=True)
            if light.shape in {"SQUARE", "DISK"}:
                sub.prop(light, "size")
            else:
                sub.prop(light, "size", text="Size X")
                sub.prop(light, "size_y", text="Y")
        column.separator()
        column.prop(light, "use_shadow", text="Cast Shadow")
        cycles = getattr(light, "cycles", None)
        if (
            cycles is not None and not cycles.cast_shadow
        ):  # it counts as well: say why there is none
            column.prop(cycles, "cast_shadow", text="Cast Shadow in Cycles")


class LODESTONE_LIGHT_PT_beam_shape(EnginePanel, Panel):
    bl_label = "Beam Shape"
    bl_parent_id = "LODESTONE_LIGHT_PT_light"
    bl_context = "data"
    shows = "light"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light.type in {"SPOT", "AREA"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        light = context.light
        column = layout.column()
        if light.type == "AREA":
            column.prop(light, "spread", text="Spread")
        else:
            column.prop(light, "spot_size", text="Spot Size")
            column.prop(light, "spot_blend", text="Blend", slider=True)
            column.prop(light, "show_cone")


_CLASSES = (LODESTONE_LIGHT_PT_light, LODESTONE_LIGHT_PT_beam_shape)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
