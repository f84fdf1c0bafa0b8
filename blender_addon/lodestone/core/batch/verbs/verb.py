# SPDX-License-Identifier: GPL-3.0-or-later
"""A verb of batch.py: its options, the job it makes of a file, and what of it is checked and told.

How it makes its pictures, inside Blender, is in ../picture_making.py.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

from ...file_names import folder_name
from ..file_jobs import FileJob, PictureRequest
from .verb_options import add_common


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
