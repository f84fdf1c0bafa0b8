# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a report that tell what the library did, from its records; in SI units."""

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
    return _picked(report, "objects built representations bytes_written wall_s cpu_s")


def cut_part(summary: native.records.CutSummary) -> dict[str, Any]:
    kinds = native.kind_counts(summary.occurrences_of_kind)
    fields = "occurrences originals triangles bytes largest_error_px largest_error_name"
    return {"kinds": kinds, **_picked(summary, fields)}


def export_part(report: native.records.ExportReport) -> dict[str, Any]:
    return _picked(
        report,
        "bytes files written cpu_s left_out left_out_bytes sky_copies shadow_rays lamp_rays "
        "sky_lights soft_lamps text_bytes texels covered cut_triangles",
    )


def povray_part(report: native.records.PovrayReport) -> dict[str, Any]:
    return _picked(report, "parse_cpu_s trace_cpu_s wall_s peak_bytes exit_code")


def _picked(record: Any, fields: str) -> dict[str, Any]:
    """Those fields of a record, in this order."""
    return {field: getattr(record, field) for field in fields.split()}
