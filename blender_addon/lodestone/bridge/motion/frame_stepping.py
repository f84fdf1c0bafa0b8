# SPDX-License-Identifier: GPL-3.0-or-later
"""Bringing a depsgraph to another frame inside render(), and back."""

from collections.abc import Callable
from typing import Any

FrameSet = Callable[[int, float], None]  # RenderEngine.frame_set


def go(depsgraph: Any, frame_set: FrameSet, frame: int, subframe: float) -> None:
    """All of the scene as it is then. Evaluated things must be asked for anew."""
    frame_set(frame, subframe)
    evaluated, original = depsgraph.scene_eval.camera, depsgraph.scene.camera
    if evaluated is None or evaluated.original != original:
        # Blender switches to a marker's camera after it has evaluated the scene
        frame_set(frame, subframe)
