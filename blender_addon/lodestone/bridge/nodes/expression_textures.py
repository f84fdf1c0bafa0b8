# SPDX-License-Identifier: GPL-3.0-or-later
"""Expressions of images as textures: exactly, as a baked picture, or, named, as their mean.

A slot has one set of texture coordinates: those of its first image, base color first. Images that
are looked up elsewhere count as their mean.
"""

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ...core.expression import color_expression as e
from ...core.expression.affine_texel import Affine, affine, peeled
from ...core.expression.color_expression import Color, Expression, Op
from ...core.native import lodestone_native as native
from ...core.problems import INFO, WARNING
from .material_looks import Baked, TextureUse, Value, VertexColors
from .node_expressions import Note, Sample, VertexColor
from .texture_coordinates import IDENTITY_2D, Coordinates, between

_REPEAT = native.Extension.REPEAT
_MOST_REPEATS = 4  # a picture may repeat within the baked one: more would lose its detail
_MOST_STEPS = 200
_EXACT = 1e-4
_COARSE = 8.0  # a range that 256 steps show badly


def main_coordinates(values: Iterable[Expression]) -> Coordinates | None:
    """The coordinates of the first image that has any."""
    for value in values:
        for leaf in e.leaves(value):
            if isinstance(leaf, Sample) and leaf.coordinates.kind != "NONE":
                return leaf.coordinates
    return None


class Textures:
    """The textures of one material, at the coordinates its slot will carry."""

    def __init__(self, pictures: Any, note: Note, coordinates: Coordinates | None) -> None:
        self._pictures = pictures
        self._note = note
        self._coordinates = coordinates

    def color(self, value: Expression) -> Value:
        return self._value(self._followed(value), False)

    def number(self, value: Expression) -> Value:
        """A texture's number is its first."""
        return self._value(self._followed(value), True)

    def constant(self, value: Expression, words: str) -> float:
        """The mean of a value that the backend holds no texture for."""
        value = self._followed(value)
        if not value.constant:
            self._note(WARNING, "texture_mean", f"the texture of its {words} is drawn as its mean")
            value = self._means(value, e.leaves(value))
        return value.value[0]

    def vertex_colors(
        self, color: Expression, alpha: Expression
    ) -> tuple[Expression, Expression, VertexColors | None]:
        """Base color and alpha without the vertex colors that multiply them, and these."""
        rest_color, leaf = _split(color, False)
        rest_alpha, alpha_leaf = _split(alpha, True)
        name = leaf or alpha_leaf
        if name is None:
            return color, alpha, None
        if leaf is None:
            rest_color = color
        if alpha_leaf != name:
            rest_alpha = alpha
        found = VertexColors(name.name, leaf is not None, alpha_leaf == name)
        return rest_color, rest_alpha, found

    # ---- Leaves that cannot be followed ----

    def _followed(self, value: Expression) -> Expression:
        """The value with the mean of every leaf that is looked up elsewhere in its place."""
        strangers = []
        for leaf in e.leaves(value):
            if isinstance(leaf, VertexColor):
                text = "vertex colors that do not simply multiply its color count as gray"
                self._note(WARNING, "vertex_colors", text)
                strangers.append(leaf)
            elif leaf.coordinates != self._coordinates:
                if leaf.coordinates.kind != "NONE":  # else it has been named
                    text = f'image "{leaf.source.name}" is looked up elsewhere than its first image'
                    self._note(WARNING, "texture_mean", f"{text}; drawn as its mean")
                strangers.append(leaf)
        return self._means(value, strangers) if strangers else value

    def _means(self, value: Expression, leaves: list[Any]) -> Expression:
        def mean(leaf: Any, of_alpha: bool) -> Expression | None:
            if leaf not in leaves:
                return None
            if isinstance(leaf, VertexColor):
                return e.number(1.0 if of_alpha else 0.5, False)
            texel = self._pictures.mean(leaf.source) or (1.0, 0.0, 1.0, 1.0)
            return e.number(texel[3], False) if of_alpha else e.constant(texel[:3], False)

        return e.replaced(value, mean)

    # ---- Texture or constant ----

    def _value(self, value: Expression, number: bool) -> Value:
        if value.constant:
            return Value(value.value)
        found = affine(value)
        if found is not None:
            return Value((0.5, 0.5, 0.5), _plain(found))
        inner, scale, offset = self._in_range(*peeled(value))
        baked = self._baked(inner, number)
        if baked is not None:
            texture = replace(baked, scale=scale, offset=offset)
            return Value((0.5, 0.5, 0.5), texture)
        # These cannot be baked together: all but the first image count as their means
        leaves = e.leaves(value)
        names = ", ".join(f'"{leaf.source.name}"' for leaf in leaves[1:])
        if len(leaves) < 2:
            self._note(WARNING, "texture_mean", "a texture is drawn as its mean")
            return Value(self._means(value, leaves).value)
        self._note(WARNING, "texture_mean", f"image {names} is drawn as its mean")
        return self._value(self._means(value, leaves[1:]), number)

    def _in_range(
        self, inner: Expression, scale: Color, offset: Color
    ) -> tuple[Expression, Color, Color]:
        """The same value as offset + scale * inner with an inner of 0...1: a picture holds nothing
        else."""
        low, high = e.bounds(inner)
        if -_EXACT <= low and high <= 1.0 + _EXACT:
            return inner, scale, offset
        if not math.isfinite(low) or not math.isfinite(high):
            self._note(INFO, "baked_range", "a computed texture is cut to 0...1")
            return inner, scale, offset
        low, high = min(low, 0.0), max(high, 1.0)
        if high - low > _COARSE:
            self._note(INFO, "baked_range", "a computed texture has few steps for its range")
        inner = e.apply(Op.DIVIDE, e.subtract(inner, e.number(low)), e.number(high - low))
        moved = [o + s * low for o, s in zip(offset, scale)]
        wide = [s * (high - low) for s in scale]
        return inner, (wide[0], wide[1], wide[2]), (moved[0], moved[1], moved[2])

    def _baked(self, inner: Expression, number: bool) -> TextureUse | None:
        """The texture of a picture that is baked; None when its images repeat differently, or it is
        too much."""
        samples = e.leaves(inner)
        base = samples[0]
        moved = [_seen_from(base, sample) for sample in samples]
        order = list(e.walk(inner))
        if None in moved or len(order) > _MOST_STEPS:
            return None
        number_of = {id(item): k for k, item in enumerate(order)}
        steps = []
        for item in order:
            if item.op == Op.TEXEL:
                steps.append(native.BakeStep(item.op, (samples.index(item.leaf),)))
                continue
            args = tuple(number_of[id(arg)] for arg in item.args)
            steps.append(native.BakeStep(item.op, args, (*item.value, 1.0), item.table))
        name = " & ".join(sample.source.name for sample in samples)
        picture = Baked(name, tuple(steps), tuple(moved), number)
        return TextureUse(
            picture,
            channel=native.Channel.RED if number else native.Channel.COLOR,
            extension=base.extension,
            closest=base.closest,
            to_picture=base.to_picture,
        )


def _plain(found: Affine) -> TextureUse:
    sample: Sample = found.leaf
    return TextureUse(
        sample.source,
        found.channel,
        sample.extension,
        sample.closest,
        sample.to_picture,
        found.scale,
        found.offset,
    )


def _seen_from(base: Sample, sample: Sample) -> Sample | None:
    """The sample mapped from the base's picture coordinates; None when one period of these does
    not hold a whole number of its own."""
    if sample.to_picture == base.to_picture:
        return replace(sample, to_picture=IDENTITY_2D)
    rows = between(base.to_picture, sample.to_picture)
    if rows is None or base.extension != _REPEAT or sample.extension != _REPEAT:
        return None
    for k in (0, 1, 3, 4):
        if abs(rows[k] - round(rows[k])) > _EXACT or abs(rows[k]) > _MOST_REPEATS:
            return None
    return replace(sample, to_picture=rows)


def _split(value: Expression, of_alpha: bool) -> tuple[Expression, VertexColor | None]:
    """The value without the vertex color (or its alpha) that multiplies it, and this."""
    if value.op == Op.TEXEL and isinstance(value.leaf, VertexColor) and not of_alpha:
        return e.ONE, value.leaf
    if of_alpha and value.op == Op.CHANNEL and value.value[0] == 3.0:
        if value.args[0].op == Op.TEXEL and isinstance(value.args[0].leaf, VertexColor):
            return e.ONE, value.args[0].leaf
    if value.op == Op.MULTIPLY:
        for this, that in (value.args, value.args[::-1]):
            rest, leaf = _split(this, of_alpha)
            if leaf is not None:
                return e.multiply(rest, that), leaf
    return value, None
