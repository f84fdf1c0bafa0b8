# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a report that tell what the library did, from its records."""

from typing import Any

from .native import lodestone_native as native


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
