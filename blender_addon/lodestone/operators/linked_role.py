# SPDX-License-Identifier: GPL-3.0-or-later
"""The role of what is linked from a library: kept in this file, by library path and
name."""

import bpy
from bpy.props import EnumProperty

from ..bridge import object_decisions
from ..properties.property_groups import ROLES


class LODESTONE_OT_linked_role(bpy.types.Operator):
    bl_idname = "lodestone.linked_role"
    bl_label = "Role Here"
    bl_description = (
        "What kind of thing this linked one is in this scene (Environment is wall, ground or sky); "
        "its library stays as it is"
    )
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    role: EnumProperty(
        name="Role",
        description="What kind of thing this is in this scene",
        items=(("LIBRARY", "As in Library", "As its library has it", 3), *ROLES),
        default="LIBRARY",
    )

    @classmethod
    def poll(cls, context):
        return _linked(context) is not None

    def execute(self, context):
        kind, item = _linked(context)
        role = None if self.role == "LIBRARY" else self.role
        object_decisions.decide_linked(context.scene, kind, item, role)
        return {"FINISHED"}


def _linked(context):
    """What the Properties editor shows, when it is linked: (kind, datablock)."""
    space = context.space_data
    shown = getattr(space, "context", "") if space is not None else ""
    if shown == "COLLECTION" and context.collection is not None:
        kind, item = "collection", context.collection
    else:
        kind, item = "object", context.object
    return (kind, item) if item is not None and item.library is not None else None


_CLASSES = (LODESTONE_OT_linked_role,)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
