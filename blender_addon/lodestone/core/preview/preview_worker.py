# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses for viewports and makes what they draw, on a thread: a redraw waits for nothing.

The thread owns the model. It is asked for one picture of each viewport at a time (the latest
counts) and answers with batches, which viewports keep by their keys, and with pictures, which name
the batches they are made of. A picture comes coarse first, then as it was asked for.
"""

import threading
import time
import traceback
from collections import OrderedDict, deque
from collections.abc import Hashable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from .. import progress_text
from ..native import lodestone_native as native
from ..picture import false_colors
from ..picture.picture_maker import POVRAY_KINDS
from ..store.store_levels import is_store
from . import preview_tree
from .preview_tree import NOT_FORCED, Changes, Names, Tree

MOST_TRIANGLES = 8_000_000  # in a picture, whatever its budget: 0.2 GB
COARSE_FIRST = 8.0  # times Pixel Error
PATIENCE_S = 0.25  # a picture that takes longer is given up when the view has moved on
NO_COLORS = "NONE"
TOO_FINE = (
    "LOD {} of everything is {} triangles, a viewport draws at most "
    f"{MOST_TRIANGLES // 1_000_000} M: force a coarser one"
)


class LiveThing:
    """Some objects that the levels do not know as they are, drawn as they are: a model of its own
    whose root places them. Belongs to the worker once it was asked for."""

    def __init__(self, model: native.Model) -> None:
        self.model = model


@dataclass(frozen=True)
class Wanted:
    """Everything that a viewport's picture depends on; equal ones draw the same. `lenses`: with the
    uids of the collections that they list. `force`: the LOD number of every object, whatever the
    Pixel Error and what is decided."""

    camera: native.Camera
    size: tuple[int, int]
    pixel_error: float
    triangles: int = 0  # budget; 0: none
    lenses: tuple[tuple[native.Lens, str], ...] = ()
    mode: str = NO_COLORS
    force: int = NOT_FORCED
    state: Hashable = 0
    things: "Things | None" = None  # told apart by `state`

    def key(self) -> Hashable:
        return replace(self, things=None)


class Things(NamedTuple):
    """The objects that are drawn as they are. `number`: how many there are; `left_out`: of those
    there is no room for."""

    changes: Changes = {}
    live: tuple[LiveThing, ...] = ()
    number: int = 0
    left_out: int = 0


class Made(NamedTuple):
    """A batch."""

    key: int
    mesh: native.BatchMesh


@dataclass(frozen=True)
class Picture:
    viewport: Hashable
    wanted: Wanted
    keys: tuple[int, ...]
    final: bool  # else a finer one follows
    triangles: int
    triangles_before: int
    drawn: int  # occurrences
    occurrences: int  # in the scene
    pixel_error: float  # found
    fits: bool
    things: Things
    choose_s: float


class Failed(NamedTuple):
    viewport: Hashable
    text: str


READY = Failed(None, "")  # the first answer: the model was read, or cannot be


class Worker:
    """Start it by asking. Every method but close() returns at once; close() waits for what runs."""

    def __init__(self, folder: Path, names: Names) -> None:
        self.tree: Tree | None = None  # set once, when the model was read
        self.ready = False  # it was read, or cannot be
        self.problem = ""  # why there are no levels
        self._folder, self._names = folder, names
        self._model: native.Model | None = None
        self._last: native.Cut | None = None  # cut without a budget
        self._before: tuple[int, int] = (0, 0)  # triangles, occurrences
        self._decided: preview_tree.Decided | None = None
        self._asked: OrderedDict[Hashable, Wanted] = OrderedDict()
        self._pictured: set[Hashable] = set()
        self._have: set[int] = set()
        self._out: deque[Made | Picture | Failed] = deque()
        self._changed = threading.Condition()
        self._job = native.Job()
        self._closing = False
        self._busy = True
        self._thread = threading.Thread(target=self._run, name="Lodestone viewport", daemon=True)
        self._thread.start()

    # ---- From the main thread ----

    def ask(self, viewport: Hashable, wanted: Wanted) -> None:
        with self._changed:
            self._asked[viewport] = wanted
            self._busy = True
            self._changed.notify()

    def forget(self, viewport: Hashable) -> None:
        """It is gone, or starts anew."""
        with self._changed:
            self._asked.pop(viewport, None)
            self._pictured.discard(viewport)

    def dropped(self, keys: Iterable[int]) -> None:
        """These batches are not kept any longer."""
        with self._changed:
            self._have.difference_update(keys)

    def take(self) -> "Made | Picture | Failed | None":
        """The next answer."""
        try:
            return self._out.popleft()
        except IndexError:
            return None

    @property
    def answered(self) -> bool:
        return bool(self._out)

    @property
    def busy(self) -> bool:
        return self._busy or bool(self._out)

    def close(self) -> None:
        with self._changed:
            self._closing = True
            self._asked.clear()
            self._job.stop()
            self._changed.notify()
        self._thread.join()

    # ---- On the thread ----

    def _run(self) -> None:
        try:
            self._read()
        except native.LodestoneError as error:
            self.problem = str(error)
        except Exception as error:
            traceback.print_exc()
            self.problem = f"Levels cannot be read: {error!r} (see the console)"
        self.ready = True
        self._out.append(READY)
        while True:
            with self._changed:
                while not self._asked and not self._closing:
                    self._busy = False
                    if self._model is not None:
                        native.release_meshes(self._model)
                    self._changed.wait()
                if self._closing:
                    break
                viewport, wanted = self._asked.popitem(last=False)
                self._job = native.Job()
            try:
                self._make(viewport, wanted)
            except native.LodestoneError as error:
                if error.status != native.Status.CANCELLED:
                    self._out.append(Failed(viewport, str(error)))
            except Exception as error:
                traceback.print_exc()
                self._out.append(Failed(viewport, f"{error!r} (see the console)"))
        if self._last is not None:
            self._last.close()
        if self._model is not None:
            self._model.close()

    def _read(self) -> None:
        if not is_store(self._folder):
            return
        model = native.Model.read(str(self._folder))
        decided = preview_tree.Decided(model, self._names)
        if not decided.found:  # it is another scene's
            model.close()
            return
        totals = model.totals()
        self._before = (totals.triangles_placed, totals.occurrences)
        self._decided, self._model, self.tree = decided, model, decided.tree

    def _superseded(self, viewport: Hashable, since: float) -> bool:
        late = time.monotonic() - since > PATIENCE_S
        return self._closing or (late and viewport in self._asked)

    def _make(self, viewport: Hashable, wanted: Wanted) -> None:
        since = time.monotonic()
        errors = [wanted.pixel_error]
        if wanted.force != NOT_FORCED:
            pass  # there is no coarser one
        elif viewport not in self._pictured and wanted.pixel_error > 0.0:
            errors.insert(0, COARSE_FIRST * wanted.pixel_error)
        elif viewport not in self._pictured and self._model is not None:
            errors.insert(0, COARSE_FIRST)
        assert wanted.things is not None
        for number, error in enumerate(errors):
            final = number == len(errors) - 1
            if not self._one(viewport, replace(wanted, pixel_error=error), wanted, since, final):
                return
            self._pictured.add(viewport)

    def _one(
        self, viewport: Hashable, wanted: Wanted, asked: Wanted, since: float, final: bool
    ) -> bool:
        """False: it was given up."""
        keys: list[int] = []
        triangles = drawn = 0
        error, fits, choose_s = wanted.pixel_error, True, 0.0
        things = wanted.things
        assert things is not None
        if self._model is not None and self._decided is not None:
            start = time.perf_counter()
            self._decided.apply(things.changes, wanted.force)
            with self._cut(self._model, viewport, wanted) as cut:
                choose_s = time.perf_counter() - start
                if cut is None:
                    return False
                error, fits = cut.pixel_error, cut.fits
                drawn = cut.summary().occurrences
                count = self._batches(viewport, cut, wanted.mode, keys, since)
                if count is None:
                    return False
                triangles = count
        for thing in things.live:
            view = self._view(wanted)
            with native.Cut(thing.model, replace(view, pixel_error=0.0, modifiers=None)) as cut:
                drawn += cut.summary().occurrences
                count = self._batches(viewport, cut, wanted.mode, keys, since)
                if count is None:
                    return False
                triangles += count
        before, occurrences = self._before
        self._out.append(
            Picture(
                viewport, asked, tuple(keys), final, triangles, max(before, triangles), drawn,
                max(occurrences, drawn), error, fits, things, choose_s,
            )
        )  # fmt: skip
        return True

    def _view(self, wanted: Wanted) -> native.View:
        lenses = []
        for lens, uid in wanted.lenses:
            if uid:
                part = self._model.find_object(uid) if self._model is not None else None
                lens = replace(lens, objects=() if part is None else (part,))
            lenses.append(lens)
        modifiers = native.Modifiers(lenses=tuple(lenses)) if lenses else None
        return native.View(
            wanted.camera, *wanted.size, wanted.pixel_error, POVRAY_KINDS, modifiers=modifiers
        )

    def _along(self, model: native.Model, view: native.View) -> native.Cut:
        """The last cut, gone along to this view."""
        if self._last is None:
            self._last = native.Cut(model, view, self._job)
        else:
            self._last.step(view, self._job)
        return self._last

    @contextmanager
    def _cut(
        self, model: native.Model, viewport: Hashable, wanted: Wanted
    ) -> Iterator[native.Cut | None]:
        """None: what is forced is too much, which the viewport is told."""
        view, most = self._view(wanted), MOST_TRIANGLES
        if wanted.force != NOT_FORCED or not wanted.triangles:
            cut = self._along(model, view)
            triangles = cut.summary().triangles
            if triangles <= most:
                yield cut
                return
            if wanted.force != NOT_FORCED:
                self._out.append(
                    Failed(viewport, TOO_FINE.format(wanted.force, progress_text.count(triangles)))
                )
                yield None
                return
        else:
            most = min(most, wanted.triangles)
        with native.Cut(model, view, self._job, native.Budget(triangles=most)) as cut:
            cut.view = replace(view, pixel_error=cut.pixel_error)  # that false colors are told by
            yield cut

    def _batches(
        self, viewport: Hashable, cut: native.Cut, mode: str, keys: list[int], since: float
    ) -> int | None:
        """Hands out those that are not there yet. How many triangles all have; None: given up."""
        if mode != NO_COLORS:
            cut.set_colors(false_colors.colors(cut, mode))
        found, triangles = cut.make_batches()
        for position, key in enumerate(found):
            keys.append(key)
            with self._changed:
                known = key in self._have
                self._have.add(key)
            if known:
                continue
            if self._superseded(viewport, since):
                self.dropped((key,))
                return None
            try:
                mesh = cut.batch_mesh(position, self._job)
            except BaseException:
                self.dropped((key,))
                raise
            self._out.append(Made(key, mesh))
        return sum(triangles)
