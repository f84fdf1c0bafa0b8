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
from .native import lodestone_native as native
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


def model_part(totals: native.records.Totals) -> dict[str, int]:
    return {
        "objects": totals.objects,
        "placements": totals.occurrences,
        "triangles_placed": totals.triangles_placed,
        "triangles_unique": totals.triangles_unique,
    }


def build_part(report: native.records.BuildReport) -> dict[str, Any]:
    return {
        "objects": report.objects,
        "built": report.built,
        "representations": report.representations,
        "bytes_written": report.bytes_written,
        "wall_s": report.wall_s,
        "cpu_s": report.cpu_s,
    }


def cut_part(summary: native.records.CutSummary) -> dict[str, Any]:
    return {
        "kinds": native.kind_counts(summary.occurrences_of_kind),
        "occurrences": summary.occurrences,
        "originals": summary.originals,
        "triangles": summary.triangles,
        "bytes": summary.bytes,
        "largest_error_px": summary.largest_error_px,
        "largest_error_name": summary.largest_error_name,
    }


def export_part(report: native.records.ExportReport) -> dict[str, Any]:
    return {
        "bytes": report.bytes,
        "files": report.files,
        "written": report.written,
        "cpu_s": report.cpu_s,
        "left_out": report.left_out,
        "left_out_bytes": report.left_out_bytes,
        "sky_copies": report.sky_copies,
        "shadow_rays": report.shadow_rays,
        "lamp_rays": report.lamp_rays,
        "sky_lights": report.sky_lights,
        "soft_lamps": report.soft_lamps,
        "text_bytes": report.text_bytes,
        "texels": report.texels,
        "covered": report.covered,
        "cut_triangles": report.cut_triangles,
    }


def povray_part(report: native.records.PovrayReport) -> dict[str, Any]:
    return {
        "parse_cpu_s": report.parse_cpu_s,
        "trace_cpu_s": report.trace_cpu_s,
        "wall_s": report.wall_s,
        "peak_bytes": report.peak_bytes,
        "exit_code": report.exit_code,
    }


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
