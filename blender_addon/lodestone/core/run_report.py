# SPDX-License-Identifier: GPL-3.0-or-later
"""The report, schema 1: what a run did, in SI units, for people and programs."""

import json
import os
import re
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .exit_codes import STATUS, ExitCode
from .problems import Problem

SCHEMA = 1
EVENTS = "events.jsonl"  # beside the report while Blender runs: what is finished so far


def file_report(verb: str, source: str, code: ExitCode, message: str = "") -> dict[str, Any]:
    """The frame of one input's report; the other parts are added as they become known."""
    report = {
        "schema": SCHEMA,
        "verb": verb,
        "status": STATUS[code],
        "exit_code": int(code),
        "input": source,
    }
    if message:
        report["message"] = message
    return report


def temporary_name(ending: str = ".png") -> str:
    """The name of a picture that is being written by this process."""
    return f".lodestone-{os.getpid()}{ending}"


def temporary_owner(name: str) -> int:
    """The process that was writing a picture of that name; 0 for other names."""
    found = re.fullmatch(r"\.lodestone-(\d{1,9})\.(png|exr)", name)
    return int(found[1]) if found else 0


def problems_part(problems: Iterable[Problem]) -> list[dict[str, str]]:
    return [problem.as_dict() for problem in problems]


def many_report(verb: str, reports: list[dict[str, Any]], code: ExitCode) -> dict[str, Any]:
    """Several inputs: their reports under `files`."""
    return {
        "schema": SCHEMA,
        "verb": verb,
        "status": STATUS[code],
        "exit_code": int(code),
        "files": reports,
    }


def write(path: str | Path, report: dict[str, Any]) -> None:
    """Writes to a temporary name, then renames: readers never see half a report. Raises OSError."""
    target = Path(path)
    handle, name = tempfile.mkstemp(dir=target.parent or ".", prefix=".report-")
    try:
        # Bytes that are no UTF-8 in a path become JSON's own escapes: reading gives the path again
        with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as file:
            json.dump(report, file, indent=1, ensure_ascii=False)
            file.write("\n")
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _umask() -> int:
    """The umask, found without setting it: another thread may be making a file."""
    with open("/proc/self/status", encoding="ascii", errors="replace") as lines:
        return next(int(line.split()[1], 8) for line in lines if line.startswith("Umask:"))
