# SPDX-License-Identifier: GPL-3.0-or-later
"""batch.py build: missing and changed levels of a file, and nothing else."""

import os
from collections.abc import Sequence
from typing import Any

from ...store.store_path import INDEX
from ..file_jobs import PictureRequest
from .verb import Verb


class Build(Verb):
    name = "build"
    help = "build missing and changed levels into the store"

    def results(self, made: dict[str, Any]) -> list[str]:
        return [os.path.join(made["store"], INDEX)] if "store" in made else []

    def builds_levels(self, requests: Sequence[PictureRequest]) -> bool:
        return True
