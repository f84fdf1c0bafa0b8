# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare: what the render engine does for it, and what comes out.

While a plan is current, the engine's pictures are its steps: the originals, the levels, and their
difference in false colors.
"""

import os
import shutil
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..native import lodestone_native as native
from .picture_maker import Picture

ORIGINALS, LEVELS, DIFFERENCE = 0, 1, 2
WORDS = ("originals", "levels", "difference")
_WORST = 3


@dataclass(frozen=True)
class Comparison:
    """Differences of display values 0...1 over the covered pixels; `worst` are paths of placements
    with their share of all differences, largest first."""

    mean: float
    max: float
    ssim: float
    pixels: int
    pixel_error: float
    worst: tuple[tuple[str, float], ...] = ()
    p999: float = 0.0

    def part(self) -> dict[str, Any]:
        """The report's part."""
        return {
            "mean": self.mean,
            "p999": self.p999,
            "max": self.max,
            "ssim": self.ssim,
            "pixels": self.pixels,
            "worst": [{"object": path, "share": share} for path, share in self.worst],
        }

    @property
    def sentence(self) -> str:
        text = f"Mean difference {255 * self.mean:.2f}, largest {255 * self.max:.0f} of 255; "
        text += f"SSIM {self.ssim:.4f}"
        if self.worst:
            text += f"; most differs {self.worst[0][0].rsplit('/', 1)[-1]}"
        return text


class Plan:
    """One comparison, in a folder of its own that its owner removes."""

    def __init__(self, folder: Path, pixel_error: float) -> None:
        self.root = folder
        self.pixel_error = pixel_error
        self.step = ORIGINALS
        self.comparison: Comparison | None = None
        self._paths: dict[int, list[str]] = {}

    @property
    def folder(self) -> Path:
        """The folder of this step's picture of what is shown where."""
        return self.root / WORDS[self.step]

    @property
    def has_this(self) -> bool:
        """Whether this step's picture is there: of several view layers the first one counts."""
        return self.step in self._paths

    @property
    def finished_step(self) -> bool:
        return self.comparison is not None if self.step == DIFFERENCE else self.has_this

    def take(self, made: Picture, shown: Path, paths: list[str]) -> None:
        """This step's picture_maker.Picture, which of its choices each pixel shows, and their
        paths."""
        os.replace(shown, self._shown(self.step))
        shutil.copyfile(made.path, self.picture(self.step))
        self._paths[self.step] = paths
        if self.step == LEVELS:  # a budget may have asked for coarser ones
            self.pixel_error = made.parts["cut"].get("pixel_error", self.pixel_error)

    def compare(self, bottom_up: bool = True) -> native.Image:
        """The difference as an image, lowest row first (Blender's order) or last; fills
        `comparison`."""
        difference, sums, image = native.image_compare_shown(
            (str(self.picture(ORIGINALS)), str(self.picture(LEVELS))),
            (str(self._shown(ORIGINALS)), str(self._shown(LEVELS))),
            (len(self._paths[ORIGINALS]), len(self._paths[LEVELS])),
            bottom_up=bottom_up,
        )
        listed = [(self._paths[step], sums[step]) for step in (ORIGINALS, LEVELS)]
        self.comparison = Comparison(
            difference.mean,
            difference.max,
            difference.ssim,
            difference.pixels,
            self.pixel_error,
            worst_of(listed),
            difference.p999,
        )
        return image

    def picture(self, step: int) -> Path:
        """The path of a step's picture."""
        return self.root / f"{WORDS[step]}.exr"

    def _shown(self, step: int) -> Path:
        return self.root / f"{WORDS[step]}_shown.exr"


def worst_of(
    listed: Iterable[tuple[Iterable[str], Iterable[float]]], most: int = _WORST
) -> tuple[tuple[str, float], ...]:
    """Paths with their share of the whole, from lists of paths and lists of sums; what is in
    several lists counts once."""
    together: dict[str, float] = defaultdict(float)
    for paths, sums in listed:
        for path, value in zip(paths, sums):
            if value > 0.0:
                together[path] += value
    whole = sum(together.values())
    order = sorted(together.items(), key=lambda item: (-item[1], item[0]))
    return tuple((path, value / whole) for path, value in order[:most])
