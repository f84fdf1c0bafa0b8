# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of Detail > Overrides: the controls that take their value from Pixel Error."""

import bpy
from bpy.types import Panel

from ..bridge import quality_settings
from ..core.picture import quality_tree
from . import EnginePanel


class LODESTONE_RENDER_PT_overrides(EnginePanel, Panel):
    bl_label = "Overrides"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context):
        if quality_settings.overrides(context.scene.lodestone):
            row = self.layout.row()
            row.operator("lodestone.inherit_control", text="", icon="LOOP_BACK", emboss=False)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.lodestone
        own = quality_settings.overrides(settings)
        column = layout.column(align=True)
        for control in quality_tree.CONTROLS:
            draw_control(column, settings, control, control.key in own)


def draw_control(column, settings, control, overridden):
    """Gray while it inherits; with a button that sets it back where it does not."""
    row = column.row(align=True)
    field = row.row(align=True)
    field.active = overridden
    below = control.parent != quality_tree.ROOT
    label = f"- {control.label}" if below else control.label
    if control.least is None and not overridden:
        _draw_inherited_word(field, settings, control.key, label)
    else:
        field.prop(settings, control.key, text=label)
    if overridden:
        back = row.operator("lodestone.inherit_control", text="", icon="LOOP_BACK")
        back.key = control.key
    else:
        row.label(text="", icon="BLANK1")


def _draw_inherited_word(field, settings, key, label):
    """A menu that shows what it inherits, as the numbers do."""
    split = field.split(factor=0.4, align=True)
    name = split.row()
    name.alignment = "RIGHT"
    name.label(text=label)
    split.prop_menu_enum(settings, key, text=quality_settings.inherited_word(settings, key))


register, unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_overrides,))
