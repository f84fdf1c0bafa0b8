# SPDX-License-Identifier: GPL-3.0-or-later
"""How a verb of batch.py makes one picture or scene, inside Blender; what is asked for is in
verbs/."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Protocol, TypeVar

from ..exit_codes import ExitCode, Failed
from ..native import lodestone_native as native
from ..picture.compare_pictures import Compared, compare
from ..picture.cost_model import StoreCosts
from ..picture.picture_maker import (
    Picture,
    SceneFolder,
    Settings,
    cut_and_export,
    make_picture,
)
from ..problems import Problems
from .file_jobs import FileJob, PictureRequest

Result = TypeVar("Result")
Made = TypeVar("Made", Picture, Compared)


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


def _export(work: PictureWork) -> dict[str, Any]:
    folder = Path(work.request.out)
    parts, _ = work.long(
        lambda: cut_and_export(
            work.model, work.camera, work.size, work.settings, folder, work.new_job("Export")
        )
    )
    return {**parts, "scene": str(folder / "scene.pov")}


def _render(work: PictureWork) -> dict[str, Any]:
    return _drawn(work, make_picture, work.save)


def _compare(work: PictureWork) -> dict[str, Any]:
    return _drawn(work, compare, work.save_compared)


def _drawn(
    work: PictureWork, draw: Callable[..., Made], save: Callable[[Made], dict[str, str] | None]
) -> dict[str, Any]:
    """Runs POV-Ray, on a thread of its own, and saves what `draw` made; what `save` returns, if
    anything, is told beside the picture."""
    with work.scene_folder() as folder:
        try:
            made = work.long(
                lambda: draw(
                    work.model, work.camera, work.size, work.settings, folder.path, work.new_job,
                    work.costs,
                )
            )  # fmt: skip
        except native.LodestoneError as error:
            if error.status == native.Status.POVRAY_FAILED:
                where = f" (its files: {folder.path})" if work.job.keep != "never" else ""
                raise Failed(ExitCode.POVRAY, f"{error}{where}") from error
            raise
        saved = save(made) or {}
    work.save_thumbnail()
    return {**saved, **made.parts, "picture": work.request.out}


# By the names of verbs: what makes a picture or scene of theirs and returns its part of the report.
# They raise Failed.
MAKERS: dict[str, Callable[[PictureWork], dict[str, Any]]] = {
    "render": _render,
    "export": _export,
    "compare": _compare,
}
