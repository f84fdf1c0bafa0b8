# SPDX-License-Identifier: GPL-3.0-or-later
"""The time and the memory that a picture will take, told before it is rendered and corrected by the
one before.

POV-Ray reads the texts and pictures that an export wrote, and keeps them: both take as long and as
much as they are large. A sample takes longer with the root of the texts and with each shadow ray;
those to lamps are many near each other, and cost more than those to suns.
Measured on one machine, in tracks of SuperTuxKart and generated nights; cost.json beside the levels
keeps by how much the last picture of each camera differed. Not known before is how often rays go on
through masks that are not cut out: where dead trees fill the picture it takes three times as long.
Bounces gather light by rays at places as dense as their error asks for, and again from what these
meet.
"""

import json
import math
import os
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from ..native import lodestone_native as native
from .quality_tree import Quality

FILE = "cost.json"
_MODEL = 4  # ratios to what another model foretold say nothing
# To read a byte of text and a texel; what they take in memory
_TEXT_S, _TEXEL_S = 5.9e-8, 2.5e-8
_TEXT_BYTES, _TEXEL_BYTES = 3.85, 2.57
# A sample takes this, times the root of the texts in bytes, of which the first make no difference
_SAMPLE_S, _FEWEST_TEXT = 3.08e-9, 5.4e5
_SHADOW_SHARE, _LAMP_SHARE = 0.13, 0.41  # a shadow ray to a sun and to a lamp, beside a sample
_SKY_SHARE = 0.1  # a sample that meets nothing beside one that does
_OBJECT_BYTES = 760  # of an object, besides what its line in scene.pov counts as
_GATHERED = 0.125  # places a pixel where light is gathered, at an error of 1
# The share of pixels that get n x n more samples, times the difference from which on they do: in
# the pictures of 14 views of scenes and nights 0.44, 0.15 and 0.055 for 0.1, 0.3 and 0.6
_MORE_SAMPLES = 0.044
_BLURRED: dict[
    int, float
] = {  # with depth of field, instead of these; measured, on a sharp floor and soft heads
    native.Antialias.OFF: 8.75,
    native.Antialias.FINAL: 56.0,
    native.Antialias.REFERENCE: 191.0,
}
_START_S = 0.7  # seconds by the clock, whatever is rendered
_EMPTY_BYTES, _PIXEL_BYTES = 18e6, 16
_LEAST_S = 0.05  # shorter times tell nothing
_MOST = 100.0  # a picture whose ratio is larger was disturbed
_MOST_BYTES = 65536
_MOST_CAMERAS = 64  # that are remembered


@dataclass(frozen=True)
class Prediction:
    parse_cpu_s: float
    trace_cpu_s: float
    wall_s: float
    peak_bytes: int

    def part(self) -> dict[str, Any]:
        """The report's part."""
        return asdict(self)


@dataclass(frozen=True)
class Ratios:
    """The ratios of what was measured to what was predicted for the last picture of a kind; 1
    before there is one."""

    parse: float = 1.0
    trace: float = 1.0
    memory: float = 1.0
    trace_exact: float = 1.0  # where everything is drawn as it is: rays look for holes in masks

    def of_trace(self, work: "Work") -> float:
        return self.trace_exact if work.exact else self.trace


@dataclass(frozen=True)
class Work:
    """The work of a picture; `pixels` are those drawn."""

    text_bytes: int  # of meshes and scene.pov
    texels: int  # of all pictures
    pixels: int
    width: int
    height: int
    shadow_rays: float  # from a point of the picture
    antialias: int
    threads: int
    gathering: float = 0.0  # rays a pixel that gather light for Bounces
    blurred: bool = False  # has depth of field
    depth: int = 3  # samples along the side of a pixel that gets more of them
    exact: bool = False  # everything is drawn as it is, masks too
    threshold: float = 0.1  # the difference of pixels from which on they get more samples
    lamp_rays: float = 0.0  # those of shadow_rays that go to lamps
    sky_lights: int = 0  # those to the world's image, one a light
    soft_lamps: int = 0
    covered: float = 1.0  # the share of the picture where anything is seen
    objects: int = 0

    @property
    def bytes(self) -> float:
        """What POV-Ray keeps of it."""
        files = _TEXT_BYTES * self.text_bytes + _TEXEL_BYTES * self.texels
        return files + _OBJECT_BYTES * self.objects

    @property
    def samples(self) -> float:
        """Samples of a pixel in the mean."""
        if self.blurred:
            return _BLURRED[self.antialias]
        if self.antialias == native.Antialias.OFF:
            return 1.0
        if self.antialias == native.Antialias.REFERENCE:
            return 17.0
        return 1.0 + min(1.0, _MORE_SAMPLES / max(self.threshold, 1e-3)) * self.depth**2

    @classmethod
    def of(
        cls,
        summary: native.records.CutSummary,
        view: native.View,
        exported: native.records.ExportReport,
        antialias: int,
        threads: int,
        quality: Quality,
    ) -> "Work":
        """The work of a view that was exported. `quality`: what shades it."""
        width, height = view.border[2:] if view.border[2] else (view.width, view.height)
        threads = threads or len(os.sched_getaffinity(0))
        whole = (view.width, view.height)
        sums = (exported.text_bytes, exported.texels, width * height)
        rays = gathering(quality.bounces, quality.bounce_rays, quality.bounce_error)
        blurred = view.camera.aperture > 0.0 and not view.camera.orthographic
        return cls(
            *sums, *whole, exported.shadow_rays, antialias, threads, rays, blurred,
            quality.antialias_depth, quality.pixel_error <= 0.0, quality.antialias_threshold,
            exported.lamp_rays, exported.sky_lights, exported.soft_lamps,
            1.0 if view.border[2] else exported.covered,  # that of the whole picture
            max(0, summary.occurrences - exported.left_out),
        )  # fmt: skip


def gathering(bounces: int, rays: int, error: float) -> float:
    """Rays a pixel: what each bounce adds; places are denser with the square of the error."""
    return _GATHERED / error**2 * rays * bounces


def predict(work: Work, ratios: Ratios = Ratios()) -> Prediction:
    parse = (_TEXT_S * work.text_bytes + _TEXEL_S * work.texels) * ratios.parse
    each = _SAMPLE_S * math.sqrt(_FEWEST_TEXT + work.text_bytes)
    others = max(0.0, work.shadow_rays - work.lamp_rays)
    each *= 1.0 + _SHADOW_SHARE * others + _LAMP_SHARE * work.lamp_rays
    seen = work.covered + _SKY_SHARE * (1.0 - work.covered)
    drawn = seen * work.pixels * (work.samples + work.gathering)
    trace = drawn * each * ratios.of_trace(work)
    wall = _START_S + parse + trace / max(1, work.threads)
    kept = _PIXEL_BYTES * work.width * work.height
    peak = _EMPTY_BYTES + kept + work.bytes * ratios.memory
    return Prediction(parse, trace, wall, int(peak))


def learn(work: Work, measured: native.records.PovrayReport, before: Ratios) -> Ratios:
    """The ratios that a finished picture teaches; `measured` has parse_cpu_s, trace_cpu_s and
    peak_bytes."""
    plain = predict(work)
    empty = predict(Work(0, 0, 0, work.width, work.height, 0, work.antialias, 1)).peak_bytes

    def ratio(found: float, expected: float, least: float, old: float) -> float:
        told = found > 0.0 and math.isfinite(found) and max(found, expected) >= least
        if not told or not expected > 0.0:
            return old
        return min(_MOST, max(1.0 / _MOST, found / expected))

    traced = ratio(measured.trace_cpu_s, plain.trace_cpu_s, _LEAST_S, before.of_trace(work))
    return replace(
        before,
        parse=ratio(measured.parse_cpu_s, plain.parse_cpu_s, _LEAST_S, before.parse),
        memory=ratio(measured.peak_bytes - empty, work.bytes, 1e7, before.memory),
        **{"trace_exact" if work.exact else "trace": traced},
    )


Costs = dict[str, Ratios]  # of the last picture by each camera, and of the last one under ""


class CostMemory:
    """The ratios of times and bytes measured to those foretold, for each folder of levels: what
    this process knows, and what the folders hold."""

    def __init__(self) -> None:
        self._last: dict[str, Costs] = {}  # by folder

    def of(self, store: Path) -> "StoreCosts":
        """The costs of pictures by the levels in a folder."""
        return StoreCosts(self._last, store)


class StoreCosts:
    """The costs of pictures by the levels in one folder."""

    def __init__(self, last: dict[str, Costs], store: Path) -> None:
        self._last, self._store = last, store

    def read(self, camera: str) -> Ratios:
        """The ratios of the last picture by a camera, else of the last picture; a file that is
        unreadable counts as none."""
        known = self._known()
        return known[camera] if camera in known else known.get("", Ratios())

    def write(self, camera: str, ratios: Ratios) -> None:
        """Keeps the ratios for the next picture. A folder that is not there or cannot be written to
        is no problem: then only this process knows."""
        known = self._known()
        for name in ("", camera):
            known.pop(name, None)  # the last one goes to the end
            known[name] = ratios
        while len(known) > _MOST_CAMERAS:
            del known[next(iter(known))]
        cameras = {name: asdict(one) for name, one in known.items() if name}
        text = json.dumps({"model": _MODEL, **asdict(ratios), "cameras": cameras})
        temporary = self._store / f".cost-{os.getpid()}.json"
        try:
            temporary.write_text(text, "utf-8")
            os.replace(temporary, self._store / FILE)
        except OSError:
            try:
                temporary.unlink(missing_ok=True)
            except OSError:
                pass

    def _known(self) -> Costs:
        key = str(self._store)
        if key not in self._last:
            self._last[key] = _from_file(self._store / FILE)
        return self._last[key]


def _from_file(path: Path) -> Costs:
    try:
        if path.stat().st_size > _MOST_BYTES:
            return {}
        value = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return {}
    if not isinstance(value, dict) or value.get("model") != _MODEL:
        return {}
    cameras = value.get("cameras")
    found = {"": _ratios(value)}
    for name, one in cameras.items() if isinstance(cameras, dict) else ():
        if isinstance(one, dict):
            found[name] = _ratios(one)
    return found


def _ratios(value: dict[str, Any]) -> Ratios:
    found = {}
    for field in fields(Ratios):
        ratio = value.get(field.name)
        if isinstance(ratio, (int, float)) and 1.0 / _MOST <= ratio <= _MOST:
            found[field.name] = float(ratio)
    return Ratios(**found)
