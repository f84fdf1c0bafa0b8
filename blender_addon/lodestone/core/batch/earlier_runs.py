# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of an earlier run, by its log: a job need not make them again."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from ..exit_codes import ExitCode
from . import input_stamps
from .file_jobs import FileJob

FINISHED = (ExitCode.DONE, ExitCode.INCOMPLETE)  # once more would give the same


@dataclass
class Found:
    """The results of one job: its whole report, or what was made of some pictures by their
    `out`."""

    report: dict[str, Any] | None = None
    pictures: dict[str, dict[str, Any]] = field(default_factory=dict)


class Earlier:
    """An index of a log's lines; later ones count."""

    def __init__(self, lines: Iterable[dict[str, Any]] = ()) -> None:
        self._inputs: dict[str, Any] = {}
        self._files: dict[str, dict[str, Any]] = {}
        self._pictures: dict[tuple[str, str], dict[str, Any]] = {}
        for line in lines:
            kind, file = line["line"], line.get("file")
            if not isinstance(file, str):
                continue
            if kind == "inputs":
                self._inputs[str(line.get("id"))] = line.get("inputs")
            elif kind == "picture":
                self._pictures[file, str(line.get("key"))] = line
            elif kind == "file":
                self._files[file] = line

    def find(self, job: FileJob, tick: Callable[[], None] = lambda: None) -> Found:
        """Reads the whole input, once, when the log holds anything of it that could be used."""
        known: dict[str, bool] = {}

        def fresh(line: dict[str, Any]) -> bool:
            name = str(line.get("inputs"))
            if name not in known:
                before = self._inputs.get(name)
                known[name] = input_stamps.unchanged(before, job.file, tick)
            return known[name]

        line = self._files.get(job.file)
        if line is not None and line.get("key") == job.key():
            report = line.get("report")
            if _finished(report) and outputs_stay(line) and fresh(line):
                return Found(report=report)
        found = Found()
        for frame, picture in job.wanted():
            line = self._pictures.get((job.file, job.picture_key(frame, picture)))
            if line is None or not isinstance(line.get("made"), dict):
                continue
            if outputs_stay(line) and fresh(line):
                found.pictures[picture.out] = line["made"]
        return found


def _finished(report: Any) -> bool:
    return isinstance(report, dict) and report.get("exit_code") in FINISHED


def outputs(paths: Iterable[str]) -> list[list[Any]]:
    """The results, [path, stamp] of each, for a line of the log."""
    return [[path, input_stamps.stamp(path)] for path in paths]


def outputs_stay(line: dict[str, Any]) -> bool:
    """Whether everything a line says was made is still there as it was made."""
    try:
        made = line["outputs"]
        return bool(made) and all(
            known is not None and input_stamps.stamp(path) == known for path, known in made
        )
    except (KeyError, TypeError, ValueError):
        return False
