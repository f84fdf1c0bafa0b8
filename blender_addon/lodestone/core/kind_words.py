# SPDX-License-Identifier: GPL-3.0-or-later
"""What designers read of the kinds of representations: a row for each kind."""

from typing import NamedTuple

from .native import lodestone_native as native


class KindWords(NamedTuple):
    """`level`: of one level; `occurrences`: of those that are drawn so."""

    level: str
    occurrences: str


KIND_WORDS: dict[int, KindWords] = {
    native.Kind.MESH: KindWords("Simplified", "Meshes"),
    native.Kind.BOX: KindWords("Box", "Boxes"),
    native.Kind.ELLIPSOID: KindWords("Ellipsoid", "Ellipsoids"),
    native.Kind.COMPOSITE: KindWords("Composite", "Composites"),
    native.Kind.ASSEMBLY: KindWords("Group", "Groups"),
}
DRAWN_KINDS = tuple(kind for kind in native.Kind if kind != native.Kind.ASSEMBLY)
SOLID_KINDS = tuple(kind for kind in DRAWN_KINDS if kind != native.Kind.MESH)


def any_solid() -> str:
    """The kinds of solids, in a sentence: "a box, an ellipsoid or a composite"."""
    words = [KIND_WORDS[kind].level.lower() for kind in SOLID_KINDS]
    named = [f"{'an' if word[0] in 'aeiou' else 'a'} {word}" for word in words]
    return f"{', '.join(named[:-1])} or {named[-1]}"


def level_word(lod: int, kind: int) -> str:
    if lod == 0:
        return "Original"
    return KIND_WORDS[kind].level if kind in KIND_WORDS else "?"
