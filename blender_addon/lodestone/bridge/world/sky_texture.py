# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's sky textures by numbers: what they light like, and their sun."""

import math
from dataclasses import dataclass
from typing import Any

Color = tuple[float, float, float]

# Radiance of one color that lights level ground as the upper half of a sky does; measured with
# Cycles in 3.4. For these two with their default settings
_SKIES = {"PREETHAM": (0.415, 0.602, 1.056), "HOSEK_WILKIE": (0.0676, 0.1076, 0.1739)}
# and for NISHITA by the sun's elevation in degrees, at sea level in clear air, beside the
# irradiance of its sun (W/m^2, square to it)
_NISHITA: list[tuple[float, Color, Color]] = [
    (-5, (0.005, 0.006, 0.0082), (0.0, 0.0, 0.0)),
    (-2, (0.0992, 0.1095, 0.1335), (0.0, 0.0, 0.0)),
    (0, (0.3185, 0.3545, 0.3845), (0.0, 0.0, 0.0)),
    (2, (0.638, 0.7327, 0.7681), (29.92, 10.43, 0.05)),
    (5, (1.0154, 1.2508, 1.4166), (70.83, 37.03, 7.91)),
    (10, (1.4412, 1.8173, 2.2642), (105.2, 69.5, 30.18)),
    (15, (1.7189, 2.1626, 2.8237), (121.28, 87.74, 48.68)),
    (20, (1.9093, 2.3935, 3.2125), (130.33, 98.8, 62.06)),
    (30, (2.1452, 2.6808, 3.7195), (139.99, 111.16, 78.99)),
    (45, (2.3274, 2.9118, 4.1601), (146.51, 119.84, 92.14)),
    (60, (2.419, 3.0362, 4.4188), (149.6, 123.97, 98.72)),
    (90, (2.4709, 3.117, 4.6079), (152.16, 127.08, 103.34)),
]


@dataclass(frozen=True)
class SkySun:
    """The sun of a sky: `direction` to it; irradiance in W/m^2 as Cycles has it; angle in radians
    across."""

    direction: tuple[float, float, float]
    light: Color
    angle: float


def place_all_around(x: float, y: float, z: float) -> tuple[float, float]:
    """The (u, v) in 0...1 of a direction of any length in an environment texture: its middle is +X,
    and v is 1 at +Z."""
    return (
        0.5 - math.atan2(y, x) / (2.0 * math.pi),
        0.5 + math.atan2(z, math.hypot(x, y)) / math.pi,
    )


class Sky:
    """A sky texture by the direction one looks in. `drawn`: as Blender draws it, else nearly."""

    drawn = False
    sun: SkySun | None = None

    def color(self, x: float, y: float, z: float) -> Color:
        """Its radiance without its sun; the direction may have any length."""
        raise NotImplementedError


class MeanSky(Sky):
    """The mean of a sky like it, and below the horizon, where it has one, black."""

    def __init__(self, node: Any) -> None:
        self._tint = mean_of_sky(node)
        self._ends = node.sky_type == "NISHITA"
        light = _at(node.sun_elevation, 2) if has_sun(node) else (0.0, 0.0, 0.0)
        if max(light) > 0.0:
            red, green, blue = (node.sun_intensity * c for c in light)
            self.sun = SkySun(direction_to_sun(node), (red, green, blue), node.sun_size)

    def color(self, x: float, y: float, z: float) -> Color:
        share = 1.0
        if self._ends:
            height = z / max(math.sqrt(x * x + y * y + z * z), 1e-12)
            share = min(1.0, max(0.0, 1.0 + 2.5 * height)) ** 3
        red, green, blue = self._tint
        return (share * red, share * green, share * blue)


class SkyToDraw(MeanSky):
    """In place of one that is drawn when it comes to it, for all that can be told before."""

    drawn = True


def mean_of_sky(node: Any) -> Color:
    """The mean color of a sky texture node."""
    if node.sky_type == "NISHITA":
        return _at(node.sun_elevation, 1)
    return _SKIES.get(node.sky_type, _SKIES["HOSEK_WILKIE"])


def has_sun(node: Any) -> bool:
    """Whether a sky texture node shows a sun."""
    older = node.sky_type in _SKIES
    return not older and node.sun_disc and node.sun_intensity > 0.0 and node.sun_size > 0.0


def direction_to_sun(node: Any) -> tuple[float, float, float]:
    high, turn = node.sun_elevation, node.sun_rotation
    flat = math.cos(high)
    return (flat * math.sin(turn), flat * math.cos(turn), math.sin(high))


def _at(elevation: float, column: int) -> Color:
    """Between the rows of the table."""
    degrees = math.degrees(elevation)
    low = high = _NISHITA[0]
    for row in _NISHITA:
        low, high = high, row
        if degrees <= row[0]:
            break
    width = high[0] - low[0]
    share = min(1.0, max(0.0, (degrees - low[0]) / width)) if width else 0.0
    red, green, blue = (a + share * (b - a) for a, b in zip(low[column], high[column]))
    return (red, green, blue)
