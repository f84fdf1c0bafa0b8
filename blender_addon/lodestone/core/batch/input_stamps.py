# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs that a file's results depend on, so that a later run knows whether they must be made
again: the bytes of the .blend, and size and time of everything it links or loads."""

import glob
import hashlib
import json
import os
from collections.abc import Callable, Iterable
from typing import Any

_CHUNK = 8 << 20
_MOST_OTHERS = 100_000


def read(
    blend: str, others: Iterable[str], tick: Callable[[], None] = lambda: None
) -> dict[str, Any]:
    """Raises OSError when the .blend cannot be read. `others` are paths; <UDIM> and its like stand
    for any text."""
    return {"blend": hash_file(blend, tick), "others": stamps(others)}


def stamps(paths: Iterable[str]) -> list[list[Any]]:
    """The stamps of some paths, [path, stamp] of each."""
    return [[path, stamp(path)] for path in sorted({p for p in paths if p})[:_MOST_OTHERS]]


def hash_file(path: str, tick: Callable[[], None] = lambda: None) -> str:
    """The hash of a file's bytes. `tick` is called between parts, and may raise."""
    found = hashlib.blake2b(digest_size=16)
    with open(path, "rb") as file:
        while data := file.read(_CHUNK):
            tick()
            found.update(data)
    return found.hexdigest()


def stamp(path: str) -> list[int] | None:
    """The stamp of a file, [bytes, time of the last change in ns]; None when there is nothing."""
    if "<" in path and ">" in path and not os.path.exists(path):
        return _stamp_of_many(path)
    try:
        state = os.stat(path)
    except (OSError, ValueError):
        return None
    return [state.st_size, state.st_mtime_ns]


def _stamp_of_many(path: str) -> list[int] | None:
    """The stamp of all tiles of an image together."""
    folder, name = os.path.split(path)
    before, after = name.split("<", 1)[0], name.rsplit(">", 1)[-1]
    pattern = os.path.join(glob.escape(folder), f"{glob.escape(before)}*{glob.escape(after)}")
    found = [known for tile in glob.glob(pattern) if (known := stamp(tile)) is not None]
    return [sum(known[0] for known in found), max(known[1] for known in found)] if found else None


def unchanged(before: Any, blend: str, tick: Callable[[], None] = lambda: None) -> bool:
    """Whether read() would say the same again. `before` may be anything a log held."""
    try:
        if any(stamp(path) != known for path, known in before["others"]):
            return False
        return bool(hash_file(blend, tick) == before["blend"])
    except (OSError, KeyError, TypeError, ValueError):
        return False


def identity(inputs: dict[str, Any]) -> str:
    """A short name for them in a log."""
    text = json.dumps(inputs, sort_keys=True)
    return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()
