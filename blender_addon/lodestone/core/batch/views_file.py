# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of --views: many pictures from one reading of one .blend."""

import argparse
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..picture import quality_tree
from . import option_values
from .file_jobs import PictureRequest

ANTIALIAS = ("automatic", "off", "final", "reference")
NUMBERS = tuple(control for control in quality_tree.CONTROLS if control.least is not None)
VIEW_KEYS = (
    "camera",
    "pixel_error",
    "antialias",
    *(control.key for control in NUMBERS),
    "budget",
    "off_screen",
    "ray_classes",
    "out",
    "false_color",
    "covered_only",
    "size",
)


def read_views(path: str, options: argparse.Namespace) -> tuple[PictureRequest, ...]:
    """The pictures of a views file; what an entry leaves out comes from the command line. Raises
    ValueError with a sentence."""
    try:
        entries = json.loads(Path(path).read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"--views {path}: {error}") from None
    if not isinstance(entries, list) or not entries:
        raise ValueError(f"--views {path}: a list of pictures is expected")
    pictures = [_view(path, number, entry, options) for number, entry in enumerate(entries)]
    if len({picture.out for picture in pictures}) < len(pictures):
        raise ValueError(f"--views {path}: two pictures have the same out")
    return tuple(pictures)


def _view(path: str, number: int, entry: Any, options: argparse.Namespace) -> PictureRequest:
    where = f"--views {path}: entry {number}"
    if not isinstance(entry, dict):
        raise ValueError(f"{where} is not an object")
    unknown = sorted(set(entry) - set(VIEW_KEYS))
    if unknown:
        raise ValueError(f"{where} has an unknown {unknown[0]} (known: {', '.join(VIEW_KEYS)})")
    out = entry.get("out")
    if not isinstance(out, str) or not out.lower().endswith(".png"):
        raise ValueError(f"{where}: out must name a .png")
    camera = entry.get("camera") or options.camera
    if not _possible(out) or not isinstance(camera, str) or not _possible(camera):
        raise ValueError(f"{where}: out and camera must be text that can be a name")
    antialias = entry.get("antialias", options.antialias)
    if antialias is not None and antialias not in ANTIALIAS:
        raise ValueError(f"{where}: antialias is one of {', '.join(ANTIALIAS)}")
    try:
        wanted = entry.get("size")
        chosen = options.size if wanted is None else option_values.size(size_text(wanted))
        error = entry.get("pixel_error", options.pixel_error)
        return PictureRequest(
            out=str(Path(out).absolute()),
            camera=camera,
            pixel_error=None if error is None else option_values.pixels(str(error)),
            antialias=antialias,
            overrides=overrides_of({**vars(options), **entry}),
            budget=budget_of({**vars(options), **entry}),
            **unseen_of({**vars(options), **entry}),
            false_color=bool(entry.get("false_color", options.false_color)),
            covered_only=bool(entry.get("covered_only", options.covered_only)),
            size=chosen,
        )
    except argparse.ArgumentTypeError as error:
        raise ValueError(f"{where}: {error}") from None


def overrides_of(values: Mapping[str, Any]) -> dict[str, float]:
    """The controls that are said, by key. Raises argparse.ArgumentTypeError."""
    said = ((control, values.get(control.key)) for control in NUMBERS)
    return {c.key: option_values.control(c)(str(v)) for c, v in said if v is not None}


def budget_of(values: Mapping[str, Any]) -> int | None:
    """The budget in bytes. Raises argparse.ArgumentTypeError."""
    said = values.get("budget")
    return None if said is None else option_values.memory(str(said))


def unseen_of(values: Mapping[str, Any]) -> dict[str, str | None]:
    """The detail that is asked for of what is not seen directly. Raises
    argparse.ArgumentTypeError."""
    said = ((key, values.get(key)) for key in ("off_screen", "ray_classes"))
    return {k: None if v is None else getattr(option_values, k)(str(v)) for k, v in said}


def _possible(name: str) -> bool:
    """JSON can say more than any file or thing can be called."""
    try:
        return b"\0" not in os.fsencode(name)
    except UnicodeEncodeError:
        return False


def size_text(value: Any) -> str:
    """The text of a size, [640, 360] or "640x360", as the command line has it."""
    return "x".join(str(v) for v in value) if isinstance(value, list) else str(value)
