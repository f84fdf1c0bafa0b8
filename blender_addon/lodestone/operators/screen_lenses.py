# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of a camera's screen lenses: adding, removing, and dragging one on the image. And the
button that begins Depth Exaggeration."""

import bpy
from bpy.types import Operator

from ..bridge import datablock_ids
from ..bridge.live import camera_image
from .polled_operator import Polled

MOST = 64  # a list that nobody reads; each is looked at for everything that is drawn


def camera_of(context):
    """The camera data whose properties are shown, else the scene's."""
    shown = getattr(context, "camera", None)
    if shown is not None:
        return shown
    item = context.scene.camera if context.scene is not None else None
    return item.data if item is not None and item.type == "CAMERA" else None


def active_lens(camera):
    settings = None if camera is None else datablock_ids.settings_of(camera)
    if settings is None:  # looking must store nothing
        return None
    number, lenses = settings.active_screen_lens, settings.screen_lenses
    return lenses[number] if 0 <= number < len(lenses) else None


def lens_count(camera):
    settings = datablock_ids.settings_of(camera)
    return 0 if settings is None else len(settings.screen_lenses)


class _OfCamera(Polled):
    @classmethod
    def refused(cls, context):
        camera = camera_of(context)
        if camera is None:
            return "Set a scene camera"
        return "The camera is linked from a library" if camera.library is not None else ""


class LODESTONE_OT_screen_lens_add(_OfCamera, Operator):
    bl_idname = "lodestone.screen_lens_add"
    bl_label = "Add Screen Lens"
    bl_description = "Add a disc on the image inside which everything is drawn finer"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refused(cls, context):
        why = super().refused(context)
        if not why and lens_count(camera_of(context)) >= MOST:
            why = f"A camera has at most {MOST} screen lenses"
        return why

    def execute(self, context):
        settings = camera_of(context).lodestone
        made = settings.screen_lenses.add()
        made.name = f"Lens {len(settings.screen_lenses)}"
        settings.active_screen_lens = len(settings.screen_lenses) - 1
        made.id_data.update_tag()
        return {"FINISHED"}


class LODESTONE_OT_screen_lens_remove(_OfCamera, Operator):
    bl_idname = "lodestone.screen_lens_remove"
    bl_label = "Remove Screen Lens"
    bl_description = "Remove the active screen lens"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refused(cls, context):
        why = super().refused(context)
        if not why and active_lens(camera_of(context)) is None:
            why = "There is no screen lens"
        return why

    def execute(self, context):
        camera = camera_of(context)
        settings = camera.lodestone
        settings.screen_lenses.remove(settings.active_screen_lens)
        last = len(settings.screen_lenses) - 1
        settings.active_screen_lens = max(0, min(settings.active_screen_lens, last))
        camera.update_tag()
        return {"FINISHED"}


class LODESTONE_OT_screen_lens_drag(_OfCamera, Operator):
    bl_idname = "lodestone.screen_lens_drag"
    bl_label = "Drag in Camera View"
    bl_description = (
        "Move the active screen lens with the mouse in the camera view; the wheel changes its "
        "radius, a click ends, Esc takes it back"
    )
    bl_options = {"REGISTER", "UNDO", "BLOCKING"}

    @classmethod
    def refused(cls, context):
        why = super().refused(context)
        if not why and active_lens(camera_of(context)) is None:
            why = "There is no screen lens"
        if not why and camera_region(context, camera_of(context)) is None:
            why = "Look through the scene's camera in a 3D view"
        return why

    def invoke(self, context, event):
        lens = active_lens(camera_of(context))
        self._before = (lens.x, lens.y, lens.radius)
        context.window_manager.modal_handler_add(self)
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        camera = camera_of(context)
        lens, found = active_lens(camera), camera_region(context, camera)
        if lens is None or found is None:
            return self._end(context, {"CANCELLED"})
        if event.type in {"ESC", "RIGHTMOUSE"}:
            lens.x, lens.y, lens.radius = self._before
            return self._end(context, {"CANCELLED"})
        if event.type in {"LEFTMOUSE", "RET", "NUMPAD_ENTER"} and event.value == "PRESS":
            return self._end(context, {"FINISHED"})
        if event.type in {"WHEELUPMOUSE", "WHEELDOWNMOUSE"}:
            lens.radius *= 1.1 if event.type == "WHEELUPMOUSE" else 1.0 / 1.1
        elif event.type == "MOUSEMOVE":
            region, corners = found
            place = camera_image.on_image(
                corners, event.mouse_x - region.x, event.mouse_y - region.y
            )
            if place is not None:
                lens.x, lens.y = place
        else:
            return {"RUNNING_MODAL"}
        found[0].tag_redraw()
        return {"RUNNING_MODAL"}

    def _tell(self, context):
        text = "Move: mouse   Radius: wheel   [Click] Keep   [Esc] Cancel"
        if context.workspace is not None:
            context.workspace.status_text_set(text)

    def _end(self, context, outcome):
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        return outcome


class LODESTONE_OT_depth_exaggerate(_OfCamera, Operator):
    bl_idname = "lodestone.depth_exaggerate"
    bl_label = "Exaggerate Depth"
    bl_description = "Draw what is twice as far as this camera's focus twice as coarse"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        camera_of(context).lodestone.depth_exaggeration = 2.0
        return {"FINISHED"}


def camera_region(context, camera):
    """The region of a 3D view of this window that looks through the scene's camera, when that has
    this data, and the corners of the image in it; else None."""
    item = context.scene.camera
    if context.window is None or item is None or item.data != camera:
        return None
    for area in context.window.screen.areas:
        if area.type != "VIEW_3D":
            continue
        space = area.spaces.active
        if space.region_3d.view_perspective != "CAMERA" or space.use_local_camera:
            continue
        for region in area.regions:
            if region.type == "WINDOW":
                corners = camera_image.image_corners(context.scene, region, space.region_3d)
                if corners is not None:
                    return region, corners
    return None


_CLASSES = (
    LODESTONE_OT_screen_lens_add,
    LODESTONE_OT_screen_lens_remove,
    LODESTONE_OT_screen_lens_drag,
    LODESTONE_OT_depth_exaggerate,
)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
