# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Scene: finds what a render would report, without rendering."""

import bpy

from .. import handlers, preferences
from ..bridge import datablock_ids, ignored_problems
from ..bridge.checks import picture_requirements, scene_check
from ..core import problem_causes
from ..core.native import lodestone_native as native
from ..core.printable_text import sentence
from ..core.problems import Problems
from ..core.session.addon_session import addon_session
from ..core.store import store_path
from .polled_operator import Polled


def check_scene(context):
    """Checks the context's scene as its view layer shows it; the panels show the result."""
    problems, scene = Problems(), context.scene
    picture_requirements.povray(preferences.povray_program(), problems)
    picture_requirements.folder(store_path.store_folder(bpy.data.filepath), problems)
    picture_requirements.names(bpy.data, problems)
    picture_requirements.libraries(bpy.data.libraries, bpy.data.filepath, problems)
    depsgraph = context.evaluated_depsgraph_get()
    found = scene_check.check(scene, context.view_layer, depsgraph, problems)
    addon_session().checks[datablock_ids.name_of(scene)] = found
    return found


class LODESTONE_OT_check_scene(Polled, bpy.types.Operator):
    bl_idname = "lodestone.check_scene"
    bl_label = "Check Scene"
    bl_description = "Find what a render would report, without rendering"
    bl_options = {"REGISTER"}

    @classmethod
    def refused(cls, context):
        if context.scene is None:
            return "There is no scene"
        if bpy.app.is_job_running("RENDER"):
            return "A render is running; it checks the scene as well"
        return ""

    def execute(self, context):
        try:
            found = check_scene(context)
        except native.LodestoneError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except UnicodeDecodeError as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        self.report(
            {"INFO"}, problem_causes.headline(found.split(ignored_problems.keys(context.scene)))
        )
        for area in context.screen.areas if context.screen else ():
            if area.type == "PROPERTIES":
                area.tag_redraw()
        return {"FINISHED"}


_CLASSES = (LODESTONE_OT_check_scene,)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


@bpy.app.handlers.persistent
def _on_load(*_):
    addon_session().checks.clear()
    addon_session().renders.clear()


_HANDLERS = (("load_pre", _on_load),)


def register():
    _register()
    handlers.add(_HANDLERS)


def unregister():
    handlers.remove(_HANDLERS)
    _unregister()
