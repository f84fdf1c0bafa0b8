# SPDX-License-Identifier: GPL-3.0-or-later
"""The levels in a store, for panels: read once for each state of the store, never blocking
twice."""

import shutil
from dataclasses import dataclass
from pathlib import Path

from ..native import lodestone_native as native
from .store_path import INDEX


@dataclass(frozen=True)
class Level:
    lod: int
    kind: int
    triangles: int
    error: float  # metres


class Store:
    """The levels of a store by uid; `problem` says why there are none."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.problem = ""
        self._levels: dict[str, tuple[Level, ...]] = {}
        self._model: native.Model | None = None
        if not (folder / INDEX).is_file():
            return
        try:
            self._model = native.Model.read(str(folder))
        except native.LodestoneError as error:
            self.problem = str(error)

    @property
    def model(self) -> native.Model | None:
        """All of it, the meshes on the disk; None when there is none."""
        return self._model

    def levels(self, uid: str) -> tuple[Level, ...]:
        """Finest first; () when the store knows no such thing."""
        if self._model is None:
            return ()
        if uid not in self._levels:
            self._levels[uid] = self._read(self._model, uid)
        return self._levels[uid]

    def _read(self, model: native.Model, uid: str) -> tuple[Level, ...]:
        try:
            item = model.find_object(uid)
            if item is None:
                return ()
            count = model.object_summary(item).representation_count
            found = [model.representation(item, lod) for lod in range(count)]
        except native.LodestoneError as error:
            self.problem = str(error)
            return ()
        return tuple(Level(i, r.kind, r.triangles, r.error) for i, r in enumerate(found))


class StoreReader:
    """Holds the store that was read last."""

    def __init__(self) -> None:
        self._read: tuple[tuple[str, int], Store] | None = None

    def open(self, folder: Path) -> Store:
        """The store as it is now; read again only after it has changed."""
        try:
            stamp = (folder / INDEX).stat().st_mtime_ns
        except OSError:
            stamp = 0
        key = (str(folder), stamp)
        if self._read is None or self._read[0] != key:
            self._read = (key, Store(folder))
        return self._read[1]

    def forget(self) -> None:
        """The store is read again when it is next asked for."""
        self._read = None

    def remove(self, folder: Path) -> bool:
        """Deletes a store, and only a store: a folder without its index is left alone. True if it
        was there. Raises OSError."""
        if not is_store(folder):
            return False
        self.forget()
        shutil.rmtree(folder)
        return True


def is_store(folder: Path) -> bool:
    """Whether a folder is one of levels."""
    return (folder / INDEX).is_file()
