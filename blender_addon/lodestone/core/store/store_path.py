# SPDX-License-Identifier: GPL-3.0-or-later
"""The folders of a file's computed levels and of its scene files."""

import hashlib
import os
from collections.abc import Mapping
from pathlib import Path

from .. import file_names

FOLDER = "lodestone"
INDEX = "tileset.json"  # a folder with it is a store
SCENE_ENDING = ".scene"  # of the folders that file_names knows to lie beside a store


def cache_folder(environment: Mapping[str, str] | None = None) -> Path:
    """$LODESTONE_CACHE, default the user's cache folder."""
    environment = os.environ if environment is None else environment
    chosen = environment.get("LODESTONE_CACHE")
    if chosen:
        return Path(chosen)
    base = environment.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / FOLDER


def store_folder(
    blend: str, override: str = "", environment: Mapping[str, str] | None = None
) -> Path:
    """The store of a .blend: beside it, //lodestone/NAME/; where that cannot be written, or for an
    unsaved file (""): in the cache folder, by hash of the path. `override` wins over both."""
    if override:
        return Path(override)
    if not blend:
        return cache_folder(environment) / "unsaved"
    path = Path(os.path.abspath(blend))
    name = file_names.folder_name(path)
    beside = path.parent / FOLDER / name
    if writable(beside):
        return beside
    key = hashlib.blake2b(os.fsencode(str(path)), digest_size=8).hexdigest()
    return cache_folder(environment) / f"{file_names.fitting(name, 200)}-{key}"


def scene_folder(store: Path) -> Path:
    """The folder for the files of a POV-Ray scene that is to be kept, beside the store."""
    return store.with_name(store.name + SCENE_ENDING)


def writable(folder: Path) -> bool:
    """True when files can be written into folder, which may have to be made first."""
    for place in (folder, *folder.parents):
        if place.exists():
            return place.is_dir() and os.access(place, os.W_OK | os.X_OK)
    return False
