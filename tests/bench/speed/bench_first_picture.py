# SPDX-License-Identifier: GPL-3.0-or-later
"""How long the first F12 of a scene takes, and the next ones, beside a picture of full detail.

    /usr/bin/python3 tests/bench/speed/bench_first_picture.py [FILE.blend ...] [--rounds 5]
        [--write]

Without files: build/samples/street.blend, which samples/quickstart.sh makes. Every round opens the
file in a Blender of its own, with no levels, and counts what both programs take from F12 to the
picture: of full detail, then at Pixel Error 1 the first, second and third time, then what Update
Levels takes to build all levels from none, then a picture with these. --pictures takes some of
these only, --whole N builds all levels in the first N rounds only. Prints a table and writes JSON;
no number makes it fail.
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
INSIDE = Path(__file__).with_name("bench_first_picture_blender.py")
PICTURES = {  # goal: most of it over the picture of full detail
    "full": ("full detail", None),
    "first": ("first F12 at Pixel Error 1", 1.2),
    "second": ("second", None),
    "third": ("third", None),
    "whole": ("Update Levels, all from none", 3.0),
    "after": ("then F12 at Pixel Error 1", 1.0),
}
WHOLE = ("whole", "after")  # what builds all levels, and what needs that
TIMEOUT = 3600


def pictures_of(number: int, options: argparse.Namespace) -> list[str]:
    """What one round takes, in order."""
    return [
        picture
        for picture in PICTURES
        if picture in options.pictures and (number < options.whole or picture not in WHOLE)
    ]


def measured(blend: Path, options: argparse.Namespace, pictures: list[str]) -> dict:
    """{picture: {"cpu_s", "wall_s", "triangles"}} of one round."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        report = folder / "report.json"
        environment = {
            **os.environ,
            "BLENDER_USER_SCRIPTS": str(STAGE),
            "LODESTONE_CACHE": str(folder / "cache"),
        }
        command = ["blender", "-b", "--factory-startup", str(blend), "--addons", "lodestone"]
        command += ["--python-exit-code", "1", "--python", str(INSIDE), "--"]
        command += [
            str(folder / "copy.blend"),
            str(report),
            *map(str, options.size),
            options.camera,
        ]
        command += pictures
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=TIMEOUT, env=environment, check=False
        )
        if done.returncode != 0 or not report.is_file():
            sys.exit(f"bench_first_picture.py: {blend} failed:\n{done.stdout[-2000:]}{done.stderr}")
        return json.loads(report.read_text("utf-8"))


def summary(found: list[dict]) -> dict[str, dict]:
    """By picture: spreads of CPU and wall seconds, and of each round's ratio to full detail."""
    out = {}
    for picture, (_, goal) in PICTURES.items():
        having = [one for one in found if picture in one]
        if not having:
            continue
        ratios = [one[picture]["cpu_s"] / max(one["full"]["cpu_s"], 1e-3) for one in having]
        out[picture] = {
            "cpu_s": benching.spread([one[picture]["cpu_s"] for one in having]),
            "wall_s": benching.spread([one[picture]["wall_s"] for one in having]),
            "ratio": benching.spread(ratios),
            "triangles": having[-1][picture]["triangles"],
            "rounds": len(having),
            "goal": goal,
        }
    return out


def table(found: dict[str, dict]) -> list[str]:
    lines = [
        "| picture | rounds | CPU s | wall s | CPU over full detail | goal | triangles |",
        "|---|---|---|---|---|---|---|",
    ]
    for picture, one in found.items():
        label = PICTURES[picture][0]
        triangles = "" if one["triangles"] is None else f"{one['triangles']:,}"
        goal = f"<= {one['goal']:g}" if one["goal"] else ""
        lines.append(
            f"| {label} | {one['rounds']} | {benching.cell(one['cpu_s'], digits=1)} "
            f"| {benching.cell(one['wall_s'], digits=1)} | {benching.cell(one['ratio'])} | {goal} "
            f"| {triangles} |"
        )
    return lines


def options_of(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("blend", type=Path, nargs="*")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", type=int, nargs=2, default=[640, 360], metavar=("W", "H"))
    parser.add_argument("--camera", default="", help="by name; default: far, else the scene's")
    parser.add_argument("--pictures", nargs="+", choices=[*PICTURES], default=[*PICTURES])
    parser.add_argument("--whole", type=int, help="rounds; default: all")
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "bench" / "first.json")
    benching.add_write(parser, "backend")
    options = parser.parse_args(arguments)
    if options.rounds < 1:
        parser.error("--rounds is at least 1")
    if "full" not in options.pictures:
        parser.error("--pictures: all are compared with full")
    options.whole = options.rounds if options.whole is None else options.whole
    options.blend = options.blend or [ROOT / "build" / "samples" / "street.blend"]
    return options


def main() -> None:
    options = options_of()
    if not (STAGE / "addons" / "lodestone").is_dir():
        sys.exit("bench_first_picture.py: build first (cmake --build --preset release)")
    busy = benching.load()
    results = {}
    told = benching.Told()
    for blend in options.blend:
        if not blend.is_file():
            sys.exit(f"bench_first_picture.py: there is no {blend}; samples/quickstart.sh makes it")
        found = []
        for number in range(options.rounds):
            pictures = pictures_of(number, options)
            found.append(measured(blend.resolve(), options, pictures))
            took = ", ".join(f"{p} {found[-1][p]['cpu_s']:.1f}" for p in pictures)
            print(f"{blend.stem} {number}: CPU s: {took}", flush=True)
        results[blend.stem] = {"rounds": found, "summary": summary(found)}
        told.tell(f"\n{blend.stem}: {benching.said(options.rounds, busy)}\n")
        told.tell("\n".join(table(results[blend.stem]["summary"])))
    data = {"input": sorted(results), "scenes": results}
    benching.write(options.json, busy, data)
    page = benching.results_path(options, "first_picture")
    benching.write_results(page, "What a build costs", told, {"load_before": busy, **data})


if __name__ == "__main__":
    main()
