# SPDX-License-Identifier: GPL-3.0-or-later
"""The controls of a picture's quality as a tree: each takes its value from its parent unless it is
overridden, and at its root is one number, Pixel Error. So a rough model is also shaded roughly.

source: dissertation, Figure 2.20
"""

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Union

Value = Union[float, int, str]

ROOT = "pixel_error"
MOST_PIXELS = 1024.0
# The kinds of Antialiasing: one sample a pixel; more where neighbors differ; 16 everywhere
OFF, ADAPTIVE, REFERENCE = "OFF", "FINAL", "REFERENCE"
_FEWEST_PIXELS = 0.25  # nothing finer shows
_LEAST_STEPS = 1e-6  # lamps lose less than 1/1024 of a point's light; 0 would keep all as they are
_DRAFT = 8.0  # pixels


class Sampling(NamedTuple):
    """The value that Antialiasing hands on: its kind, how many times rougher than final it is (1
    where it is overridden), from which difference of neighbors on a pixel gets more samples, and
    how many at most along a side."""

    kind: str
    rough: float
    threshold: float = 0.1
    depth: int = 3


class Control(NamedTuple):
    """A control of quality. `inherited(parent)`: its value below a parent's. `least` and `most`:
    the bounds of what may be asked for; None for words."""

    key: str
    label: str
    parent: str
    inherited: Callable[[Any], Value | Sampling]
    unit: str
    least: float | None
    most: float | None
    description: str


def _same(error: float) -> float:
    return error


def _sky_occlusion(shadows: float) -> int:
    """The rays of a corner: as many at all errors, so that all share what was found."""
    return 128 if shadows < _DRAFT else 0


def _textures(error: float) -> float:
    """Below a pixel nothing that the picture's samples show is blurred. At a pixel what is blurred
    is no more than the pixel filter blurs, and what varies too little to get samples is even."""
    return error if error >= 1.0 else 0.0


def _lights(error: float) -> float:
    """At a pixel four steps at most: in pictures of nights a hundredth of the pixels is off by more
    than three to five then, beside edges and blurred textures that are off by more, and a third of
    the rays to lamps is spared. Larger errors are seen less as they grow, as with antialiasing."""
    return error if error < 1.0 else max(round(4.0 * math.sqrt(error)), error)


def _halvings(error: float) -> int:
    """The number of times that 1 is doubled to reach an error, rounded up; 0 below."""
    return math.ceil(math.log2(error)) if error > 1.0 else 0


def _antialiasing(error: float) -> Sampling:
    """From a pixel on 2 x 2 samples: the pixel filter smooths what they leave, and beside converged
    Cycles a picture is as near as one of 3 x 3 without it, which takes twice as long. Differences
    up to 0.3 (of all colors together) are left: with 0.2 pictures of scenes are nearer to Cycles by
    a twentieth of what they differ, for a fifth more time."""
    if error < 1.0:
        return Sampling(ADAPTIVE, 1.0)
    return Sampling(OFF if error >= _DRAFT else ADAPTIVE, error, 0.3 * math.sqrt(error), 2)


def _area_samples(sampling: Sampling) -> int:
    if sampling.kind == OFF:
        return 1
    return (16 >> min(_halvings(sampling.rough), 3)) + 1


def _indirect(sampling: Sampling) -> int:
    if sampling.kind == REFERENCE:
        return 64
    return 12 if sampling.kind == OFF else max(12, 24 - 4 * _halvings(sampling.rough))


def _bounces(sampling: Sampling) -> int:
    """The number of bounces, only where asked for: they take several times as long."""
    return 0


def _bounce_rays(sampling: Sampling) -> int:
    if sampling.kind == REFERENCE:
        return 800
    return 60 if sampling.kind == OFF else max(60, round(200 / sampling.rough))


def _bounce_error(sampling: Sampling) -> float:
    """The error up to which POV-Ray uses gathered light again."""
    if sampling.kind == REFERENCE:
        return 0.4
    return 1.0 if sampling.kind == OFF else min(1.0, 0.6 * math.sqrt(sampling.rough))


def _trace_depth(error: float) -> int:
    return max(2, 5 - _halvings(error))


CONTROLS = (
    Control(
        "textures", "Textures", ROOT, _textures, "px", 0.0, MOST_PIXELS,
        "How much image textures may be blurred on the picture, in pixels: larger ones than that "
        "needs are made smaller. 0: by nothing that its samples could show",
    ),
    Control(
        "shadows", "Shadows", ROOT, _same, "px", 0.0, MOST_PIXELS,
        "Soft edges of shadows that are narrower than this on the picture are drawn sharp, in "
        "pixels",
    ),
    Control(
        "sky_occlusion", "Sky Occlusion", "shadows", _sky_occlusion, "", 0, 1024,
        "Rays by which each corner of a large triangle (half as many: of a small one) finds how "
        "much of the sky's light reaches it: under trees and roofs it is darker. What they "
        "find is kept for the next picture, which they make take a little longer. 0: the sky "
        "shines through everything. Bounces do without it",
    ),
    Control(
        "reflections", "Reflections", ROOT, _same, "px", 0.0, MOST_PIXELS,
        "Reflections and refractions that change the picture by less than so many steps of 255 "
        "are left out",
    ),
    Control(
        "trace_depth", "Trace Depth", "reflections", _trace_depth, "", 1, 50,
        "How many mirrors or bodies of glass, one behind the other, a ray is followed through",
    ),
    Control(
        "lights", "Lights", ROOT, _lights, "px", 0.0, MOST_PIXELS,
        "Many lamps become few, never through walls, as far as points of the picture change by "
        "about so many steps of 255. 0: no point loses more than a 1024th of its light",
    ),
    Control(
        "antialias", "Antialiasing", ROOT, _antialiasing, "", None, None,
        "How many samples POV-Ray takes in a pixel",
    ),
    Control(
        "area_samples", "Area Samples", "antialias", _area_samples, "", 1, 129,
        "Rays along the edge of a lamp, from which soft shadows are made; made 2, 4, 8 ... and one "
        "more. 1 is a sharp shadow",
    ),
    Control(
        "indirect", "Indirect", "antialias", _indirect, "", 0, 1024,
        "The most lights that stand for the bright places of the image around the scene; in drafts "
        "and with Bounces for all of it: more give finer shadows. 0: without shadows",
    ),
    Control(
        "bounces", "Bounces", "antialias", _bounces, "", 0, 8,
        "How many times light goes from surface to surface before the camera sees it, as Diffuse "
        "Bounces do in Cycles. It takes several times as long. 0: direct light only; a room lit "
        "through a window is dark then, and needs 2 or more",
    ),
)  # fmt: skip
CONTROL = {control.key: control for control in CONTROLS}


class Quality(NamedTuple):
    """The value of every control."""

    pixel_error: float
    textures: float
    shadows: float
    sky_occlusion: int
    reflections: float
    trace_depth: int
    lights: float
    antialias: str
    antialias_threshold: float
    antialias_depth: int
    area_samples: int
    indirect: int
    bounces: int
    bounce_rays: int
    bounce_error: float

    def povray(self) -> dict[str, Any]:
        """The values as fields of the library's PovrayOptions, but antialias, which is an enum
        there."""
        return {
            "antialias_threshold": self.antialias_threshold,
            "antialias_depth": self.antialias_depth,
            "trace_depth": self.trace_depth,
            "area_samples": self.area_samples,
            "sky_lights": self.indirect or -1,
            "shadow_error": max(self.shadows, _FEWEST_PIXELS),
            "light_error": max(self.lights, _LEAST_STEPS),
            "reflection_error": max(self.reflections, 1.0),
            "texture_error": self.textures,
            "sky_rays": self.sky_occlusion or -1,
            "bounces": self.bounces,
            "bounce_rays": self.bounce_rays,
            "bounce_error": self.bounce_error,
        }


def quality(pixel_error: float, overrides: Mapping[str, Value] | None = None) -> Quality:
    """Every control's value. `overrides`: those that do not inherit, by key; what is out of range
    is brought to the nearest limit; what is no number, or no word of the control's, is ignored."""
    given = overrides or {}
    found: dict[str, Any] = {ROOT: within(pixel_error, 0.0, MOST_PIXELS)}
    for control in CONTROLS:  # parents come first
        otherwise = control.inherited(found[control.parent])
        found[control.key] = _value_of(control, otherwise, given)
    sampling = found["antialias"]
    found["antialias"] = sampling.kind
    return Quality(
        antialias_threshold=round(min(sampling.threshold, 1.0), 6),
        antialias_depth=sampling.depth,
        bounce_rays=_bounce_rays(sampling),
        bounce_error=round(_bounce_error(sampling), 6),
        **found,
    )


def inherits(key: str, pixel_error: float, overrides: Mapping[str, Value] | None = None) -> Value:
    """The value that one control would have without its own override."""
    others = {name: value for name, value in (overrides or {}).items() if name != key}
    value: Value = getattr(quality(pixel_error, others), key)
    return value


def _value_of(control: Control, otherwise: Any, given: Mapping[str, Value]) -> Any:
    if control.key not in given:
        return otherwise
    value = given[control.key]
    if control.least is None or control.most is None:
        known = value in (OFF, ADAPTIVE, REFERENCE)
        return Sampling(str(value), 1.0) if known else otherwise
    if isinstance(value, str) or value != value:
        return otherwise
    limited = within(value, control.least, control.most)
    return round(limited) if isinstance(control.least, int) else limited


def within(value: float, least: float, most: float) -> float:
    """NaN is the least: the finest there is."""
    return min(max(value, least), most) if value == value else least
