# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs that make something for a camera, and what they share: pictures or POV-Ray scenes."""

import argparse
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...exit_codes import ExitCode, Failed
from ...file_names import LONGEST, fitting
from ..file_jobs import FileJob, PictureRequest
from ..views_file import overrides_of, unseen_of
from .verb import Verb
from .verb_options import add_picture


class PictureVerb(Verb):
    """Asks for something to be made for each camera, and says by --out where it goes."""

    asks_for_pictures = True

    def add_options(self, parser: argparse.ArgumentParser) -> None:
        super().add_options(parser)
        add_picture(parser)

    def job(self, options: argparse.Namespace, file: Path) -> FileJob:
        return replace(
            super().job(options, file),
            pictures=self.requests(options, file),
            frames=options.frames,
        )

    def requests(self, options: argparse.Namespace, file: Path) -> tuple[PictureRequest, ...]:
        """The pictures of one of the files. Raises ValueError with a sentence."""
        if not options.out:
            raise ValueError("--out is missing: where should it go?")
        in_folder = len(options.files) > 1 or options.frames is not None
        return (self._request(options, self.output(options.out, file, in_folder)),)

    def output(self, out: str, file: Path, in_folder: bool) -> Path:
        """The path of the result. `in_folder`: several go into `out`. Raises ValueError."""
        raise NotImplementedError

    def _request(self, options: argparse.Namespace, out: Path) -> PictureRequest:
        return PictureRequest(
            out=str(out),
            camera=options.camera,
            pixel_error=options.pixel_error,
            antialias=options.antialias,
            overrides=overrides_of(vars(options)),
            budget=options.budget,
            **unseen_of(vars(options)),
            false_color=getattr(options, "false_color", False),
            covered_only=getattr(options, "covered_only", False),
            size=options.size,
        )

    def results(self, made: dict[str, Any]) -> list[str]:
        found = map(result_of, made.get("pictures", [made]))
        return [path for path in found if path]

    def lines(self, report: dict[str, Any]) -> list[str]:
        return self.results(report)

    def check_output(self, out: str) -> None:
        folder = self.folder_of(Path(out))
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Failed(ExitCode.FAILED, f"cannot make the folder of {out}: {error}")
        if not os.access(folder, os.W_OK | os.X_OK):
            raise Failed(ExitCode.FAILED, f"cannot write into {folder}")

    def folder_of(self, out: Path) -> Path:
        """The folder in which a result is written."""
        raise NotImplementedError


class PovrayVerb(PictureVerb):
    """Runs POV-Ray and writes PNG files."""

    runs_povray = True

    def output(self, out: str, file: Path, in_folder: bool) -> Path:
        path = Path(out).absolute()
        if in_folder:
            return path / (fitting(file.stem, LONGEST - 4) + ".png")
        if path.suffix.lower() != ".png":
            raise ValueError(f"--out {out}: the picture is a .png")
        return path

    def job(self, options: argparse.Namespace, file: Path) -> FileJob:
        return replace(super().job(options, file), program=options.povray, keep=options.keep)

    def folder_of(self, out: Path) -> Path:
        return out.parent

    def check_output(self, out: str) -> None:
        super().check_output(out)
        if Path(out).is_dir():
            raise Failed(ExitCode.FAILED, f"{out} is a folder, not a picture")


def result_of(made: dict[str, Any]) -> str:
    """The path of one picture or scene, by its part of a report."""
    return made.get("picture") or made.get("scene") or ""
