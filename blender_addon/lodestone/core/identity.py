# SPDX-License-Identifier: GPL-3.0-or-later
"""Ids that stay the same from one run to the next: 16 hexadecimal digits.

Without a stored uid a thing is known by its library and name; a stored uid starts as the hash of
just these, so levels built before it was written stay valid, and those built after survive renames.
"""

import hashlib
from collections.abc import Iterable

DIGITS = 16


def stable_id(*parts: object) -> str:
    """16 hex digits of the parts; ("a", "bc") and ("ab", "c") differ."""
    digest = hashlib.blake2b(digest_size=DIGITS // 2)
    for part in parts:
        data = str(part).encode("utf-8", "surrogateescape")
        digest.update(len(data).to_bytes(8, "little"))
        digest.update(data)
    return digest.hexdigest()


def named_id(kind: str, library: str, name: str) -> str:
    """The id of a datablock that has no stored uid."""
    return stable_id(kind, library, name)


def is_uid(text: str) -> bool:
    return len(text) == DIGITS and all(c in "0123456789abcdef" for c in text)


def assign_uids(
    things: Iterable[tuple[str, str, str, str]], taken: Iterable[str] = ()
) -> list[str]:
    """A uid for each (kind, library, name, stored uid), in order, all different and none of taken.

    A stored one is kept by the first thing that has it; copies get a new one.
    """
    items = list(things)
    used = set(taken)
    result: list[str] = []
    for _, _, _, stored in items:
        keep = is_uid(stored) and stored not in used
        if keep:
            used.add(stored)
        result.append(stored if keep else "")
    for position, (kind, library, name, _) in enumerate(items):
        if result[position]:
            continue
        uid, attempt = named_id(kind, library, name), 0
        while uid in used:
            attempt += 1
            uid = stable_id(kind, library, name, attempt)
        used.add(uid)
        result[position] = uid
    return result
