# SPDX-License-Identifier: GPL-3.0-or-later
"""report.md and report.json: what the pictures cost, what they differ by, what the levels paid."""

import json
import math
from pathlib import Path


def _row(name: str, picture: dict, difference: dict, empty: int) -> dict:
    export, povray, cut = picture["export"], picture["povray"], picture["cut"]
    return {
        "picture": name,
        "occurrences": cut["occurrences"],
        "kinds": cut["kinds"],
        "triangles": cut["triangles"],
        "largest_error_px": cut["largest_error_px"],
        "scene_bytes": export["bytes"],
        "export_cpu_s": export["cpu_s"],
        "parse_cpu_s": povray["parse_cpu_s"],
        "trace_cpu_s": povray["trace_cpu_s"],
        "memory_bytes": max(0, povray["peak_bytes"] - empty),
        **{key: difference[key] for key in ("mean", "p999", "max", "ssim")},
    }


def _total(row: dict) -> float:
    return row["export_cpu_s"] + row["parse_cpu_s"] + row["trace_cpu_s"]


def _table(rows: list[dict]) -> list[str]:
    lines = [
        "| picture | occurrences (mesh / box / ellipsoid / composite) | triangles | scene MB "
        "| export s | parse s | trace s | memory MB | mean | 99.9 % | max | SSIM |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        kinds = row["kinds"]
        lines.append(
            f"| {row['picture']} | {row['occurrences']:,} ({kinds['mesh']:,} / {kinds['box']:,} / "
            f"{kinds['ellipsoid']:,} / {kinds['composite']:,}) | {row['triangles']:,} "
            f"| {row['scene_bytes'] / 1e6:.1f} "
            f"| {row['export_cpu_s']:.2f} | {row['parse_cpu_s']:.2f} | {row['trace_cpu_s']:.2f} "
            f"| {row['memory_bytes'] / 1e6:.1f} | {row['mean']:.4f} | {row['p999']:.3f} "
            f"| {row['max']:.3f} | {row['ssim']:.3f} |"
        )
    return lines


def _verdict(rows: list[dict]) -> list[str]:
    """One sentence a measure: approximated against full detail, both in this run."""
    full = rows[0]
    lines = []
    for row in rows[1:]:
        parse = row["parse_cpu_s"] / max(1e-9, full["parse_cpu_s"])
        memory = row["memory_bytes"] / max(1, full["memory_bytes"])
        lines.append(
            f"- {row['picture']}: parse CPU 1/{1 / max(parse, 1e-9):.1f}, memory "
            f"1/{1 / max(memory, 1e-9):.1f}, all CPU 1/{_total(full) / max(1e-9, _total(row)):.1f} "
            f"of full detail; SSIM {row['ssim']:.3f} instead of {full['ssim']:.3f}"
        )
    return lines


def write_report(folder: Path, batch: dict, differences: dict, empty: int) -> Path:
    """Writes both files; returns the path of report.md."""
    by_name = {Path(picture["picture"]).stem: picture for picture in batch["pictures"]}
    cameras = {
        camera: [_row(name, by_name[f"{camera}_{name}"], found[name], empty) for name in found]
        for camera, found in differences.items()
    }
    model, build = batch["model"], batch["build"]
    lines = ["# The street, full detail and approximated", ""]
    lines.append(
        f"{model['placements']:,} occurrences of {model['objects']:,} objects and groups; "
        f"{model['triangles_placed']:,} triangles placed, {model['triangles_unique']:,} unique. "
        "640 x 360, all pictures of one run. Differences are from a 16-sample full-detail "
        "picture, of display values 0...1, on covered pixels; memory is POV-Ray's, above "
        f"{empty / 1e6:.0f} MB for an empty scene; times are CPU seconds."
    )
    for camera, rows in cameras.items():
        lines += ["", f"## Camera {camera}", "", f"![strip](strip_{camera}.png)", ""]
        lines += _table(rows) + [""] + _verdict(rows)
        one = next(row for row in rows if row["picture"] == "1px")
        saved = _total(rows[0]) - _total(one)
        if build["built"] == 0:
            paid = "The levels were there already."
        elif saved <= 0:
            paid = "At Pixel Error 1 nothing is saved here."
        else:
            count = math.ceil(build["cpu_s"] / saved)
            paid = f"At Pixel Error 1 they have paid after {count} pictures from here."
        lines += [
            "",
            f"Building the levels: {build['built']:,} of {build['objects']:,} objects, "
            f"{build['cpu_s']:.1f} CPU s ({build['wall_s']:.1f} s). {paid}",
        ]
    path = folder / "report.md"
    path.write_text("\n".join(lines) + "\n", "utf-8")
    data = {
        "schema": 1,
        "verb": "compare",
        "input": batch["input"],
        "model": model,
        "build": build,
        "empty_scene_bytes": empty,
        "cameras": cameras,
    }
    (folder / "report.json").write_text(json.dumps(data, indent=1) + "\n", "utf-8")
    return path
