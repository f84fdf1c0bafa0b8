# SPDX-License-Identifier: GPL-3.0-or-later
"""batch.py render: a picture of each frame and camera, as F12 would save it."""

import argparse
from dataclasses import replace
from pathlib import Path

from ...file_names import folder_name
from ..file_jobs import FileJob, PictureRequest
from ..views_file import read_views
from .picture_verb import PovrayVerb
from .verb_options import add_content, add_povray, add_render


class Render(PovrayVerb):
    name = "render"
    help = "render pictures with POV-Ray"

    def add_options(self, parser: argparse.ArgumentParser) -> None:
        super().add_options(parser)
        add_content(parser)
        add_povray(parser)
        add_render(parser)

    def job(self, options: argparse.Namespace, file: Path) -> FileJob:
        return replace(super().job(options, file), keep_exr=options.keep_exr)

    def requests(self, options: argparse.Namespace, file: Path) -> tuple[PictureRequest, ...]:
        if not options.views:
            return super().requests(options, file)
        if options.frames:
            raise ValueError("--views goes without --frames")
        pictures = read_views(options.views, options)
        return pictures if len(options.files) == 1 else _in_folders(pictures, options.out, file)


def _in_folders(
    pictures: tuple[PictureRequest, ...], out: str | None, file: Path
) -> tuple[PictureRequest, ...]:
    """The views of one of several files: their names, in a folder of the file's."""
    if not out:
        raise ValueError("--views of several files needs --out, a folder: theirs go into it")
    folder = Path(out).absolute() / folder_name(file)
    moved = tuple(replace(p, out=str(folder / Path(p.out).name)) for p in pictures)
    if len({picture.out for picture in moved}) < len(moved):
        raise ValueError("--views: two pictures have the same name, so they need one file each")
    return moved
