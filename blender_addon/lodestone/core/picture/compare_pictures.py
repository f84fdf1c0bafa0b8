# SPDX-License-Identifier: GPL-3.0-or-later
"""Two pictures of one view, by its originals and by its levels, and how much they differ: what
batch.py compare makes. Compare Levels in the window takes the same steps, one render each."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..native import lodestone_native as native
from . import compare_plan
from .cost_model import StoreCosts
from .picture_maker import Picture, Settings, make_identities, make_picture

STEPS = (compare_plan.ORIGINALS, compare_plan.LEVELS)


@dataclass
class Compared:
    """Two pictures and their difference. `pictures`: of the originals, of the levels; their EXRs
    lie at `paths`. `image`: the difference in false colors, top row first."""

    pictures: tuple[Picture, ...]
    paths: tuple[Path, ...]
    comparison: compare_plan.Comparison
    image: native.Image

    @property
    def parts(self) -> dict[str, Any]:
        """The report's: those of the picture by levels, and what the originals took beside it."""
        before, after = (picture.parts for picture in self.pictures)
        kept = ("cut", "export", "povray")
        return {
            **after,
            "compare": self.comparison.part(),
            "originals": {name: before[name] for name in kept},
        }


def compare(
    model: native.Model,
    camera: native.Camera,
    size: tuple[int, int],
    settings: Settings,
    folder: Path,
    new_job: Callable[[str], native.Job],
    costs: StoreCosts | None = None,
) -> Compared:
    """Makes two pictures as make_picture() does; everything it writes is in `folder`, which is its
    caller's."""
    plan = compare_plan.Plan(folder, settings.pixel_error)
    pictures = []
    for step, how in zip(STEPS, (settings.of_originals(), settings)):
        plan.step = step
        made = make_picture(model, camera, size, how, folder, new_job, costs)
        plan.take(made, *make_identities(model, camera, size, how, plan.folder, new_job))
        pictures.append(made)
    image = plan.compare(bottom_up=False)
    assert plan.comparison is not None
    paths = tuple(plan.picture(step) for step in STEPS)
    return Compared(tuple(pictures), paths, plan.comparison, image)
