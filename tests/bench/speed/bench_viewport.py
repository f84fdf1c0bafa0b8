# SPDX-License-Identifier: GPL-3.0-or-later
"""How much a redraw of the 3D Viewport takes with levels, beside Blender's drawing of everything.

/usr/bin/python3 tests/bench/speed/bench_viewport.py [--scene build/samples/street.blend]
    [--rounds 5] [--camera near] [--stage build/release/stage] [--json build/bench/viewport.json]
    [--pictures DIR] [--write]

The scene's levels must be built beside it (batch.py build). Needs Xvfb, and OpenGL in software.
Each way of drawing (levels, Solid, Material Preview; overlays off, and levels and Solid with them)
has a Blender of its own in each round: time to the first complete picture, CPU of a redraw while
the view turns by half a degree, and what memory grows by.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
KINDS = ("levels", "solid", "material", "levels overlays", "solid overlays")
GOALS = {"redraw_cpu_s": 0.25, "first_cpu_s": 0.25, "memory": 0.25}  # of Solid's
UNITS = (("redraw_cpu_s", 1e-3, "ms CPU a redraw"), ("first_cpu_s", 1.0, "s CPU to the first"),
         ("first_s", 1.0, "s to the first"), ("memory", 1e6, "MB"))  # fmt: skip


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", type=Path, default=ROOT / "build" / "samples" / "street.blend")
    parser.add_argument("--stage", type=Path, default=ROOT / "build" / "release" / "stage")
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "bench" / "viewport.json")
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--camera", default="near")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--kinds", nargs="+", default=KINDS, choices=KINDS)
    benching.add_write(parser, "blender_addon")
    return parser.parse_args()


def one(asked, kind, folder):
    """What one Blender measures of one way."""
    out = folder / "out.json"
    out.unlink(missing_ok=True)
    picture = ""
    if asked.pictures:
        asked.pictures.mkdir(parents=True, exist_ok=True)
        picture = str((asked.pictures / f"{kind.replace(' ', '_')}.png").resolve())
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x800x24 +extension GLX", "blender"]
    script = Path(__file__).with_name("bench_viewport_blender.py")
    command += ["--factory-startup", str(asked.scene), "--python", str(script), "--"]
    command += [kind, asked.camera, str(out), picture]
    environment = {
        **os.environ,
        "BLENDER_USER_SCRIPTS": str(asked.stage),
        "BLENDER_USER_CONFIG": str(folder / "config"),
    }
    log = subprocess.run(command, env=environment, capture_output=True, timeout=900, text=True)
    if not out.is_file():
        sys.exit(f"{kind}: no result\n{log.stdout[-2000:]}{log.stderr[-2000:]}")
    return json.loads(out.read_text("utf-8"))


def main():
    asked = options()
    if shutil.which("xvfb-run") is None:
        sys.exit("skipped: xvfb-run is not installed")
    if not asked.scene.is_file():
        sys.exit(f"skipped: no {asked.scene}")
    busy = benching.load()
    found = {kind: [] for kind in asked.kinds}
    with tempfile.TemporaryDirectory() as name:
        for _, kind in benching.turns(asked.rounds, asked.kinds):
            found[kind].append(one(asked, kind, Path(name)))
            print(kind, found[kind][-1], flush=True)
    told = benching.Told()
    told.tell(benching.said(asked.rounds, busy))
    told.tell(f"\n| | {' | '.join(words for _, _, words in UNITS)} |\n|---|{'---|' * len(UNITS)}")
    table = {}
    for kind, rows in found.items():
        table[kind] = {key: benching.spread([row[key] for row in rows]) for key, _, _ in UNITS}
        cells = [benching.cell(table[kind][key], unit, 1) for key, unit, _ in UNITS]
        told.tell(f"| {kind} | {' | '.join(cells)} |")
    ratios = {}
    for kind in table:
        peer = "solid overlays" if "overlays" in kind else "solid"
        if peer not in table:
            continue
        ratios[kind] = {
            key: table[kind][key]["median"] / max(1e-9, table[peer][key]["median"]) for key in GOALS
        }
        shown = ", ".join(
            f"{key} {ratio:.2f} (goal for levels {GOALS[key]})"
            for key, ratio in ratios[kind].items()
        )
        told.tell(f"\n{kind}, of {peer}: {shown}")
    data = {"rounds": found, "ratios": ratios}
    benching.write(asked.json, busy, data)
    page = benching.results_path(asked, "viewport")
    benching.write_results(page, "A redraw of the viewport", told, {"load_before": busy, **data})


if __name__ == "__main__":
    main()
