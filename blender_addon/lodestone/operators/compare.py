# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare: the frame by its originals, by its levels, and their difference, in three render slots.

No setting is touched: the engine is given a plan, of which the pictures are the steps. The
compositor alone, which would work on the difference, is off while that is shown.
"""

import contextlib
import shutil
import tempfile
from pathlib import Path

import bpy

from .. import handlers
from ..bridge import quality_settings
from ..bridge.scene_settings import SceneSettings
from ..core import progress_text
from ..core.picture import compare_plan
from ..core.session.addon_session import addon_session
from ..engines import render_engine
from . import window_run
from .polled_operator import Polled

SLOTS = 3
_INTERVAL_S = 0.1


class NotMade(Exception):
    """A picture was cancelled or failed; what failed was reported by the engine."""


class Comparing:
    """One run. `close()` puts everything back, in any state."""

    def __init__(self, scene):
        self.scene = scene.name
        self._folder = Path(tempfile.mkdtemp(prefix="lodestone-compare-"))
        self.plan = compare_plan.Plan(
            self._folder, quality_settings.pixel_error(SceneSettings(scene))
        )
        self._step = contextlib.ExitStack()
        slots = _slots()
        self._slot = slots.active_index if slots is not None else 0
        self._done = False
        self._handed = contextlib.ExitStack()
        self._handed.enter_context(render_engine.comparing(self.plan))

    @property
    def _scene(self):
        return bpy.data.scenes[self.scene]

    def render(self, step, how=()):
        """The picture of one step, into its slot."""
        self.plan.step = step
        slots = _slots()
        if slots is not None:
            while len(slots) < SLOTS:
                slots.new()
            slots.active_index = step
        elif step == compare_plan.ORIGINALS:
            self._slot = 0  # Blender's first picture of all
        if step == compare_plan.DIFFERENCE:
            render = self._scene.render
            self._step.callback(setattr, render, "use_compositing", render.use_compositing)
            render.use_compositing = False
        bpy.ops.render.render(*how, scene=self.scene)

    def rendered(self):
        """After each render. Raises NotMade."""
        self._step.close()
        if not self.plan.finished_step:
            raise NotMade

    def pause(self):
        """Puts back the settings that are another for the step, until the next one."""
        self._step.close()

    def finish(self):
        """Of the last step: the Comparison, also for the panel."""
        self._done = True
        addon_session().comparisons[self.scene] = self.plan.comparison
        return self.plan.comparison

    def close(self):
        self._handed.close()
        try:
            self._step.close()
        except ReferenceError:  # the scene is gone, with its settings
            pass
        slots = _slots()
        if not self._done and slots is not None and self._slot < len(slots):
            slots.active_index = self._slot
        shutil.rmtree(self._folder, ignore_errors=True)


def _slots():
    result = bpy.data.images.get("Render Result")
    return None if result is None else result.render_slots


def compare(scene):
    """Synchronously, for scripts and batch jobs. Returns the Comparison; raises NotMade, or the
    RuntimeError that Blender makes of an engine's report."""
    run = Comparing(scene)
    try:
        for step in range(SLOTS):
            run.render(step)
            run.rendered()
        return run.finish()
    finally:
        run.close()


def refusal(context):
    """Why nothing can be compared now; "" when it can."""
    scene = context.scene
    if scene.render.engine != render_engine.LODESTONE_RE_povray.bl_idname:
        return "Set the render engine to Lodestone POV-Ray"
    if scene.camera is None:
        return "Set a scene camera"
    settings = SceneSettings(scene)
    if not settings.use_levels:
        return "Levels of Detail are off: there is nothing to compare"
    if quality_settings.is_exact(settings):
        return "Pixel Error 0 renders the originals: there is nothing to compare"
    if scene.render.use_sequencer and scene.sequence_editor and scene.sequence_editor.sequences:
        return "The sequencer makes this scene's picture: turn it off in Output > Post Processing"
    if render_engine.is_comparing():
        return "Already running (Esc to cancel)"
    return window_run.refusal()


class RunningComparison:
    """The comparison that runs in the window; part of the session."""

    run = None

    def close(self):
        """Ends it, leaving everything as it was."""
        run, self.run = self.run, None
        if run is not None:
            run.close()


def _running():
    return addon_session().part(RunningComparison)


class LODESTONE_OT_compare(Polled, bpy.types.Operator):
    bl_idname = "lodestone.compare"
    bl_label = "Compare Levels"
    bl_description = (
        "Render the originals into slot 1 and the levels into slot 2, of the border only where "
        "there is one, and show their difference in slot 3: black where there is none, then blue "
        "(2 %), green (5 %), yellow (10 %) and red. Numbers are in Levels of Detail > Comparison"
    )
    bl_options = {"REGISTER"}

    _timer = None

    @classmethod
    def refused(cls, context):
        return refusal(context)

    def execute(self, context):
        try:
            found = compare(context.scene)
        except NotMade:
            self.report({"ERROR"}, "A picture could not be made: see Problems")
            return {"CANCELLED"}
        except (OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error).strip())
            return {"CANCELLED"}
        self.report({"INFO"}, found.sentence)
        return {"FINISHED"}

    def invoke(self, context, event):
        try:
            run = _running().run = Comparing(context.scene)
            run.render(0, ("INVOKE_DEFAULT",))
        except (OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error).strip())
            return self._end(context, {"CANCELLED"})
        manager = context.window_manager
        self._timer = manager.event_timer_add(_INTERVAL_S, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        run = _running().run
        if run is None:  # a file was loaded, the add-on disabled
            return self._end(context, {"CANCELLED"})
        # Esc reaches the render job, which then leaves no picture
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        step = run.plan.step
        if bpy.app.is_job_running("RENDER"):
            word = compare_plan.WORDS[step]
            window_run.status(context, progress_text.comparing(step + 1, SLOTS, word))
            return {"PASS_THROUGH"}
        try:
            run.rendered()
            if step + 1 < SLOTS:
                run.render(step + 1, ("INVOKE_DEFAULT",))
                return {"PASS_THROUGH"}
            self.report({"INFO"}, run.finish().sentence)
            return self._end(context, {"FINISHED"})
        except NotMade:
            return self._end(context, {"CANCELLED"})
        except (OSError, RuntimeError, KeyError) as error:
            self.report({"ERROR"}, str(error).strip())
            return self._end(context, {"CANCELLED"})

    def _end(self, context, outcome):
        _running().close()
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        window_run.status(context, None)
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                if area.type in {"PROPERTIES", "IMAGE_EDITOR"}:
                    area.tag_redraw()
        return outcome


@bpy.app.handlers.persistent
def _on_load(*_):
    _running().close()
    addon_session().comparisons.clear()


@bpy.app.handlers.persistent
def _on_save(*_):
    """A file must not remember that the compositor is off for a moment."""
    run = _running().run
    if run is not None:
        run.pause()


def _draw_menu(self, context):
    self.layout.separator()
    self.layout.operator("lodestone.compare", icon="IMAGE_REFERENCE")


_HANDLERS = (("load_pre", _on_load), ("save_pre", _on_save))
_register, _unregister = bpy.utils.register_classes_factory((LODESTONE_OT_compare,))


def register():
    _register()
    bpy.types.TOPBAR_MT_render.append(_draw_menu)
    handlers.add(_HANDLERS)


def unregister():
    addon_session().drop(RunningComparison)
    handlers.remove(_HANDLERS)
    bpy.types.TOPBAR_MT_render.remove(_draw_menu)
    _unregister()
