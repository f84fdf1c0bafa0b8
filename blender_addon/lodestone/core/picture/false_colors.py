# SPDX-License-Identifier: GPL-3.0-or-later
"""False colors: what a cut chose, as colors for the viewport and for pictures, with their legend.

Colors are linear Rec.709, 0...1.
"""

from typing import Any

from .. import progress_text, srgb
from ..kind_words import SOLID_KINDS, level_word
from ..native import lodestone_native as native

Color = tuple[float, float, float]

LEVEL, ERROR, COST = "LEVEL", "ERROR", "COST"
ORIGINAL: Color = (0.67, 0.67, 0.67)
ABOVE: Color = (0.75, 0.08, 0.55)  # coarser than Pixel Error asks for, by a decision
# By the share of Pixel Error that is used up
_ERRORS: tuple[tuple[float, Color], ...] = (
    (0.0, (0.05, 0.12, 0.6)),
    (0.5, (0.08, 0.55, 0.2)),
    (0.75, (0.9, 0.75, 0.08)),
    (1.0, (0.8, 0.06, 0.03)),
)
_ROUNDING = 1e-6
# By the most triangles that an occurrence takes; solids take none
_COSTS: tuple[tuple[float, Color], ...] = (
    (12, (0.03, 0.05, 0.35)),
    (100, (0.06, 0.25, 0.7)),
    (1_000, (0.08, 0.55, 0.45)),
    (10_000, (0.45, 0.7, 0.08)),
    (100_000, (0.9, 0.5, 0.05)),
    (float("inf"), (0.8, 0.05, 0.03)),
)
_LEVELS = 6  # meshes this coarse and coarser share a color


def of_level(kind: int, lod: int) -> Color:
    return native.povray_false_color(kind, lod)


def of_error(error_px: float, pixel_error: float) -> Color:
    """The color of an error on screen, beside what was asked for."""
    if error_px <= 0.0:
        return ORIGINAL
    share = error_px / pixel_error if pixel_error > 0.0 else float("inf")
    if not share <= 1.0 + _ROUNDING:
        return ABOVE
    for (low, first), (high, second) in zip(_ERRORS, _ERRORS[1:]):
        if share <= high:
            part = (share - low) / (high - low)
            mixed = [a + part * (b - a) for a, b in zip(first, second)]
            return (mixed[0], mixed[1], mixed[2])
    return _ERRORS[-1][1]


def of_cost(triangles: int) -> Color:
    """The color of one occurrence by its triangles."""
    return next(color for most, color in _COSTS if triangles <= most)


def colors(cut: native.Cut, mode: str) -> list[Color]:
    """The colors of a cut's choices, in their order."""
    choices = cut.choices()
    known: dict[Any, Color] = {}
    if mode == ERROR:
        asked = cut.view.pixel_error
        return [of_error(choice.error_px, asked) for choice in choices]
    found = []
    for choice in choices:
        key = (choice.object.key, choice.lod)
        color = known.get(key)
        if color is None:
            if mode == COST:
                drawn = cut.model.representation(choice.object, choice.lod)
                color = of_cost(drawn.triangles)
            else:
                color = of_level(choice.kind, choice.lod)
            known[key] = color
        found.append(color)
    return found


def legend(mode: str, pixel_error: float) -> list[tuple[str, Color]]:
    """Words and colors, finest or cheapest first."""
    if mode == ERROR:
        shares = ((share * pixel_error, color) for share, color in _ERRORS)
        shown = [(f"{error:.3g} px", color) for error, color in shares]
        return [("Original", ORIGINAL), *shown, (f"above {pixel_error:.3g} px", ABOVE)]
    if mode == COST:
        bounds = [(f"up to {progress_text.count(most)}", color) for most, color in _COSTS[1:-1]]
        more = f"more than {progress_text.count(_COSTS[-2][0])} triangles"
        solids = ", ".join(level_word(1, kind) for kind in SOLID_KINDS).capitalize()
        return [(solids, _COSTS[0][1]), *bounds, (more, _COSTS[-1][1])]
    words = ["Original", *(f"LOD {lod}" for lod in range(1, _LEVELS)), f"LOD {_LEVELS}+"]
    meshes = [(word, of_level(native.Kind.MESH, lod)) for lod, word in enumerate(words)]
    return [*meshes, *((level_word(1, kind), of_level(kind, 1)) for kind in SOLID_KINDS)]


def displayed(color: Color) -> Color:
    """A color as sRGB, for what draws in display values."""
    red, green, blue = (srgb.encode(min(1.0, value)) for value in color)
    return (red, green, blue)


# The linear values of sRGB bytes, for bytes.translate()
LINEAR = bytes(round(255.0 * linear) for linear in srgb.DECODED)
