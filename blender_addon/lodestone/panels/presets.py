# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the picture's quality, in the header of Levels of Detail: ours, and the user's own."""

import os

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel
from bpy.types import Operator, Panel

from ..bridge import quality_settings
from ..core.picture import quality_tree, unseen_detail

# Name: Pixel Error, from which everything else follows
PRESETS = {
    "DRAFT": ("Draft", 8.0),
    "PREVIEW": ("Preview", 2.0),
    "FINAL": ("Final", 1.0),
    "EXACT": ("Exact", 0.0),
}
_WORDS = {
    "DRAFT": "8 pixels, no antialiasing, sharp shadows: the fastest. Overrides are set back",
    "PREVIEW": "2 pixels: for judging light and composition. Overrides are set back",
    "FINAL": "1 pixel: differences are hard to see. Overrides are set back",
    "EXACT": "0: the originals, as slow as they are. Overrides are set back",
}
# What a preset of the user's own keeps
_KEPT = (
    "use_levels",
    "pixel_error_render",
    "pixel_error_viewport",
    "budget_render",
    "budget_viewport",
    "coarser_moving_dark",
    "off_screen",
    *(ray_class.key for ray_class in unseen_detail.CLASSES),
    "antialias",
    *(quality_settings.OWN + c.key for c in quality_tree.CONTROLS if c.least is not None),
)


class LODESTONE_OT_levels_preset(Operator):
    bl_idname = "lodestone.levels_preset"
    bl_label = "Levels Preset"
    bl_description = "Use this quality in renders"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    preset: bpy.props.EnumProperty(
        name="Preset",
        description="How coarse renders may be",
        items=[(key, name, _WORDS[key]) for key, (name, *_) in PRESETS.items()],
    )

    @classmethod
    def description(cls, context, properties):
        return _WORDS[properties.preset]

    def execute(self, context):
        settings = context.scene.lodestone
        settings.use_levels = True
        _, settings.pixel_error_render = PRESETS[self.preset]
        for control in quality_tree.CONTROLS:
            quality_settings.inherit(settings, control.key)
        return {"FINISHED"}


class LODESTONE_OT_levels_preset_add(AddPresetBase, Operator):
    bl_idname = "lodestone.levels_preset_add"
    bl_label = "Add Levels Preset"
    bl_description = "Add or remove a preset of your own"
    preset_menu = "LODESTONE_PT_levels_presets"
    preset_subdir = "lodestone/levels"
    preset_defines = ["settings = bpy.context.scene.lodestone"]
    preset_values = [f"settings.{name}" for name in _KEPT]


class LODESTONE_PT_levels_presets(PresetPanel, Panel):
    bl_label = "Levels of Detail Presets"
    preset_subdir = "lodestone/levels"
    preset_operator = "script.execute_preset"
    preset_add_operator = "lodestone.levels_preset_add"

    def draw(self, context):
        layout = self.layout
        layout.emboss = "PULLDOWN_MENU"
        for key, (name, *_) in PRESETS.items():
            layout.operator("lodestone.levels_preset", text=name).preset = key
        layout.separator()
        if bpy.utils.preset_paths(self.preset_subdir):
            super().draw(context)
        else:  # the user has none: only the row that adds one, not "Missing Paths"
            self.path_menu(
                [os.path.dirname(__file__)],
                self.preset_operator,
                filter_ext=lambda extension: False,
                add_operator=self.preset_add_operator,
            )


_CLASSES = (
    LODESTONE_OT_levels_preset,
    LODESTONE_OT_levels_preset_add,
    LODESTONE_PT_levels_presets,
)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
