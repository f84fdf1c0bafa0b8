# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels in the 3D Viewport: what the engine's Rendered shading draws.

Nothing in the file is written: levels are drawn beside the scene, for each viewport those that
suit it. A redraw uploads for some milliseconds and draws; everything else is a thread's
(core/preview/preview_worker.py). Objects that were moved or hidden since levels were built follow;
what has another shape is drawn as it is.
"""

import itertools
import time
import traceback
import weakref

import bpy

from .. import handlers
from ..bridge import datablock_ids
from ..bridge.datablock_ids import name_of
from ..bridge.live import preview_changes, viewport_camera
from ..bridge.object_decisions import edits_of
from ..bridge.scene import quality_lenses
from ..bridge.scene_settings import SceneSettings
from ..core.preview import preview_worker
from ..core.preview.preview_worker import Failed, Made, Picture, Wanted
from ..core.preview.viewport_state import View
from ..core.problems import Problems
from ..core.session.addon_session import addon_session
from ..core.store import store_path
from . import forced_lod, preview_draw

ENGINE = "LODESTONE_POVRAY"
UPLOAD_S = 0.015  # of a redraw
LEARN_S = 0.01
POLL_S = 0.03
_MOST_CANVASES = 8

_numbers = itertools.count(1)  # of viewports; none is used twice


class Preview:
    """What viewports show, and the threads that make it; part of the session."""

    def __init__(self):
        self.pool = preview_draw.Pool()
        self.canvases = {}  # by region
        self.sources = {}  # by scene and view layer
        self.shown_in = weakref.WeakValueDictionary()  # by region
        self.told = set()  # problems that were printed

    def close(self):
        """Ends the threads and drops what they made."""
        for source in self.sources.values():
            source.worker.close()
        self.sources.clear()
        self.pool.clear()
        self.canvases.clear()
        addon_session().drop(preview_draw.PreviewShader)


def preview():
    """The Preview of the session."""
    return addon_session().part(Preview)


class _Source:
    """The levels of one view layer, and who looks at them."""

    def __init__(self, key, scene):
        self.key = key
        self.folder = store_path.store_folder(bpy.data.filepath)
        self.stamp = _stamp(self.folder)
        self.worker = preview_worker.Worker(self.folder, preview_changes.names_of(scene))
        self.scene = preview_changes.Scene(addon_session().changed_shapes.names())
        self.views = weakref.WeakValueDictionary()  # by viewport
        self._lenses = self._sun = None  # not looked at since something has changed

    def changed(self, depsgraph):
        self.scene.changed(depsgraph)
        self._lenses = self._sun = None

    def lenses(self, scene):
        if self._lenses is None:
            self._lenses = _lenses(scene)
        return self._lenses

    def sun(self, depsgraph):
        if self._sun is None:
            self._sun = preview_draw.sun_of(depsgraph)
        return self._sun

    def outdated(self):
        folder = store_path.store_folder(bpy.data.filepath)
        return folder != self.folder or _stamp(folder) != self.stamp

    def collect(self):
        """Takes what the thread has made."""
        while True:
            item = self.worker.take()
            if item is None:
                return
            if isinstance(item, Made):
                preview().pool.put(item.key, item.mesh)
                continue
            view = self.views.get(item.viewport)
            if view is not None and isinstance(item, Picture):
                view.next, view.problem = item, ""
            elif view is not None and isinstance(item, Failed):
                view.problem = item.text


def _stamp(folder):
    try:
        return (folder / store_path.INDEX).stat().st_mtime_ns
    except OSError:
        return 0


def _source_of(context, depsgraph):
    scene = context.scene
    key = (name_of(scene), name_of(depsgraph.view_layer))
    source = preview().sources.get(key)
    if source is not None and source.outdated():
        _drop(source)
        source = None
    if source is None:
        source = preview().sources[key] = _Source(key, scene)
    return source


def _drop(source):
    """Its pictures stay where they are shown until there are new ones."""
    source.worker.close()
    preview().sources.pop(source.key, None)


# ---- Called by the engine ----


def update(engine, context, depsgraph):
    """Something of the scene has changed, or a viewport begins to show levels."""
    _source_of(context, depsgraph).changed(depsgraph)


def draw(engine, context, depsgraph):
    """Draws the viewport of the context."""
    start = time.thread_time()
    state = _view_of(engine)
    try:
        source = _source_of(context, depsgraph)
        source.views[state.number] = state.view
        preview().shown_in[context.region.as_pointer()] = state
        state.source = source
        _ask(source, state, context, depsgraph)
        source.collect()
        _advance(source, state)
        state.prepared = time.thread_time() - start
        _show(engine, state, context, depsgraph)
    except Exception as error:
        text = f"{error!r}"
        if text not in preview().told:
            preview().told.add(text)
            traceback.print_exc()
        state.view.problem = f"the preview failed: {text} (see the console)"
    engine.update_stats("", state.view.line())
    if _busy(state) or (state.source is not None and not state.source.scene.learned):
        _poll_soon()
    state.seconds = time.thread_time() - start


class _Viewport:
    """What an engine instance holds."""

    def __init__(self):
        self.number = next(_numbers)
        self.view = View()
        self.source = None
        self.prepared = 0.0  # CPU seconds of the last redraw, until OpenGL begins to draw
        self.seconds = 0.0  # and all of it
        self.batches = 0  # in sight


def _view_of(engine):
    state = getattr(engine, "lodestone_viewport", None)
    if state is None:
        state = engine.lodestone_viewport = _Viewport()
    return state


def _busy(state):
    source = state.source
    if source is None:
        return False
    return source.worker.busy or source.scene.stale or state.view.next is not None


def _ask(source, state, context, depsgraph):
    worker = source.worker
    if not worker.ready:
        return
    source.scene.refresh(depsgraph, worker.tree)
    region, space = context.region, context.space_data
    region_data = context.region_data
    camera = viewport_camera.camera_of(
        region_data.view_matrix, region_data.window_matrix, space.clip_start
    )
    if camera is None or region.width < 1 or region.height < 1:
        return
    things, shown = source.scene.things, source.scene.state
    if space.local_view is not None:
        local = {name_of(item) for item in context.view_layer.objects if item.local_view_get(space)}
        things, shown = source.scene.within(local, worker.tree), (shown, frozenset(local))
    settings = SceneSettings(context.scene)
    used = settings.use_levels
    chosen = context.window_manager.lodestone_overlay
    wanted = Wanted(
        camera=camera,
        size=(region.width, region.height),
        pixel_error=settings.pixel_error_viewport if used else 0.0,
        triangles=round(1e6 * settings.budget_viewport) if used else 0,
        lenses=source.lenses(context.scene),
        mode=chosen.mode if chosen.seen_from == "VIEW" else preview_worker.NO_COLORS,
        force=forced_lod.of_view(space),
        state=shown,
        things=things,
    )
    if state.view.wants(wanted):
        worker.ask(state.number, wanted)


def _lenses(scene):
    """Those of the scene, each with the uid of the collection that it lists."""
    shown = [
        item for item in scene.objects if item.type == "EMPTY" and quality_lenses.is_lens(item)
    ]
    found = []
    for item in shown:
        for lens in quality_lenses.detail([item], lambda collection: (), Problems()):
            own = item.lodestone.lens
            listed = own.filter != "ALL" and own.collection is not None
            found.append(
                (lens, datablock_ids.uid_of("collection", own.collection) if listed else "")
            )
    return tuple(found)


def _advance(source, state):
    view = state.view
    lacking = view.advance(preview().pool.has)
    if not lacking:
        return
    lost = [key for key in lacking if not preview().pool.holds(key)]
    if lost:  # dropped while the picture was made: once more
        source.worker.dropped(lost)
        view.next = None
        view.again()
        return
    preview().pool.upload(lacking, UPLOAD_S)
    view.advance(preview().pool.has)


def _show(engine, state, context, depsgraph):
    picture = state.view.shown
    region = context.region
    size = (region.width, region.height)
    canvas = preview().canvases.get(region.as_pointer())
    if canvas is None or canvas.size != size:
        if len(preview().canvases) >= _MOST_CANVASES:  # regions come and go
            preview().canvases.clear()
        canvas = preview().canvases[region.as_pointer()] = preview_draw.Canvas(size)
    keys = picture.keys if picture is not None else ()
    state.batches = canvas.draw(
        preview().pool,
        keys,
        context.region_data,
        preview_draw.background_of(context.scene),
        state.source.sun(depsgraph),
    )
    engine.bind_display_space_shader(context.scene)
    canvas.show()
    engine.unbind_display_space_shader()
    _prune()


def _prune():
    used = set()
    for source in preview().sources.values():
        for view in source.views.values():
            used.update(view.keys())
    gone = preview().pool.prune(used)
    if gone:
        for source in preview().sources.values():
            source.worker.dropped(gone)


# ---- Between redraws ----


def _poll_soon():
    if not bpy.app.timers.is_registered(_poll):
        bpy.app.timers.register(_poll, first_interval=POLL_S)


def _poll():
    """A timer, while something is made: viewports are drawn again when there is something new."""
    if any(map(_has_news, preview().sources.values())):
        redraw()
        return None  # a redraw asks for the next
    return POLL_S if _learn() else None


def _has_news(source):
    waiting = any(view.next is not None for view in source.views.values())
    return waiting or source.worker.answered or source.scene.stale


def _learn():
    """In idle moments: what shapes things have. False when there is nothing more to do."""
    context = bpy.context
    source = preview().sources.get((name_of(context.scene), name_of(context.view_layer)))
    if any(other.worker.busy for other in preview().sources.values()):
        return True
    if source is None or source.scene.learned or source.scene.stale:
        return False
    source.scene.learn(context.evaluated_depsgraph_get(), LEARN_S)
    return not source.scene.learned


def viewports():
    """Areas that show levels."""
    manager = bpy.context.window_manager
    for window in manager.windows if manager else ():
        if window.scene.render.engine != ENGINE:
            continue
        for area in window.screen.areas:
            if area.type == "VIEW_3D" and area.spaces.active.shading.type == "RENDERED":
                yield area


def redraw():
    for area in viewports():
        area.tag_redraw()


def shows_levels(context):
    """Whether the viewport of the context does."""
    space = context.space_data
    return (
        context.scene.render.engine == ENGINE
        and space.type == "VIEW_3D"
        and space.shading.type == "RENDERED"
    )


def state_of(area):
    """What is known of a 3D viewport that shows levels, or None."""
    for region in area.regions:
        if region.type == "WINDOW" and region.as_pointer() in preview().shown_in:
            return preview().shown_in[region.as_pointer()]
    return None


def lines(context):
    """What the viewport of the context draws, for its popover."""
    state = state_of(context.area)
    return state.view.lines() if state is not None else ()


@bpy.app.handlers.persistent
def _on_change(scene, depsgraph):
    changed = addon_session().changed_shapes.reported(
        edits_of(update.id)
        for update in depsgraph.updates
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object)
    )
    if not changed:
        return
    addon_session().changed_shapes.note(changed)
    for source in preview().sources.values():
        source.scene.touch(changed)


@bpy.app.handlers.persistent
def _on_load(*_):
    forget()
    addon_session().changed_shapes.clear()


def forget():
    """Ends the threads and drops what they made."""
    addon_session().drop(Preview)


_HANDLERS = (("depsgraph_update_post", _on_change), ("load_pre", _on_load), ("load_post", _on_load))


def register():
    handlers.add(_HANDLERS)


def unregister():
    handlers.remove(_HANDLERS)
    if bpy.app.timers.is_registered(_poll):
        bpy.app.timers.unregister(_poll)
    forget()
