# SPDX-License-Identifier: GPL-3.0-or-later
"""The cut: which representation of every occurrence a view uses."""

import ctypes
import struct
from collections import Counter
from typing import Any, NamedTuple

from . import structs
from .handle import Handle
from .job import Job
from .library import check, library
from .model import Model
from .structs import Object, record, text_out
from .view import Budget, View


class Choice(NamedTuple):
    object: Object
    lod: int
    kind: int
    error_px: float
    world: tuple[float, ...]


class Cut(Handle):
    """Keeps its model alive; close it (or leave the `with` block) to free its memory.

    With a budget: the finest cut that costs no more, but not finer than the view's Pixel Error.
    `pixel_error` is then what was found, `fits` False where even the coarsest cut
    costs more."""

    _destroy = "lds_cut_destroy"

    def __init__(
        self, model: Model, view: View, job: Job | None = None, budget: Budget | None = None
    ) -> None:
        self.model = model
        self.view = view
        self.pixel_error = view.pixel_error
        self.fits = True
        self._handle: ctypes.c_void_p | None = ctypes.c_void_p()
        made, lib = ctypes.byref(self._handle), library()
        if budget is None:
            check(lib.lds_cut_create(model.handle, view.struct(), job, made))
            return
        report = structs.BudgetReport()
        wanted = ctypes.byref(budget.struct())
        check(
            lib.lds_cut_create_within(
                model.handle, view.struct(), wanted, job, ctypes.byref(report), made
            )
        )
        self.pixel_error = report.pixel_error
        self.fits = report.fits != 0

    def summary(self) -> Any:
        out = structs.CutSummary()
        check(library().lds_cut_get_summary(self.handle, ctypes.byref(out)))
        return record(out)

    def choices(self) -> list[Choice]:
        return [
            Choice(Object(*c.object.key), c.lod, c.kind, c.error_px, tuple(c.world))
            for c in self._buffer()
        ]

    def counts(self) -> dict[tuple[Object, int], int]:
        """How often which LOD number of which object is chosen."""
        rest = ctypes.sizeof(structs.Choice) - 3 * ctypes.sizeof(ctypes.c_uint32)
        counted = Counter(struct.iter_unpack(f"=3I{rest}x", self._buffer()))
        return {(Object(*key[:2]), key[2]): number for key, number in counted.items()}

    def reason(self, position: int) -> Any:
        """Why a choice is what it is: fields as lds_reason's."""
        out = structs.Reason()
        check(
            library().lds_cut_choice_reason(
                self.model.handle, self.handle, position, ctypes.byref(out)
            )
        )
        return record(out)

    def _buffer(self) -> Any:
        count = library().lds_cut_choice_count(self.handle)
        buffer = (structs.Choice * count)()
        check(library().lds_cut_choice_copy(self.handle, buffer, count))
        return buffer

    def choice_path(self, position: int) -> str:
        """Names of the placements from the root, joined by '/'."""
        return text_out(library().lds_cut_choice_path(self.handle, position))
