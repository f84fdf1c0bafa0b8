# SPDX-License-Identifier: GPL-3.0-or-later
"""How much less the street costs POV-Ray approximated than in full, with the spread of the rounds.

    /usr/bin/python3 tests/bench/speed/bench_street.py [--blend build/samples/street.blend]
        [--rounds 5]

samples/quickstart.sh makes the street, its levels and the stage; levels that are stale are built
first. All pictures come from one batch job with the same antialiasing, the two kinds in turns, so
that a busy machine slows both. Prints a table and writes JSON; no number makes it fail.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
ADDON = STAGE / "addons" / "lodestone"
GOAL = 5.0  # full detail over approximated
GOALS = {"parse_cpu_s": GOAL, "memory_bytes": GOAL, "trace_cpu_s": None}
LABELS = {
    "parse_cpu_s": "parse, CPU s",
    "memory_bytes": "memory above an empty scene, MB",
    "trace_cpu_s": "trace, CPU s",
}
UNITS = {"parse_cpu_s": 1.0, "memory_bytes": 1e6, "trace_cpu_s": 1.0}
KINDS = ("full", "approximated")


def views_of(rounds: int, camera: str, size: list[int], pixel_error: float, folder: Path) -> list:
    """What batch.py renders: each kind once a round, now the one first, now the other."""
    views = []
    for number in range(rounds):
        for kind in KINDS if number % 2 == 0 else reversed(KINDS):
            views.append(
                {
                    "camera": camera,
                    "size": size,
                    "antialias": "final",
                    "pixel_error": pixel_error if kind == "approximated" else 0.0,
                    "out": str(folder / f"{number}_{kind}.png"),
                }
            )
    return views


def measured(pictures: list[dict], empty: int) -> list[dict]:
    """The rounds: {kind: {measure: number}} of a batch report's pictures."""
    rounds: dict[int, dict] = {}
    for picture in pictures:
        number, kind = Path(picture["picture"]).stem.split("_")
        povray = picture["povray"]
        rounds.setdefault(int(number), {})[kind] = {
            "parse_cpu_s": povray["parse_cpu_s"],
            "memory_bytes": max(0, povray["peak_bytes"] - empty),
            "trace_cpu_s": povray["trace_cpu_s"],
        }
    return [rounds[number] for number in sorted(rounds)]


def summary(rounds: list[dict]) -> dict[str, dict]:
    """By measure: the spread of both kinds and of each round's ratio full / approximated."""
    out = {}
    for measure, goal in GOALS.items():
        full, approximated = ([one[kind][measure] for one in rounds] for kind in KINDS)
        # Below a millisecond or a byte a ratio says nothing but "a lot".
        least = 1.0 if measure == "memory_bytes" else 1e-3
        out[measure] = {
            "full": benching.spread(full),
            "approximated": benching.spread(approximated),
            "ratio": benching.spread([f / max(a, least) for f, a in zip(full, approximated)]),
            "goal": goal,
        }
    return out


def table(found: dict[str, dict]) -> list[str]:
    """Markdown; numbers are minimum, median, maximum of the rounds."""
    lines = [
        "| | full detail | approximated | full / approximated | goal |",
        "|---|---|---|---|---|",
    ]
    for measure, one in found.items():
        unit = UNITS[measure]
        digits = 1 if measure == "memory_bytes" else 2
        goal = f">= {one['goal']:g}" if one["goal"] else ""
        full, ours = (benching.cell(one[kind], unit, digits) for kind in KINDS)
        ratio = benching.cell(one["ratio"], digits=1)
        lines.append(f"| {LABELS[measure]} | {full} | {ours} | {ratio} | {goal} |")
    return lines


def render(blend: Path, store: Path, views: list, folder: Path) -> dict:
    """Runs the batch job; returns its report, exits with its code when it fails."""
    request, report = folder / "views.json", folder / "batch.json"
    request.write_text(json.dumps(views), "utf-8")
    command = ["/usr/bin/python3", str(ADDON / "batch.py"), "render", str(blend)]
    command += ["--store", str(store), "--views", str(request), "--json", str(report)]
    code = subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode
    if code != 0:
        sys.exit(f"bench_street.py: batch.py ended with exit code {code}")
    return json.loads(report.read_text("utf-8"))


def options_of(arguments: list[str] | None = None) -> argparse.Namespace:
    samples = ROOT / "build" / "samples"
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blend", type=Path, default=samples / "street.blend")
    parser.add_argument("--store", type=Path, default=samples / "store")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--camera", default="far")
    parser.add_argument("--pixel-error", type=float, default=1.0)
    parser.add_argument("--size", type=int, nargs=2, default=[640, 360], metavar=("W", "H"))
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "bench" / "street.json")
    benching.add_write(parser, "samples")
    options = parser.parse_args(arguments)
    if options.rounds < 1 or not options.pixel_error > 0:
        parser.error("--rounds is at least 1, --pixel-error above 0")
    return options


def main() -> None:
    options = options_of()
    if not options.blend.is_file() or not ADDON.is_dir():
        sys.exit("bench_street.py: run samples/quickstart.sh first, it makes the street")
    sys.path.insert(0, str(ADDON))
    import lodestone_native as native

    busy = benching.load()
    empty = native.povray_empty_bytes(*options.size)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        views = views_of(options.rounds, options.camera, options.size, options.pixel_error, folder)
        batch = render(options.blend.resolve(), options.store.resolve(), views, folder)
    rounds = measured(batch["pictures"], empty)
    found = summary(rounds)
    told = benching.Told()
    told.tell(
        f"Camera {options.camera}, {options.size[0]} x {options.size[1]}, Pixel Error "
        f"{options.pixel_error:g}; {benching.said(len(rounds), busy)}\n"
    )
    told.tell("\n".join(table(found)))
    data = {
        "input": str(options.blend),
        "camera": options.camera,
        "size": options.size,
        "pixel_error": options.pixel_error,
        "build": batch["build"],
        "empty_scene_bytes": empty,
        "rounds": rounds,
        "summary": found,
    }
    benching.write(options.json, busy, data)
    title = f"The street, the spread of {len(rounds)} rounds"
    page = benching.results_path(options, "spread")
    benching.write_results(page, title, told, {"load_before": busy, **data})


if __name__ == "__main__":
    main()
