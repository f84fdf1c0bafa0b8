# SPDX-License-Identifier: GPL-3.0-or-later
"""A verb of batch.py: its options, the job it makes of a file, and its part of the run.

The methods down to lines() are called outside Blender, those after it inside.
"""

import argparse
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, ClassVar, Protocol, TypeVar

from ... import run_report
from ...file_names import folder_name
from ...picture.compare_pictures import Compared
from ...picture.cost_model import StoreCosts
from ...picture.picture_maker import Picture, SceneFolder, Settings
from ...problems import Problems
from ..file_jobs import FileJob, PictureRequest
from .verb_options import add_common

Result = TypeVar("Result")


class PictureWork(Protocol):
    """One picture of a scene that Blender has read, with the steps of making it that need
    Blender."""

    job: FileJob
    request: PictureRequest
    model: Any
    camera: Any
    size: tuple[int, int]
    settings: Settings
    costs: StoreCosts
    problems: Problems

    def new_job(self, stage: str) -> Any:
        """A job of the library, whose progress is told under the name of a stage."""

    def long(self, function: Callable[[], Result]) -> Result:
        """The function's result; progress is told meanwhile, and the run can be stopped."""

    def scene_folder(self) -> AbstractContextManager[SceneFolder]:
        """The folder for POV-Ray's files of this picture."""

    def save(self, made: Picture) -> None:
        """Writes the picture as F12 would save it."""

    def save_compared(self, made: Compared) -> dict[str, str]:
        """Writes the difference, and the two pictures beside it; returns the paths of these."""

    def save_thumbnail(self) -> None:
        """Writes a small copy of the saved picture, when one is asked for."""


class Verb:
    """A verb that makes no pictures; picture_verb.py has the base of those that do."""

    name: ClassVar[str]
    help: ClassVar[str]
    asks_for_pictures: ClassVar[bool] = False
    runs_povray: ClassVar[bool] = False

    def add_options(self, parser: argparse.ArgumentParser) -> None:
        """Declares the options of this verb."""
        add_common(parser)

    def job(self, options: argparse.Namespace, file: Path) -> FileJob:
        """The job for one of the files. Raises ValueError with a sentence."""
        several = len(options.files) > 1
        store = options.store or ""
        if store and several:
            store = str(Path(store) / folder_name(file))
        return FileJob(
            verb=self.name,
            file=str(file.absolute()),
            store=str(Path(store).absolute()) if store else "",
            report="",
            pictures=(),
            threads=options.threads,
            strict=options.strict,
            trust_scripts=options.trust_scripts,
        )

    def results(self, made: dict[str, Any]) -> list[str]:
        """The paths of what a report says was made."""
        raise NotImplementedError

    def lines(self, report: dict[str, Any]) -> list[str]:
        """What is printed of a finished file, by its report."""
        return []

    def check_output(self, out: str) -> None:
        """Makes the folder of a result. Raises Failed when it cannot be written there."""

    def check_requests(self, requests: Sequence[PictureRequest]) -> None:
        """Raises Failed when pictures are asked for that this verb cannot make."""

    def builds_levels(self, requests: Sequence[PictureRequest]) -> bool:
        """Whether missing and changed levels are built before the pictures; only then the scene is
        read with automatic groups."""
        return any(request.levels for request in requests)

    def about(self, model: Any, job: FileJob) -> dict[str, Any]:
        """What it tells of a scene that was read for a job, before anything is made: parts of the
        report."""
        return {"model": run_report.model_part(model.totals())}

    def make(self, work: PictureWork) -> dict[str, Any]:
        """Makes one picture or scene of those that were asked for; returns its part of the
        report."""
        raise NotImplementedError
