# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing a POV-Ray scene for a cut, and running POV-Ray on it."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

from . import records, structs
from .base import text_in, text_out
from .cut import Cut
from .enums import Antialias
from .job import Job
from .library import check, library
from .view import View


_SHADING = (
    "antialias_threshold",
    "antialias_depth",
    "trace_depth",
    "area_samples",
    "sky_lights",
    "shadow_error",
    "light_error",
    "reflection_error",
    "texture_error",
    "bounces",
    "bounce_rays",
    "bounce_error",
    "sky_rays",
    "filter_size",
)


@dataclass(frozen=True)
class PovrayOptions:
    antialias: int = Antialias.FINAL
    false_color: bool = False  # paint by kind and LOD number
    covered_only: bool = False  # without environment objects and world
    threads: int = 0  # 0 = all
    program: str | None = None  # None: $LODESTONE_POVRAY, else povray on the PATH
    # How finely it is shaded, as lodestone.h says; 0: as usual
    antialias_threshold: float = 0.0
    antialias_depth: int = 0
    trace_depth: int = 0
    area_samples: int = 0
    sky_lights: int = 0
    shadow_error: float = 0.0
    # How far lights are approximated; 0: all light everything; negative: the view's Pixel Error.
    light_error: float = -1.0
    reflection_error: float = 0.0
    texture_error: float = 0.0
    bounces: int = 0
    bounce_rays: int = 0
    bounce_error: float = 0.0
    sky_rays: int = 0
    filter_size: float = 0.0
    bake_folder: str | None = None  # keeps what sky_rays found; None: the scene's folder
    # A picture alone: the sky lights what moves in an animation as what rests, and opaque faces on
    # the side that is seen; gloss shows lit surfaces around.
    still: bool = False

    def struct(self) -> structs.PovrayOptions:
        out = structs.PovrayOptions()
        check(library().lds_povray_options_default(out))
        out.antialias = self.antialias
        out.false_color = int(self.false_color)
        out.covered_only = int(self.covered_only)
        out.still = int(self.still)
        out.threads = self.threads
        out.program = text_in(self.program or None)
        out.bake_folder = text_in(self.bake_folder)
        for name in _SHADING:
            setattr(out, name, getattr(self, name))
        return out


def povray_export(
    cut: Cut, folder: str, options: PovrayOptions, job: Job | None = None, view: View | None = None
) -> records.ExportReport:
    """Writes scene.pov, scene.ini and r/<16 hex>.inc into folder. `view`: seen from there, not from
    where the cut was made for."""
    out = structs.ExportReport()
    check(
        library().lds_povray_export(
            cut.model.handle,
            cut.handle,
            (view or cut.view).struct(),
            text_in(folder),
            options.struct(),
            job,
            out,
        )
    )
    return out.record()


def povray_run(
    folder: str, picture: str, options: PovrayOptions, job: Job | None = None
) -> records.PovrayReport:
    """Renders folder/scene.ini to folder/picture (.exr or .png)."""
    out = structs.PovrayReport()
    check(library().lds_povray_run(text_in(folder), text_in(picture), options.struct(), job, out))
    return out.record()


def povray_empty_bytes(width: int, height: int, program: str | None = None) -> int:
    """POV-Ray's peak memory on a picture of this size without any object: what to subtract."""
    out = ctypes.c_uint64()
    check(library().lds_povray_empty_bytes(width, height, text_in(program or None), out))
    return out.value


def povray_find(program: str | None = None) -> str:
    """The program that would be run; raises POVRAY_MISSING saying what to do."""
    out = ctypes.c_char_p()
    check(library().lds_povray_find(text_in(program or None), out))
    return text_out(out.value)


def povray_false_color(kind: int, lod: int) -> tuple[float, float, float]:
    out = (ctypes.c_double * 3)()
    check(library().lds_povray_false_color(kind, lod, out))
    return (out[0], out[1], out[2])
