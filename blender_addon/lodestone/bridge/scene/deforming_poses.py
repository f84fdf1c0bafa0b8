# SPDX-License-Identifier: GPL-3.0-or-later
"""The poses of a scene: what deforms in it, in a few frames that are always the same ones.

Its levels are collapsed once to suit these poses, whichever frame is rendered first, by which
process, however often.
"""

from collections.abc import Callable
from typing import Any

from ...core.native import lodestone_native as native
from ...core.problems import Problems
from .. import datablock_ids
from ..datablock_ids import name_of
from ..motion import frame_stepping
from ..motion.motion_sampling import Motion, frames_to_sample
from ..scene_settings import SceneSettings
from . import scene_extraction
from .leaf_objects import DRAWN, Leaf, Leaves, Look, override_of

_IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


class Poses:
    """Models for BuildOptions, one a frame; close them when nothing is built any more."""

    def __init__(self) -> None:
        self.models: list[Any] = []

    def close(self) -> None:
        for model in self.models:
            model.close()
        self.models = []


class _DeformingLeaves(Leaves):
    """Nothing else is there."""

    def _get(self, data: Any, shown: Any, owner: Any, look: Look, *how: Any) -> Leaf | None:
        return super()._get(data, shown, owner, look, *how) if look.deforms else None


def wanted(depsgraph: Any, still: dict[str, list[str]] | None) -> bool:
    """Whether levels are to follow, and there may be something they would follow."""
    if SceneSettings(depsgraph.scene).deforming != "FOLLOW":
        return False
    motion = Motion(still)
    return any(
        item.type in DRAWN and (motion.deforms(item) or motion.emits_anew(item))
        for item in depsgraph.objects
    )


def read(
    depsgraph: Any,
    frame_set: frame_stepping.FrameSet,
    still: dict[str, list[str]] | None,
    tick: Callable[[], None],
) -> Poses:
    """`frame_set` brings the depsgraph to a frame: RenderEngine.frame_set, so only inside render();
    it is called for the frame it was in afterwards. `still`: what sample() found. Nothing
    that was read of the depsgraph before may be used after."""
    original = depsgraph.scene
    before = (original.frame_current, original.frame_subframe)
    sampled = frames_to_sample(original.frame_start, original.frame_end)
    poses = Poses()
    if not wanted(depsgraph, still):
        return poses
    try:
        for frame in sampled:
            frame_stepping.go(depsgraph, frame_set, frame, 0.0)
            poses.models.append(native.Model())
            _fill(poses.models[-1], depsgraph, still, tick)
    except BaseException:
        poses.close()
        raise
    finally:
        frame_stepping.go(depsgraph, frame_set, *before)
    return poses


def _fill(
    model: Any, depsgraph: Any, still: dict[str, list[str]] | None, tick: Callable[[], None]
) -> None:
    problems, uids = (
        Problems(),
        datablock_ids.Uids(),
    )  # of the frames that are drawn they are told anyway
    leaves = _DeformingLeaves(model, depsgraph.scene, uids, problems, override_of(depsgraph))
    scene_extraction.walked(depsgraph, leaves, problems, tick, Motion(still))
    root = model.add_group(uids.claim(datablock_ids.scene_uid(name_of(depsgraph.scene))), "Poses")
    for leaf in leaves:
        model.add_placement(root, leaf.object, _IDENTITY, leaf.data)
    model.set_root(root)
