# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and means of nodes that are functions of one number, or of nothing we follow."""

import math
from array import array
from typing import Any

RAMP_ROWS = 1025
CURVE_ROWS = 257

# Means of what procedural textures give with their default settings. Those with colors of their
# own (checker, brick) are the mean of these instead.
PROCEDURAL = {
    "TEX_NOISE": 0.5,
    "TEX_WHITE_NOISE": 0.5,
    "TEX_MUSGRAVE": 0.0,
    "TEX_VORONOI": 0.4,
    "TEX_WAVE": 0.5,
    "TEX_MAGIC": 0.5,
    "TEX_GRADIENT": 0.5,
    "TEX_IES": 1.0,
    "AMBIENT_OCCLUSION": 1.0,
    "WIREFRAME": 0.0,
    "HAIR_INFO": 0.5,
    "PARTICLE_INFO": 0.5,
}


def ramp(color_ramp: Any, of_alpha: bool) -> array:
    """RGBA rows over 0...1."""
    last = RAMP_ROWS - 1
    table = array("f")
    for k in range(RAMP_ROWS):
        color = color_ramp.evaluate(k / last)
        table.extend((color[3],) * 4 if of_alpha else color)
    return table


def curves(mapping: Any, channels: int) -> array:
    """RGBA rows over 0...1 of a curve mapping; of three channels after the combined curve."""
    mapping.initialize()
    last = CURVE_ROWS - 1
    table = array("f")
    for k in range(CURVE_ROWS):
        at = k / last
        if channels == 1:
            table.extend((mapping.evaluate(mapping.curves[0], at),) * 4)
            continue
        common = mapping.evaluate(mapping.curves[3], at)
        row = [mapping.evaluate(mapping.curves[c], common) for c in range(3)]
        table.extend((*row, 1.0))
    return table


def facing(blend: float) -> float:
    """Mean of Layer Weight's Facing over the visible half, weighted as it is seen."""
    blend = min(max(blend, 0.0), 1.0 - 1e-5)
    power = 1.0
    if blend != 0.5:
        power = 2.0 * blend if blend < 0.5 else 0.5 / (1.0 - blend)
    # The mean of 1 - cos^p, with the weight 2 cos
    return 1.0 - 2.0 / (power + 2.0)


def blackbody(kelvin: float) -> tuple[float, float, float]:
    """Linear Rec.709 of luminance 1: Planck's law seen by an analytic CIE 1931 observer.

    source: Wyman, Sloan, Shirley: Simple analytic approximations to the CIE XYZ color matching
    functions, JCGT 2 (2013), multi-lobe fit.
    """
    kelvin = min(max(kelvin, 800.0), 12000.0)
    x = y = z = 0.0
    for nm in range(380, 781, 5):
        power = (560.0 / nm) ** 5 / math.expm1(1.438776877e7 / (nm * kelvin))
        power *= math.expm1(1.438776877e7 / (560.0 * kelvin))
        x += power * (
            1.056 * _lobe(nm, 599.8, 37.9, 31.0)
            + 0.362 * _lobe(nm, 442.0, 16.0, 26.7)
            - 0.065 * _lobe(nm, 501.1, 20.4, 26.2)
        )
        y += power * (0.821 * _lobe(nm, 568.8, 46.9, 40.5) + 0.286 * _lobe(nm, 530.9, 16.3, 31.1))
        z += power * (1.217 * _lobe(nm, 437.0, 11.8, 36.0) + 0.681 * _lobe(nm, 459.0, 26.0, 13.8))
    x, z = x / y, z / y
    return (
        3.2404542 * x - 1.5371385 - 0.4985314 * z,
        -0.9692660 * x + 1.8760108 + 0.0415560 * z,
        0.0556434 * x - 0.2040259 + 1.0572252 * z,
    )


def _lobe(at: float, center: float, below: float, above: float) -> float:
    part = (at - center) / (below if at < center else above)
    return math.exp(-0.5 * part * part)
