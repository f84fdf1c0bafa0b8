# SPDX-License-Identifier: GPL-3.0-or-later
"""The way from a built model and a camera to a picture: cut, export, POV-Ray. F12 and batch share
this."""

import contextlib
import itertools
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from .. import locked_folder, report_parts, stable_ids
from ..kind_words import DRAWN_KINDS
from ..native import lodestone_native as native
from ..problems import Problems
from ..store import store_path
from . import cost_model, quality_tree, slow_causes, unseen_detail

PICTURE = "picture.exr"
_PICTURE_NAME = re.compile(r"\bi/[0-9a-f]{16}\.\w+")
POVRAY_KINDS = sum(1 << kind for kind in DRAWN_KINDS)


@dataclass(frozen=True)
class Settings:
    """The settings of a picture; pixel_error 0 draws the originals. `overrides`: of the controls
    below it, as quality_tree.quality() takes them. `budget`: the bytes that POV-Ray's scene may
    take; 0: any number."""

    pixel_error: float = 1.0
    overrides: Mapping[str, quality_tree.Value] = field(default_factory=dict)
    budget: int = 0
    modifiers: native.Modifiers | None = None  # None: nothing bends quality
    false_color: bool = False
    covered_only: bool = False
    threads: int = 0
    program: str = ""  # POV-Ray; "": $LODESTONE_POVRAY, else the PATH
    filter_size: float = 0.0  # pixels; Blender's Filter Size. 0: each pixel is what it covers
    bakes: str = ""  # the folder that keeps what was found of the sky's light; "": the scene's
    still: bool = False  # a picture alone, in which what moves in an animation rests
    border: tuple[int, int, int, int] = (0, 0, 0, 0)  # left, top, width, height; width 0: all

    @property
    def levels(self) -> bool:
        """Whether anything but originals may be drawn."""
        return self.pixel_error > 0.0 or self.budget > 0

    def of_originals(self) -> "Settings":
        """The same picture by its originals alone."""
        modifiers = self.modifiers
        if modifiers is not None and modifiers.ray_classes:
            modifiers = replace(modifiers, ray_classes=0)
        return replace(self, pixel_error=0.0, budget=0, modifiers=modifiers)

    @property
    def quality(self) -> quality_tree.Quality:
        return quality_tree.quality(self.pixel_error, self.overrides)

    def povray(self) -> native.PovrayOptions:
        quality = self.quality
        return native.PovrayOptions(
            antialias=native.Antialias[quality.antialias],
            **quality.povray(),
            false_color=self.false_color,
            covered_only=self.covered_only,
            threads=self.threads,
            program=self.program,
            bake_folder=self.bakes or None,
            filter_size=self.filter_size,
            still=self.still,
        )

    def view(self, camera: native.Camera, size: tuple[int, int]) -> native.View:
        return native.View(
            camera, *size, self.pixel_error, POVRAY_KINDS, self.border, self.modifiers
        )

    def cut(
        self,
        model: native.Model,
        camera: native.Camera,
        size: tuple[int, int],
        job: native.Job | None = None,
    ) -> native.Cut:
        """The cut of a view, within the budget if there is one: its `pixel_error` may then be
        larger."""
        budget = native.Budget(bytes=self.budget) if self.budget else None
        cut = native.Cut(model, self.view(camera, size), job, budget)
        cut.view = replace(cut.view, pixel_error=cut.pixel_error)
        return cut

    def stamp(self) -> dict[str, str]:
        """The text in a picture's file about how it was made: the version, the Pixel Error, and a
        hash of all settings that show in the picture."""
        own = (*self.quality, self.budget, self.false_color, self.covered_only, self.filter_size)
        shown = (*own, self.still, *bent_by(self.modifiers))
        return {
            "Lodestone": native.version(),
            "Lodestone Pixel Error": f"{self.pixel_error:g}",
            "Lodestone Settings": stable_ids.stable_id(native.version(), *(str(v) for v in shown)),
        }


def bent_by(modifiers: native.Modifiers | None) -> tuple[str, ...]:
    """The texts of what bends quality, the same in every session: without the camera as the shutter
    closes, which belongs to a frame as its camera does."""
    if modifiers is None or modifiers == native.Modifiers(closing=modifiers.closing):
        return ()
    named = []
    for one in fields(modifiers):
        value = getattr(modifiers, one.name)
        if one.name == "lenses":
            value = [replace(lens, objects=tuple(o.index for o in lens.objects)) for lens in value]
        if one.name != "closing":
            named.append(f"{one.name} {value}")
    return tuple(named)


@dataclass
class Picture:
    """A finished picture. The EXR lies at `path`; `parts` are the report's."""

    path: Path
    parts: dict[str, Any] = field(default_factory=dict)
    in_use: dict[str, dict[int, int]] = field(default_factory=dict)  # uid: {LOD: occurrences}
    problems: Problems = field(default_factory=Problems)  # the model's, and what made it slow
    remedies: dict[str, slow_causes.Remedy] = field(default_factory=dict)  # by code of a problem


def cut_and_export(
    model: native.Model,
    camera: native.Camera,
    size: tuple[int, int],
    settings: Settings,
    folder: Path,
    job: native.Job,
) -> tuple[dict[str, Any], dict[str, dict[int, int]]]:
    """Writes the scene for one view into folder (made when missing); returns the report's parts
    and how often which level is in use."""
    parts, in_use, *_ = _cut_and_export(model, camera, size, settings, folder, job)
    return parts, in_use


def _cut_and_export(
    model: native.Model,
    camera: native.Camera,
    size: tuple[int, int],
    settings: Settings,
    folder: Path,
    job: native.Job,
) -> tuple[dict[str, Any], dict[str, dict[int, int]], cost_model.Work, quality_tree.Quality]:
    folder.mkdir(parents=True, exist_ok=True)
    with settings.cut(model, camera, size, job) as cut:
        view, summary = cut.view, cut.summary()
        parts = {"cut": report_parts.cut_part(summary)}
        met = unseen_detail.met(cut)
        if met is not None:
            parts["cut"]["rays"] = unseen_detail.part(met)
        if settings.budget:
            parts["cut"].update(pixel_error=cut.pixel_error, fits=cut.fits)
        in_use = levels_in_use(model, cut)
        shaded = replace(settings, pixel_error=cut.pixel_error)  # as roughly as it is drawn
        exported = native.povray_export(cut, str(folder), shaded.povray(), job)
    parts["export"] = report_parts.export_part(exported)
    quality = shaded.quality
    antialias = native.Antialias[quality.antialias]
    work = cost_model.Work.of(summary, view, exported, antialias, settings.threads, quality)
    return parts, in_use, work, quality


def levels_in_use(model: native.Model, cut: native.Cut) -> dict[str, dict[int, int]]:
    """The levels that a cut draws, by uid of the object: how many occurrences draw which LOD
    number."""
    found: dict[str, dict[int, int]] = {}
    for (item, lod), number in cut.counts().items():
        found.setdefault(model.object_summary(item).uid, {})[lod] = number
    return found


def make_picture(
    model: native.Model,
    camera: native.Camera,
    size: tuple[int, int],
    settings: Settings,
    folder: Path,
    new_job: Callable[[str], native.Job],
    costs: cost_model.StoreCosts | None = None,
    live: native.LivePicture | None = None,
    chosen: Callable[[int], None] = lambda triangles: None,
) -> Picture:
    """Cuts, exports into folder and renders folder/picture.exr. `new_job(stage)` is called before
    each long call and gives its Job. Raises LodestoneError; then no new picture is there.
    `costs`: what it takes is predicted from, and remembered with, the last picture of the camera.
    `live`: what is drawn into meanwhile. `chosen` is told how many triangles are drawn."""
    exported = _cut_and_export(model, camera, size, settings, folder, new_job("Export"))
    parts, in_use, work, quality = exported
    ratios = cost_model.Ratios() if costs is None else costs.read(camera.name)
    predicted = cost_model.predict(work, ratios)
    chosen(parts["cut"]["triangles"])
    wanted, job = (str(folder), PICTURE, settings.povray()), new_job("Trace")
    if live is None:
        ran = native.povray_run(*wanted, job)
    else:
        ran = native.povray_run_live(*wanted, live, job)
    problems = Problems()
    problems.extend_native(model.problems())
    made = Picture(folder / PICTURE, parts, in_use, problems)
    if not (settings.false_color or settings.covered_only):
        if costs is not None:
            costs.write(camera.name, cost_model.learn(work, ran, ratios))
        for cause in slow_causes.found(work, quality, ran.parse_cpu_s + ran.trace_cpu_s):
            problems.extend([cause.problem])
            if cause.remedy is not None:
                made.remedies[cause.problem.code] = cause.remedy
    parts["povray"] = report_parts.povray_part(ran)
    parts["predicted"] = predicted.part()
    parts["pixel_error"] = settings.pixel_error
    return made


def make_identities(
    model: native.Model,
    camera: native.Camera,
    size: tuple[int, int],
    settings: Settings,
    folder: Path,
    new_job: Callable[[str], native.Job],
) -> tuple[Path, list[str]]:
    """A picture of which choice each pixel shows, for native.image_compare_shown(), and the
    choices' paths. Sharp, without antialiasing and Environment."""
    folder.mkdir(parents=True, exist_ok=True)
    overrides: dict[str, quality_tree.Value] = dict(settings.overrides)
    overrides["antialias"] = quality_tree.OFF
    plain = replace(settings, overrides=overrides, false_color=True, covered_only=True)
    sharp = replace(camera, aperture=0.0)
    job = new_job("Coverage")
    with settings.cut(model, camera, size, job) as cut:
        cut.set_identities()
        paths = [cut.choice_path(position) for position in range(len(cut.choices()))]
        view = replace(cut.view, camera=sharp)
        native.povray_export(cut, str(folder), plain.povray(), job, view)
    native.povray_run(str(folder), PICTURE, plain.povray(), new_job("Coverage"))
    return folder / PICTURE, paths


def used_files(folder: Path) -> set[str]:
    """The representations that the scene in a folder includes, what is kept beside them, and all
    pictures that are shown: r/..., i/..."""
    found = set()
    with open(folder / "scene.pov", encoding="utf-8", errors="replace") as lines:
        for line in lines:
            if line.startswith('#include "r/'):
                found.add(line[len('#include "') :].rstrip().rstrip('"'))
            elif line.startswith("// r/"):  # what is kept beside them for the next time
                found.add(line[len("// ") :].rstrip())
            found.update(_PICTURE_NAME.findall(line))
    for name in [name for name in found if name.startswith("r/")]:
        with contextlib.suppress(OSError):
            found |= _pictures_of(folder / name)
    return found


def _pictures_of(representation: Path) -> set[str]:
    """The pictures that a representation lists in its first lines."""
    with open(representation, encoding="utf-8", errors="replace") as lines:
        listed = itertools.takewhile(lambda line: line.startswith("// "), lines)
        return {name for line in listed for name in _PICTURE_NAME.findall(line)}


def remove_others(folder: Path, used: set[str]) -> None:
    """Removes the representations and pictures that no scene of the frame used: what deforms is
    written anew in every frame, and a long animation must not fill the disk."""
    for path in [*(folder / "r").glob("*.*"), *(folder / "i").glob("*.*")]:
        if f"{path.parent.name}/{path.name}" not in used:
            path.unlink(missing_ok=True)


class SceneFolder:
    """The folder of scene files: `keep` is NEVER, FAILED or ALWAYS. A context; `path` names it.
    Files that are not kept are removed on leaving; those of a failed picture stay for the user to
    look at."""

    def __init__(self, kept: Path, keep: str) -> None:
        self._keep = keep
        self._kept = kept
        self.path = kept
        self.stays = keep == "ALWAYS"
        self._locked: locked_folder.LockedFolder | None = None
        self._hold: locked_folder.Hold | None = None

    def __enter__(self) -> "SceneFolder":
        parent, name = self._kept.parent, self._kept.name
        parent.mkdir(parents=True, exist_ok=True)
        for place in {parent, store_path.cache_folder()}:  # of killed runs, whatever they rendered
            locked_folder.settle_all(place, store_path.SCENE_ENDING)
        if self._keep == "ALWAYS":
            self._kept.mkdir(exist_ok=True)
            self._hold = locked_folder.Hold(self._kept)
        else:
            locked_folder.settle(parent, name)  # long names have another ending
            self._locked = locked_folder.LockedFolder(parent, name)
            self.path = self._locked.path
        return self

    def __exit__(self, kind: type[BaseException] | None, error: object, trace: object) -> None:
        failed = kind is not None and not getattr(error, "cancelled", False)
        self.stays = self._keep == "ALWAYS" or (self._keep == "FAILED" and failed)
        if self._hold is not None:
            self._hold.release()
        elif self._locked is not None and self.stays:
            self._locked.keep()
        elif self._locked is not None:
            self._locked.remove()
