# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures computed from other pictures, texel by texel."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from ctypes import c_float
from dataclasses import dataclass

from . import structs
from .base import pointer_to, text_in
from .enums import BakeOp


@dataclass(frozen=True)
class BakeStep:
    """One operation; args are the numbers of earlier steps, for TEXEL that of a texture.

    table: RGBA rows (array 'f', [row][4]) over 0...1 of a RAMP or CURVES.
    """

    op: BakeOp
    args: tuple[int, ...] = ()
    value: tuple[float, ...] = ()
    table: array[float] | None = None


def bake(
    name: str,
    steps: Sequence[BakeStep],
    textures: Sequence[structs.Texture],
    size: tuple[int, int],
    linear: bool,
) -> structs.Bake:
    """Points into the steps' tables: keep them until the call is over."""
    rows = (structs.BakeStep * len(steps))(*map(_row, steps))
    return structs.Bake(
        name=text_in(name),
        steps=rows,
        step_count=len(steps),
        textures=(structs.Texture * len(textures))(*textures),
        texture_count=len(textures),
        width=size[0],
        height=size[1],
        linear=int(linear),
    )


def _row(step: BakeStep) -> structs.BakeStep:
    if step.table is not None and (step.table.itemsize != 4 or len(step.table) % 4):
        raise ValueError("a table needs rows of four 4-byte floats")
    return structs.BakeStep(
        op=step.op,
        args=(*step.args, 0, 0, 0)[:3],
        value=(*step.value, 0.0, 0.0, 0.0, 0.0)[:4],
        table=pointer_to(step.table, c_float),
        table_count=0 if step.table is None else len(step.table) // 4,
    )
