# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether levels are shaded like what they stand for, where shading tells the shape.

    /usr/bin/python3 tests/bench/sheets/bench_shading.py [--scenes ridges still_life ...]
        [--heights FILE.png] [--pixel-errors 1 2 4] [--size 320x180] [--write]

Makes two terrains of 522,242 triangles and a still life of smooth things (smooth_scenes.py), and of
a gray picture a terrain more. Builds their levels anew, draws them in POV-Ray beside full detail,
both with 16 samples a pixel, and prints how alike they are. The pictures stay in
build/bench/shading. No number makes it fail.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

STAGE = Path(os.environ.get("LODESTONE_STAGE") or benching.ROOT / "build" / "release" / "stage")
MAKER = Path(__file__).resolve().parents[1] / "scenes" / "smooth_scenes.py"
OUT = benching.ROOT / "build" / "bench" / "shading"
SCENES = ("ridges", "dunes", "still_life")
GOALS = {  # least SSIM, by scene and Pixel Error
    ("ridges", 1.0): 0.95,
    ("dunes", 1.0): 0.95,
    ("heights", 1.0): 0.95,
    ("still_life", 2.0): 0.96,
}


def quiet(command: list) -> None:
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{command[0]} ended with {done.returncode}:\n{done.stdout}{done.stderr}")


def made(scene: str, heights: str | None) -> Path:
    """The scene's file, anew."""
    blend = OUT / f"{scene}.blend"
    last = ["--", scene, blend] + ([Path(heights).resolve()] if scene == "heights" else [])
    quiet(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", MAKER, *last])
    return blend


def compared(blend: Path, pixel_error: float, size: str) -> dict:
    """The report of one comparison with full detail."""
    name = OUT / f"{blend.stem}_{pixel_error:g}"
    report = name.with_suffix(".json")
    batch = STAGE / "addons" / "lodestone" / "batch.py"
    quiet(
        ["/usr/bin/python3", batch, "compare", blend, "--pixel-error", pixel_error, "--size", size]
        + ["--antialias", "reference", "--store", OUT / "stores" / blend.stem]
        + ["--json", report, "--out", name.with_suffix(".png")]
    )
    return json.loads(report.read_text("utf-8"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--heights", metavar="FILE", help="a gray picture for a terrain more")
    parser.add_argument("--pixel-errors", nargs="+", type=float, default=[1.0, 2.0, 4.0])
    parser.add_argument("--size", default="320x180")
    benching.add_write(parser, "backend")
    options = parser.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    told, rows = benching.Told(), []
    told.tell(f"{options.size}, 16 samples a pixel; differences are of display values 0...1.\n")
    told.tell("| scene | Pixel Error | triangles | solids | mean | 99.9 % | SSIM | goal |")
    told.tell("|---|---|---|---|---|---|---|---|")
    for scene in [*options.scenes, *(["heights"] if options.heights else [])]:
        blend = made(scene, options.heights)
        shutil.rmtree(OUT / "stores" / scene, ignore_errors=True)
        for pixel_error in options.pixel_errors:
            report = compared(blend, pixel_error, options.size)
            found, kinds = report["compare"], report["cut"]["kinds"]
            solids = sum(count for kind, count in kinds.items() if kind != "mesh")
            triangles = report["cut"]["triangles"]
            goal = GOALS.get((scene, pixel_error))
            told.tell(
                f"| {scene} | {pixel_error:g} | {triangles:,} | {solids:,} | {found['mean']:.4f} "
                f"| {found['p999']:.3f} | {found['ssim']:.3f} | {goal or ''} |"
            )
            rows.append(
                {
                    "scene": scene,
                    "pixel_error": pixel_error,
                    "triangles": triangles,
                    "solids": solids,
                    **{name: found[name] for name in ("mean", "p999", "ssim")},
                }
            )
    path = benching.results_path(options, "shading")
    benching.write_results(path, "How alike levels are shaded", told, {"rows": rows})


main()
