# SPDX-License-Identifier: GPL-3.0-or-later
"""False colors over the 3D Viewport: what the scene camera's picture uses, seen from anywhere.

Drawn beside Blender's own drawing: nothing in the file is written. The GPU is only touched while a
viewport is drawn, so never without a window. What is drawn is made anew when the cut or the colors
change; a redraw only draws it.
"""

import traceback

import bpy
from bpy.props import EnumProperty, FloatProperty, PointerProperty

from .. import handlers
from ..bridge.live import kept_model_view
from ..core import kind_words
from ..core.native import lodestone_native as native
from ..core.picture import false_colors
from ..core.session.addon_session import addon_session
from . import forced_lod, levels_popover, levels_preview

MOST_TRIANGLES = 400_000
DELAY_S = 0.05
MODES = (
    ("NONE", "None", "Show the scene as it is"),
    (
        "LEVEL",
        "Level",
        "Gray originals; blue, green and yellow ever coarser levels; other colors what is drawn as "
        + kind_words.any_solid(),
    ),
    ("ERROR", "Error on Screen", "How much of Pixel Error each level uses up"),
    ("COST", "Cost", "How many triangles each object or group takes"),
)


def _changed(self, context):
    _tag_redraw()


SEEN_FROM = (
    ("CAMERA", "Scene Camera", "What the picture uses, from wherever it is looked at"),
    ("VIEW", "This View", "What each viewport that shows levels uses itself"),
)


class LODESTONE_PG_overlay(forced_lod.ForcedLod, bpy.types.PropertyGroup):
    mode: EnumProperty(
        name="Color By",
        description="Color what the scene camera's picture uses",
        items=MODES,
        default="NONE",
        update=_changed,
        options={"SKIP_SAVE"},
    )
    seen_from: EnumProperty(
        name="From",
        description="Whose levels are colored",
        items=SEEN_FROM,
        default="CAMERA",
        update=_changed,
        options={"SKIP_SAVE"},
    )
    opacity: FloatProperty(
        name="Opacity",
        description="How much the colors hide of the scene",
        default=1.0,
        min=0.1,
        max=1.0,
        subtype="FACTOR",
        update=_changed,
        options={"SKIP_SAVE"},
    )


class Shown:
    """What is drawn: made by refresh() without the GPU, uploaded by the next draw."""

    def __init__(self):
        self.key = None  # of what it shows
        self.lines = ()
        self.legend = ()
        self.triangles = 0
        self._arrays = None
        self._batch = None

    def set(self, key, corners, colors, triangles, legend, lines):
        self.key, self.triangles = key, triangles
        self.legend, self.lines = legend, lines
        self._arrays, self._batch = (corners, colors), None

    def batch(self, gpu):
        """While something is drawn. None when there is nothing to draw."""
        if self._batch is None and self._arrays is not None and self.triangles:
            corners, colors = self._arrays
            form = gpu.types.GPUVertFormat()
            form.attr_add(id="pos", comp_type="F32", len=3, fetch_mode="FLOAT")
            form.attr_add(id="color", comp_type="U8", len=4, fetch_mode="INT_TO_FLOAT_UNIT")
            count = 3 * self.triangles
            buffer = gpu.types.GPUVertBuf(form, count)
            buffer.attr_fill("pos", memoryview(corners).cast("B").cast("f", (count, 3)))
            buffer.attr_fill("color", memoryview(colors).cast("B", (count, 4)))
            self._batch = gpu.types.GPUBatch(type="TRIS", buf=buffer)
            self._arrays = None
        return self._batch


class Overlay:
    """What is drawn over viewports, and into what; part of the session."""

    def __init__(self):
        self.shown = Shown()
        self.offscreens = {}  # by region: ((width, height), GPUOffScreen)


_handle = None


def drawn():
    """The Overlay of the session."""
    return addon_session().part(Overlay)


def settings(context):
    return context.window_manager.lodestone_overlay


def wanted_key(context, scene, kept, mode):
    """Tells when what is shown is of something else."""
    asked = kept_model_view.now(kept, scene, context.evaluated_depsgraph_get())
    return (scene.name, id(kept), mode, asked)


def refresh(context, scene, mode):
    """Makes what is to be drawn, on the main thread. False when the model is in use."""
    kept = addon_session().kept_models.get(scene.name)
    if kept is None or not kept.lock.acquire(blocking=False):
        return False
    try:
        if kept.closed:
            return False
        key = wanted_key(context, scene, kept, mode)
        cut = kept.cut(key[-1])
        cut.set_colors(false_colors.colors(cut, mode))
        count = cut.make_surface(MOST_TRIANGLES)
        corners, colors = cut.surface(count)
        cut.make_surface(0)
        # The picture of them is put over the viewport in linear light
        colors = bytearray(colors.tobytes().translate(false_colors.LINEAR))
        asked = cut.view.pixel_error
        line = f"{cut.view.camera.name}, Pixel Error {asked:g}: {len(cut.choices()):,} drawn"
        drawn().shown.set(key, corners, colors, count, false_colors.legend(mode, asked), (line,))
    finally:
        kept.lock.release()
    return True


def _refresh_later():
    """A timer: nothing heavy happens while something is drawn."""
    context = bpy.context
    try:
        mode = settings(context).mode
        if (
            mode != "NONE"
            and settings(context).seen_from == "CAMERA"
            and not refresh(context, context.scene, mode)
        ):
            if addon_session().kept_models.get(context.scene.name) is not None:
                return 4 * DELAY_S  # it is in use
    except native.LodestoneError as error:
        drawn().shown.set(None, None, None, 0, (), (str(error),))
    except Exception:
        traceback.print_exc()
        drawn().shown.set(None, None, None, 0, (), ("False colors failed: see the console",))
        return None
    _tag_redraw()
    return None


def _tag_redraw():
    manager = bpy.context.window_manager
    for window in manager.windows if manager else ():
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _draw():
    """In every 3D viewport; an exception here would be printed at each redraw."""
    context = bpy.context
    mode = settings(context).mode
    if settings(context).seen_from == "VIEW":
        _draw_own(context, mode)
        return
    if mode == "NONE" or not context.space_data.overlay.show_overlays:
        return
    try:
        _draw_colors(context, mode)
    except Exception:
        traceback.print_exc()
        settings(context).mode = "NONE"


def _draw_own(context, mode):
    """The legend of what levels_preview.py colors itself."""
    if mode == "NONE" or not context.space_data.overlay.show_overlays:
        return
    if not levels_preview.shows_levels(context):
        _draw_text(context, (), ("Lodestone: this viewport shows no levels",))
        return
    asked = context.scene.lodestone.pixel_error_viewport
    _draw_text(context, false_colors.legend(mode, asked), ())


def _draw_colors(context, mode):
    import gpu  # only where there is a window

    kept = addon_session().kept_models.get(context.scene.name)
    if kept is None:
        _draw_text(context, (), ("Lodestone: press Read Scene, or render a picture",))
        return
    key, shown = wanted_key(context, context.scene, kept, mode), drawn().shown
    if key != shown.key and not bpy.app.timers.is_registered(_refresh_later):
        bpy.app.timers.register(_refresh_later, first_interval=DELAY_S)
    if shown.key is None or shown.key[1] == id(kept):
        batch = shown.batch(gpu)
        if batch is not None:
            _draw_batch(context, gpu, batch)
    lines = list(shown.lines)
    if kept_model_view.old(kept, context.scene):
        lines.append("The scene has changed since: Read Scene")
    _draw_text(context, shown.legend, lines)


def _draw_batch(context, gpu, batch):
    """Into a picture with a depth of its own, then over the viewport: what is colored neither
    flickers with the originals nor hides behind them."""
    from gpu_extras.batch import batch_for_shader

    region, size = context.region, (context.region.width, context.region.height)
    offscreens = drawn().offscreens
    held = offscreens.get(region.as_pointer())
    if held is None or held[0] != size:
        held = (size, gpu.types.GPUOffScreen(*size))
        if len(offscreens) > 8:  # regions come and go
            offscreens.clear()
        offscreens[region.as_pointer()] = held
    offscreen = held[1]
    view = context.region_data
    flat = "3D_FLAT_COLOR" if bpy.app.version < (4, 0, 0) else "FLAT_COLOR"
    shader = gpu.shader.from_builtin(flat)
    with offscreen.bind():
        frame = gpu.state.active_framebuffer_get()
        frame.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_matrix(view.view_matrix)
            gpu.matrix.load_projection_matrix(view.window_matrix)
            gpu.state.depth_test_set("LESS_EQUAL")
            gpu.state.depth_mask_set(True)
            batch.draw(shader)
            gpu.state.depth_mask_set(False)
            gpu.state.depth_test_set("NONE")
    image = gpu.shader.from_builtin("IMAGE_COLOR")
    width, height = size
    places = ((0, 0), (width, 0), (width, height), (0, height))
    quad = batch_for_shader(
        image, "TRI_FAN", {"pos": places, "texCoord": ((0, 0), (1, 0), (1, 1), (0, 1))}
    )
    gpu.state.blend_set("ALPHA")
    image.bind()
    image.uniform_sampler("image", offscreen.texture_color)
    image.uniform_float("color", (1.0, 1.0, 1.0, settings(context).opacity))
    quad.draw(image)
    gpu.state.blend_set("NONE")


def _draw_text(context, legend, lines):
    """At the lower left: what is shown, above it the colors."""
    import blf
    import gpu
    from gpu_extras.batch import batch_for_shader

    scale = context.preferences.system.ui_scale
    step, left, at = 18 * scale, 70 * scale, 24 * scale
    flat = "2D_UNIFORM_COLOR" if bpy.app.version < (4, 0, 0) else "UNIFORM_COLOR"
    shader = gpu.shader.from_builtin(flat)
    if bpy.app.version < (4, 0, 0):
        blf.size(0, 12 * scale, 72)
    else:
        blf.size(0, 12 * scale)
    blf.color(0, 1.0, 1.0, 1.0, 1.0)
    if lines or legend:
        words = [*(word for word, _ in legend), *lines]
        wide = 40 * scale + max(blf.dimensions(0, word)[0] for word in words)
        low, high = at - 8 * scale, at + step * len(words)
        back = ((left - 8, low), (left + wide, low), (left + wide, high), (left - 8, high))
        gpu.state.blend_set("ALPHA")
        shader.bind()
        shader.uniform_float("color", (0.0, 0.0, 0.0, 0.6))
        batch_for_shader(shader, "TRI_FAN", {"pos": back}).draw(shader)
        gpu.state.blend_set("NONE")
    for line in reversed(lines):
        blf.position(0, left, at, 0)
        blf.draw(0, line)
        at += step
    for word, color in reversed(legend):
        side = 11 * scale
        x, y = left, at - 1 * scale
        box = ((x, y), (x + side, y), (x + side, y + side), (x, y + side))
        shader.bind()
        shader.uniform_float("color", (*false_colors.displayed(color), 1.0))
        batch_for_shader(shader, "TRI_FAN", {"pos": box}).draw(shader)
        blf.position(0, left + 18 * scale, at, 0)
        blf.draw(0, word)
        at += step


class LODESTONE_VIEW3D_PT_false_colors(bpy.types.Panel):
    bl_label = "Levels"
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_ui_units_x = 13

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        chosen = settings(context)
        levels_popover.draw_levels(layout, context)
        layout.separator()
        layout.prop(chosen, "mode")
        column = layout.column()
        column.active = chosen.mode != "NONE"
        column.prop(chosen, "seen_from")
        column = column.column()
        column.active = chosen.seen_from == "CAMERA"
        column.prop(chosen, "opacity")
        column.operator("lodestone.read_levels", icon="FILE_REFRESH")
        layout.operator_menu_enum("lodestone.false_color_picture", "seen_from", icon="IMAGE_DATA")


def _draw_header(self, context):
    chosen = settings(context)
    icon = "COLOR" if chosen.mode != "NONE" else "NONE"
    row = self.layout.row(align=True)
    if context.scene.render.engine == levels_preview.ENGINE:
        shown = levels_preview.shows_levels(context)
        row.operator("lodestone.show_levels", text="", icon="MOD_DECIM", depress=shown)
    name = LODESTONE_VIEW3D_PT_false_colors.__name__
    row.popover(panel=name, text="Levels", icon=icon)


@bpy.app.handlers.persistent
def _on_load(*_):
    """A file is opened as it is, whatever was shown when it was saved."""
    forget()
    for manager in bpy.data.window_managers:
        manager.lodestone_overlay.property_unset("mode")


def forget():
    """Drops all that is drawn."""
    addon_session().drop(Overlay)
    addon_session().drop(forced_lod.ForcedViewports)


_HANDLERS = (("load_post", _on_load),)
_CLASSES = (LODESTONE_PG_overlay, LODESTONE_VIEW3D_PT_false_colors)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


def register():
    global _handle
    _register()
    bpy.types.WindowManager.lodestone_overlay = PointerProperty(
        type=LODESTONE_PG_overlay, options={"HIDDEN", "SKIP_SAVE"}
    )
    bpy.types.VIEW3D_HT_header.append(_draw_header)
    handlers.add(_HANDLERS)
    if not bpy.app.background:
        _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def unregister():
    global _handle
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None
    if bpy.app.timers.is_registered(_refresh_later):
        bpy.app.timers.unregister(_refresh_later)
    handlers.remove(_HANDLERS)
    bpy.types.VIEW3D_HT_header.remove(_draw_header)
    del bpy.types.WindowManager.lodestone_overlay
    _unregister()
    forget()
