# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in the window: what operators do beside the window, one at a time.

The scene is read by a render job of the extract engine, then a thread works; a timer watches both
and Esc stops each. Loading a file or disabling the add-on ends a run, the file as it was.
"""

import contextlib
import traceback

import bpy

from .. import handlers
from ..core import background_calls
from ..core.native import lodestone_native as native
from ..core.printable_text import sentence
from ..core.session.addon_session import addon_session
from ..engines import extract_engine, render_job

INTERVAL_S = 0.1
FAILURES = (native.LodestoneError, OSError, RuntimeError, UnicodeDecodeError)


class CurrentRun:
    """The run that is under way in the window; part of the session."""

    run = None


def _current():
    return addon_session().part(CurrentRun)


class WindowRun:
    """One run: what is read, how far the work is, and what has to be put back."""

    def __init__(self, request):
        self.request = request
        self.extraction = None
        self.work = background_calls.Work()
        self._outcome = {}
        self._thread = None
        self._reading = contextlib.ExitStack()

    def start_reading(self, context):
        """Starts the render job; raises RuntimeError when Blender refuses."""
        self._reading = _start_reading(context, self.request)

    def reading(self):
        """True while the render job runs; afterwards `extraction` is there. Raises what failed."""
        if self.extraction is not None:
            return False
        if render_job.runs():
            return True
        self._reading.close()
        if self.work.stopping:
            raise background_calls.Stopped
        if self.request.error is not None:
            raise self.request.error
        if self.request.extraction is None:
            raise background_calls.Stopped
        self.extraction = self.request.extraction
        self.was_read()
        return False

    def was_read(self):
        """Called once, when the extraction is there."""

    def start(self, function):
        """Calls it on a thread, which alone touches the model meanwhile."""
        self._thread = background_calls.start(function, self._outcome)

    def working(self):
        return self._thread is not None and self._thread.is_alive()

    def worked(self):
        """What the function returned; raises what it raised, Stopped when it was stopped."""
        return background_calls.finish(self._outcome, self.work.stopping)

    def stop(self):
        """Asks what runs to stop; reading() and worked() raise Stopped when it has."""
        self.request.tick = _raise_stopped
        self.work.stop()

    def busy(self):
        return render_job.runs() or self.working()

    def close(self, keep=False):
        """Puts everything back, but with `keep` what the run has written into the file."""
        self.work.stop()
        if self._thread is not None:
            self._thread.join()
        render_job.when_none_runs(self._put_back)

    def _put_back(self):
        self._reading.close()
        if self.request.extraction is not None:
            self.request.extraction.model.close()
        self.request.poses.close()


def current(kind=WindowRun):
    """The run that is under way, if it is one of this kind; else None."""
    run = _current().run
    return run if isinstance(run, kind) else None


def refusal():
    """The reason why no run can start now; "" when one can."""
    if _current().run is not None:
        return "Already running (Esc to cancel)"
    return "A render is running" if render_job.runs() else ""


class InWindow:
    """What operators do while a run is under way; no operator itself: Blender finds no methods
    of an operator that another one inherits. They have step(context, run), which returns what
    modal() is to return and may raise."""

    failures = FAILURES  # what is told without a traceback
    _timer = None

    def begin(self, context, run):
        """Starts to read the scene."""
        try:
            run.start_reading(context)
        except self.failures as error:
            run.close()
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        _current().run = run
        return self.watch(context)

    def watch(self, context):
        manager = context.window_manager
        self._timer = manager.event_timer_add(INTERVAL_S, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        run = _current().run
        if run is None:  # stopped from outside: a file was loaded, the add-on disabled
            return self.end(context, {"CANCELLED"})
        if event.type == "ESC" and event.value == "PRESS":
            return self.stop(context, run, None)
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            return self.step(context, run)
        except (*self.failures, background_calls.Stopped) as error:
            return self.stop(context, run, error)
        except Exception as error:
            traceback.print_exc()
            return self.stop(context, run, error)

    def stop(self, context, run, error):
        """Esc when there is no error: what runs is told to stop and waited for, the window stays
        usable meanwhile."""
        if error is None:
            run.stop()
            status(context, "Lodestone: stopping")
            if run.busy():
                return {"RUNNING_MODAL"}
        left = self.left_by(run)
        run.close()
        if error is not None and not isinstance(error, background_calls.Stopped):
            self.report({"ERROR"}, sentence(error))
        elif left:
            self.report({"INFO"}, left)
        return self.end(context, {"CANCELLED"})

    def left_by(self, run):
        """What a run that is stopped leaves behind, as a sentence; "" when that is nothing."""
        return ""

    def end(self, context, outcome):
        _current().run = None
        self.remove_timer(context)
        status(context, None)
        return outcome

    def remove_timer(self, context):
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None


def status(context, text):
    """In the status bar; None: what Blender shows there."""
    if context.workspace is not None:
        context.workspace.status_text_set(text)


def _start_reading(context, request):
    """Starts a render job that reads the scene for an extract_engine.Request; returns what to close
    afterwards."""
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


def _raise_stopped():
    raise background_calls.Stopped


def stop_running():
    """Ends a run from outside, leaving the file as it is."""
    run, _current().run = _current().run, None
    if run is None:
        return
    run.stop()
    run.close()


@bpy.app.handlers.persistent
def _on_load(*_):
    stop_running()


_HANDLERS = (("load_pre", _on_load),)


def register():
    handlers.add(_HANDLERS)


def unregister():
    stop_running()
    handlers.remove(_HANDLERS)
