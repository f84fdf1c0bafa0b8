# SPDX-License-Identifier: GPL-3.0-or-later
"""Expressions: colors computed from images' texels, constants folded while they are built.

Every value is a color (three numbers); a number is a color of three equal ones. The operations
are those of the backend's bakes (BakeOp), which say what each does.
"""

from __future__ import annotations

import math
import operator
from array import array
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from .. import srgb
from ..native import lodestone_native as native

Op = native.BakeOp
Color = tuple[float, float, float]
WEIGHTS = (0.2126, 0.7152, 0.0722)  # luma, ITU-R BT.709


@dataclass(frozen=True, eq=False)
class Expression:
    """One operation on others. `exact` False: a constant that only stands for the mean of something
    that cannot be said.

    TEXEL has an image's `leaf`; an expression of a mesh's colors is a TEXEL too, with its own kind
    of leaf. RAMP and CURVES have a table of RGBA rows over 0...1.
    """

    op: Op
    args: tuple[Expression, ...] = ()
    value: Color = (0.0, 0.0, 0.0)
    leaf: Any = None
    table: array[float] | None = None
    exact: bool = True

    @property
    def constant(self) -> bool:
        return self.op == Op.CONSTANT


def color_of(values: Iterable[float]) -> Color:
    """Of three."""
    red, green, blue = values
    return (red, green, blue)


def constant(value: Color, exact: bool = True) -> Expression:
    return Expression(Op.CONSTANT, value=(value[0], value[1], value[2]), exact=exact)


def number(value: float, exact: bool = True) -> Expression:
    return Expression(Op.CONSTANT, value=(value, value, value), exact=exact)


ZERO, ONE = number(0.0), number(1.0)


def texel(leaf: Any) -> Expression:
    return Expression(Op.TEXEL, leaf=leaf)


def alpha(leaf: Any) -> Expression:
    return Expression(Op.CHANNEL, (texel(leaf),), value=(3.0, 0.0, 0.0))


def apply(op: Op, *args: Expression) -> Expression:
    """Folded when all arguments are constants; neutral operations vanish."""
    if all(arg.constant for arg in args):
        return Expression(
            Op.CONSTANT, value=_folded(op, args), exact=all(arg.exact for arg in args)
        )
    kept = _neutral(op, args)
    return Expression(op, args) if kept is None else kept


def channel(a: Expression, index: int) -> Expression:
    """Red, green or blue."""
    if a.constant:
        return number(a.value[index], a.exact)
    if a.op == Op.COMBINE:
        return a.args[index] if _is_number(a.args[index]) else channel(a.args[index], index)
    if _is_number(a):
        return a
    return Expression(Op.CHANNEL, (a,), value=(float(index), 0.0, 0.0))


def luma(a: Expression) -> Expression:
    if a.constant:
        return number(sum(w * c for w, c in zip(WEIGHTS, a.value)), a.exact)
    return a if _is_number(a) else Expression(Op.LUMA, (a,))


def ramp(a: Expression, table: array[float]) -> Expression:
    """A color by a number 0...1; of a mean the table's mean."""
    if not a.constant:
        return Expression(Op.RAMP, (a,), table=table)
    if a.exact:
        return constant(_row(table, a.value[0]))
    rows = len(table) // 4
    mean = [math.fsum(table[c::4]) / rows for c in range(3)]
    return constant((mean[0], mean[1], mean[2]), False)


def curves(a: Expression, table: array[float]) -> Expression:
    if not a.constant:
        return Expression(Op.CURVES, (a,), table=table)
    return constant(color_of(_row(table, a.value[c])[c] for c in range(3)), a.exact)


def add(a: Expression, b: Expression) -> Expression:
    return apply(Op.ADD, a, b)


def subtract(a: Expression, b: Expression) -> Expression:
    return apply(Op.SUBTRACT, a, b)


def multiply(a: Expression, b: Expression) -> Expression:
    return apply(Op.MULTIPLY, a, b)


def mix(a: Expression, b: Expression, share: Expression) -> Expression:
    return apply(Op.MIX, a, b, share)


def clamp(a: Expression, least: float = 0.0, most: float = 1.0) -> Expression:
    low, high = bounds(a)
    if low < least:
        a = apply(Op.MAXIMUM, a, number(least))
    return apply(Op.MINIMUM, a, number(most)) if high > most else a


def walk(a: Expression) -> Iterator[Expression]:
    """Every different expression in it, arguments before what uses them."""
    seen: set[int] = set()
    stack = [(a, False)]
    while stack:
        item, ready = stack.pop()
        if ready:
            yield item
        elif id(item) not in seen:
            seen.add(id(item))
            stack.append((item, True))
            stack.extend((arg, False) for arg in reversed(item.args))


def leaves(a: Expression) -> list[Any]:
    """The different leaves in it, in the order they are met."""
    if not a.args:  # nearly always: a number, or a picture as it is
        return [a.leaf] if a.op == Op.TEXEL else []
    return list({item.leaf: None for item in walk(a) if item.op == Op.TEXEL})


def replaced(a: Expression, by: Callable[[Any, bool], Expression | None]) -> Expression:
    """The expression with by(leaf, False) in the place of the color of every leaf for which it is
    not None, and by(leaf, True) in the place of its alpha."""
    done: dict[int, Expression] = {}
    for item in walk(a):
        new = None
        if item.op == Op.TEXEL:
            new = by(item.leaf, False)
        elif item.op == Op.CHANNEL and item.value[0] == 3.0 and item.args[0].op == Op.TEXEL:
            new = by(item.args[0].leaf, True)
        elif item.args:
            args = tuple(done[id(arg)] for arg in item.args)
            if any(x is not y for x, y in zip(args, item.args)):
                new = _rebuilt(item, args)
        done[id(item)] = item if new is None else new
    return done[id(a)]


def _rebuilt(item: Expression, args: tuple[Expression, ...]) -> Expression:
    if item.op == Op.CHANNEL:
        return channel(args[0], int(item.value[0]))
    if item.op == Op.LUMA:
        return luma(args[0])
    if item.op == Op.RAMP and item.table is not None:
        return ramp(args[0], item.table)
    if item.op == Op.CURVES and item.table is not None:
        return curves(args[0], item.table)
    return apply(item.op, *args)


def bounds(a: Expression) -> tuple[float, float]:
    """Lowest and highest of its numbers where texels are 0...1; cautious."""
    found: dict[int, tuple[float, float]] = {}
    for item in walk(a):
        low, high = _bounds(item, [found[id(arg)] for arg in item.args])
        unknown = math.isnan(low) or math.isnan(high)  # differences of infinities
        found[id(item)] = (-math.inf, math.inf) if unknown else (low, high)
    return found[id(a)]


def _bounds(item: Expression, args: list[tuple[float, float]]) -> tuple[float, float]:
    if item.constant:
        return (min(item.value), max(item.value))
    if item.op == Op.TEXEL:
        return (0.0, 1.0)
    if item.op in _SAME_RANGE:
        return (min(low for low, _ in args), max(high for _, high in args))
    if item.op in {Op.RAMP, Op.CURVES} and item.table is not None:
        return (min(item.table), max(item.table))
    if item.op == Op.GREATER:
        return (0.0, 1.0)
    if item.op in _CORNERS:
        corners = [_CORNERS[item.op](x, y) for x in args[0] for y in args[1]]
        return (min(corners), max(corners))
    if item.op == Op.POWER and 0.0 <= args[0][0] and args[0][1] <= 1.0 and args[1][0] >= 0.0:
        return (0.0, 1.0)
    if (
        item.op == Op.POWER
        and args[0][0] > 0.0
        and max(abs(x) for x in (*args[0], *args[1])) < 100.0
    ):
        corners = [_power(x, y) for x in args[0] for y in args[1]]
        return (min(corners), max(corners))
    if item.op == Op.DIVIDE and not args[1][0] <= 0.0 <= args[1][1]:
        corners = [x / y for x in args[0] for y in args[1]]
        return (min(corners), max(corners))
    if item.op == Op.ABSOLUTE:
        return (0.0, max(abs(args[0][0]), abs(args[0][1])))
    if item.op == Op.FLOOR and math.isfinite(args[0][0]) and math.isfinite(args[0][1]):
        return (float(math.floor(args[0][0])), float(math.floor(args[0][1])))
    if item.op == Op.MODULO:
        most = max(abs(args[1][0]), abs(args[1][1]))
        return (0.0 if args[0][0] >= 0.0 else -most, most)
    if item.op == Op.MIX and 0.0 <= args[2][0] and args[2][1] <= 1.0:
        return (min(args[0][0], args[1][0]), max(args[0][1], args[1][1]))
    if item.op in {Op.TO_HSV, Op.FROM_HSV, Op.TO_SRGB, Op.FROM_SRGB} and args[0] == (0.0, 1.0):
        return (0.0, 1.0)
    return (-math.inf, math.inf)


# ---- Folding ----


def _is_number(a: Expression) -> bool:
    """Whether its three numbers are certainly equal."""
    if a.constant:
        return a.value[0] == a.value[1] == a.value[2]
    if a.op in {Op.CHANNEL, Op.LUMA}:
        return True
    if a.op in {Op.TEXEL, Op.COMBINE, Op.RAMP, Op.CURVES, Op.TO_HSV, Op.FROM_HSV}:
        return False
    return all(_is_number(arg) for arg in a.args)


def _neutral(op: Op, args: tuple[Expression, ...]) -> Expression | None:
    """The simpler expression that an operation comes to which changes nothing, or None."""
    if op == Op.ADD:
        return next((args[1 - k] for k in (0, 1) if _all(args[k], 0.0)), None)
    if op == Op.MULTIPLY:
        if _all(args[0], 0.0) or _all(args[1], 0.0):
            return ZERO
        return next((args[1 - k] for k in (0, 1) if _all(args[k], 1.0)), None)
    if op == Op.MIX:
        if args[0] is args[1]:
            return args[0]
        return args[0] if _all(args[2], 0.0) else args[1] if _all(args[2], 1.0) else None
    if op == Op.SUBTRACT:
        return args[0] if _all(args[1], 0.0) else None
    if op in {Op.DIVIDE, Op.POWER}:
        return args[0] if _all(args[1], 1.0) else None
    if op == Op.COMBINE and all(a.op == Op.CHANNEL for a in args):
        of = {id(a.args[0]) for a in args}
        if len(of) == 1 and [int(a.value[0]) for a in args] == [0, 1, 2]:
            return args[0].args[0]
    return None


def _all(a: Expression, value: float) -> bool:
    return a.constant and a.exact and a.value == (value, value, value)


def _folded(op: Op, args: tuple[Expression, ...]) -> Color:
    values = [arg.value for arg in args]
    if op in _BY_CHANNEL:
        function = _BY_CHANNEL[op]
        return color_of(_finite(function(*parts)) for parts in zip(*values))
    if op == Op.COMBINE:
        return (values[0][0], values[1][1], values[2][2])
    return to_hsv(values[0]) if op == Op.TO_HSV else from_hsv(values[0])


def _finite(value: float) -> float:
    return value if math.isfinite(value) else 0.0


def _power(x: float, y: float) -> float:
    try:
        return math.pow(x, y)
    except (ValueError, OverflowError, ZeroDivisionError):
        return 0.0


def _row(table: array[float], at: float) -> Color:
    last = len(table) // 4 - 1
    place = min(1.0, max(0.0, at)) * last
    low = min(int(place), last)
    high, part = min(low + 1, last), place - low
    return color_of(
        table[4 * low + c] * (1.0 - part) + table[4 * high + c] * part for c in range(3)
    )


def to_hsv(color: Color) -> Color:
    most, spread = max(color), max(color) - min(color)
    if spread <= 0.0:
        return (0.0, 0.0, most)
    r, g, b = color
    if most == r:
        hue = (g - b) / spread
    elif most == g:
        hue = 2.0 + (b - r) / spread
    else:
        hue = 4.0 + (r - g) / spread
    return ((hue / 6.0) % 1.0, spread / most if most else 0.0, most)


def from_hsv(color: Color) -> Color:
    hue = 6.0 * (color[0] % 1.0)

    def part(shift: float) -> float:
        at = (hue + shift) % 6.0
        return color[2] * (1.0 - color[1] * min(1.0, max(0.0, min(at, 4.0 - at))))

    return (part(5.0), part(3.0), part(1.0))


_BY_CHANNEL: dict[Op, Callable[..., float]] = {
    Op.ADD: operator.add,
    Op.SUBTRACT: operator.sub,
    Op.MULTIPLY: operator.mul,
    Op.DIVIDE: lambda x, y: float(x / y) if y else 0.0,
    Op.POWER: _power,
    Op.MINIMUM: min,
    Op.MAXIMUM: max,
    Op.MIX: lambda x, y, share: float(x + share * (y - x)),
    Op.GREATER: lambda x, y: 1.0 if x > y else 0.0,
    Op.ABSOLUTE: abs,
    Op.FLOOR: lambda x: float(math.floor(x)) if math.isfinite(x) else 0.0,
    Op.MODULO: lambda x, y: math.fmod(x, y) if y and math.isfinite(x) else 0.0,
    Op.TO_SRGB: srgb.encode,
    Op.FROM_SRGB: srgb.decode,
}
_SAME_RANGE = {Op.CHANNEL, Op.LUMA, Op.COMBINE}
_CORNERS: dict[Op, Callable[[float, float], float]] = {
    Op.ADD: _BY_CHANNEL[Op.ADD],
    Op.SUBTRACT: _BY_CHANNEL[Op.SUBTRACT],
    Op.MULTIPLY: _BY_CHANNEL[Op.MULTIPLY],
    Op.MINIMUM: min,
    Op.MAXIMUM: max,
}
