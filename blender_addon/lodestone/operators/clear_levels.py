# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear: removes what was computed, and what Update Levels wrote into the file."""

import bpy
from bpy.props import BoolProperty

from ..bridge import object_decisions
from ..core.session.addon_session import addon_session
from ..core.store import store_path
from .polled_operator import Polled


def clear_levels(with_decisions):
    """Removes the file's store and every uid, with_decisions roles too. Returns how many
    datablocks were cleared and whether there was a store. Raises OSError."""
    removed = addon_session().stores.remove(store_path.store_folder(bpy.data.filepath))
    local = [item for item in (*bpy.data.collections, *bpy.data.objects) if not item.library]
    cleared = sum(object_decisions.forget(item, with_decisions) for item in local)
    for scene in bpy.data.scenes:
        if not scene.library:
            if with_decisions:
                cleared += object_decisions.forget_linked(scene)
            object_decisions.drop_empty(scene)
    addon_session().renders.clear()
    return cleared, removed


class LODESTONE_OT_clear_levels(Polled, bpy.types.Operator):
    bl_idname = "lodestone.clear_levels"
    bl_label = "Clear"
    bl_description = (
        "Remove all generated levels of this file. Your own decisions stay unless you hold Shift"
    )
    bl_options = {"REGISTER", "UNDO"}

    decisions: BoolProperty(
        name="Also Decisions",
        description="Remove roles as well",
        default=False,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def refused(cls, context):
        return "A render is running" if bpy.app.is_job_running("RENDER") else ""

    def invoke(self, context, event):
        self.decisions = event.shift
        return self.execute(context)

    def execute(self, context):
        try:
            cleared, removed = clear_levels(self.decisions)
        except OSError as error:
            self.report({"ERROR"}, f"The levels cannot be removed: {error}")
            return {"CANCELLED"}
        if not cleared and not removed:
            self.report({"INFO"}, "No levels to clear")
            return {"CANCELLED"}
        self.report({"INFO"}, "Levels cleared")
        return {"FINISHED"}


_CLASSES = (LODESTONE_OT_clear_levels,)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
