# SPDX-License-Identifier: GPL-3.0-or-later
"""What approximating 400 lamps saves POV-Ray, and what it changes.

    /usr/bin/python3 tests/bench/speed/bench_lights.py [--scenes house corridor market] [--rounds 5]
        [--write]

Each scene of light_scenes.py is drawn with all lamps and with approximated ones, in turns. The
differences are to a picture with all lamps and 16 samples in every pixel, which is made once.
Prints a table and writes JSON and pictures; no number makes it fail.
"""

import argparse
import math
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
from bench.scenes import light_scenes  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
KINDS = ("all", "approximated")
GOALS = {"cpu": 5.0, "mean": 2.5, "room": 2.0}


def camera_of(native, scene: light_scenes.Scene, aspect: float):
    way = [b - a for a, b in zip(scene.eye, scene.target)]
    way = [value / math.hypot(*way) for value in way]
    flat = math.hypot(way[0], way[1])
    right = [way[1] / flat, -way[0] / flat, 0.0]
    up = [
        right[1] * way[2] - right[2] * way[1],
        right[2] * way[0] - right[0] * way[2],
        right[0] * way[1] - right[1] * way[0],
    ]
    return native.Camera(
        scene.name,
        False,
        scene.eye,
        tuple(way),
        tuple(value * scene.width for value in right),
        tuple(value * scene.width / aspect for value in up),
        0.1,
    )


def draw(native, model, view, folder: Path, picture: str, light_error: float, antialias: int):
    options = native.PovrayOptions(antialias=antialias, light_error=light_error, threads=1)
    with native.Cut(model, view) as cut:
        start = sum(os.times()[:2])
        exported = native.povray_export(cut, str(folder), options)
        export_s = sum(os.times()[:2]) - start
    ran = native.povray_run(str(folder), picture, options)
    return {
        "export_cpu_s": export_s,
        "trace_cpu_s": ran.trace_cpu_s,
        "memory_bytes": ran.peak_bytes,
        "lights_each": exported.lights_each,
    }


def light_of(image, part: tuple[float, float, float, float]) -> float:
    """Sum of the linear light in a part of a picture."""
    left, right = (round(part[i] * image.width) for i in (0, 2))
    top, bottom = (round(part[i] * image.height) for i in (1, 3))
    total = 0.0
    for y in range(max(0, top), min(image.height, bottom)):
        for x in range(max(0, left), min(image.width, right)):
            at = 4 * (y * image.width + x)
            total += sum(image.pixels[at : at + 3])
    return total


def brightest_room(native, scene: light_scenes.Scene, full: Path, ours: Path) -> float | None:
    """By how much (percent) the room that gains most light is brighter."""
    a, b = native.image_read(str(full)), native.image_read(str(ours))
    found = [(light_of(a, part), light_of(b, part)) for part in scene.rooms]
    gains = [100 * (ours / full - 1) for full, ours in found if full > 0]
    return max(gains) if gains else None


def run_scene(native, name: str, rounds: int, size: list[int], folder: Path) -> dict:
    model, scene = light_scenes.SCENES[name](native)
    view = native.View(camera_of(native, scene, size[0] / size[1]), size[0], size[1], 1.0)
    numbers: dict[str, list[dict]] = {kind: [] for kind in KINDS}
    folders = {kind: folder / f"{name}_{kind}" for kind in KINDS}
    final = native.Antialias.FINAL
    for _, kind in benching.turns(rounds, KINDS):
        error = 0.0 if kind == "all" else -1.0
        numbers[kind].append(draw(native, model, view, folders[kind], "p.png", error, final))
    reference = folder / f"{name}_reference"
    draw(native, model, view, reference, "p.png", 0.0, native.Antialias.REFERENCE)
    pictures = {kind: folders[kind] / "p.png" for kind in KINDS}
    out = {
        "ratio": benching.spread(
            [
                a["trace_cpu_s"] / (b["trace_cpu_s"] or 1e-3)
                for a, b in zip(*(numbers[kind] for kind in KINDS))
            ]
        ),
        "room_percent": brightest_room(
            native, scene, reference / "p.png", pictures["approximated"]
        ),
    }
    for kind in KINDS:
        differs = native.image_compare(str(reference / "p.png"), str(pictures[kind]))
        out[kind] = {
            key: benching.spread([one[key] for one in numbers[kind]]) for key in numbers[kind][0]
        }
        out[kind]["mean"] = 255 * differs.mean
        out[kind]["ssim"] = differs.ssim
    return out


def table(found: dict[str, dict]) -> list[str]:
    lines = [
        "| | " + " | ".join(found) + " | goal |",
        "|---|" + "---|" * (len(found) + 1),
    ]

    def row(label: str, cells: list[str], goal: str = "") -> None:
        lines.append(f"| {label} | " + " | ".join(cells) + f" | {goal} |")

    ones = list(found.values())
    for kind in KINDS:
        row(f"{kind}: trace, CPU s", [benching.cell(one[kind]["trace_cpu_s"]) for one in ones])
    row(
        "**all / approximated**",
        [benching.cell(one["ratio"], digits=1) for one in ones],
        f">= {GOALS['cpu']:g}",
    )
    row(
        "choosing lights and writing, CPU s",
        [benching.cell(one["approximated"]["export_cpu_s"]) for one in ones],
    )
    row(
        "lights of a point, of 400",
        [f"{one['approximated']['lights_each']['median']:.1f}" for one in ones],
    )
    for kind in KINDS:
        row(
            f"{kind}: memory, MB",
            [f"{one[kind]['memory_bytes']['median'] / 1e6:.0f}" for one in ones],
        )
    for kind in KINDS:
        row(
            f"{kind}: mean difference, 255ths",
            [f"{one[kind]['mean']:.2f}" for one in ones],
            f"<= {GOALS['mean']:g}" if kind != "all" else "",
        )
    row(
        "the room that gains most light, %",
        ["" if one["room_percent"] is None else f"{one['room_percent']:+.2f}" for one in ones],
        f"<= {GOALS['room']:g}",
    )
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="+", default=list(light_scenes.SCENES))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", type=int, nargs=2, default=[320, 180], metavar=("W", "H"))
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "bench" / "lights")
    benching.add_write(parser, "povray_export")
    options = parser.parse_args()
    addon = STAGE / "addons" / "lodestone"
    if not addon.is_dir():
        sys.exit("bench_lights.py: build the add-on first")
    sys.path.insert(0, str(addon))
    import lodestone_native as native

    busy = benching.load()
    found = {
        name: run_scene(native, name, options.rounds, options.size, options.folder)
        for name in options.scenes
    }
    told = benching.Told()
    told.tell(f"{options.size[0]} x {options.size[1]}; {benching.said(options.rounds, busy)}\n")
    told.tell("\n".join(table(found)))
    data = {"size": options.size, "scenes": found}
    benching.write(options.folder / "lights.json", busy, data)
    page = benching.results_path(options, "lights")
    benching.write_results(page, "Many lamps", told, {"load_before": busy, **data})


if __name__ == "__main__":
    main()
