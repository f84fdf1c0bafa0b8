# SPDX-License-Identifier: GPL-3.0-or-later
"""An engine that renders nothing: its render() only extracts, from the same depsgraph a picture
would be made from. Registered while it is used, so that users never meet it.
"""

import contextlib
import traceback

import bpy

from ..bridge import quality_settings
from ..bridge.checks import extraction_check
from ..bridge.checks.picture_requirements import NO_CAMERA
from ..bridge.datablock_ids import name_of
from ..bridge.motion import shutter_motion
from ..bridge.scene import deforming_poses, quality_lenses, scene_camera, scene_extraction
from ..bridge.scene_settings import SceneSettings
from ..core.background_calls import Stopped
from ..core.native import lodestone_native as native
from ..core.printable_text import sentence, valid
from ..core.problems import Problems
from ..core.session.addon_session import addon_session
from . import whole_panels


class Request:
    """What to extract; afterwards the result, or why there is none. One at a time.

    `cameras` are names of camera objects ("" for the scene's own) with the size of their picture
    (None for the scene's): their frames are in `frames` in the same order. `still`: what
    sample() found. `structured`, `store`: as extract() takes them. `with_poses`: also the `poses`
    that levels follow; close them when done.
    """

    def __init__(
        self,
        cameras=(),
        tick=None,
        compare=False,
        still=None,
        with_poses=False,
        structured=True,
        store="",
    ):
        self.cameras = tuple(cameras)
        self.tick = tick or (lambda: None)
        self.compare = compare
        self.still = still
        self.with_poses = with_poses
        self.structured = structured
        self.store = store
        self.poses = deforming_poses.Poses()
        self.without_camera = False  # the scene has none; it renders with a stand-in
        self.extraction = None
        self.frames = []
        self.modifiers = []  # of each camera; None: nothing bends quality there
        self.differences = []
        self.error = None


class ExtractState:
    """The extraction that runs; part of the session."""

    request = None


class LODESTONE_RE_extract(bpy.types.RenderEngine):
    bl_idname = "LODESTONE_EXTRACT"
    bl_label = "Lodestone (reading the scene)"
    bl_use_preview = False

    def render(self, depsgraph):
        with whole_panels.engine_works():
            self._read(depsgraph)

    def _read(self, depsgraph):
        request = addon_session().part(ExtractState).request
        if request is None or request.extraction is not None or request.error is not None:
            return  # further view layers: the first one counts

        def tick():
            if self.test_break():
                raise Stopped
            request.tick()

        try:
            tick()  # it may have been stopped while Blender made the scene ready
            if request.with_poses:
                request.poses = deforming_poses.read(depsgraph, self.frame_set, request.still, tick)
            extraction = scene_extraction.extract(
                depsgraph, tick, request.still, request.structured, request.store
            )
            try:
                for name, size in request.cameras:
                    if not name and request.without_camera:
                        raise CameraMissing(NO_CAMERA.format(name_of(depsgraph.scene_eval)))
                    request.frames.append(_frame(depsgraph, name, size, extraction.problems))
                if request.cameras:
                    request.modifiers = _modifiers(depsgraph, self.frame_set, request, extraction)
                if request.compare:
                    request.differences = extraction_check.compare_occurrences(
                        depsgraph, extraction
                    )
            except BaseException:
                extraction.model.close()
                raise
            request.extraction = extraction
        except UnicodeDecodeError as error:
            request.error = native.LodestoneError(native.Status.BAD_FILE, sentence(error))
        except Exception as error:
            # When the add-on is disabled meanwhile, the settings go first that are read here
            if not isinstance(error, (Stopped, CameraMissing)) and not _is_stopped(tick):
                traceback.print_exc()
            request.error = error


def _is_stopped(tick):
    try:
        tick()
    except Stopped:
        return True
    return False


class CameraMissing(Exception):
    """A picture was asked for without a camera; the text says what to do."""


def _frame(depsgraph, name, size, problems):
    """(camera, (width, height)) of one picture."""
    evaluated = depsgraph.scene_eval
    found = _camera(depsgraph, name)
    frame = scene_camera.Frame.of(evaluated.render)
    if size is not None:
        frame = scene_camera.Frame(size[0], size[1], frame.aspect_x, frame.aspect_y)
    scene_camera.report_render(evaluated, problems)
    return scene_camera.extract(found, frame, problems), (frame.width, frame.height)


def _camera(depsgraph, name):
    """The evaluated camera object; raises CameraMissing."""
    evaluated = depsgraph.scene_eval
    found = evaluated.camera
    if name:  # not by get(), which crashes Blender over a name that is no UTF-8
        found = next((item for item in evaluated.objects if name_of(item) == name), None)
    if found is None or found.type != "CAMERA":
        if name:
            raise CameraMissing(f'Scene "{name_of(evaluated)}" has no camera "{valid(name)}"')
        raise CameraMissing(NO_CAMERA.format(name_of(evaluated)))
    return found.evaluated_get(depsgraph)


def _modifiers(depsgraph, frame_set, request, extraction):
    """Of each camera of a request. What moves is told to the extraction's model."""
    settings = SceneSettings(depsgraph.scene)  # of the original: writing them tags nothing
    names = [name for name, _ in request.cameras]
    closing = [None] * len(names)
    if quality_settings.is_coarser_moving_dark(settings):

        def seen():
            asked = request.cameras
            return [_frame(depsgraph, name, size, Problems())[0] for name, size in asked]

        model, moving = extraction.model, extraction.moving
        closing = shutter_motion.read(depsgraph, frame_set, moving, model, seen)
    parts_of = quality_lenses.parts_in(extraction)
    detail = quality_lenses.detail(depsgraph.objects, parts_of, extraction.problems)
    return [
        quality_lenses.modifiers(settings, detail, _camera(depsgraph, name), end)
        for name, end in zip(names, closing)
    ]


@contextlib.contextmanager
def prepared(target, request):
    """Makes a render of the scene `target` an extraction for `request`; all is put back after."""
    render, state = target.render, addon_session().part(ExtractState)
    request.without_camera = target.camera is None
    addon_session().changed_shapes.reading()
    names = ("engine", "use_compositing", "use_sequencer")
    before = {name: getattr(render, name) for name in names}
    camera_before, stand_in = target.camera, None
    bpy.utils.register_class(LODESTONE_RE_extract)
    state.request = request
    try:
        if target.camera is None:  # Blender renders nothing without one
            data = bpy.data.cameras.new("Lodestone")
            stand_in = bpy.data.objects.new("Lodestone", data)
            target.camera = stand_in
        render.engine = LODESTONE_RE_extract.bl_idname
        render.use_compositing = render.use_sequencer = False
        yield
    finally:
        state.request = None
        for name, value in before.items():
            setattr(render, name, value)
        if stand_in is not None:
            target.camera = camera_before
            data = stand_in.data
            bpy.data.objects.remove(stand_in)
            bpy.data.cameras.remove(data)
        bpy.utils.unregister_class(LODESTONE_RE_extract)


def extract_now(target, request):
    """Extracts synchronously (batch jobs and scripts). Raises what stopped it."""
    with prepared(target, request):
        bpy.ops.render.render(scene=target.name)
    if request.error is not None:
        raise request.error
    if request.extraction is None:
        raise RuntimeError("Blender did not render: nothing was read")
    return request.extraction
