# SPDX-License-Identifier: GPL-3.0-or-later
"""The version of Blender that wrote a file, as far as its first bytes tell."""

import re


def version(path: str) -> tuple[int, int] | None:
    """The version, as (4, 2) for Blender 4.2; None for a compressed file, and for anything else."""
    try:
        with open(path, "rb") as file:
            head = file.read(17)
    except OSError:
        return None
    # BLENDER-v402 up to 4.5; BLENDER17-01v0500 since 5.0
    found = re.match(rb"BLENDER(?:[-_][vV](\d)(\d\d)|\d\d-\d\d[vV](\d\d)(\d\d))", head)
    if not found:
        return None
    major, minor = (int(part) for part in found.groups() if part is not None)
    return major, minor


def written_by(path: str) -> str:
    """The version in words for the end of a sentence, as " (written by Blender 4.2)"; "" where it
    is not known."""
    known = version(path)
    return f" (written by Blender {known[0]}.{known[1]})" if known else ""
