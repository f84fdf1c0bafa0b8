# SPDX-License-Identifier: GPL-3.0-or-later
"""The exit codes of a batch run, and which one stands for several files."""

from collections.abc import Iterable
from enum import IntEnum


class ExitCode(IntEnum):
    DONE = 0
    FAILED = 1
    USAGE = 2
    INCOMPLETE = 3  # done, but the picture is known to be wrong or incomplete somewhere
    UNREADABLE = 4  # the input cannot be read, or Blender died on it
    POVRAY = 5  # POV-Ray missing or failed
    CANCELLED = 130


STATUS = {
    ExitCode.DONE: "done",
    ExitCode.FAILED: "failed",
    ExitCode.USAGE: "usage",
    ExitCode.INCOMPLETE: "incomplete",
    ExitCode.UNREADABLE: "unreadable",
    ExitCode.POVRAY: "povray_failed",
    ExitCode.CANCELLED: "cancelled",
}


def of_many(codes: Iterable[int]) -> ExitCode:
    """The exit code of several files: 130, 1 when any failed, 3 when any is incomplete, else 0. One
    file: its own code."""
    found = [ExitCode(code) for code in codes]
    if len(found) == 1:
        return found[0]
    if ExitCode.CANCELLED in found:
        return ExitCode.CANCELLED
    if any(code not in (ExitCode.DONE, ExitCode.INCOMPLETE) for code in found):
        return ExitCode.FAILED
    return ExitCode.INCOMPLETE if ExitCode.INCOMPLETE in found else ExitCode.DONE


class Failed(Exception):
    """Ends the file with a code and a sentence."""

    def __init__(self, code: ExitCode, text: str) -> None:
        super().__init__(text)
        self.code = code
