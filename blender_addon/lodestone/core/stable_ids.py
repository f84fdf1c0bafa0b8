# SPDX-License-Identifier: GPL-3.0-or-later
"""Ids that stay the same from one run to the next: 16 hexadecimal digits.

A thing is known by its library and name: nothing has to be written into the file for that. A uid
is stored only where it says more: with a decision, which has to survive renames, and where a name
is not enough. It starts as the hash of library and name, so what was known before stays known.
"""

import hashlib
from collections.abc import Iterable
from functools import lru_cache

DIGITS = 16


def stable_id(*parts: object) -> str:
    """16 hex digits of the parts; ("a", "bc") and ("ab", "c") differ."""
    digest = hashlib.blake2b(digest_size=DIGITS // 2)
    for part in parts:
        data = str(part).encode("utf-8", "surrogateescape")
        digest.update(len(data).to_bytes(8, "little"))
        digest.update(data)
    return digest.hexdigest()


@lru_cache(maxsize=1 << 16)  # a material is asked for by each of its users, in every frame
def named_id(kind: str, library: str, name: str) -> str:
    """The id of a datablock that has no stored uid."""
    return stable_id(kind, library, name)


def same_library(a: str, b: str) -> bool:
    """Whether two paths may name one library: equal, or one of them relative ("//" as in Blender)
    and the other ending with it."""
    if a == b:
        return True
    if not (a.startswith("//") or b.startswith("//")):
        return False
    short, long = sorted((_steps(a), _steps(b)), key=len)
    return bool(short) and long[-len(short) :] == short


def _steps(path: str) -> list[str]:
    steps = path.replace("\\", "/").split("/")
    return [step for step in steps if step not in ("", ".", "..")]


def is_uid(text: str) -> bool:
    return len(text) == DIGITS and all(c in "0123456789abcdef" for c in text)


def assign_uids(
    things: Iterable[tuple[str, str, str, str, bool]], taken: Iterable[str] = ()
) -> list[str]:
    """The uid each (kind, library, name, stored uid, decided) has to store, in order; "" where its
    name is enough. The names they are then known by are all different and none of taken.

    A stored one is kept by the first thing that has it. A copy, and a thing that has none, is known
    by its name, unless it holds a decision or another thing has that id.
    """
    items = list(things)
    used = set(taken)
    result: list[str] = []
    for *_, stored, _ in items:
        keep = is_uid(stored) and stored not in used
        if keep:
            used.add(stored)
        result.append(stored if keep else "")
    for position, (kind, library, name, _, decided) in enumerate(items):
        if result[position]:
            continue
        named = named_id(kind, library, name)
        uid, attempt = named, 0
        while uid in used:
            attempt += 1
            uid = stable_id(kind, library, name, attempt)
        used.add(uid)
        if decided or uid != named:
            result[position] = uid
    return result
