# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of what a view of a store would use, for panels: chosen anew when the view or the
store changes."""

import time
from collections.abc import Hashable
from dataclasses import dataclass, replace

from .. import report_parts
from ..native import lodestone_native as native
from . import unseen_detail
from .picture_maker import POVRAY_KINDS, Settings

_ENDLESS = 1e300  # metres


@dataclass(frozen=True)
class Statistics:
    """The numbers of a view. `*_before`: those of the originals. `pixel_error`: the one that a
    budget made of it. `choose_s`: how long choosing took. `bytes`: of all that any ray meets."""

    triangles_before: int
    triangles: int
    bytes_before: int
    bytes: int
    kinds: dict[str, int]
    occurrences: int
    largest_error_px: float
    largest_error_name: str
    pixel_error: float
    fits: bool
    choose_s: float
    met: unseen_detail.Met | None = None  # by classes of rays that have levels of their own


class Chooser:
    """Remembers the last answers for a model, and their cuts, which go along with the camera. The
    model is the caller's."""

    def __init__(self) -> None:
        self._model: native.Model | None = None
        self._before: tuple[int, int] = (0, 0)
        self._known: dict[str, tuple[Hashable, Statistics]] = {}
        self._cuts: dict[str, native.Cut] = {}  # by what they are for; none of budgets

    def close(self) -> None:
        """Frees what is kept."""
        for cut in self._cuts.values():
            cut.close()
        self._model, self._known, self._cuts = None, {}, {}

    def statistics(
        self,
        model: native.Model,
        key: Hashable,
        camera: native.Camera,
        size: tuple[int, int],
        settings: Settings,
        triangles: int = 0,
        what: str = "render",
    ) -> Statistics:
        """The statistics of a view whose every input is in `key`. `triangles`: a budget of them,
        instead of the settings' bytes; 0: none. Raises LodestoneError."""
        if model is not self._model:
            self.close()
            self._model = model
            self._before = _originals(model, camera, size)
        if what in self._known and self._known[what][0] == key:
            return self._known[what][1]
        found = self._chosen(model, camera, size, settings, triangles, what)
        self._known[what] = (key, found)
        return found

    def _chosen(
        self,
        model: native.Model,
        camera: native.Camera,
        size: tuple[int, int],
        settings: Settings,
        triangles: int,
        what: str,
    ) -> Statistics:
        start = time.perf_counter()
        view = settings.view(camera, size)
        if what == "render" and not settings.levels:
            view = _of_originals(view)
        if triangles or settings.budget:
            with native.Cut(model, view, None, native.Budget(triangles, settings.budget)) as cut:
                return self._statistics(cut, start, cut.pixel_error)
        if what in self._cuts:
            self._cuts[what].step(view)
        else:
            self._cuts[what] = native.Cut(model, view)
        return self._statistics(self._cuts[what], start, settings.pixel_error)

    def _statistics(self, cut: native.Cut, start: float, pixel_error: float) -> Statistics:
        summary = cut.summary()
        part = report_parts.cut_part(summary)
        met = unseen_detail.met(cut)
        return Statistics(
            triangles_before=self._before[0],
            triangles=summary.triangles,
            bytes_before=self._before[1],
            bytes=summary.bytes if met is None else met.bytes,
            kinds=part["kinds"],
            occurrences=summary.occurrences,
            largest_error_px=summary.largest_error_px,
            largest_error_name=part["largest_error_name"],
            pixel_error=pixel_error,
            fits=cut.fits,
            choose_s=time.perf_counter() - start,
            met=met,
        )


def _originals(
    model: native.Model, camera: native.Camera, size: tuple[int, int]
) -> tuple[int, int]:
    """Triangles and bytes of what is placed; the same from everywhere."""
    view = _of_originals(native.View(camera, *size, 0.0, POVRAY_KINDS))
    with native.Cut(model, view) as cut:
        return (model.totals().triangles_placed, cut.summary().bytes)


def _of_originals(view: native.View) -> native.View:
    """A view that draws all originals, also of what is scaled to nothing, whose levels have no
    error on screen: here nothing but an original is good enough, however far it is."""
    modifiers = replace(view.modifiers or native.Modifiers(), criterion=native.Criterion.DISTANCE)
    return replace(view, pixel_error=_ENDLESS, modifiers=modifiers)
