# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the scene and keeps it with its levels, for false colors and explanations. Builds nothing.

The scene is read by a render job, a thread finds its levels; Esc stops either.
"""

import bpy

from .. import handlers
from ..bridge import quality_settings
from ..bridge.scene import quality_lenses
from ..bridge.scene_settings import SceneSettings
from ..core.native import lodestone_native as native
from ..core.picture.picture_maker import Settings
from ..core.printable_text import sentence
from ..core.session import kept_model
from ..core.store import motion_file, store_path
from ..core.store.store_levels import is_store
from ..engines import extract_engine
from . import window_run
from ..core.session.addon_session import addon_session
from .polled_operator import Polled

FAILURES = (*window_run.FAILURES, extract_engine.CameraMissing)


def request(store):
    still = motion_file.read(store)
    return extract_engine.Request(cameras=[("", None)], still=still, with_poses=True)


def make_kept(extraction, asked, store, pixel_error, frame, job=None):
    """The model with the levels that there are, as a Kept, which owns it from then on."""
    camera, size = asked.frames[0]
    view = Settings(pixel_error=pixel_error, modifiers=asked.modifiers[0]).view(camera, size)
    if is_store(store):
        options = native.BuildOptions(poses=asked.poses.models, view=view)
        options.share = 0.0
        extraction.model.build(str(store), options, job)
        native.release_meshes(extraction.model)
    return kept_model.Kept(extraction.model, view, extraction.parts, frame)


def read_levels(scene):
    """Synchronously. Returns the Kept; raises what failed."""
    store = store_path.store_folder(bpy.data.filepath)
    asked = request(store)
    try:
        extraction = extract_engine.extract_now(scene, asked)
        try:
            pixel_error = quality_settings.pixel_error(SceneSettings(scene))
            kept = make_kept(extraction, asked, store, pixel_error, scene.frame_current)
        except BaseException:
            extraction.model.close()
            raise
    finally:
        asked.poses.close()
    addon_session().kept_models.put(scene.name, kept)
    return kept


class Reading(window_run.WindowRun):
    """One reading in the window."""

    def __init__(self, scene):
        self._store = store_path.store_folder(bpy.data.filepath)
        self._scene = scene.name
        self._frame = scene.frame_current
        self._pixel_error = quality_settings.pixel_error(SceneSettings(scene))
        super().__init__(request(self._store))

    def was_read(self):
        job = self.work.new_job("Levels")
        self.start(
            lambda: make_kept(
                self.extraction, self.request, self._store, self._pixel_error, self._frame, job
            )
        )

    def finish(self):
        """Call when working() is False. Raises what failed."""
        kept = self.worked()
        self.request.extraction = None  # its model is the kept one's from now on
        addon_session().kept_models.put(self._scene, kept)
        return kept


class OfCamera(Polled):
    @classmethod
    def refused(cls, context):
        return window_run.refusal() if context.scene.camera else "Set a scene camera"


class LODESTONE_OT_read_levels(OfCamera, window_run.InWindow, bpy.types.Operator):
    bl_idname = "lodestone.read_levels"
    bl_label = "Read Scene"
    bl_description = (
        "Read the scene with the levels that there are, for false colors and explanations. Builds "
        "and changes nothing"
    )
    bl_options = {"REGISTER"}

    failures = FAILURES

    def execute(self, context):
        try:
            read_levels(context.scene)
        except FAILURES as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        redraw(context)
        return {"FINISHED"}

    def invoke(self, context, event):
        return self.begin(context, Reading(context.scene))

    def step(self, context, run):
        if run.reading() or run.working():
            window_run.status(context, "Lodestone: reading the scene   [Esc] Cancel")
            return {"PASS_THROUGH"}
        run.finish()
        run.close()
        redraw(context)
        return self.end(context, {"FINISHED"})


def redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"PROPERTIES", "VIEW_3D"}:
                area.tag_redraw()


@bpy.app.handlers.persistent
def _on_change(scene, depsgraph):
    """Cameras and lenses may move: they are those of the moment. Lights may where what is dark is
    as fine as the rest. Objects that move or change their shape make it out of date, materials do
    not."""
    own = SceneSettings(scene)
    lit = quality_settings.is_coarser_moving_dark(own)
    if any(_counts(update, lit) for update in depsgraph.updates):
        addon_session().kept_models.outdate()


def _counts(update, lit):
    """Whether it may change what a kept scene says. `lit`: lights do."""
    item = update.id
    if isinstance(item, (bpy.types.Light, bpy.types.World)):
        return lit
    if not isinstance(item, bpy.types.Object):
        return False
    if not (update.is_updated_transform or update.is_updated_geometry) or item.type == "CAMERA":
        return False
    if item.type == "LIGHT":
        return lit
    return item.instance_type != "NONE" or not quality_lenses.is_lens(item.original)


@bpy.app.handlers.persistent
def _on_undo(*_):
    addon_session().kept_models.outdate()


@bpy.app.handlers.persistent
def _on_load(*_):
    addon_session().kept_models.clear()


_HANDLERS = (
    ("depsgraph_update_post", _on_change),
    ("undo_post", _on_undo),
    ("redo_post", _on_undo),
    ("load_pre", _on_load),
)
_register, _unregister = bpy.utils.register_classes_factory((LODESTONE_OT_read_levels,))


def register():
    _register()
    handlers.add(_HANDLERS)


def unregister():
    handlers.remove(_HANDLERS)
    addon_session().kept_models.clear()
    _unregister()
