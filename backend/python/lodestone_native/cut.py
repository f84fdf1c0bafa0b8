# SPDX-License-Identifier: GPL-3.0-or-later
"""The cut: which representation of every occurrence a view uses."""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from . import records, structs
from .base import pointer_to, text_out
from .enums import Drawn, Kind, Rays
from .handle import Handle
from .job import Job
from .library import check, library
from .model import Model
from .structs import Object
from .view import Budget, View


class BatchMesh(NamedTuple):
    """What a graphics card is given of a batch: positions array('f') [vertex][3] in the world;
    normals array('h') [vertex][4], unit times 32767, zero where flat, the fourth 32767 where it
    glows; colors array('B') [vertex][4], sRGB and how much light it stops; triangles array('I')
    [triangle][3]. `box`: its lower and its upper corner."""

    positions: array[float]
    normals: array[int]
    colors: array[int]
    triangles: array[int]
    box: tuple[float, ...]

    @property
    def bytes(self) -> int:
        buffers: tuple[array[Any], ...] = (
            self.positions,
            self.normals,
            self.colors,
            self.triangles,
        )
        return sum(len(part) * part.itemsize for part in buffers)


def kind_counts(occurrences_of_kind: Sequence[int]) -> dict[str, int]:
    """By the words that reports have for the kinds that can be drawn; of Cut.summary()."""
    drawn = [kind for kind in Kind if kind != Kind.ASSEMBLY]
    return {kind.name.lower(): occurrences_of_kind[kind] for kind in drawn}


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
        made, lib = ctypes.c_void_p(), library()
        self._handle = made
        if budget is None:
            check(lib.lds_cut_create(model.handle, view.struct(), job, made))
            return
        report = structs.BudgetReport()
        wanted = budget.struct()
        check(lib.lds_cut_create_within(model.handle, view.struct(), wanted, job, report, made))
        self.pixel_error = report.pixel_error
        self.fits = report.fits != 0

    def step(self, view: View, job: Job | None = None) -> None:
        """Becomes the cut of another view of the model, as a new one would be, but soon where only
        the camera has moved, or lenses that hide nothing have changed. Its colors and its surface
        are gone. Raises LodestoneError; then it is as it was."""
        check(library().lds_cut_step(self.model.handle, self.handle, view.struct(), job))
        self.view, self.pixel_error, self.fits = view, view.pixel_error, True

    def summary(self) -> records.CutSummary:
        out = structs.CutSummary()
        check(library().lds_cut_get_summary(self.handle, out))
        return out.record()

    def choices(self) -> list[Choice]:
        return [
            Choice(Object(*c.object.key), c.lod, c.kind, c.error_px, tuple(c.world))
            for c in self._buffer()
        ]

    def counts(self) -> dict[tuple[Object, int], int]:
        """How often which LOD number of which object is chosen."""
        count, ask = ctypes.c_size_t(), library().lds_cut_level_uses
        check(ask(self.handle, None, 0, count))
        buffer = (structs.LevelUse * count.value)()
        check(ask(self.handle, buffer, len(buffer), count))
        return {(Object(*use.object.key), use.lod): use.occurrences for use in buffer}

    def reason(self, position: int) -> records.Reason:
        """Why a choice is what it is: fields as lds_reason's."""
        out = structs.Reason()
        check(library().lds_cut_choice_reason(self.model.handle, self.handle, position, out))
        return out.record()

    def rays(self, rays: Rays) -> records.RaySummary:
        """What a class of rays meets: fields as lds_ray_summary's."""
        out = structs.RaySummary()
        check(library().lds_cut_get_rays(self.handle, rays, out))
        return out.record()

    def choice_rays(self, position: int, rays: Rays) -> records.RayChoice:
        """What a class of rays meets of a choice: fields as lds_ray_choice's."""
        out, handle = structs.RayChoice(), self.handle
        check(library().lds_cut_choice_rays(self.model.handle, handle, position, rays, out))
        return out.record()

    def _buffer(self) -> ctypes.Array[structs.Choice]:
        count = library().lds_cut_choice_count(self.handle)
        buffer = (structs.Choice * count)()
        check(library().lds_cut_choice_copy(self.handle, buffer, count))
        return buffer

    def choice_path(self, position: int) -> str:
        """Names of the placements from the root, joined by '/'."""
        return text_out(library().lds_cut_choice_path(self.handle, position))

    def find_choice(self, item: Object, world: Iterable[float]) -> tuple[Drawn, int]:
        """How the occurrence of an object at a place (3 x 4, by rows) is drawn, and by which choice
        (-1: by none)."""
        rows = (ctypes.c_double * 12)(*world)
        drawn, position = ctypes.c_int32(), ctypes.c_size_t()
        find = library().lds_cut_find_choice
        check(find(self.model.handle, self.handle, item, rows, drawn, position))
        found = Drawn(drawn.value)
        by_choice = found in (Drawn.ITSELF, Drawn.IN_GROUP)
        return found, position.value if by_choice else -1

    def set_colors(self, colors: Iterable[tuple[float, float, float]]) -> None:
        """Linear colors of the choices, in their order, of false-colored pictures and surfaces;
        none: those of povray_false_color()."""
        flat = array("d", (value for color in colors for value in color))
        given = pointer_to(flat, ctypes.c_double)
        check(library().lds_cut_set_colors(self.handle, given, len(flat) // 3))

    def set_identities(self) -> None:
        """Colors that image_compare_shown() tells the choices by."""
        check(library().lds_cut_set_identities(self.handle))

    def make_surface(self, most_triangles: int, job: Job | None = None) -> int:
        """Makes loose triangles of what cameras see, and returns how many; 0 frees them."""
        out = ctypes.c_uint64()
        make = library().lds_cut_make_surface
        check(make(self.model.handle, self.handle, most_triangles, job, out))
        return out.value

    def surface(self, triangles: int) -> tuple[array[float], array[int]]:
        """Of make_surface(): array('f') [triangles][3][3] in the world, array('B')
        [triangles][3][4] of sRGB."""
        corners, colors = array("f", bytes(36 * triangles)), array("B", bytes(12 * triangles))
        if triangles:
            to = pointer_to(corners, ctypes.c_float), pointer_to(colors, ctypes.c_uint8)
            check(library().lds_cut_surface_copy(self.handle, *to, triangles))
        return corners, colors

    def make_batches(self) -> tuple[array[int], array[int]]:
        """Divides what cameras see into batches: (keys, triangles), array('Q') each. Equal keys
        show the same in any cut."""
        out = ctypes.c_size_t()
        lib = library()
        check(lib.lds_cut_make_batches(self.model.handle, self.handle, out))
        keys, triangles = array("Q", bytes(8 * out.value)), array("Q", bytes(8 * out.value))
        to = pointer_to(keys, ctypes.c_uint64), pointer_to(triangles, ctypes.c_uint64)
        check(lib.lds_cut_batch_keys(self.handle, *to, out.value))
        return keys, triangles

    def batch_mesh(self, position: int, job: Job | None = None) -> BatchMesh:
        """Of make_batches(). Reads the meshes it needs."""
        made, lib = ctypes.c_void_p(), library()
        check(lib.lds_batch_create(self.model.handle, self.handle, position, job, made))
        try:
            vertices = lib.lds_batch_vertex_count(made)
            box = (ctypes.c_double * 6)()
            check(lib.lds_batch_box(made, box))
            mesh = BatchMesh(
                array("f", bytes(12 * vertices)),
                array("h", bytes(8 * vertices)),
                array("B", bytes(4 * vertices)),
                array("I", bytes(12 * lib.lds_batch_triangle_count(made))),
                tuple(box),
            )
            to = (
                pointer_to(mesh.positions, ctypes.c_float),
                pointer_to(mesh.normals, ctypes.c_int16),
                pointer_to(mesh.colors, ctypes.c_uint8),
                pointer_to(mesh.triangles, ctypes.c_uint32),
            )
            check(lib.lds_batch_copy(made, *to))
        finally:
            lib.lds_batch_destroy(made)
        return mesh


def most_demanding(model: Model, group: Object) -> str:
    """The path below a group to what opens it by its importance or limit; "" when nothing does."""
    out = ctypes.c_char_p()
    check(library().lds_model_most_demanding(model.handle, group, out))
    return text_out(out.value)


def change_placement(
    model: Model, group: Object, position: int, transform: Sequence[float] | None, hidden: int = 0
) -> None:
    """Of the child at `position` of a group, after levels were built: it is elsewhere (None: where
    it was), or hidden from RayClasses. Groups around it are opened."""
    rows = None if transform is None else (ctypes.c_double * 12)(*transform)
    check(library().lds_model_change_placement(model.handle, group, position, rows, hidden))


def release_meshes(model: Model) -> None:
    """Frees the meshes that the model's store can give back."""
    check(library().lds_model_release_meshes(model.handle))
