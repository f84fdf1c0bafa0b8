# SPDX-License-Identifier: GPL-3.0-or-later
"""The state that a viewport keeps between two redraws: the picture it shows, the next one, what is
in sight. It needs neither Blender nor a GPU."""

from collections.abc import Callable, Hashable, Iterable, Sequence

from .. import progress_text
from .preview_tree import NOT_FORCED
from .preview_worker import Picture, Wanted

Planes = list[tuple[float, float, float, float]]


def planes_of(matrix: Sequence[Sequence[float]]) -> Planes:
    """The planes around what a projection (4 x 4 rows, world to clip space) shows: a x + b y + c z
    + d >= 0 inside."""
    last = matrix[3]
    planes = []
    for row in matrix[:3]:
        for sign in (1.0, -1.0):
            planes.append(tuple(a + sign * b for a, b in zip(last, row)))
    return planes  # type: ignore[return-value]


def outside(planes: Planes, box: Sequence[float]) -> bool:
    """A box (lower and upper corner) that is surely not seen."""
    for a, b, c, d in planes:
        x = box[3] if a > 0.0 else box[0]
        y = box[4] if b > 0.0 else box[1]
        z = box[5] if c > 0.0 else box[2]
        if a * x + b * y + c * z + d < 0.0:
            return True
    return False


class View:
    """The state of one viewport. `shown` is complete; `next` waits for its batches."""

    def __init__(self) -> None:
        self.asked: Hashable = None  # key of the last Wanted
        self.shown: Picture | None = None
        self.next: Picture | None = None
        self.problem = ""

    def wants(self, wanted: Wanted) -> bool:
        """True when it is to be asked for."""
        if wanted.key() == self.asked:
            return False
        self.asked = wanted.key()
        return True

    def again(self) -> None:
        self.asked = None

    def advance(self, there: Callable[[int], bool]) -> list[int]:
        """Shows the next picture when its batches are there; else returns those that lack."""
        if self.next is None:
            return []
        lacking = [key for key in self.next.keys if not there(key)]
        if not lacking:
            self.shown, self.next = self.next, None
        return lacking

    def keys(self) -> Iterable[int]:
        for picture in (self.shown, self.next):
            if picture is not None:
                yield from picture.keys

    def line(self) -> str:
        """The line at the top of the viewport."""
        return "Lodestone: " + " | ".join(self.lines())

    def lines(self) -> list[str]:
        """The lines that tell what is drawn."""
        if self.problem:
            return [self.problem]
        picture = self.shown
        if picture is None:
            return ["reading levels"]
        parts = [
            f"{progress_text.count(picture.triangles)} of "
            f"{progress_text.count(picture.triangles_before)} triangles",
            f"{picture.drawn:,} drawn of {picture.occurrences:,}",
            f"Pixel Error {picture.pixel_error:.3g}",
        ]
        if picture.wanted.force != NOT_FORCED:
            parts[-1] = f"every object at LOD {picture.wanted.force}"
        if not picture.fits:
            parts.append("even the coarsest levels are more than the budget")
        if picture.things.number:
            parts.append(f"{picture.things.number:,} without levels are drawn as they are")
        if picture.things.left_out:
            parts.append(f"{picture.things.left_out:,} without levels are too much and left out")
        if not picture.final or self.next is not None:
            parts.append("refining")
        return parts
