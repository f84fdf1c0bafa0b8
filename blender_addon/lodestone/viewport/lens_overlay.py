# SPDX-License-Identifier: GPL-3.0-or-later
"""The rims of lenses in the viewport: where a detail lens ends and where half of it is left, and
screen lenses on the image. Nothing of the GPU is touched before something is drawn."""

import bpy
from mathutils import Vector

from .. import handlers
from ..bridge.live import camera_image, live_view
from ..core.picture import lens_rim
from ..core.session.addon_session import addon_session

_RIM = (0.35, 0.75, 1.0, 0.9)
_HALF = (0.35, 0.75, 1.0, 0.35)
_MOST = 256  # drawn; more would stop the window
_handles = []


class FoundLenses(dict[str, list[str]]):
    """The names of lenses by scene, until something changes; part of the session."""


def _draw_world():
    context = bpy.context
    if not _shown(context):
        return
    lines = []
    for item in _lenses(context)[:_MOST]:
        if not item.visible_get(view_layer=context.view_layer):
            continue
        outline = lens_rim.box if item.empty_display_type == "CUBE" else lens_rim.circles
        half = lens_rim.half_way(item.lodestone.lens.falloff)
        for share, color in ((1.0, _RIM), (half, _HALF)):
            if share == half == 1.0 and color is _HALF:
                continue
            points = outline(share * item.empty_display_size)
            lines.append(([item.matrix_world @ Vector(point) for point in points], color))
    _draw_lines(lines)


def _draw_image():
    context = bpy.context
    region_3d = context.region_data
    if not _shown(context) or region_3d is None or region_3d.view_perspective != "CAMERA":
        return
    camera = context.scene.camera
    if camera is None or camera.type != "CAMERA" or not camera.data.is_property_set("lodestone"):
        return
    corners = camera_image.image_corners(context.scene, context.region, region_3d)
    if corners is None:
        return
    left, bottom, right, top = corners
    width, height = right - left, top - bottom
    lines = []
    for lens in camera.data.lodestone.screen_lenses:
        if lens.enabled and len(lines) < _MOST:
            x, y = left + lens.x * width, bottom + lens.y * height
            half = lens_rim.half_way(lens.falloff)
            lines.append((lens_rim.disc(x, y, lens.radius * width), _RIM))
            if half < 1.0:
                lines.append((lens_rim.disc(x, y, half * lens.radius * width), _HALF))
    _draw_lines(lines)


def _draw_lines(lines):
    if not lines:
        return
    import gpu  # not at register time: it fails without a window
    from gpu_extras.batch import batch_for_shader

    name = "3D_UNIFORM_COLOR" if bpy.app.version < (4, 0, 0) else "UNIFORM_COLOR"
    shader = gpu.shader.from_builtin(name)
    gpu.state.blend_set("ALPHA")
    try:
        for points, color in lines:
            batch = batch_for_shader(shader, "LINES", {"pos": [tuple(point) for point in points]})
            shader.bind()
            shader.uniform_float("color", color)
            batch.draw(shader)
    finally:
        gpu.state.blend_set("NONE")


def _shown(context):
    space = context.space_data
    return space is not None and space.type == "VIEW_3D" and space.overlay.show_overlays


def _lenses(context):
    scene, found = context.scene, addon_session().part(FoundLenses)
    if scene.name not in found:
        found[scene.name] = [item.name for item in live_view.lens_objects(scene)]
    items = (scene.objects.get(name) for name in found[scene.name])
    return [item for item in items if item is not None and item.type == "EMPTY"]


@bpy.app.handlers.persistent
def _forget(*_):
    addon_session().drop(FoundLenses)


_HANDLERS = tuple(
    (name, _forget) for name in ("depsgraph_update_post", "undo_post", "redo_post", "load_post")
)


def register():
    handlers.add(_HANDLERS)
    if not bpy.app.background:
        add = bpy.types.SpaceView3D.draw_handler_add
        _handles.append(add(_draw_world, (), "WINDOW", "POST_VIEW"))
        _handles.append(add(_draw_image, (), "WINDOW", "POST_PIXEL"))


def unregister():
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
    handlers.remove(_HANDLERS)
    _forget()
