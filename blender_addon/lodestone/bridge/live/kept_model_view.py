# SPDX-License-Identifier: GPL-3.0-or-later
"""The view of a kept model as the scene asks for it now, and how its cut draws a datablock."""

from dataclasses import replace
from typing import Any

from ...core.picture import why_sentences
from ...core.problems import Problems
from ...core.session import kept_model
from .. import datablock_ids, quality_settings, render_result
from ...core.session.addon_session import addon_session
from ..scene import quality_lenses, scene_camera
from ..scene_settings import SceneSettings
from . import live_objects, live_view


def now(kept: Any, scene: Any, depsgraph: Any) -> "kept_model.Asked":
    """The view that the scene camera's picture asks for; the one that the model was read for when
    there is no camera. Motion, Importance and Use are as they were when the model was read."""
    if scene.camera is None or scene.camera.type != "CAMERA":
        return kept_model.Asked(kept.view)
    read_with = kept.view.modifiers
    settings = live_view.settings_of(
        scene, quality_lenses.parts_in(kept), None if read_with is None else read_with.closing
    )
    frame = scene_camera.Frame.of(scene.render)
    seen = scene_camera.extract(scene.camera.evaluated_get(depsgraph), frame, Problems())
    left, bottom, *part = render_result.border(scene.render, frame.width, frame.height)
    settings = replace(settings, border=(left, frame.height - bottom - part[1], *part))
    return kept_model.Asked(settings.view(seen, (frame.width, frame.height)), settings.budget)


def old(kept: Any, scene: Any) -> bool:
    """Whether the scene is not any more as it was read, or was read without what moves
    or lies in the dark: lights that changed meanwhile did not count."""
    own, read_with = SceneSettings(scene), kept.view.modifiers
    moving = quality_settings.is_coarser_moving_dark(own)
    still = read_with is None or not read_with.when_moving
    return kept.outdated or kept.frame != scene.frame_current or (moving and still)


def explained(scene: Any, depsgraph: Any, item: Any) -> "why_sentences.Explanation | None":
    """Why an object is drawn as it is; None when the scene was not read yet, or is in use."""
    kept = addon_session().kept_models.get(scene.name)
    if kept is None or not kept.lock.acquire(blocking=False):
        return None
    try:
        if kept.closed:
            return None
        cut = kept.cut(now(kept, scene, depsgraph))
        world = live_objects.expected_world(item.evaluated_get(depsgraph))
        drawn, position = kept.find([datablock_ids.key_of("object", item.original)], world)
        return why_sentences.explain(cut, drawn, position)
    finally:
        kept.lock.release()
