# SPDX-License-Identifier: GPL-3.0-or-later
"""The places of things when the shutter closes: for drawing coarser what crosses the picture
fast."""

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from mathutils import Matrix

from ..listed_instances import rows
from . import frame_stepping


class Moving(NamedTuple):
    """A placement that an animation moves: the `position`-th of a group without a transform of its
    own, placed as `item` (an original) or by it."""

    group: Any
    position: int
    item: Any
    place: tuple[float, ...]  # 12, by rows


def read(
    depsgraph: Any,
    frame_set: frame_stepping.FrameSet,
    moving: Iterable[Moving],
    model: Any,
    camera: Callable[[], Any],
) -> Any:
    """Tells the model where the placements go, and returns what `camera()` finds at that time.
    Moves the depsgraph there and back: evaluated objects must be asked for anew."""
    scene = depsgraph.scene_eval
    frame, subframe = scene.frame_current, scene.frame_subframe
    shutter = max(0.0, scene.render.motion_blur_shutter)
    moving = list(moving)
    before = [one.item.evaluated_get(depsgraph).matrix_world.copy() for one in moving]
    end = frame + subframe + shutter
    frame_stepping.go(depsgraph, frame_set, int(end // 1), end % 1.0)
    try:
        after = [one.item.evaluated_get(depsgraph).matrix_world.copy() for one in moving]
        found = camera()
    finally:
        frame_stepping.go(depsgraph, frame_set, frame, subframe)
    for one, start, stop in zip(moving, before, after):
        if start != stop:
            model.move_placement(one.group, one.position, _moved(one.place, start, stop))
    return found


def _moved(place: tuple[float, ...], start: Matrix, stop: Matrix) -> tuple[float, ...] | None:
    """The place after the move from start to stop; None for what had no volume: nobody could tell
    how it moves."""
    matrix = Matrix((place[0:4], place[4:8], place[8:12], (0.0, 0.0, 0.0, 1.0)))
    try:
        return tuple(rows(stop @ start.inverted() @ matrix))
    except ValueError:
        return None
