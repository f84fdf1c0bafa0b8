# SPDX-License-Identifier: GPL-3.0-or-later
"""The sRGB transfer functions (IEC 61966-2-1), by component."""

import math


def encode(linear: float) -> float:
    """Values below 0 count as 0."""
    linear = max(0.0, linear)
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * math.pow(linear, 1 / 2.4) - 0.055


def decode(encoded: float) -> float:
    return encoded / 12.92 if encoded <= 0.04045 else math.pow((encoded + 0.055) / 1.055, 2.4)


DECODED = [decode(value / 255.0) for value in range(256)]  # the linear values of bytes
