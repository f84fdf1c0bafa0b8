# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of a batch job, with those steps of making it that need Blender."""

import contextlib
import os
from pathlib import Path

import bpy

from ..core import file_names
from ..core.background_calls import Work
from ..core.batch.file_jobs import FileJob, PictureRequest
from ..core.picture.compare_pictures import Compared
from ..core.picture.cost_model import CostMemory
from ..core.picture.picture_maker import Picture, SceneFolder, Settings
from ..core.problems import Problems
from ..core.store import store_path
from . import picture_files


class SceneFolders:
    """The folders for POV-Ray's files of one job. One folder serves all pictures, so that what did
    not change is not written again; scenes that are to be looked at afterwards have one each."""

    def __init__(self, job: FileJob) -> None:
        self._job = job
        self._held = contextlib.ExitStack()
        self.shared: SceneFolder | None = None

    def __enter__(self) -> "SceneFolders":
        return self

    def __exit__(self, *error):
        return self._held.__exit__(*error)

    def folder(self, store: Path, out: str):
        """A context that gives the SceneFolder of the picture that goes to `out`."""
        kept, keep = store_path.scene_folder(store), self._job.keep.upper()
        if keep == "ALWAYS" and self._job.many_pictures:
            return SceneFolder(kept / file_names.folder_name(out), keep)
        if self.shared is None:
            self.shared = self._held.enter_context(SceneFolder(kept, keep))
        return contextlib.nullcontext(self.shared)


class BlenderPictureWork:
    """As core/batch/picture_making.py's PictureWork."""

    def __init__(
        self, job: FileJob, request: PictureRequest, scene, model, camera, size, modifiers,
        store: Path, costs: CostMemory, folders: SceneFolders, work: Work, say,
    ) -> None:  # fmt: skip
        self.job, self.request = job, request
        self.model, self.camera, self.size = model, camera, size
        self.store, self.costs = store, costs.of(store)
        self.settings = Settings(
            pixel_error=request.pixel_error,
            overrides=request.overrides,
            budget=request.budget,
            modifiers=modifiers,
            false_color=request.false_color,
            covered_only=request.covered_only,
            threads=job.threads,
            program=job.program,
            filter_size=scene.render.filter_size,
            bakes=str(store),
            still=not job.frames,
        )
        self.new_job = work.new_job
        self.problems = Problems()
        self._scene: bpy.types.Scene = scene
        self._folders, self._work, self._say = folders, work, say

    @property
    def about(self) -> dict:
        """The report's part that is the same for every verb."""
        return {
            "camera": self.camera.name,
            "antialias": self.settings.quality.antialias.lower(),
            "size": list(self.size),
            "pixel_error": self.request.pixel_error,
        }

    def long(self, function):
        return self._work.run(function, self._say)

    def scene_folder(self):
        return self._folders.folder(self.store, self.request.out)

    def save(self, made: Picture) -> None:
        self.problems.extend(made.problems)
        out, with_alpha = Path(self.request.out), self.request.covered_only
        picture_files.save(self._scene, made.path, out, with_alpha, self.settings.stamp())
        if self.job.keep_exr:
            picture_files.copy_exr(made.path, out.with_suffix(".exr"))

    def save_compared(self, made: Compared) -> dict[str, str]:
        self.problems.extend(made.pictures[-1].problems)
        return picture_files.save_compared(self._scene, made, Path(self.request.out), self.settings)

    def save_thumbnail(self) -> None:
        if self.job.thumbnail and not os.path.exists(self.job.thumbnail):
            picture_files.save_thumbnail(self.request.out, self.job.thumbnail)
