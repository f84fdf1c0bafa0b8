# SPDX-License-Identifier: GPL-3.0-or-later
"""What makes a picture slow, told where one kind of work takes most of a long time, and the control
that makes it faster."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from ..native import lodestone_native as native
from ..problems import INFO, Problem
from . import quality_tree
from .cost_model import Work, predict
from .quality_tree import Quality

# Taste: nobody wants to be told what makes a shorter picture slow.
_LONG_CPU_S = 10.0
# Taste: of less than this the picture would not get much faster.
_MOST_OF_IT = 0.6
_MOST_LIGHTS = 64.0  # steps of 255: larger ones would be seen as another light
_FEWEST_SUNS = 12  # of an image around the scene; with fewer its shadows show them one by one


class Remedy(NamedTuple):
    """A control, the value that it has, and one that takes less time."""

    key: str
    before: quality_tree.Value
    after: quality_tree.Value

    @property
    def words(self) -> str:
        """Area Samples 5 instead of 9."""
        label = quality_tree.CONTROL[self.key].label
        return f"{label} {_word(self.after)} instead of {_word(self.before)}"


class _Cause(NamedTuple):
    code: str
    name: Callable[[Work], str]
    without: Callable[[Work], Work]  # the work without what the cause asks for
    remedy: Callable[[Quality], Remedy | None]


def problems(work: Work, quality: Quality, took_cpu_s: float) -> list[Problem]:
    """One for each cause that took most of the time of a picture which took long. `took_cpu_s`:
    what POV-Ray took for it."""
    whole = _cpu_s(work)
    if not took_cpu_s >= _LONG_CPU_S or not whole > 0.0:
        return []
    found = []
    for cause in _CAUSES:
        share = 1.0 - _cpu_s(cause.without(work)) / whole
        if share < _MOST_OF_IT:
            continue
        text = f"{cause.name(work)}: about {100 * share:.0f} % of the time"
        faster = cause.remedy(quality)
        if faster is not None:
            text += f"; {faster.words} takes less"
        found.append(Problem("", INFO, cause.code, text))
    return found


def remedy(code: str, quality: Quality) -> Remedy | None:
    """The next step against a cause, by the code of its problem; None where there is none."""
    cause = next((cause for cause in _CAUSES if cause.code == code), None)
    return cause.remedy(quality) if cause is not None else None


def _cpu_s(work: Work) -> float:
    took = predict(work)
    return took.parse_cpu_s + took.trace_cpu_s


def _word(value: quality_tree.Value) -> str:
    if isinstance(value, str):
        return value.title()
    return f"{value:g}"


def _softer(quality: Quality) -> Remedy | None:
    """Fewer rays to each light; their number is the square."""
    rays = quality.area_samples
    return Remedy("area_samples", rays, rays // 2 + 1 if rays > 3 else 1) if rays > 1 else None


def _lamps(quality: Quality) -> Remedy | None:
    if quality.lights >= _MOST_LIGHTS:
        return _softer(quality)
    return _softer(quality) or Remedy(
        "lights", quality.lights, min(_MOST_LIGHTS, max(4.0, 4.0 * quality.lights))
    )


def _suns(quality: Quality) -> Remedy | None:
    if quality.indirect > _FEWEST_SUNS:
        return Remedy("indirect", quality.indirect, _FEWEST_SUNS)
    return _softer(quality)


def _fewer_bounces(quality: Quality) -> Remedy | None:
    return Remedy("bounces", quality.bounces, quality.bounces - 1) if quality.bounces else None


def _adaptive(quality: Quality) -> Remedy | None:
    if quality.antialias != quality_tree.REFERENCE:
        return None
    return Remedy("antialias", quality_tree.REFERENCE, quality_tree.ADAPTIVE)


def _name_of_lamps(work: Work) -> str:
    if work.soft_lamps == 0:
        return "Lamps"
    return f"{work.soft_lamps:,} lamp{'s' if work.soft_lamps > 1 else ''} with soft shadows"


_CAUSES = (
    _Cause(
        "slow_lamps",
        _name_of_lamps,
        lambda work: replace(work, shadow_rays=work.shadow_rays - work.lamp_rays),
        _lamps,
    ),
    _Cause(
        "slow_suns",
        lambda work: "Soft shadows of suns and of the image around the scene",
        lambda work: replace(work, shadow_rays=work.lamp_rays),
        _suns,
    ),
    _Cause(
        "slow_bounces",
        lambda work: "Light that bounces",
        lambda work: replace(work, gathering=0.0),
        _fewer_bounces,
    ),
    _Cause(
        "slow_reference",
        lambda work: "16 samples in every pixel",
        lambda work: (
            replace(work, antialias=native.Antialias.FINAL)
            if work.antialias == native.Antialias.REFERENCE
            else work
        ),
        _adaptive,
    ),
)
