# SPDX-License-Identifier: GPL-3.0-or-later
"""The detail of what the picture does not show directly: of things off screen, and for classes of
rays (what casts its shadows, what its mirrors show), which may meet coarser levels than the camera
sees."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from ..native import lodestone_native as native


class RayClass(NamedTuple):
    """A class of rays. `key`: the setting of a scene that switches it on. `word`: the command
    line's."""

    key: str
    word: str
    label: str
    rays: native.Rays
    description: str


CLASSES = (
    RayClass(
        "shadow_levels",
        "shadow",
        "Shadows",
        native.Rays.SHADOW,
        "Shadows are cast by coarser levels than the picture shows, as far as their edges in it "
        "stay within Pixel Error. Not where something is so near that it could show",
    ),
    RayClass(
        "reflection_levels",
        "reflection",
        "Reflections",
        native.Rays.REFLECTION,
        "Mirrors show coarser levels than the picture does, as far as their images in it stay "
        "within Pixel Error: they are farther away by the way to the mirror",
    ),
)
NONE = "none"
OFF_SCREEN = tuple(one.name.lower() for one in native.OffScreen)


class RayNumbers(NamedTuple):
    """The numbers of what a class of rays meets. `own`: how many things and groups it meets
    coarser; those it does not, because they must be as they are, because a stand-in would shadow
    (or mirror) its own original, and because something else is too near."""

    ray_class: RayClass
    own: int
    triangles: int
    largest_error_px: float
    needed: int
    shaped: int
    touching: int


class Met(NamedTuple):
    """The numbers of all classes that are switched on, and what POV-Ray has to keep for them and
    the camera together."""

    classes: tuple[RayNumbers, ...]
    triangles: int
    bytes: int


def mask(keys: Iterable[str]) -> int:
    """The bits of the classes with these settings or words."""
    wanted = set(keys)
    return sum(int(one.rays) for one in CLASSES if wanted & {one.key, one.word})


def text_of(rays: int) -> str:
    """The names of classes of rays, "shadow,reflection" as the command line has it; "none"."""
    return ",".join(one.word for one in CLASSES if rays & int(one.rays)) or NONE


def rays_of(text: str) -> int:
    """The bits of the classes that a text of text_of() names. Raises ValueError with a sentence."""
    words = text.split(",")
    known = {one.word for one in CLASSES}
    if words == [NONE]:
        return 0
    for word in words:
        if word not in known:
            raise ValueError(f"{word!r} is no class of rays ({', '.join(sorted(known))}, {NONE})")
    return mask(words)


def met(cut: native.Cut) -> Met | None:
    """The numbers of a cut; None where it was made without classes."""
    modifiers = cut.view.modifiers
    wanted = modifiers.ray_classes if modifiers is not None else 0
    found, last = [], None
    for one in CLASSES:
        if wanted & int(one.rays):
            last = cut.rays(one.rays)
            found.append(
                RayNumbers(
                    one,
                    last.own,
                    last.triangles,
                    last.largest_error_px,
                    last.kept_need,
                    last.kept_shape,
                    last.kept_contact,
                )
            )
    return None if last is None else Met(tuple(found), last.all_triangles, last.all_bytes)


def part(found: Met) -> dict[str, Any]:
    """A report's."""
    own = {
        one.ray_class.word: {
            "coarser": one.own,
            "triangles": one.triangles,
            "largest_error_px": one.largest_error_px,
            "kept": {"needed": one.needed, "shaped": one.shaped, "touching": one.touching},
        }
        for one in found.classes
    }
    return {"classes": own, "triangles": found.triangles, "bytes": found.bytes}
