# SPDX-License-Identifier: GPL-3.0-or-later
"""The view of the scene's camera on the levels that were built, as the scene is now: for panels,
which follow lenses, cameras and settings while they are changed. Objects are where they were when
levels were last updated."""

from collections.abc import Hashable
from typing import Any

import bpy

from ...core.native import lodestone_native as native
from ...core.picture import view_statistics
from ...core.picture.picture_maker import Settings
from ...core.preview import preview_tree
from ...core.problems import Problems
from ...core.store import store_path
from .. import quality_settings
from ..checks.scene_check import rendered_objects
from ...core.session.addon_session import addon_session
from ..scene import quality_lenses
from ..scene import scene_camera as cameras
from ..scene_settings import SceneSettings
from . import preview_changes, viewport_camera


def statistics(context: Any) -> view_statistics.Statistics | str:
    """The statistics of the picture that F12 would make; else why there are none."""
    scene = context.scene
    store = addon_session().stores.open(store_path.store_folder(bpy.data.filepath))
    if store.problem:
        return f"Levels cannot be read: {store.problem}"
    if store.model is None:
        return "No levels yet: Update Levels builds them"
    item = scene.camera
    if item is None or item.type != "CAMERA":
        return "Set a scene camera"
    frame = cameras.Frame.of(scene.render)
    seen = cameras.extract(item, frame, Problems())
    settings = settings_of(scene, quality_lenses.parts_stored(store.model))
    size = (frame.width, frame.height)
    key = (seen, size, _hashable(settings))
    return (
        addon_session()
        .part(LiveStatistics)
        .chooser.statistics(store.model, key, seen, size, settings)
    )


def viewport_statistics(context: Any) -> view_statistics.Statistics | None:
    """The statistics of what its Pixel Error and budget of triangles give the largest 3D view;
    None: there is no view or no store."""
    scene = context.scene
    store = addon_session().stores.open(store_path.store_folder(bpy.data.filepath))
    seen = viewport_camera.of_screen(context.screen)
    if store.model is None or seen is None:
        return None
    own = scene.lodestone
    live = addon_session().part(LiveStatistics)
    model, decided, chooser = store.model, (), live.chooser
    if preview_changes.any_pin():
        pinned = live.pinned
        pinned.follow(store, scene)
        model, decided, chooser = pinned.model, pinned.decided(), pinned.chooser
    parts_of = quality_lenses.parts_stored(model)
    detail = quality_lenses.detail(rendered_lenses(scene), parts_of, Problems())
    settings = Settings(
        pixel_error=own.pixel_error_viewport if own.use_levels else 0.0,
        modifiers=native.Modifiers(lenses=detail) if detail else None,
    )
    triangles = round(1e6 * own.budget_viewport) if own.use_levels else 0
    key = (*seen, triangles, decided, _hashable(settings))
    return chooser.statistics(model, key, *seen, settings, triangles, "viewport")


class _Pinned:
    """A store's model as viewports draw it, for where something is pinned."""

    def __init__(self) -> None:
        self.model: Any = None
        self.chooser = view_statistics.Chooser()
        self._key: Hashable = None
        self._model: Any = None  # preview_tree.Decided

    def follow(self, store: Any, scene: Any) -> None:
        """Reads it when it is not yet that of the store. Raises LodestoneError."""
        names = preview_changes.names_of(scene)
        key = (id(store), names)
        if self._key != key:
            self.model = native.Model.read(str(store.folder))
            self._model = preview_tree.Decided(self.model, names)
            self._key = key

    def decided(self) -> Hashable:
        changes = preview_changes.decisions(self._model.tree)
        self._model.apply(changes)
        return tuple(sorted(changes.items()))


class LiveStatistics:
    """The cuts that were chosen for panels; part of the session."""

    def __init__(self) -> None:
        self.chooser = view_statistics.Chooser()
        self.pinned = _Pinned()

    def close(self) -> None:
        """Frees the cuts of the store's model."""
        self.chooser.close()


def settings_of(
    scene: Any, parts_of: quality_lenses.PartsOf, closing: Any | None = None
) -> Settings:
    """The settings as F12 has them, but for motion, which takes another frame to see: `closing` is
    the camera as the shutter closes, where it is known."""
    own = SceneSettings(scene)
    detail = quality_lenses.detail(rendered_lenses(scene), parts_of, Problems())
    return Settings(
        pixel_error=quality_settings.pixel_error(own),
        overrides=quality_settings.overrides(own),
        budget=quality_settings.budget(own),
        modifiers=quality_lenses.modifiers(own, detail, scene.camera, closing),
    )


def lens_objects(scene: Any) -> list[Any]:
    return [item for item in scene.objects if item.type == "EMPTY" and quality_lenses.is_lens(item)]


def rendered_lenses(scene: Any) -> list[Any]:
    """The lenses of a scene without those whose collections are excluded or hidden from renders."""
    found = lens_objects(scene)
    rendered = rendered_objects(list(scene.view_layers)) if found else {}
    return [item for item in found if item in rendered]


def _hashable(settings: Settings) -> Hashable:
    """A value that is equal for settings that choose the same."""
    return (settings.pixel_error, settings.budget, settings.modifiers)


def forget() -> None:
    """Panels choose anew."""
    addon_session().drop(LiveStatistics)
