# SPDX-License-Identifier: GPL-3.0-or-later
"""motion.json of a store: the animated objects that turned out to rest in the sampled frames.

Only a hint for what may be grouped and simplified: levels are found by what they were made from, so
an old or missing file never makes a picture wrong.
"""

import json
import os
from pathlib import Path

from .. import stable_ids

_KINDS = ("still_shape", "still_place")
_MOST_BYTES = 1 << 26


def read(store: Path) -> dict[str, list[str]]:
    """{"still_shape": uids, "still_place": uids}; empty lists when there is no usable file."""
    found: dict[str, list[str]] = {kind: [] for kind in _KINDS}
    path = store / "motion.json"
    try:
        if path.stat().st_size > _MOST_BYTES:
            return found
        value = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return found
    if not isinstance(value, dict):
        return found
    for kind in _KINDS:
        uids = value.get(kind)
        if isinstance(uids, list):
            found[kind] = [uid for uid in uids if isinstance(uid, str) and stable_ids.is_uid(uid)]
    return found


def write(store: Path, still: dict[str, list[str]]) -> None:
    """A file that says the same stays as it is. Raises OSError."""
    if {kind: list(still[kind]) for kind in _KINDS} == read(store) and (
        store / "motion.json"
    ).is_file():
        return
    store.mkdir(parents=True, exist_ok=True)
    temporary = store / f".motion-{os.getpid()}.json"
    try:
        temporary.write_text(json.dumps({kind: still[kind] for kind in _KINDS}), "utf-8")
        os.replace(temporary, store / "motion.json")
    finally:
        temporary.unlink(missing_ok=True)
