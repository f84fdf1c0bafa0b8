# SPDX-License-Identifier: GPL-3.0-or-later
"""Affine expressions: those that are offset + scale * one image's texel, as the backend's textures
are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Union

from ..native import lodestone_native as native
from .color_expression import WEIGHTS, Color, Expression, Op, color_of, walk

Channel = native.Channel
_SAME = 1e-9


@dataclass(frozen=True)
class Affine:
    """An expression offset + scale * (the leaf's texel, or one channel of it), by channel of
    color."""

    leaf: Any
    channel: int = Channel.COLOR
    scale: Color = (1.0, 1.0, 1.0)
    offset: Color = (0.0, 0.0, 0.0)

    def scaled(self, factor: Color) -> Affine:
        return Affine(self.leaf, self.channel, _by(self.scale, factor), _by(self.offset, factor))

    def moved(self, shift: Color) -> Affine:
        return Affine(self.leaf, self.channel, self.scale, _sum(self.offset, shift))


Value = Union[Affine, Color, None]


def affine(a: Expression) -> Affine | None:
    """The affine form of an expression; None when it has none, a constant included."""
    found: dict[int, Value] = {}
    for item in walk(a):
        found[id(item)] = _of(item, [found[id(arg)] for arg in item.args])
    result = found[id(a)]
    return result if isinstance(result, Affine) else None


def peeled(a: Expression) -> tuple[Expression, Color, Color]:
    """The parts (inner, scale, offset) of a = offset + scale * inner, without the constants around
    it."""
    scale: Color = (1.0, 1.0, 1.0)
    offset: Color = (0.0, 0.0, 0.0)
    while len(a.args) == 2 and (a.args[0].constant or a.args[1].constant):
        first = a.args[0].constant
        value, rest = (a.args[0], a.args[1]) if first else (a.args[1], a.args[0])
        if a.op == Op.MULTIPLY:
            scale = _by(scale, value.value)
        elif a.op == Op.ADD:
            offset = _sum(offset, _by(scale, value.value))
        elif a.op == Op.SUBTRACT and not first:
            offset = _sum(offset, _by(scale, color_of(-c for c in value.value)))
        elif a.op == Op.SUBTRACT:
            offset, scale = _sum(offset, _by(scale, value.value)), _by(scale, (-1.0, -1.0, -1.0))
        elif a.op == Op.DIVIDE and not first and 0.0 not in value.value:
            scale = _by(scale, color_of(1.0 / c for c in value.value))
        else:
            break
        a = rest
    return a, scale, offset


def _of(item: Expression, given: Sequence[Value]) -> Value:
    """The affine form of an operation on constants (colors) and affine things; None: it has
    none."""
    if item.constant:
        return item.value
    if item.op == Op.TEXEL:
        return Affine(item.leaf)
    args = [arg for arg in given if arg is not None]
    if len(args) < len(given):
        return None
    if item.op == Op.CHANNEL:
        return _channel(args[0], int(item.value[0]))
    if item.op == Op.LUMA:
        return _luma(args[0])
    if item.op == Op.COMBINE:
        return _combined(args)
    if item.op == Op.MIX:
        return _mixed(*args)
    if item.op in {Op.ADD, Op.SUBTRACT}:
        return _added(args[0], args[1], 1.0 if item.op == Op.ADD else -1.0)
    if item.op == Op.MULTIPLY:
        return _multiplied(args[0], args[1])
    if item.op == Op.DIVIDE and not isinstance(args[1], Affine) and 0.0 not in args[1]:
        return _multiplied(args[0], color_of(1.0 / c for c in args[1]))
    return None


def _channel(a: Affine | Color, index: int) -> Affine | None:
    if not isinstance(a, Affine):
        return None
    if a.channel == Channel.COLOR:
        if index == 3:  # asked for of a texel itself only
            return Affine(a.leaf, Channel.ALPHA)
        scale, offset = a.scale[index], a.offset[index]
        return Affine(a.leaf, Channel.RED + index, _grey(scale), _grey(offset))
    index = min(index, 2)
    return Affine(a.leaf, a.channel, _grey(a.scale[index]), _grey(a.offset[index]))


def _luma(a: Affine | Color) -> Affine | None:
    if not isinstance(a, Affine):
        return None
    offset = sum(w * c for w, c in zip(WEIGHTS, a.offset))
    if a.channel != Channel.COLOR:
        scale = sum(w * c for w, c in zip(WEIGHTS, a.scale))
        return Affine(a.leaf, a.channel, _grey(scale), _grey(offset))
    if max(a.scale) - min(a.scale) > _SAME:
        return None
    return Affine(a.leaf, Channel.LUMA, _grey(a.scale[0]), _grey(offset))


def _combined(args: Sequence[Affine | Color]) -> Affine | None:
    parts = [arg for arg in args if isinstance(arg, Affine)]
    if len(parts) < len(args) or any(part.leaf != parts[0].leaf for part in parts):
        return None
    channels = [part.channel for part in parts]
    if channels == [Channel.RED, Channel.GREEN, Channel.BLUE]:
        kind: int = Channel.COLOR
    elif len(set(channels)) == 1 and channels[0] != Channel.COLOR:
        kind = channels[0]
    else:
        return None
    scale = color_of(part.scale[c] for c, part in enumerate(parts))
    offset = color_of(part.offset[c] for c, part in enumerate(parts))
    return Affine(parts[0].leaf, kind, scale, offset)


def _added(a: Affine | Color, b: Affine | Color, sign: float) -> Affine | None:
    if not isinstance(b, Affine):
        return a.moved(color_of(sign * c for c in b)) if isinstance(a, Affine) else None
    b = b.scaled(_grey(sign))
    if not isinstance(a, Affine):
        return b.moved(a)
    if a.leaf != b.leaf or a.channel != b.channel:
        return None
    return Affine(a.leaf, a.channel, _sum(a.scale, b.scale), _sum(a.offset, b.offset))


def _multiplied(a: Affine | Color, b: Affine | Color) -> Affine | None:
    if isinstance(a, Affine):
        return None if isinstance(b, Affine) else a.scaled(b)
    return b.scaled(a) if isinstance(b, Affine) else None


def _mixed(a: Affine | Color, b: Affine | Color, share: Affine | Color) -> Affine | None:
    if not isinstance(share, Affine):
        rest = color_of(1.0 - s for s in share)
        a = a.scaled(rest) if isinstance(a, Affine) else _by(a, rest)
        b = b.scaled(share) if isinstance(b, Affine) else _by(b, share)
        return _added(a, b, 1.0)
    if isinstance(a, Affine) or isinstance(b, Affine):
        return None
    difference = color_of(y - x for x, y in zip(a, b))
    return share.scaled(difference).moved(a)


def _grey(value: float) -> Color:
    return (value, value, value)


def _by(a: Color, b: Color) -> Color:
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


def _sum(a: Color, b: Color) -> Color:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
