# SPDX-License-Identifier: GPL-3.0-or-later
"""Update Levels: builds missing and changed levels; the window stays usable meanwhile.

In the window the scene is read, a dialog tells what would be built, a thread builds it.
"""

import bpy
from bpy.props import BoolProperty

from ..bridge import object_decisions
from ..core import progress_text
from ..core.native import lodestone_native as native
from ..core.printable_text import sentence
from ..core.session.addon_session import addon_session
from ..core.store import motion_file, store_path
from ..engines import extract_engine
from . import window_run
from .polled_operator import Polled

UNDO_NAME = "Update Levels"
STOPPED = "Stopped. Finished levels are kept, but for those of about the last 20 seconds"


class NothingThere(Exception):
    """The scope holds nothing with faces that renders show."""


FAILURES = (*window_run.FAILURES, NothingThere)


def build_options(extraction, keys, poses):
    """For the datablocks of a scope (None: everything), and what they follow. Raises
    NothingThere."""
    scope = extraction.scope(keys)
    if keys is not None and not scope:
        raise NothingThere("Nothing to build: the scope holds nothing that renders show")
    return native.BuildOptions(scope=scope, poses=poses.models)


def update_levels(context, scope):
    """Reads, builds and writes the uids that are needed, synchronously; scope is SCENE, COLLECTION
    or SELECTED. Returns the build report; raises what failed, then nothing in the file has
    changed."""
    store = store_path.store_folder(bpy.data.filepath)
    keys = object_decisions.scope_keys(context, scope)
    changed = object_decisions.issue_uids(object_decisions.in_scope(context, scope))
    request = extract_engine.Request(still=motion_file.read(store), with_poses=True)
    try:
        extraction = extract_engine.extract_now(context.scene, request)
        with extraction.model as model:
            options = build_options(extraction, keys, request.poses)
            store.mkdir(parents=True, exist_ok=True)
            report = model.build(str(store), options)
            addon_session().changed_shapes.settle()
            return report
    except BaseException:
        object_decisions.take_back(changed)
        raise
    finally:
        request.poses.close()


class _Run(window_run.WindowRun):
    """One update in the window."""

    def __init__(self, context, scope):
        self.store = store_path.store_folder(bpy.data.filepath)
        still = motion_file.read(self.store)
        super().__init__(extract_engine.Request(still=still, with_poses=True))
        self.estimate = None
        self.options = None
        self.building = False
        self._keys = object_decisions.scope_keys(context, scope)
        self._changed = object_decisions.issue_uids(object_decisions.in_scope(context, scope))

    def was_read(self):
        self.options = build_options(self.extraction, self._keys, self.request.poses)
        self.estimate = self.extraction.model.build_estimate(str(self.store), self.options)

    def start_building(self):
        self.store.mkdir(parents=True, exist_ok=True)
        self.building = True
        model, store, job = self.extraction.model, str(self.store), self.work.new_job("Levels")
        options = self.options
        self.start(lambda: model.build(store, options, job))

    def close(self, keep=False):
        """The uids stay when `keep`."""
        super().close(keep)
        if not keep:
            object_decisions.take_back(self._changed)


class _InWindow(window_run.InWindow):
    """What both operators do while it builds."""

    failures = FAILURES

    def left_by(self, run):
        return STOPPED if run.building else ""

    def watch_building(self, context, run):
        if run.working():
            total = run.estimate.built
            done = min(total, int(run.work.fraction * total))
            window_run.status(context, progress_text.building(done, total))
            return {"PASS_THROUGH"}
        report = run.worked()
        addon_session().changed_shapes.settle()
        run.close(keep=True)
        outcome = self.end(context, {"FINISHED"})
        bpy.ops.ed.undo_push(message=UNDO_NAME)
        self.report({"INFO"}, summary(report))
        for area in context.screen.areas if context.screen else ():
            if area.type == "PROPERTIES":
                area.tag_redraw()
        return outcome


class LODESTONE_OT_update_levels(Polled, _InWindow, bpy.types.Operator):
    bl_idname = "lodestone.update_levels"
    bl_label = "Update Levels"
    bl_description = (
        "Build missing and changed levels in the background. Originals, names and collections "
        "stay as they are"
    )
    bl_options = {"REGISTER"}

    confirm: BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def refused(cls, context):
        return window_run.refusal() if context.scene else "There is no scene"

    def execute(self, context):
        try:
            report = update_levels(context, context.scene.lodestone.scope)
        except FAILURES as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        if not bpy.app.background:
            bpy.ops.ed.undo_push(message=UNDO_NAME)
        self.report({"INFO"}, summary(report))
        return {"FINISHED"}

    def invoke(self, context, event):
        return self.begin(context, _Run(context, context.scene.lodestone.scope))

    def step(self, context, run):
        if run.extraction is not None:
            return self.watch_building(context, run)
        if run.reading():
            if not run.work.stopping:
                window_run.status(context, "Lodestone: reading the scene   [Esc] Cancel")
            return {"PASS_THROUGH"}
        if run.estimate.built == 0 or not self.confirm:
            run.start_building()
            return {"PASS_THROUGH"}
        window_run.status(context, None)
        self.remove_timer(context)
        bpy.ops.lodestone.build_levels("INVOKE_DEFAULT")
        return {"FINISHED"}


class LODESTONE_OT_build_levels(_InWindow, bpy.types.Operator):
    bl_idname = "lodestone.build_levels"
    bl_label = "Update Levels"
    bl_description = "Build the levels that were found missing or changed"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context):
        run = window_run.current(_Run)
        return run is not None and run.estimate is not None

    def invoke(self, context, event):
        return context.window_manager.invoke_props_dialog(self, width=320)

    def draw(self, context):
        run = window_run.current(_Run)
        column = self.layout.column(align=True)
        if run is not None and run.estimate is not None:
            estimate = run.estimate
            column.label(text=f"{estimate.built:,} of {estimate.objects:,} objects and groups")
            column.label(text=f"{progress_text.count(estimate.triangles)} triangles to simplify")
            column.label(text=f"About {progress_text.clock(max(1.0, estimate.wall_s))} minutes")
            column.label(text=f"Into {run.store}", icon="FILE_FOLDER")

    def execute(self, context):
        run = window_run.current(_Run)
        try:
            run.start_building()
        except OSError as error:
            return self.stop(context, run, error)
        return self.watch(context)

    def cancel(self, context):
        run = window_run.current(_Run)
        if run is not None:
            run.close()
            self.end(context, {"CANCELLED"})

    def step(self, context, run):
        return self.watch_building(context, run)


def summary(report):
    if report.objects == 0:
        return "There is nothing here to build levels of"
    if report.built == 0:
        return "Nothing changed since the last build"
    return f"Built levels of {report.built:,} of {report.objects:,} objects and groups"


_CLASSES = (LODESTONE_OT_update_levels, LODESTONE_OT_build_levels)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
