# SPDX-License-Identifier: GPL-3.0-or-later
"""The view of a kept model as the scene has it now, and how the model's cut draws a datablock."""

from dataclasses import replace
from typing import Any

from ..core import kept_model, why
from ..core.problems import Problems
from . import camera, ids, preview_live, quality, render_result
from .settings import SceneSettings


def now(kept: Any, scene: Any, depsgraph: Any) -> Any:
    """The view the scene camera has; the one the model was read for when there is no camera.
    Everything else that bends quality is as it was when the model was read."""
    if scene.camera is None or scene.camera.type != "CAMERA":
        return kept.view
    frame = camera.Frame.of(scene.render)
    seen = camera.extract(scene.camera.evaluated_get(depsgraph), frame, Problems())
    left, bottom, *part = render_result.border(scene.render, frame.width, frame.height)
    return replace(
        kept.view,
        camera=seen,
        width=frame.width,
        height=frame.height,
        pixel_error=quality.pixel_error(SceneSettings(scene)),
        border=(left, frame.height - bottom - part[1], *part),
    )


def explained(scene: Any, depsgraph: Any, item: Any) -> "why.Explanation | None":
    """Why an object is drawn as it is; None when the scene was not read yet, or is in use."""
    kept = kept_model.get(scene.name)
    if kept is None or not kept.lock.acquire(blocking=False):
        return None
    try:
        if kept.closed:
            return None
        cut = kept.cut(now(kept, scene, depsgraph))
        world = preview_live.expected_world(item.evaluated_get(depsgraph))
        drawn, position = kept.find([ids.key_of("object", item.original)], world)
        return why.explain(cut, drawn, position)
    finally:
        kept.lock.release()
