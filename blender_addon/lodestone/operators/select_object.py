# SPDX-License-Identifier: GPL-3.0-or-later
"""Selects an object that a panel names."""

import bpy
from bpy.props import StringProperty

from .polled_operator import InObjectMode


_EMITTED = " instances"  # ends the name of the group of what an object's nodes or particles show


def at_path(view_layer, path):
    """The innermost object on a path of placements that can be seen by itself: an instance, where
    what it shows is only within it. None when there is no such one."""
    within, found = view_layer.objects, None
    left = path
    while left:
        name, item = _longest(within, left)
        if item is not None:
            if item.visible_get(view_layer=view_layer):
                found = item
            if item.instance_collection is not None:
                within = item.instance_collection.all_objects
        left = left[len(name) + 1 :]
    first = path.partition("/")[0]
    if found is None and first.endswith(_EMITTED):
        found = view_layer.objects.get(first[: -len(_EMITTED)])
    return found if found is not None and found.visible_get(view_layer=view_layer) else None


def _longest(objects, path):
    """(the longest name that the path begins with and that is one of the objects', it), for names
    may hold slashes; else (the first part, None)."""
    name = path
    while name:
        item = objects.get(name)
        if item is not None:
            return name, item
        name = name.rpartition("/")[0]
    return path.partition("/")[0], None


class LODESTONE_OT_select_object(InObjectMode, bpy.types.Operator):
    bl_idname = "lodestone.select_object"
    bl_label = "Select"
    bl_description = "Object whose stand-in differs most on screen; click to select it"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    path: StringProperty(options={"HIDDEN"})

    def execute(self, context):
        found = at_path(context.view_layer, self.path)
        if found is None:
            self.report({"WARNING"}, f'"{self.path}" is not in this view layer')
            return {"CANCELLED"}
        for other in context.selected_objects:
            other.select_set(False)
        found.select_set(True)
        context.view_layer.objects.active = found
        return {"FINISHED"}


_CLASSES = (LODESTONE_OT_select_object,)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
