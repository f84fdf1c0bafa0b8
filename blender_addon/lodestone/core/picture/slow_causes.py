# SPDX-License-Identifier: GPL-3.0-or-later
"""What made a picture slow, where one kind of work took most of a long time, and the control that
makes the next one faster."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from ..problems import INFO, MEASURED, Problem
from . import quality_tree
from .cost_model import Work, predict
from .quality_tree import Quality

# Taste: nobody wants to be told what made a shorter picture slow.
_LONG_CPU_S = 10.0
# Taste: of less than this the next picture would not get much faster.
_MOST_OF_IT = 0.6
# So many steps of 255 for Lights took a fifth to a third of the time from three scenes at night,
# and twice as many hardly more; fewer Area Samples took none to a quarter
_LIGHTS = 4.0
_FEWEST_SKY = 12  # lights of a world's image: of fewer the shadows are seen one by one


class Remedy(NamedTuple):
    """A control, the value that it had in a picture, and one that takes less time."""

    key: str
    before: quality_tree.Value
    after: quality_tree.Value

    @property
    def words(self) -> str:
        """Area Samples 5 instead of 9."""
        label = quality_tree.CONTROL[self.key].label
        return f"{label} {self.after:g} instead of {self.before:g}"


class SlowCause(NamedTuple):
    """A kind of work that took most of a picture's time; `remedy` is None where no control helps
    without being seen."""

    problem: Problem
    remedy: Remedy | None


class _Kind(NamedTuple):
    name: str
    words: Callable[[Work], str]
    without: Callable[[Work], Work]  # the work without this kind
    remedy: Callable[[Work, Quality], Remedy | None]


def found(work: Work, quality: Quality, took_cpu_s: float) -> list[SlowCause]:
    """The causes of a picture that was drawn with a quality. `took_cpu_s`: what POV-Ray took for
    it; the shares of it are foretold, not measured."""
    whole = _cpu_s(work)
    if not took_cpu_s >= _LONG_CPU_S or not whole > 0.0:
        return []
    causes = []
    for kind in _KINDS:
        share = 1.0 - _cpu_s(kind.without(work)) / whole
        if share < _MOST_OF_IT:
            continue
        text = f"{kind.words(work)}: about {100 * share:.0f} % of the time"
        remedy = kind.remedy(work, quality)
        if remedy is not None:
            text += f"; {remedy.words} takes less"
        causes.append(SlowCause(Problem("", INFO, MEASURED + kind.name, text), remedy))
    return causes


def _cpu_s(work: Work) -> float:
    took = predict(work)
    return took.parse_cpu_s + took.trace_cpu_s


def _words_of_lamps(work: Work) -> str:
    if work.soft_lamps == 0:
        return "Lamps"
    return f"{work.soft_lamps:,} lamp{'s' if work.soft_lamps > 1 else ''} with soft shadows"


def _fewer_rays(quality: Quality) -> Remedy | None:
    """Half the rays along the edge of a light; their number is the square."""
    rays = quality.area_samples
    return Remedy("area_samples", rays, rays // 2 + 1 if rays > 3 else 1) if rays > 1 else None


def _of_lamps(work: Work, quality: Quality) -> Remedy | None:
    if quality.lights < _LIGHTS:
        return Remedy("lights", quality.lights, _LIGHTS)
    return _fewer_rays(quality) if work.soft_lamps > 0 else None


def _of_sky(work: Work, quality: Quality) -> Remedy | None:
    if min(work.sky_lights, quality.indirect) <= _FEWEST_SKY:
        return None
    return Remedy("indirect", quality.indirect, _FEWEST_SKY)


def _of_bounces(work: Work, quality: Quality) -> Remedy | None:
    """One bounce less; without any, a room lit through a window would be dark."""
    bounces = quality.bounces
    return Remedy("bounces", bounces, bounces - 1) if bounces > 1 else None


_KINDS = (
    _Kind(
        "lamps",
        _words_of_lamps,
        lambda work: replace(work, shadow_rays=work.shadow_rays - work.lamp_rays, lamp_rays=0.0),
        _of_lamps,
    ),
    _Kind(
        "sky",
        lambda work: "Shadows of the image around the scene",
        lambda work: replace(work, shadow_rays=work.shadow_rays - work.sky_lights),
        _of_sky,
    ),
    _Kind(
        "suns",
        lambda work: "Shadows of suns",
        lambda work: replace(work, shadow_rays=work.lamp_rays + work.sky_lights),
        lambda work, quality: _fewer_rays(quality),
    ),
    _Kind(
        "bounces",
        lambda work: "Light that bounces",
        lambda work: replace(work, gathering=0.0),
        _of_bounces,
    ),
)
