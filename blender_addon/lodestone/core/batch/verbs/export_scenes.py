# SPDX-License-Identifier: GPL-3.0-or-later
"""batch.py export: a folder with the POV-Ray scene of each frame and camera."""

import argparse
from pathlib import Path

from ...file_names import folder_name
from .picture_verb import PictureVerb
from .verb_options import add_content


class Export(PictureVerb):
    name = "export"
    help = "write POV-Ray scenes"

    def add_options(self, parser: argparse.ArgumentParser) -> None:
        super().add_options(parser)
        add_content(parser)

    def output(self, out: str, file: Path, in_folder: bool) -> Path:
        path = Path(out).absolute()
        return path / folder_name(file) if in_folder else path

    def folder_of(self, out: Path) -> Path:
        return out
