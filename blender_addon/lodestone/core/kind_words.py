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


def level_word(lod: int, kind: int) -> str:
    if lod == 0:
        return "Original"
    return KIND_WORDS[kind].level if kind in KIND_WORDS else "?"
