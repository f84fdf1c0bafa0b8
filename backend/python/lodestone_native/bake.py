# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures computed from other pictures, texel by texel."""

import ctypes
from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from . import structs
from .enums import BakeOp
from .structs import text_in


@dataclass(frozen=True)
class BakeStep:
    """One operation; args are the numbers of earlier steps, for TEXEL that of a texture.

    table: RGBA rows (array 'f', [row][4]) over 0...1 of a RAMP or CURVES.
    """

    op: BakeOp
    args: tuple[int, ...] = ()
    value: tuple[float, ...] = ()
    table: array | None = None


def bake(
    name: str,
    steps: Sequence[BakeStep],
    textures: Sequence[structs.Texture],
    size: tuple[int, int],
    linear: bool,
) -> structs.Bake:
    """Points into the steps' tables: keep them until the call is over."""
    rows = (structs.BakeStep * len(steps))()
    for row, step in zip(rows, steps):
        row.op = step.op
        row.args = (*step.args, 0, 0, 0)[:3]
        row.value = (*step.value, 0.0, 0.0, 0.0, 0.0)[:4]
        if step.table is not None:
            if step.table.itemsize != 4 or len(step.table) % 4:
                raise ValueError("a table needs rows of four 4-byte floats")
            row.table = step.table.buffer_info()[0]
            row.table_count = len(step.table) // 4
    return structs.Bake(
        name=text_in(name),
        steps=ctypes.cast(rows, ctypes.POINTER(structs.BakeStep)),
        step_count=len(steps),
        textures=(structs.Texture * len(textures))(*textures),
        texture_count=len(textures),
        width=size[0],
        height=size[1],
        linear=int(linear),
    )
