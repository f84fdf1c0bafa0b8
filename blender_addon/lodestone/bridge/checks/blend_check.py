# SPDX-License-Identifier: GPL-3.0-or-later
"""The check of an opened file for what it lost on the way in: libraries, data of a newer Blender,
drivers not run."""

import os
from collections.abc import Iterator
from typing import Any

import bpy

from ...core.problems import ERROR, Problems
from ..datablock_ids import name_of
from . import picture_requirements


def check_file(problems: Problems, scripts_ran: bool) -> None:
    """Names each loss once; `scripts_ran`: the file was opened with its scripts allowed."""
    for library in bpy.data.libraries:
        path = bpy.path.abspath(library.filepath, library=library.library)
        if not os.path.exists(path):
            text = f'Library "{name_of(library)}" is missing ({path}): what it holds is left out'
            problems.add(name_of(library), ERROR, "library_missing", text)
    written = tuple(bpy.data.version[:2])
    if written > tuple(bpy.app.version[:2]):
        text = (
            f"The file is from Blender {written[0]}.{written[1]}, and this is "
            f"{bpy.app.version_string}: what only the newer one knows is left out"
        )
        problems.add("", ERROR, "newer_blender", text)
    if not scripts_ran:
        for owner in sorted({name_of(owner) for owner in _owners_of_scripts()}):
            text = (
                f'A driver of "{owner}" is Python and was not run: what it drives stays as it was '
                "saved (--trust-scripts runs it)"
            )
            problems.add(owner, ERROR, "driver_not_run", text)


def repair_names(problems: Problems) -> None:
    """Gives what is called by bytes that are no UTF-8 a name that Blender can tell. Only for a file
    that is not saved afterwards."""
    for item in list(picture_requirements.unreadable(bpy.data)):  # renaming sorts them anew
        item.name = name_of(item)
        picture_requirements.name_unreadable(item, problems)


def _owners_of_scripts() -> Iterator[Any]:
    """Datablocks with drivers that Blender runs as Python: it works out simple ones itself."""
    for item in picture_requirements.datablocks(bpy.data):
        for owner in (
            item,
            getattr(item, "node_tree", None),
            getattr(item, "shape_keys", None),
        ):
            animation = getattr(owner, "animation_data", None)
            for curve in animation.drivers if animation else ():
                driver = curve.driver
                if driver.type == "SCRIPTED" and not driver.is_simple_expression:
                    yield item
