# SPDX-License-Identifier: GPL-3.0-or-later
"""Update Levels: builds missing and changed levels; the window stays usable meanwhile.

In the window three steps follow each other, driven by a timer: the scene is read by a render job
of the extract engine, a dialog tells what would be built, a thread builds it. Esc stops each.
"""

import contextlib
import time
import traceback

import bpy
from bpy.props import BoolProperty

from .. import extract_engine
from ..bridge import decisions
from ..core import motion_file, progress, store_path, work
from ..core.native import lodestone_native as native
from ..core.text import sentence

UNDO_NAME = "Update Levels"
INTERVAL_S = 0.1


class NothingThere(Exception):
    """The scope holds nothing with faces that renders show."""


FAILURES = (native.LodestoneError, NothingThere, OSError, RuntimeError, UnicodeDecodeError)
_running = None  # the one session in the window


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
    keys = decisions.scope_keys(context, scope)
    changed = decisions.issue_uids(decisions.in_scope(context, scope))
    request = extract_engine.Request(still=motion_file.read(store), with_poses=True)
    try:
        extraction = extract_engine.extract_now(context.scene, request)
        with extraction.model as model:
            options = build_options(extraction, keys, request.poses)
            store.mkdir(parents=True, exist_ok=True)
            return model.build(str(store), options)
    except BaseException:
        decisions.take_back(changed)
        raise
    finally:
        request.poses.close()


def start_reading(context, request):
    """Starts a render job that reads the scene for an extract_engine.Request; returns what to close
    afterwards. Raises RuntimeError when Blender refuses."""
    preferences = context.preferences
    with contextlib.ExitStack() as stack:
        stack.enter_context(extract_engine.prepared(context.scene, request))
        view, dirty = preferences.view, preferences.is_dirty
        stack.callback(setattr, preferences, "is_dirty", dirty)
        stack.callback(setattr, view, "render_display_type", view.render_display_type)
        view.render_display_type = "NONE"
        result = bpy.data.images.get("Render Result")
        if result is not None and len(result.render_slots) > 1:  # the picture there must stay
            slots = result.render_slots
            stack.callback(setattr, slots, "active_index", slots.active_index)
            slots.active_index = (slots.active_index + 1) % len(slots)
        bpy.ops.render.render("INVOKE_DEFAULT")
        return stack.pop_all()


def running():
    """Whether an update runs in the window."""
    return _running is not None


class _Session:
    """One update in the window: what has to be put back, and how far it is."""

    def __init__(self, context, scope):
        self.store = store_path.store_folder(bpy.data.filepath)
        self.extraction = None
        self.estimate = None
        self.options = None
        still = motion_file.read(self.store)
        self.request = extract_engine.Request(still=still, with_poses=True)
        self._keys = decisions.scope_keys(context, scope)
        self.build = work.Work()
        self._outcome = {}
        self._thread = None
        self._reading = contextlib.ExitStack()
        self._changed = decisions.issue_uids(decisions.in_scope(context, scope))

    # ---- Reading ----

    def start_reading(self, context):
        """Starts the render job; raises RuntimeError when Blender refuses."""
        self._reading = start_reading(context, self.request)

    def reading(self):
        """True while the render job runs; afterwards its result is taken, or its error raised."""
        if bpy.app.is_job_running("RENDER"):
            return True
        self._reading.close()
        if self.build.stopping:
            raise work.Stopped
        if self.request.error is not None:
            raise self.request.error
        if self.request.extraction is None:
            raise work.Stopped
        self.extraction = self.request.extraction
        self.options = build_options(self.extraction, self._keys, self.request.poses)
        self.estimate = self.extraction.model.build_estimate(str(self.store), self.options)
        return False

    # ---- Building ----

    def start_building(self):
        self.store.mkdir(parents=True, exist_ok=True)
        model, store, job = self.extraction.model, str(self.store), self.build.new_job("Levels")
        options = self.options
        self._thread = work.start(lambda: model.build(store, options, job), self._outcome)

    def building(self):
        return self._thread is not None and self._thread.is_alive()

    def built(self):
        """The build report; raises what failed."""
        return work.finish(self._outcome, self.build.stopping)

    # ---- The end ----

    def stop(self):
        """Asks what runs to stop; reading() and built() raise Stopped when it has."""
        self.request.tick = _raise_stopped
        self.build.stop()

    def busy(self):
        return bpy.app.is_job_running("RENDER") or self.building()

    def close(self, keep):
        """Puts everything back; the uids stay when `keep`."""
        self.build.stop()
        if self._thread is not None:
            self._thread.join()
        self._reading.close()
        extraction = self.extraction or self.request.extraction
        if extraction is not None:
            extraction.model.close()
        self.request.poses.close()
        if not keep:
            decisions.take_back(self._changed)


class _InWindow:
    """What both operators do while a session runs; no operator itself: Blender does not find the
    methods of an operator that another one inherits."""

    _timer = None

    def begin(self, context):
        manager = context.window_manager
        self._timer = manager.event_timer_add(INTERVAL_S, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        session = _running
        if session is None:  # stopped from outside: a file was loaded, the add-on disabled
            return self.end(context, {"CANCELLED"})
        if event.type == "ESC" and event.value == "PRESS":
            return self.stop(context, session, None)
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            return self.step(context, session)
        except (*FAILURES, work.Stopped) as error:
            return self.stop(context, session, error)
        except Exception as error:
            traceback.print_exc()
            return self.stop(context, session, error)

    def watch_building(self, context, session):
        if session.building():
            total = session.estimate.built
            done = min(total, int(session.build.fraction * total))
            _status(context, progress.building(done, total))
            return {"PASS_THROUGH"}
        report = session.built()
        session.close(keep=True)
        outcome = self.end(context, {"FINISHED"})
        bpy.ops.ed.undo_push(message=UNDO_NAME)
        self.report({"INFO"}, summary(report))
        for area in context.screen.areas if context.screen else ():
            if area.type == "PROPERTIES":
                area.tag_redraw()
        return outcome

    def stop(self, context, session, error):
        """Esc when there is no error: what runs is told to stop and waited for, the window stays
        usable meanwhile."""
        if error is None:
            session.stop()
            _status(context, "Lodestone: stopping")
            if session.busy():
                return {"RUNNING_MODAL"}
        session.close(keep=False)
        if error is not None and not isinstance(error, work.Stopped):
            self.report({"ERROR"}, sentence(error))
        return self.end(context, {"CANCELLED"})

    def end(self, context, outcome):
        global _running
        _running = None
        self.remove_timer(context)
        _status(context, None)
        return outcome

    def remove_timer(self, context):
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None


class LODESTONE_OT_update_levels(_InWindow, bpy.types.Operator):
    bl_idname = "lodestone.update_levels"
    bl_label = "Update Levels"
    bl_description = (
        "Build missing and changed levels in the background. Originals, names and collections "
        "stay as they are"
    )
    bl_options = {"REGISTER"}

    confirm: BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        if _running is not None:
            cls.poll_message_set("Already running (Esc to cancel)")
            return False
        if bpy.app.is_job_running("RENDER"):
            cls.poll_message_set("A render is running")
            return False
        return context.scene is not None

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
        global _running
        session = _Session(context, context.scene.lodestone.scope)
        try:
            session.start_reading(context)
        except FAILURES as error:
            session.close(keep=False)
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        _running = session
        return self.begin(context)

    def step(self, context, session):
        if session.extraction is not None:
            return self.watch_building(context, session)
        if session.reading():
            if not session.build.stopping:
                _status(context, "Lodestone: reading the scene   [Esc] Cancel")
            return {"PASS_THROUGH"}
        if session.estimate.built == 0 or not self.confirm:
            session.start_building()
            return {"PASS_THROUGH"}
        _status(context, None)
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
        return _running is not None and _running.estimate is not None

    def invoke(self, context, event):
        return context.window_manager.invoke_props_dialog(self, width=320)

    def draw(self, context):
        estimate = _running.estimate if _running else None
        column = self.layout.column(align=True)
        if estimate is not None:
            column.label(text=f"{estimate.built:,} of {estimate.objects:,} objects and groups")
            column.label(text=f"{progress.count(estimate.triangles)} triangles to simplify")
            column.label(text=f"About {progress.clock(max(1.0, estimate.wall_s))} minutes")
            column.label(text=f"Into {_running.store}", icon="FILE_FOLDER")

    def execute(self, context):
        try:
            _running.start_building()
        except OSError as error:
            return self.stop(context, _running, error)
        return self.begin(context)

    def cancel(self, context):
        if _running is not None:
            _running.close(keep=False)
            self.end(context, {"CANCELLED"})

    def step(self, context, session):
        return self.watch_building(context, session)


def summary(report):
    if report.built == 0:
        return "Nothing changed since the last build"
    return f"Built levels of {report.built:,} of {report.objects:,} objects and groups"


def _status(context, text):
    if context.workspace is not None:
        context.workspace.status_text_set(text)


def _raise_stopped():
    raise work.Stopped


def stop_running():
    """Stops a session from outside, leaving the file as it is."""
    global _running
    session, _running = _running, None
    if session is not None:
        session.stop()
        deadline = time.monotonic() + 10.0
        while bpy.app.is_job_running("RENDER") and time.monotonic() < deadline:
            time.sleep(0.05)
        session.close(keep=False)


@bpy.app.handlers.persistent
def _on_load(*_):
    stop_running()


_CLASSES = (LODESTONE_OT_update_levels, LODESTONE_OT_build_levels)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


def register():
    _register()
    bpy.app.handlers.load_pre.append(_on_load)


def unregister():
    stop_running()
    if _on_load in bpy.app.handlers.load_pre:
        bpy.app.handlers.load_pre.remove(_on_load)
    _unregister()
