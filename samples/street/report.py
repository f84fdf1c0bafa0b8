# SPDX-License-Identifier: GPL-3.0-or-later
"""report.md and report.json: what the pictures cost, what they differ by, what the levels paid; and
the same of one camera, short, for the first page of the repository."""

import json
import math
from pathlib import Path

# The lines of README.md between these are written by strip_block.
BEGIN, END = "<!-- strip:begin -->", "<!-- strip:end -->"
STRIP_PICTURES = ("full", "0.5px", "1px", "4px")


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
    words = " / ".join(rows[0]["kinds"])
    lines = [
        f"| picture | occurrences ({words}) | triangles | scene MB "
        "| export s | parse s | trace s | memory MB | mean | 99.9 % | max | SSIM |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        counts = " / ".join(f"{count:,}" for count in row["kinds"].values())
        lines.append(
            f"| {row['picture']} | {row['occurrences']:,} ({counts}) | {row['triangles']:,} "
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


def _pictures_to_pay(rows: list[dict], build: dict) -> int | None:
    """After how many pictures at Pixel Error 1 the levels have paid; None where they never do."""
    one = next(row for row in rows if row["picture"] == "1px")
    saved = _total(rows[0]) - _total(one)
    return math.ceil(build["cpu_s"] / saved) if saved > 0 else None


def strip_block(report: dict) -> str:
    """The table below the picture strip of README.md, from what write_report wrote as JSON."""
    cells = ["600 m street, far camera, 640 x 360", "triangles placed", "POV-Ray memory"]
    cells += ["parse + trace", "SSIM (16-sample reference)"]
    lines = [f"| {' | '.join(cells)} |", "|---|---|---|---|---|"]
    rows = report["cameras"]["far"]
    by_name = {row["picture"]: row for row in rows}
    for name in STRIP_PICTURES:
        row = by_name[name]
        cells = [
            "full detail" if name == "full" else f"Pixel Error {name.removesuffix('px')}",
            f"{row['triangles']:,}",
            f"{row['memory_bytes'] / 1e6:.0f} MB",
            f"{row['parse_cpu_s']:.1f} + {row['trace_cpu_s']:.1f} CPU s",
            f"{row['ssim']:.3f}",
        ]
        if name == "1px":
            cells = [f"**{cell}**" for cell in cells]
        lines.append(f"| {' | '.join(cells)} |")
    lines += ["", "One run; memory is above that of an empty scene, SSIM on covered pixels."]
    build, pictures = report["build"], _pictures_to_pay(rows, report["build"])
    if build["built"] > 0:
        lines[-1] += f" Building the levels took {build['cpu_s']:.0f} CPU s once"
        lines[-1] += (
            f": paid back\nafter {pictures} pictures from this camera." if pictures else "."
        )
    return "\n".join(lines)


def with_strip(page: str, block: str) -> str:
    """The page with the block between its two marks, which it must have once."""
    before, begun, rest = page.partition(BEGIN)
    _, ended, after = rest.partition(END)
    if not begun or not ended or BEGIN in rest or END in before + after:
        raise ValueError(f"the page needs {BEGIN} and {END} once, in this order")
    return f"{before}{BEGIN}\n{block}\n{END}{after}"


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
        pictures = _pictures_to_pay(rows, build)
        if build["built"] == 0:
            paid = "The levels were there already."
        elif pictures is None:
            paid = "At Pixel Error 1 nothing is saved here."
        else:
            paid = f"At Pixel Error 1 they have paid after {pictures} pictures from here."
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
