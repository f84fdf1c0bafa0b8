# SPDX-License-Identifier: GPL-3.0-or-later
"""batch.py compare: pictures by the originals and by levels, and how much they differ."""

import argparse
from collections.abc import Sequence

from ...exit_codes import ExitCode, Failed
from ..file_jobs import PictureRequest
from .picture_verb import PovrayVerb
from .verb_options import add_povray

NO_LEVELS = (
    "Pixel Error 0 renders the originals: there is nothing to compare; give another --pixel-error"
)


class Compare(PovrayVerb):
    name = "compare"
    help = "render originals and levels, and tell how they differ"

    def add_options(self, parser: argparse.ArgumentParser) -> None:
        super().add_options(parser)
        add_povray(parser)

    def check_requests(self, requests: Sequence[PictureRequest]) -> None:
        if not all(request.levels for request in requests):
            raise Failed(ExitCode.FAILED, NO_LEVELS)
