# SPDX-License-Identifier: GPL-3.0-or-later
"""Render engine Lodestone POV-Ray: F12, and `blender -b FILE --addons lodestone -E
LODESTONE_POVRAY -f 1`.

Failure is never a black picture: an error report before any result makes Blender keep the old file
and exit with 1; error_set() or an escaping exception would save black and exit with 0.
"""

import time
import traceback

import bpy

from . import preferences
from .bridge import camera, picture, scene
from .core import last_render, progress, store_path
from .core.native import lodestone_native as native
from .core.picture import SceneFolder, Settings, make_picture
from .core.work import Stopped, Work
from .extract_engine import NO_CAMERA

# Where each stage starts on the progress bar, and how much of it it takes
_SHARES = {"Levels": (0.0, 0.4), "Export": (0.4, 0.1), "Parse": (0.5, 0.5), "Trace": (0.5, 0.5)}


class Refused(Exception):
    """The picture cannot be made; the text tells the user why and what to do."""


class LODESTONE_RE_povray(bpy.types.RenderEngine):
    bl_idname = "LODESTONE_POVRAY"
    bl_label = "Lodestone POV-Ray"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update(self, data, depsgraph):
        self.lodestone_blend = data.filepath  # bpy.data is out of bounds inside render()

    def render(self, depsgraph):
        try:
            _Run(self, depsgraph).render()
        except Stopped:
            pass
        except (Refused, native.LodestoneError) as error:
            self.report({"ERROR"}, str(error))
        except Exception as error:
            traceback.print_exc()
            self.report({"ERROR"}, f"Lodestone failed: {error!r} (see the console)")


class _Run:
    """One call of render(): one view layer of one frame."""

    def __init__(self, engine, depsgraph):
        self.engine = engine
        self.depsgraph = depsgraph
        self.scene = depsgraph.scene_eval
        settings = depsgraph.scene.lodestone  # of the original: writing them tags nothing
        self.keep = settings.keep_scene_files
        self.store = store_path.store_folder(getattr(engine, "lodestone_blend", ""))
        self.settings = Settings(
            pixel_error=settings.pixel_error_render,
            antialias=native.Antialias[settings.antialias],
            threads=self.scene.render.threads if self.scene.render.threads_mode == "FIXED" else 0,
            program=preferences.povray_program(),
        )
        self.work = Work()
        self.clock = progress.StageClock(self.scene.frame_current)
        self._shown = ""

    def render(self):
        camera_object = self.engine.camera_override or self.scene.camera
        if camera_object is None or camera_object.type != "CAMERA":
            raise Refused(NO_CAMERA.format(self.scene.name))
        frame = camera.Frame.of(self.scene.render)
        extraction = scene.extract(self.depsgraph, self._tick)
        problems = extraction.problems
        with extraction.model as model:
            totals = model.totals()
            if totals.occurrences == 0:
                raise Refused("Nothing to render: no object with faces is visible in renders")
            triangles = progress.count(totals.triangles_placed)
            self.clock.tail = f"{triangles} triangles"
            view = camera.extract(camera_object, frame, problems)
            size = (frame.width, frame.height)
            made, image = self.work.run(lambda: self._make(model, view, size), self._poll)
            problems.extend_native(model.problems())
        self._remember(totals, made, problems)
        part = picture.cropped(image, *picture.border(self.scene.render, *size))
        picture.hand_over(self.engine, self.depsgraph.view_layer_eval.name, part)
        self._report(problems)

    def _make(self, model, view, size):
        """On the worker's thread: no bpy in here."""
        if self.settings.pixel_error > 0.0:
            try:
                self.store.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise Refused(f"Cannot make the folder for the levels: {error}") from None
            model.build(str(self.store), native.BuildOptions(), self.work.new_job("Levels"))
        try:
            with SceneFolder(store_path.scene_folder(self.store), self.keep) as folder:
                made = make_picture(
                    model, view, size, self.settings, folder.path, self.work.new_job
                )
                return made, picture.read(str(made.path))
        except OSError as error:
            raise Refused(f"Cannot write the scene for POV-Ray: {error}") from None

    # ---- Progress ----

    def _tick(self):
        """Between two meshes of the extraction."""
        if self.engine.test_break():
            raise Stopped
        self._show(self.clock.line("Extract", time.monotonic()))

    def _poll(self):
        if self.engine.test_break():
            self.work.stop()
        stage, fraction = self.work.stage, self.work.fraction
        if self.work.library_stage == native.Stage.PARSE:
            stage = "Parse"
        start, share = _SHARES.get(stage, (0.0, 0.0))
        self.engine.update_progress(start + share * fraction)
        self._show(self.clock.line(stage, time.monotonic(), fraction))

    def _show(self, line):
        if line != self._shown:  # without a window each one is a line on the console
            self._shown = line
            self.engine.update_stats("", line)

    # ---- Afterwards ----

    def _remember(self, totals, made, problems):
        cut = made.parts["cut"]
        last_render.put(
            self.scene.name,
            last_render.LastRender(
                totals.triangles_placed,
                cut["triangles"],
                cut["kinds"],
                cut["largest_error_px"],
                cut["largest_error_name"],
                made.in_use,
                tuple(problems),
            ),
        )

    def _report(self, problems):
        for problem in problems:
            print(f"Lodestone: {problem.severity}: {problem.sentence}")
        wrong = problems.wrong
        if wrong:
            more = f" (and {len(wrong) - 1} more, see the console)" if len(wrong) > 1 else ""
            self.engine.report({"WARNING"}, f"The picture is incomplete: {wrong[0].sentence}{more}")


_register, _unregister = bpy.utils.register_classes_factory((LODESTONE_RE_povray,))


def register():
    _register()


def unregister():
    last_render.clear()
    _unregister()
