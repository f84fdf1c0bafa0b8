# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as it was read last, kept with its levels: other cuts of it take milliseconds.

One scene is kept at a time. Any thread may put one, so whoever uses one holds its lock.
"""

import threading
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from ..native import lodestone_native as native

Key = tuple[str, str, str]  # as bridge.datablock_ids.Key


class Asked(NamedTuple):
    """A view, and how many bytes POV-Ray's scene may take; 0: any number."""

    view: native.View
    budget: int = 0


class Kept:
    """A model that is built (meshes that are in its store need not be in memory) and the view it
    was read for. `parts`: what the model's objects came from. Use it inside `with kept.lock`."""

    def __init__(
        self,
        model: native.Model,
        view: native.View,
        parts: dict[Key, list[native.Object]],
        frame: int,
    ) -> None:
        self.lock = threading.RLock()
        self.view = view
        self.parts = parts
        self.frame = frame
        self.outdated = False  # the scene has changed since
        self._model: native.Model | None = model
        self._cut: native.Cut | None = None
        self._asked: Asked | None = None  # the view that the cut is for

    @property
    def closed(self) -> bool:
        return self._model is None

    def cut(self, asked: Asked) -> native.Cut:
        """The cut for this view; the last one when it was for the same. A budget may make the Pixel
        Error of its `view` larger. Valid until the next call."""
        if self._cut is not None and self._asked == asked:
            return self._cut
        if self._model is None:
            raise ValueError("the kept model is closed")
        if asked.budget:
            made = native.Cut(self._model, asked.view, None, native.Budget(bytes=asked.budget))
            made.view = replace(made.view, pixel_error=made.pixel_error)
            self._drop_cut()
        elif self._cut is None:
            made = native.Cut(self._model, asked.view)
        else:
            made = self._cut
            made.step(asked.view)
        self._cut, self._asked = made, asked
        return made

    def find(self, keys: Iterable[Key], world: Iterable[float]) -> tuple[native.Drawn, int]:
        """The way the last cut draws the occurrence of a datablock at a place: (Drawn,
        position)."""
        rows = tuple(world)
        found = (native.Drawn.MISSING, -1)
        if self._cut is None:
            return found
        for item in dict.fromkeys(item for key in keys for item in self.parts.get(key, ())):
            found = self._cut.find_choice(item, rows)
            if found[0] != native.Drawn.MISSING:
                break
        return found

    def close(self) -> None:
        with self.lock:
            self._drop_cut()
            if self._model is not None:
                self._model.close()
                self._model = None

    def _drop_cut(self) -> None:
        if self._cut is not None:
            self._cut.close()
            self._cut, self._asked = None, None


class KeptModels:
    """The model of one scene at a time. Any thread may put one."""

    def __init__(self) -> None:
        self._kept: dict[str, Kept] = {}
        self._guard = threading.Lock()

    def put(self, scene: str, kept: Kept) -> None:
        """Keeps a model of a scene in the place of the one before, which is closed."""
        with self._guard:
            others = list(self._kept.values())
            self._kept.clear()
            self._kept[scene] = kept
        for other in others:
            other.close()

    def get(self, scene: str) -> Kept | None:
        """The model of a scene, if it is the one that is kept."""
        return self._kept.get(scene)

    def outdate(self) -> None:
        """The scenes are not any more as they were read."""
        for kept in list(self._kept.values()):
            kept.outdated = True

    def clear(self) -> None:
        """Closes the model that is kept."""
        with self._guard:
            others = list(self._kept.values())
            self._kept.clear()
        for other in others:
            other.close()
