# SPDX-License-Identifier: GPL-3.0-or-later
"""Why a cut draws a thing as it does, in sentences with every number that counted."""

import math
from dataclasses import dataclass

from .. import progress_text
from ..kind_words import level_word
from ..native import lodestone_native as native
from . import unseen_detail

# Fields of a reason that make finer where above 1, and those that make coarser
_FINER = (
    ("importance", "Importance"),
    ("lenses", "Detail lenses"),
    ("screen_lenses", "Screen lenses"),
)
_COARSER = (
    ("depth", "Depth exaggeration"),
    ("motion", "Motion"),
    ("darkness", "Darkness"),
    ("off_screen", "Not seen directly"),
)
_TIMES, _AT_MOST, _MORE = "\N{MULTIPLICATION SIGN}", "\N{LESS-THAN OR EQUAL TO}", ">"
_DOT = "\N{MIDDLE DOT}"


@dataclass(frozen=True)
class Explanation:
    """The reasons for one thing. `title` names what is drawn, `lines` say why, the most telling
    first."""

    title: str
    lines: tuple[str, ...] = ()


def pixels(value: float) -> str:
    """An error in words: 0.9 px, 19 px, 1,200 px."""
    if not math.isfinite(value):
        return "\N{INFINITY} px"
    if value >= 10.0:
        return f"{value:,.0f} px"
    return f"{value:.2g} px" if value else "0 px"


def metres(value: float) -> str:
    """A distance: 41 m, 4.1 m, 0.35 m."""
    return f"{value:,.0f} m" if value >= 10.0 else f"{value:.2g} m"


def factor(value: float) -> str:
    return "\N{INFINITY}" if math.isinf(value) else f"{value:.3g}"


def level_name(lod: int, kind: int) -> str:
    return f"LOD {lod}  {level_word(lod, kind)}"


def explain(cut: native.Cut, drawn: native.Drawn, position: int) -> Explanation:
    """The explanation of something that a cut was asked for by Kept.find()."""
    if drawn == native.Drawn.MISSING:
        return Explanation(
            "Not in the last picture", ("It was hidden in renders, or is newer, or has moved",)
        )
    if drawn == native.Drawn.NOT:
        return Explanation("Not drawn", ("No ray sees it, or a lens shows other things instead",))
    if drawn == native.Drawn.OPENED:
        return Explanation("Drawn by what is in it", ("Its parts have levels of their own",))
    choice = cut.choices()[position]
    title = level_name(choice.lod, choice.kind)
    if drawn == native.Drawn.IN_GROUP:
        group = cut.choice_path(position).rsplit("/", 1)[-1]
        group = group or cut.model.object_summary(choice.object).name  # all of the scene
        title = f"In group {group}: {title}"
    reason = cut.reason(position)
    lines = [_main_line(reason, cut.view.pixel_error)]
    lines += _factor_lines(reason)
    lines += _coarser_lines(cut, choice, reason)
    lines += _ray_lines(cut, choice, position)
    return Explanation(title, tuple(lines))


_KEPT: dict[int, str] = {
    native.Met.NEED: "nothing coarser is good enough",
    native.Met.SHAPE: "a coarser one would cover the original",
    native.Met.CONTACT: "something else is too near",
}


def _ray_lines(cut: native.Cut, choice: native.Choice, position: int) -> list[str]:
    """Lines about the levels that its shadow and its images in mirrors are of, where they may be
    coarser."""
    modifiers, lines = cut.view.modifiers, []
    for one in unseen_detail.CLASSES:
        if modifiers is None or not modifiers.ray_classes & int(one.rays):
            continue
        met = cut.choice_rays(position, one.rays)
        if met.met in _KEPT:
            lines.append(f"{one.label}: as it is seen, {_KEPT[met.met]}")
        elif met.met != native.Met.OFF:
            what = level_name(met.lod, met.kind)
            if met.met == native.Met.GROUP:
                what = f"group {cut.model.object_summary(met.object).name} as {what}"
            lines.append(f"{one.label}: by {what}, off by at most {pixels(met.error_px)}")
    return lines


def _main_line(reason: native.records.Reason, asked: float) -> str:
    """The line with the numbers of the choice, as "41 m · 11 mm = 0.9 px ≤ 1 px"."""
    error = reason.error * reason.stretch
    text = f"{metres(reason.z)} {_DOT} {progress_text.length(error)}"
    text += f" = {pixels(reason.error_px)}"
    judged = reason.error_px
    if judged > 0.0 and reason.factor != 1.0:
        judged *= reason.factor
        text += f" {_TIMES} {factor(reason.factor)} = {pixels(judged)}"
    sign = _AT_MOST if judged <= asked * (1.0 + 1e-9) else _MORE
    text += f" {sign} {pixels(asked)}"
    return text if sign == _AT_MOST else text + ": nothing finer can be drawn"


def _factor_lines(reason: native.records.Reason) -> list[str]:
    lines = []
    for field, word in _FINER:
        value = getattr(reason, field)
        if value != 1.0:
            lines.append(f"{word} {_TIMES} {factor(value)} {_way(value)}")
    for field, word in _COARSER:
        value = getattr(reason, field)
        if value != 1.0:
            lines.append(f"{word} {_TIMES} {factor(value)} {_way(1.0 / value if value else 2.0)}")
    if reason.demand != 1.0:
        lines.append(_demand_line("A part of it", reason.demand))
    return lines


def _way(value: float) -> str:
    return "finer" if value > 1.0 else "coarser"


def _demand_line(what: str, demand: float) -> str:
    if math.isinf(demand):
        return f"{what} may not be drawn coarser than a level of its own"
    return f"{what} is drawn {factor(demand)} times as fine"


def _coarser_lines(
    cut: native.Cut, choice: native.Choice, reason: native.records.Reason
) -> list[str]:
    """Lines about the level that would be seen instead, and what keeps it from being used."""
    if not reason.coarser_object:
        return ["There is no coarser level"]
    own = reason.coarser_object == choice.object
    what = level_name(reason.coarser_lod, reason.coarser_kind)
    if not own:
        group = cut.model.object_summary(reason.coarser_object).name
        what = f"Group {group} as {what}"
    judged = reason.coarser_error_px * reason.coarser_factor
    text = f"{what} would be {pixels(reason.coarser_error_px)}"
    if reason.coarser_factor != 1.0 and math.isfinite(reason.coarser_factor):
        text += f" {_TIMES} {factor(reason.coarser_factor)} = {pixels(judged)}"
    lines = [text]
    if reason.pinned:
        lines.append("Use does not allow that one")
    elif math.isinf(reason.coarser_factor) or reason.coarser_factor > reason.factor:
        opens = "" if own else native.most_demanding(cut.model, reason.coarser_object)
        if opens:
            part = opens.rsplit("/", 1)[-1]
            lines.append(f"The group is opened for {part}, which is to be finer than the rest")
    elif judged <= cut.view.pixel_error and not own:
        lines.append("What is in the group costs less than that")
    return lines
