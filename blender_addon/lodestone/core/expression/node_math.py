# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Math, Mix and Map Range nodes as expressions.

source: the operations as Blender's manual defines them and Cycles computes them.
"""

import math
from collections.abc import Callable

from .color_expression import (
    ONE,
    ZERO,
    Expression,
    Op,
    add,
    apply,
    bounds,
    color_of,
    constant,
    from_hsv,
    mix,
    multiply,
    number,
    subtract,
    to_hsv,
)

HALF, TWO = number(0.5), number(2.0)


def _less(a: Expression, b: Expression) -> Expression:
    return apply(Op.GREATER, b, a)


def _fraction(a: Expression) -> Expression:
    return subtract(a, apply(Op.FLOOR, a))


def _square_root(a: Expression) -> Expression:
    return apply(Op.POWER, apply(Op.MAXIMUM, a, ZERO), HALF)


def _compare(a: Expression, b: Expression, within: Expression) -> Expression:
    limit = apply(Op.MAXIMUM, within, number(1e-5))
    return subtract(ONE, apply(Op.GREATER, apply(Op.ABSOLUTE, subtract(a, b)), limit))


def _snap(a: Expression, step: Expression, _: Expression) -> Expression:
    return multiply(apply(Op.FLOOR, apply(Op.DIVIDE, a, step)), step)


def _wrap(a: Expression, most: Expression, least: Expression) -> Expression:
    span = subtract(most, least)
    turns = apply(Op.FLOOR, apply(Op.DIVIDE, subtract(a, least), span))
    return subtract(a, multiply(span, turns))


_MATH: dict[str, Callable[[Expression, Expression, Expression], Expression]] = {
    "ADD": lambda a, b, c: add(a, b),
    "SUBTRACT": lambda a, b, c: subtract(a, b),
    "MULTIPLY": lambda a, b, c: multiply(a, b),
    "DIVIDE": lambda a, b, c: apply(Op.DIVIDE, a, b),
    "MULTIPLY_ADD": lambda a, b, c: add(multiply(a, b), c),
    "POWER": lambda a, b, c: apply(Op.POWER, a, b),
    "SQRT": lambda a, b, c: _square_root(a),
    "INVERSE_SQRT": lambda a, b, c: apply(Op.DIVIDE, ONE, _square_root(a)),
    "ABSOLUTE": lambda a, b, c: apply(Op.ABSOLUTE, a),
    "EXPONENT": lambda a, b, c: apply(Op.POWER, number(math.e), a),
    "MINIMUM": lambda a, b, c: apply(Op.MINIMUM, a, b),
    "MAXIMUM": lambda a, b, c: apply(Op.MAXIMUM, a, b),
    "LESS_THAN": lambda a, b, c: _less(a, b),
    "GREATER_THAN": lambda a, b, c: apply(Op.GREATER, a, b),
    "SIGN": lambda a, b, c: subtract(apply(Op.GREATER, a, ZERO), _less(a, ZERO)),
    "COMPARE": _compare,
    "ROUND": lambda a, b, c: apply(Op.FLOOR, add(a, HALF)),
    "FLOOR": lambda a, b, c: apply(Op.FLOOR, a),
    "CEIL": lambda a, b, c: subtract(ZERO, apply(Op.FLOOR, subtract(ZERO, a))),
    "TRUNC": lambda a, b, c: subtract(a, apply(Op.MODULO, a, ONE)),
    "FRACT": lambda a, b, c: _fraction(a),
    "MODULO": lambda a, b, c: apply(Op.MODULO, a, b),
    "WRAP": _wrap,
    "SNAP": _snap,
    "RADIANS": lambda a, b, c: multiply(a, number(math.pi / 180.0)),
    "DEGREES": lambda a, b, c: multiply(a, number(180.0 / math.pi)),
}
_OF_CONSTANTS: dict[str, Callable[[float, float, float], float]] = {
    "LOGARITHM": lambda a, b, c: math.log(a, b),
    "SINE": lambda a, b, c: math.sin(a),
    "COSINE": lambda a, b, c: math.cos(a),
    "TANGENT": lambda a, b, c: math.tan(a),
    "ARCSINE": lambda a, b, c: math.asin(a),
    "ARCCOSINE": lambda a, b, c: math.acos(a),
    "ARCTANGENT": lambda a, b, c: math.atan(a),
    "ARCTAN2": lambda a, b, c: math.atan2(a, b),
    "SINH": lambda a, b, c: math.sinh(a),
    "COSH": lambda a, b, c: math.cosh(a),
    "TANH": lambda a, b, c: math.tanh(a),
}


def maths(kind: str, args: list[Expression]) -> Expression | None:
    """A Math node's value of its (up to) three numbers; None: not known."""
    a, b, c = (*args, ZERO, ZERO, ZERO)[:3]
    if kind in _MATH:
        return _MATH[kind](a, b, c)
    if kind in _OF_CONSTANTS and a.constant and b.constant and c.constant:
        try:
            value = _OF_CONSTANTS[kind](a.value[0], b.value[0], c.value[0])
        except (ValueError, OverflowError, ZeroDivisionError):
            value = 0.0
        return number(value if math.isfinite(value) else 0.0, a.exact and b.exact)
    return None


def _screen(a: Expression, b: Expression) -> Expression:
    return subtract(ONE, multiply(subtract(ONE, a), subtract(ONE, b)))


def _overlay(a: Expression, b: Expression, share: Expression) -> Expression:
    rest = subtract(ONE, share)
    two = multiply(TWO, share)
    dark = multiply(a, add(rest, multiply(two, b)))
    light = add(rest, multiply(two, subtract(ONE, b)))
    light = subtract(ONE, multiply(light, subtract(ONE, a)))
    return mix(light, dark, _less(a, HALF))


def _soft_light(a: Expression, b: Expression, share: Expression) -> Expression:
    screen = multiply(a, _screen(a, b))
    return mix(a, add(multiply(multiply(subtract(ONE, a), b), a), screen), share)


def _divide(a: Expression, b: Expression, share: Expression) -> Expression:
    empty = apply(Op.GREATER, apply(Op.ABSOLUTE, b), ZERO)  # dividing by 0 changes nothing
    return mix(a, mix(a, apply(Op.DIVIDE, a, b), share), empty)


_BLEND: dict[str, Callable[[Expression, Expression, Expression], Expression]] = {
    "MIX": mix,
    "ADD": lambda a, b, share: add(a, multiply(share, b)),
    "MULTIPLY": lambda a, b, share: _multiplied(a, b, share),
    "SUBTRACT": lambda a, b, share: subtract(a, multiply(share, b)),
    "DIVIDE": _divide,
    "SCREEN": lambda a, b, share: mix(a, _screen(a, b), share),
    "OVERLAY": _overlay,
    "SOFT_LIGHT": _soft_light,
    "LINEAR_LIGHT": lambda a, b, share: add(a, multiply(share, subtract(multiply(TWO, b), ONE))),
    "DIFFERENCE": lambda a, b, share: mix(a, apply(Op.ABSOLUTE, subtract(a, b)), share),
    "DARKEN": lambda a, b, share: mix(a, apply(Op.MINIMUM, a, b), share),
    "LIGHTEN": lambda a, b, share: mix(a, apply(Op.MAXIMUM, a, b), share),
}


def _multiplied(a: Expression, b: Expression, share: Expression) -> Expression:
    """Kept a product: what multiplies a constant stays affine."""
    if share.constant:
        return multiply(a, add(subtract(ONE, share), multiply(share, b)))
    return mix(a, multiply(a, b), share)


def blend(kind: str, a: Expression, b: Expression, share: Expression) -> Expression | None:
    """A Mix node's color; None: not known."""
    return _BLEND[kind](a, b, share) if kind in _BLEND else None


def mapped(
    value: Expression, low: Expression, high: Expression, to_low: Expression, to_high: Expression
) -> Expression:
    """Linear Map Range."""
    part = apply(Op.DIVIDE, subtract(value, low), subtract(high, low))
    return add(to_low, multiply(part, subtract(to_high, to_low)))


def smooth(kind: str, part: Expression) -> Expression:
    """Smooth Step and Smoother Step of a number already within 0...1."""
    square = multiply(part, part)
    if kind == "SMOOTHSTEP":
        return multiply(square, subtract(number(3.0), multiply(TWO, part)))
    cube = multiply(square, part)
    inner = add(multiply(part, subtract(multiply(part, number(6.0)), number(15.0))), number(10.0))
    return multiply(cube, inner)


def hue_saturation(
    color: Expression, hue: Expression, saturation: Expression, value: Expression
) -> Expression:
    """Blender's node: hue 0.5 and saturation and value 1 change nothing."""
    if color.constant and hue.constant and saturation.constant and value.constant:
        h, s, v = to_hsv(color.value)
        turned = (
            (h + hue.value[0] + 0.5) % 1.0,
            min(1.0, max(0.0, s * saturation.value[0])),
            v * value.value[0],
        )
        return constant(color_of(max(0.0, c) for c in from_hsv(turned)), color.exact)
    hsv = apply(Op.TO_HSV, color)
    shift = apply(Op.COMBINE, add(hue, HALF), ZERO, ZERO)
    factor = apply(Op.COMBINE, ONE, saturation, value)
    changed = multiply(add(hsv, shift), factor)
    wide = number(1e9)
    most = apply(Op.COMBINE, wide, ONE, wide)
    result = apply(Op.MAXIMUM, apply(Op.FROM_HSV, apply(Op.MINIMUM, changed, most)), ZERO)
    if value.constant and value.value[0] <= 1.0 and bounds(color)[1] <= 1.0:
        result = apply(Op.MINIMUM, result, ONE)  # it is: now that can be seen
    return result
