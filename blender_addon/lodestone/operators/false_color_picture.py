# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of what the scene camera's picture uses, in false colors with a legend, by POV-Ray.

Seen by the scene camera, from the viewport, or from outside of everything (dissertation, fig. 5.5).
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import bpy
from bpy.props import EnumProperty
from mathutils import Vector

from .. import preferences
from ..bridge.live import kept_model_view
from ..core import background_calls
from ..core.native import lodestone_native as native
from ..core.picture import false_colors, legend_strip, overview_camera
from ..core.picture.picture_maker import PICTURE
from ..core.printable_text import sentence
from ..core.session.addon_session import addon_session
from . import read_levels
from . import window_run

NAME = "Lodestone False Colors"
OVERVIEW = "OVERVIEW"
SEEN_FROM = (
    ("CAMERA", "Scene Camera", "The picture itself"),
    ("VIEW", "This Viewport", "As the 3D viewport shows it now, while levels stay the camera's"),
    ("OVERVIEW", "Overview", "From outside of all there is, while levels stay the camera's"),
)
MODES = (
    ("LEVEL", "Level", "By the level in use"),
    ("ERROR", "Error on Screen", "By how much of Pixel Error it uses up"),
    ("COST", "Cost", "By the triangles that each object or group takes"),
)
FAILURES = read_levels.FAILURES


def of_viewport(camera, region, view):
    """A camera that sees what a 3D viewport shows, and its size in pixels."""
    matrix, window = view.view_matrix.inverted(), view.window_matrix
    turn, place = matrix.to_3x3(), matrix.translation
    # Camera space from picture space is linear in both kinds of projection
    width, height = 2.0 / window[0][0], 2.0 / window[1][1]
    orthographic = not view.is_perspective
    if orthographic:
        middle = Vector((-window[0][3] / window[0][0], -window[1][3] / window[1][1], 0.0))
        direction = turn @ Vector((0.0, 0.0, -1.0))
        # An orthographic viewport's eye may be inside of what it shows
        position = place + turn @ middle - direction * 1e4
    else:
        position = place
        middle = Vector((window[0][2] / window[0][0], window[1][2] / window[1][1], -1.0))
        direction = turn @ middle
    seen = replace(
        camera,
        name="Viewport",
        orthographic=orthographic,
        position=tuple(position),
        direction=tuple(direction),
        right=tuple(turn @ Vector((width, 0.0, 0.0))),
        up=tuple(turn @ Vector((0.0, height, 0.0))),
        aperture=0.0,
    )
    return seen, (region.width, region.height)


def picture(kept, asked, mode, seen, size, folder, program, new_job):
    """The image with its legend, top row first. On any thread: no bpy in here. `seen`: the camera
    to see it from, None for the view's own."""
    with kept.lock:
        if kept.closed:
            raise background_calls.Stopped
        cut = kept.cut(asked)
        view = cut.view
        cut.set_colors(false_colors.colors(cut, mode))
        shown = replace(view, border=(0, 0, 0, 0), width=size[0], height=size[1])
        if seen is None:
            shown = replace(view, camera=replace(view.camera, aperture=0.0))
        elif seen == OVERVIEW:
            center, radius = overview_camera.bound_of(cut)
            shown = replace(
                shown, camera=overview_camera.overview(view.camera, center, radius, size)
            )
        else:
            shown = replace(shown, camera=seen)
        options = native.PovrayOptions(false_color=True, program=program)
        job = new_job("Export")
        native.povray_export(cut, str(folder), options, job, shown)
        number = len(cut.choices())
    native.povray_run(str(folder), PICTURE, options, new_job("Trace"))
    image = native.image_read(str(folder / PICTURE))
    title = f"{view.camera.name}, Pixel Error {view.pixel_error:g}, {number} drawn:"
    return legend_strip.with_legend(image, title, false_colors.legend(mode, view.pixel_error))


def into_image(image):
    """The datablock of that name, made anew; only the main thread may do this."""
    before = bpy.data.images.get(NAME)
    if before is not None and before.library is None:
        bpy.data.images.remove(before)
    made = bpy.data.images.new(NAME, image.width, image.height, float_buffer=True)
    made.pixels.foreach_set(legend_strip.flipped(image).pixels)
    made.update()
    return made


class _Request:
    """What the picture is of, taken from the context before anything runs."""

    def __init__(self, context, mode, seen_from):
        self.mode = mode
        self.program = preferences.povray_program()
        self.seen, self.size = None, None
        if seen_from == OVERVIEW:
            self.seen = OVERVIEW
        elif seen_from == "VIEW":
            area = context.area
            region = next(one for one in area.regions if one.type == "WINDOW")
            camera = native.Camera("", False, (0,) * 3, (0,) * 3, (0,) * 3, (0,) * 3, 0.01)
            self.seen, self.size = of_viewport(camera, region, area.spaces.active.region_3d)

    def make(self, kept, asked, new_job):
        with tempfile.TemporaryDirectory(prefix="lodestone-colors-") as folder:
            size = self.size or (asked.view.width, asked.view.height)
            return picture(
                kept, asked, self.mode, self.seen, size, Path(folder), self.program, new_job
            )


class _Run(read_levels.Reading):
    """Reads the scene where that is needed, then makes the picture on the thread."""

    def __init__(self, context, asked):
        self.asked = asked
        super().__init__(context.scene)
        self.picturing = False

    def start_picture(self, context):
        scene = context.scene
        kept = addon_session().kept_models.get(scene.name)
        asked = kept_model_view.now(kept, scene, context.evaluated_depsgraph_get())
        self._outcome = {}
        self.picturing = True
        self.start(lambda: self.asked.make(kept, asked, self.work.new_job))


class LODESTONE_OT_false_color_picture(
    read_levels.OfCamera, window_run.InWindow, bpy.types.Operator
):
    bl_idname = "lodestone.false_color_picture"
    bl_label = "False-Color Picture"
    bl_description = (
        "Draw what the scene camera's picture uses in flat colors, with a legend, as the image "
        f'"{NAME}"'
    )
    bl_options = {"REGISTER"}

    failures = FAILURES

    seen_from: EnumProperty(
        name="Seen From",
        description="Where the picture is drawn from",
        items=SEEN_FROM,
        default="CAMERA",
    )
    mode: EnumProperty(
        name="Color By", description="What the colors tell", items=MODES, default="LEVEL"
    )

    def _asked(self, context):
        chosen = context.window_manager.lodestone_overlay.mode
        mode = self.mode if self.properties.is_property_set("mode") or chosen == "NONE" else chosen
        if self.seen_from == "VIEW" and (context.area is None or context.area.type != "VIEW_3D"):
            raise RuntimeError("Seen From: This Viewport needs a 3D viewport")
        return _Request(context, mode, self.seen_from)

    def execute(self, context):
        """At once, with what was read last where that is still so."""
        scene = context.scene
        try:
            request = self._asked(context)
            kept = addon_session().kept_models.get(scene.name)
            if kept is None or kept_model_view.old(kept, scene):
                kept = read_levels.read_levels(scene)
            asked = kept_model_view.now(kept, scene, context.evaluated_depsgraph_get())
            into_image(request.make(kept, asked, background_calls.Work().new_job))
        except FAILURES as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        try:
            run = _Run(context, self._asked(context))
        except FAILURES as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        return self.begin(context, run)

    def step(self, context, run):
        if not run.picturing and run.reading():
            window_run.status(context, "Lodestone: reading the scene   [Esc] Cancel")
            return {"PASS_THROUGH"}
        if run.working():
            window_run.status(context, "Lodestone: drawing false colors   [Esc] Cancel")
            return {"PASS_THROUGH"}
        if not run.picturing:
            run.finish()
            run.start_picture(context)
            return {"PASS_THROUGH"}
        image = into_image(run.worked())
        run.close()
        _show(context, image)
        self.report({"INFO"}, f'The picture is image "{image.name}"')
        return self.end(context, {"FINISHED"})


def _show(context, image):
    """In the first image editor that there is."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR" and area.spaces.active.ui_mode == "VIEW":
                area.spaces.active.image = image
                return


def _draw_menu(self, context):
    self.layout.operator_menu_enum(
        "lodestone.false_color_picture", "seen_from", text="False-Color Picture", icon="COLOR"
    )


_register, _unregister = bpy.utils.register_classes_factory((LODESTONE_OT_false_color_picture,))


def register():
    _register()
    bpy.types.TOPBAR_MT_render.append(_draw_menu)


def unregister():
    bpy.types.TOPBAR_MT_render.remove(_draw_menu)
    _unregister()
