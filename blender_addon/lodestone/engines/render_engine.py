# SPDX-License-Identifier: GPL-3.0-or-later
"""Render engine Lodestone POV-Ray: F12, and `blender -b FILE --addons lodestone -E
LODESTONE_POVRAY -f 1`.

Failure is never a black picture: an error report before any result makes Blender keep the old file
and exit with 1; error_set() or an escaping exception would save black and exit with 0.
"""

import atexit
import contextlib
import time
import traceback
from dataclasses import replace

import bpy

from .. import handlers, preferences
from ..bridge import ignored_problems, quality_settings, render_result
from ..bridge.checks import hidden_grease_pencil, picture_requirements
from ..bridge.datablock_ids import name_of
from ..bridge.motion import shutter_motion
from ..bridge.scene import deforming_poses, quality_lenses, scene_camera, scene_extraction
from ..bridge.scene_settings import SceneSettings
from ..core import egl_library, progress_text
from ..core.background_calls import Stopped, Work
from ..core.native import lodestone_native as native
from ..core.picture import compare_plan
from ..core.picture.picture_maker import Settings, make_identities, make_picture
from ..core.picture.render_folder import RenderFolder
from ..core.picture.watched_picture import WatchedPicture, watched
from ..core.printable_text import printable, sentence, valid
from ..core.problems import ERROR, Problems
from ..core.session import kept_model
from ..core.session.addon_session import addon_session, end_session
from ..core.session.last_check import Check
from ..core.session.last_render import LastRender
from ..core.store import motion_file, store_path
from ..viewport import levels_preview
from . import render_job, whole_panels

# Where each stage starts on the progress bar, and how much of it it takes
_SHARES = {"Levels": (0.0, 0.4), "Export": (0.4, 0.1), "Parse": (0.5, 0.5), "Trace": (0.5, 0.5)}
_SHARES["Coverage"] = (1.0, 0.0)
_leaving = False  # the add-on is disabled: what runs is to stop


class RenderState:
    """What is kept from one picture of a render to the next; part of the session."""

    def __init__(self):
        self.watched = not bpy.app.background  # somebody looks while a picture is drawn
        self.folder = RenderFolder(lasting=self.watched)
        self.poses = {}  # by scene and view layer
        self.plan = None  # of Compare Levels, whose steps the pictures are
        self.hidden_pencil = hidden_grease_pencil.HiddenGreasePencil()

    def end_render(self):
        """A render begins or is over: what was read may be another thing in the next one. Files
        that are written are not: their names are their content."""
        self.folder.end_render()
        for held in self.poses.values():
            held.close()
        self.poses.clear()

    def close(self):
        """Another file is opened, or it is the end."""
        self.end_render()
        self.folder.close()


@contextlib.contextmanager
def comparing(plan):
    """Pictures that are made meanwhile are steps of this comparison."""
    state = addon_session().part(RenderState)
    state.plan = plan
    try:
        yield
    finally:
        state.plan = None


def is_comparing():
    """Whether a comparison has pictures made."""
    return addon_session().part(RenderState).plan is not None


class Refused(Exception):
    """The picture cannot be made; the text tells the user why and what to do."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


class LODESTONE_RE_povray(bpy.types.RenderEngine):
    bl_idname = "LODESTONE_POVRAY"
    bl_label = "Lodestone POV-Ray"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update(self, data, depsgraph):
        with whole_panels.engine_works():
            self.lodestone_blend = data.filepath  # bpy.data is out of bounds inside render()
            self.lodestone_libraries = Problems()
            picture_requirements.names(data, self.lodestone_libraries)
            picture_requirements.libraries(data.libraries, data.filepath, self.lodestone_libraries)

    def view_update(self, context, depsgraph):
        levels_preview.update(self, context, depsgraph)

    def view_draw(self, context, depsgraph):
        levels_preview.draw(self, context, depsgraph)

    def render(self, depsgraph):
        with whole_panels.engine_works():
            _render(self, depsgraph)


def _render(engine, depsgraph):
    try:
        run = _Run(engine, depsgraph, addon_session().part(RenderState))
        if run.failed_before:
            return
        try:
            run.render()
        except Refused as error:
            run.fail(error.code, str(error))
        except native.LodestoneError as error:
            run.fail("picture_failed", str(error))
        except UnicodeDecodeError as error:
            run.fail("unreadable_name", sentence(error))
    except Stopped:
        pass
    except native.LodestoneError as error:  # the library itself is missing
        engine.report({"ERROR"}, str(error))
    except Exception as error:
        traceback.print_exc()
        engine.report({"ERROR"}, f"Lodestone failed: {error!r} (see the console)")


class _Run:
    """One call of render(): one view layer of one frame."""

    def __init__(self, engine, depsgraph, state):
        self.engine = engine
        self.state = state
        self.depsgraph = depsgraph
        self.scene = depsgraph.scene_eval
        addon_session().changed_shapes.reading()
        settings = SceneSettings(depsgraph.scene)  # of the original: writing them tags nothing
        self.keep, self.scene_settings = settings.keep_scene_files, settings
        self.build = "ALL" if engine.is_animation else settings.build_on_render
        self.left = 0  # objects and groups without levels
        self.store = store_path.store_folder(getattr(engine, "lodestone_blend", ""))
        self.settings = Settings(
            pixel_error=quality_settings.pixel_error(settings),
            overrides=quality_settings.overrides(settings),
            budget=quality_settings.budget(settings),
            threads=self.scene.render.threads if self.scene.render.threads_mode == "FIXED" else 0,
            program=preferences.povray_program(),
            filter_size=self.scene.render.filter_size,
            bakes=str(self.store),
            still=not engine.is_animation,
        )
        self.problems = Problems()
        self.problems.extend(getattr(engine, "lodestone_libraries", ()))
        self.ignored = ignored_problems.keys(depsgraph.scene)
        self.problems.extend(state.hidden_pencil.problems)
        self.users = {}
        self.poses = deforming_poses.Poses()
        self.plan = state.plan
        if self.plan is not None and self.plan.step == compare_plan.ORIGINALS:
            self.settings = self.settings.of_originals()
        self.work = Work()
        self.frame = self.scene.frame_current
        self.clock = progress_text.StageClock(self.frame)
        self.layer = ""
        self.picture = None  # a WatchedPicture, while POV-Ray may draw it
        self._shown = ""

    def render(self):
        self.layer = render_result.layer_of(self.depsgraph)
        if self.plan is not None and self.plan.step == compare_plan.DIFFERENCE:
            self._show_difference()
            return
        self._required()
        still = motion_file.read(self.store)
        levels = self.settings.levels  # else neither they nor groups are asked for
        if levels:
            self._read_poses(still)
        camera_object = self._required()  # as it is in this frame again
        frame = scene_camera.Frame.of(self.scene.render)
        # Compare tells things by their paths, which groups are a part of
        structured = levels or self.plan is not None
        extraction = scene_extraction.extract(
            self.depsgraph, self._tick, still, structured=structured, store=str(self.store)
        )
        self.problems.extend(extraction.problems)
        self.users = extraction.users
        with contextlib.ExitStack() as stack:
            model = stack.enter_context(extraction.model)
            totals = model.totals()
            shown = self.depsgraph.scene
            if totals.occurrences == 0 and not picture_requirements.something(shown, self.problems):
                raise Refused("nothing_to_render", picture_requirements.NOTHING)
            placed = totals.triangles_placed
            self.clock.tail = progress_text.triangles(placed, placed)
            closing = None
            if levels and quality_settings.is_coarser_moving_dark(self.scene_settings):
                closing = self._read_shutter(extraction, model, frame)
                camera_object = self._required()
            view = scene_camera.extract(camera_object, frame, self.problems)
            scene_camera.report_render(self.scene, self.problems)
            size = (frame.width, frame.height)
            left, bottom, *part = render_result.border(self.scene.render, *size)
            border = (left, size[1] - bottom - part[1], *part)
            modifiers = self._modifiers(extraction, camera_object, closing)
            self.settings = replace(self.settings, border=border, modifiers=modifiers)
            made, image = self._made_before_eyes(model, view, size, placed)
            self.problems.extend(made.problems)
            if levels and not self.engine.is_animation:
                native.release_meshes(model)
                stack.pop_all()
                kept = kept_model.Kept(
                    model, self.settings.view(view, size), extraction.parts, self.frame
                )
                addon_session().kept_models.put(name_of(self.scene), kept)
        self._remember(totals, made)
        self._hand_over(image)
        self._report()

    def _read_shutter(self, extraction, model, frame):
        """The camera as the shutter closes; tells the model where else things are then."""

        def seen():
            return scene_camera.extract(self._required(), frame, Problems())

        set_frame = self.engine.frame_set
        closing = shutter_motion.read(self.depsgraph, set_frame, extraction.moving, model, seen)
        self.scene = self.depsgraph.scene_eval
        return closing

    def _modifiers(self, extraction, camera_object, closing):
        objects = self.depsgraph.objects
        detail = quality_lenses.detail(objects, quality_lenses.parts_in(extraction), self.problems)
        made = quality_lenses.modifiers(self.scene_settings, detail, camera_object, closing)
        originals = self.plan is not None and self.plan.step == compare_plan.ORIGINALS
        return replace(made, ray_classes=0) if made is not None and originals else made

    def _read_poses(self, still):
        """Once for all frames of an animation. Moves the depsgraph to other frames and back."""
        key = (name_of(self.scene), name_of(self.depsgraph.view_layer_eval))
        if key not in self.state.poses:
            self.state.poses[key] = deforming_poses.read(
                self.depsgraph, self.engine.frame_set, still, self._tick
            )
            self.scene = self.depsgraph.scene_eval
        self.poses = self.state.poses[key]

    def _required(self):
        """The camera. What a picture cannot do without is looked for before hours of work."""
        lacking = Problems()
        found = self.engine.camera_override or picture_requirements.camera(self.scene, lacking)
        picture_requirements.povray(self.settings.program, lacking)
        if len(lacking):
            self.problems.extend(lacking)
            first = lacking.wrong[0]
            raise Refused(first.code, first.message)
        return found

    def _made_before_eyes(self, model, view, size, placed):
        """The picture and its image. What is drawn is shown meanwhile, and stays when it is
        stopped."""

        def chosen(triangles):
            self.clock.tail = progress_text.triangles(triangles, placed)

        def make():
            return self._make(model, view, size, chosen)

        if self.state.watched:
            self.picture = watched(self.settings.border)
        try:
            return self.work.run(make, self._poll)
        except Stopped:
            if self.picture is not None:
                self._show_drawn(WatchedPicture.rest)
            raise

    def _show_drawn(self, parts):
        """Shows some parts of the picture, `parts` of it. Who looks on is no reason to end a
        render: after a failure nothing more is shown of it."""
        try:
            depth = self.depsgraph.view_layer_eval.use_pass_z
            for part in parts(self.picture):
                render_result.show_part(self.engine, self.layer, part, depth)
        except Exception:
            print("Lodestone: the picture is not shown while it is drawn:")
            traceback.print_exc()
            self.picture = None

    def _make(self, model, view, size, chosen):
        """On the worker's thread: no bpy in here."""
        if self.settings.levels:
            try:
                self.store.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                text = f"Cannot make the folder for the levels: {error}"
                raise Refused("folder_unwritable", text) from None
            options = self._build_options(self.settings.view(view, size))
            self.left = model.build(str(self.store), options, self.work.new_job("Levels")).left
            if self.left == 0:
                addon_session().changed_shapes.settle()
        try:
            kept = store_path.scene_folder(self.store)
            costs = addon_session().costs.of(self.store)
            with self.state.folder.use(kept, self.keep, self.frame) as folder:
                live = None if self.picture is None else self.picture.live
                made = make_picture(
                    *(model, view, size, self.settings, folder.path, self.work.new_job, costs),
                    live=live,
                    chosen=chosen,
                )
                if self.plan is not None and not self.plan.has_this:
                    shown = make_identities(
                        model, view, size, self.settings, self.plan.folder, self.work.new_job
                    )
                    self.plan.take(made, *shown)
                return made, render_result.read(str(made.path), self.settings.border)
        except OSError as error:
            text = f"Cannot write the scene for POV-Ray: {error}"
            raise Refused("folder_unwritable", text) from None

    def _show_difference(self):
        """The third picture of Compare, of two that are there."""
        image = self.work.run(self.plan.compare, self._poll)
        left, bottom, *part = render_result.border(self.scene.render, image.width, image.height)
        part = render_result.cropped(image, left, bottom, *part)
        self._hand_over(part)

    def _hand_over(self, part):
        depth = self.depsgraph.view_layer_eval.use_pass_z
        render_result.hand_over(self.engine, self.layer, part, self.settings.stamp(), depth)

    def _build_options(self, view):
        """What property_groups.BUILD_ON_RENDER says."""
        view = None if self.build == "ALL" else view
        options = native.BuildOptions(poses=self.poses.models, view=view, of_one_frame=1)
        if self.build == "NONE":
            options.share = 0.0
        return options

    # ---- Progress ----

    def _tick(self):
        """Between two meshes of the extraction."""
        if self._stopped():
            raise Stopped
        self._show(self.clock.line("Extract", time.monotonic()))

    def _poll(self):
        if self._stopped():
            self.work.stop()
        stage, fraction, left = self.work.stage, self.work.fraction, None
        if self.work.library_stage == native.Stage.PARSE:
            stage = "Parse"
        start, share = _SHARES.get(stage, (0.0, 0.0))
        self.engine.update_progress(start + share * fraction)
        if self.picture is not None and stage == "Trace":
            fraction, left = self.picture.finished, self.picture.seconds_left()
            self._show_drawn(WatchedPicture.news)
        self._show(self.clock.line(stage, time.monotonic(), fraction, left))

    def _stopped(self):
        return _leaving or self.engine.test_break()

    def _show(self, line):
        if line != self._shown:  # without a window each one is a line on the console
            self._shown = line
            self.engine.update_stats("", line)

    # ---- Afterwards ----

    def _remember(self, totals, made):
        render = LastRender.of(made, totals.triangles_placed, self.left)
        addon_session().renders[name_of(self.scene)] = render

    @property
    def _this_frame(self):
        return (name_of(self.scene), self.scene.frame_current)

    @property
    def failed_before(self):
        """Another view layer of the frame did: one reason is told once, and there is no picture."""
        return getattr(self.engine, "lodestone_failed", None) == self._this_frame

    def _remember_check(self):
        """What was found, with what this frame's other view layers had, which is returned."""
        frame = self._this_frame
        before, problems, users = getattr(self.engine, "lodestone_found", (None, (), {}))
        problems = problems if before == frame else ()
        every = Problems()
        if before == frame:
            every.extend(problems)
            joined = {material: dict.fromkeys(shown) for material, shown in users.items()}
            for material, shown in self.users.items():
                joined.setdefault(material, {}).update(dict.fromkeys(shown))
            self.users = {material: tuple(shown) for material, shown in joined.items()}
        every.extend(self.problems)
        found = tuple(every)
        self.engine.lodestone_found = (frame, found, self.users)
        addon_session().checks[name_of(self.scene)] = Check(found, self.users)
        return problems

    def fail(self, code, text):
        """No picture: the reason is reported and stays in the panel."""
        self.problems.add("", ERROR, code, text)
        self._remember_check()
        self.engine.lodestone_failed = self._this_frame
        self.engine.report({"ERROR"}, valid(text))

    def _report(self):
        told = {problem.key for problem in self._remember_check()}
        for problem in self.problems:
            if problem.key not in told:
                print(f"Lodestone: {problem.severity}: {printable(problem.sentence)}")
        hidden = told | set(self.ignored)
        wrong = [problem for problem in self.problems.wrong if problem.key not in hidden]
        if wrong:
            more = f" (and {len(wrong) - 1} more, see the console)" if len(wrong) > 1 else ""
            self.engine.report({"WARNING"}, f"The picture is incomplete: {wrong[0].sentence}{more}")


@bpy.app.handlers.persistent
def _end_render(*_):
    addon_session().part(RenderState).end_render()


@bpy.app.handlers.persistent
def _forget(*_):
    addon_session().part(RenderState).close()


@bpy.app.handlers.persistent
def _hide_pencil(rendered, *_):
    """A picture begins: grease pencil is hidden while it is made, where drawing it ends Blender."""
    ours = rendered.render.engine == LODESTONE_RE_povray.bl_idname
    if ours and bpy.app.background and len(bpy.data.grease_pencils) and egl_library.missing():
        hidden = addon_session().part(RenderState).hidden_pencil
        hidden.hide(bpy.data, rendered, bpy.context.view_layer)


@bpy.app.handlers.persistent
def _show_pencil(*_):
    addon_session().part(RenderState).hidden_pencil.put_back()


_ENDS = ("render_complete", "render_cancel")
_HANDLERS = (
    ("load_pre", _forget),
    *((name, _end_render) for name in ("render_init", *_ENDS)),
    *whole_panels.HANDLERS,
    ("render_pre", _hide_pencil),
    *((name, _show_pencil) for name in ("render_post", *_ENDS)),
)
_register, _unregister = bpy.utils.register_classes_factory((LODESTONE_RE_povray,))


def register():
    global _leaving
    if render_job.take_back(_leave):
        state = addon_session().part(RenderState)
        state.folder.lasting = state.watched
    else:
        _register()
    _leaving = False
    handlers.add(_HANDLERS)
    atexit.register(_forget)


def unregister():
    global _leaving
    _leaving = True
    addon_session().part(RenderState).folder.lasting = False
    atexit.unregister(_forget)
    handlers.remove(_HANDLERS)
    render_job.when_none_runs(_leave)


def _leave():
    """No render runs any more that could use what is remembered."""
    end_session()
    _unregister()
