# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the last picture of a scene, for the panels. Never part of the file."""

from dataclasses import dataclass, field

from ..picture.picture_maker import Picture
from ..picture.slow_causes import Remedy


@dataclass(frozen=True)
class LastRender:
    """Numbers of a finished picture; `in_use` maps a uid to {LOD number: occurrences}."""

    triangles_placed: int
    triangles: int
    kinds: dict[str, int]
    largest_error_px: float
    largest_error_name: str
    in_use: dict[str, dict[int, int]] = field(default_factory=dict)
    without_levels: int = 0  # objects and groups not built yet
    predicted_s: float = 0.0  # POV-Ray's time by the clock, told before the picture
    actual_s: float = 0.0
    predicted_bytes: int = 0  # its memory, likewise
    actual_bytes: int = 0
    remedies: dict[str, Remedy] = field(default_factory=dict)  # of slow causes, by problem's code

    @classmethod
    def of(cls, made: Picture, triangles_placed: int, without_levels: int) -> "LastRender":
        """The numbers of a picture that was predicted and drawn."""
        cut, ran, predicted = made.parts["cut"], made.parts["povray"], made.parts["predicted"]
        return cls(
            triangles_placed,
            cut["triangles"],
            cut["kinds"],
            cut["largest_error_px"],
            cut["largest_error_name"],
            made.in_use,
            without_levels,
            predicted["wall_s"],
            ran["wall_s"],
            predicted["peak_bytes"],
            ran["peak_bytes"],
            made.remedies,
        )
