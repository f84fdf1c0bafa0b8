# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Lodestone > Detail Lens: an Empty around which everything is drawn finer."""

import bpy
from bpy.props import EnumProperty, FloatProperty
from bpy.types import Menu, Operator
from bpy_extras.object_utils import AddObjectHelper

from ..bridge.scene.quality_lenses import DISPLAY, is_lens
from .polled_operator import InObjectMode, Polled

SHAPES = (
    ("SPHERE", "Sphere", "All directions alike", "SPHERE", 0),
    ("CUBE", "Box", "Scale it to a room or a street", "CUBE", 1),
)


def add_lens(context, shape, radius, strength, location, rotation=(0.0, 0.0, 0.0)):
    """The new Empty, active and alone selected."""
    made = bpy.data.objects.new("Detail Lens", None)
    made.empty_display_type = shape
    made.empty_display_size = radius
    made.location = location
    made.rotation_euler = rotation
    made.lodestone.lens.enabled = True
    made.lodestone.lens.strength = strength
    context.collection.objects.link(made)
    for other in context.selected_objects:
        other.select_set(False)
    made.select_set(True)
    context.view_layer.objects.active = made
    return made


class LODESTONE_OT_detail_lens_add(InObjectMode, AddObjectHelper, Operator):
    bl_idname = "lodestone.detail_lens_add"
    bl_label = "Detail Lens"
    bl_description = "Add an Empty in whose sphere or box everything is drawn finer"
    bl_options = {"REGISTER", "UNDO"}

    shape: EnumProperty(
        name="Shape", description="What is inside of it", items=SHAPES, default="SPHERE"
    )
    radius: FloatProperty(
        name="Radius",
        description="Of the sphere, or half of the box's sides",
        default=2.0,
        min=0.0,
        soft_max=1000.0,
        subtype="DISTANCE",
    )
    strength: FloatProperty(
        name="Strength",
        description="How many times finer what is in its middle is drawn",
        default=4.0,
        min=1.0 / 64.0,
        max=64.0,
    )

    @classmethod
    def refused(cls, context):
        if context.collection is None or context.collection.library is not None:
            return "The active collection is linked from a library"
        return super().refused(context)

    def execute(self, context):
        add_lens(
            context, self.shape, self.radius, self.strength, self.location, tuple(self.rotation)
        )
        return {"FINISHED"}


class LODESTONE_OT_detail_lens_enable(Polled, Operator):
    bl_idname = "lodestone.detail_lens_enable"
    bl_label = "Make Detail Lens"
    bl_description = "Use the selected Empties as detail lenses: arrows and the like become spheres"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refused(cls, context):
        if not _candidates(context):
            return "Select Empties that are no lenses yet"
        return ""

    def execute(self, context):
        for item in _candidates(context):
            if item.empty_display_type not in DISPLAY:
                item.empty_display_type = "SPHERE"
            item.lodestone.lens.enabled = True
        return {"FINISHED"}


def _candidates(context):
    chosen = {item.name: item for item in context.selected_objects}
    if context.object is not None:
        chosen[context.object.name] = context.object
    return [
        item
        for item in chosen.values()
        if item.type == "EMPTY" and item.library is None and not is_lens(item)
    ]


class LODESTONE_MT_add(Menu):
    bl_label = "Lodestone"

    def draw(self, context):
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        for key, name, _, icon, _ in SHAPES:
            text = f"Detail Lens ({name})"
            layout.operator("lodestone.detail_lens_add", text=text, icon=icon).shape = key


def _draw_add(self, context):
    self.layout.menu("LODESTONE_MT_add", icon="ZOOM_SELECTED")


_CLASSES = (LODESTONE_OT_detail_lens_add, LODESTONE_OT_detail_lens_enable, LODESTONE_MT_add)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


def register():
    _register()
    bpy.types.VIEW3D_MT_add.append(_draw_add)


def unregister():
    bpy.types.VIEW3D_MT_add.remove(_draw_add)
    _unregister()
