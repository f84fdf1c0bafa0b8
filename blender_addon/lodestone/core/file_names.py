# SPDX-License-Identifier: GPL-3.0-or-later
"""Names for results that are called after the user's files, whatever those are called."""

import hashlib
import os
from pathlib import Path

LONGEST = 255  # bytes of a name in a folder
_BESIDE = (".scene", ".log")  # endings of what lies beside a file's folder


def fitting(name: str, most: int = LONGEST) -> str:
    """The name if it has at most that many bytes, else its beginning and a hash of it."""
    data = os.fsencode(name)
    if len(data) <= most:
        return name
    key = _key(name)
    return f"{data[: most - 1 - len(key)].decode('utf-8', 'ignore')}-{key}"


def folder_name(file: str | Path) -> str:
    """The name of the folder of a file's results: the file's name without its ending, unless that
    would lead out of the folder around it, be taken for what lies beside another's, or be too long
    for it."""
    path = Path(file)
    stem = path.stem
    if stem in ("", ".", "..") or stem.endswith(_BESIDE):
        stem = f"{stem.replace('.', '_')}-{_key(path.name)}"
    return fitting(stem, LONGEST - max(map(len, _BESIDE)))


def _key(name: str) -> str:
    return hashlib.blake2b(os.fsencode(name), digest_size=8).hexdigest()
