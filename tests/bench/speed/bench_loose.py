# SPDX-License-Identifier: GPL-3.0-or-later
"""What a kit-bashed city in one mesh costs POV-Ray, as one object and with its loose parts as many.

    /usr/bin/python3 tests/bench/speed/bench_loose.py [--side 32] [--rounds 5] [--pictures FOLDER]
        [--write]

The city has SIDE x SIDE plots with buildings of some parts each. Each way its levels are built,
then pictures are made from a street, above the roofs and from outside, in full and approximated, in
turns. Prints a table and writes JSON; no number makes it fail.
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
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
ADDON = STAGE / "addons" / "lodestone"
CAMERAS = ("street", "roof", "outside")
WAYS = ("one", "automatic")


def batch(verb: str, blend: Path, *more: str) -> dict:
    report = blend.with_suffix(f".{verb}.json")
    command = ["/usr/bin/python3", str(ADDON / "batch.py"), verb, str(blend), "--json", str(report)]
    code = subprocess.run([*command, *more], stdout=subprocess.DEVNULL, check=False).returncode
    if code != 0:
        sys.exit(f"bench_loose.py: batch.py {verb} ended with exit code {code}")
    return json.loads(report.read_text("utf-8"))


def views(options: argparse.Namespace, folder: Path) -> Path:
    """A request for all cameras, rounds and pixel errors; pictures are ROUND_CAMERA_ERROR.png."""
    wanted = []
    for number in range(options.rounds):
        for camera in CAMERAS:
            for error in (0.0, options.pixel_error):
                wanted.append(
                    {
                        "camera": camera,
                        "size": options.size,
                        "antialias": "final",
                        "pixel_error": error,
                        "out": str(
                            folder / f"{number}_{camera}_{'full' if not error else 'cut'}.png"
                        ),
                    }
                )
    path = folder / "views.json"
    path.write_text(json.dumps(wanted), "utf-8")
    return path


def options_of(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=32)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--pixel-error", type=float, default=1.0)
    parser.add_argument("--size", type=int, nargs=2, default=[640, 360], metavar=("W", "H"))
    parser.add_argument(
        "--pictures", type=Path, help="folder to keep the first round's pictures in"
    )
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "bench" / "loose.json")
    benching.add_write(parser, "backend")
    return parser.parse_args(arguments)


def main() -> None:
    options = options_of()
    if not ADDON.is_dir():
        sys.exit("bench_loose.py: build first: the staged add-on is not there")
    sys.path.insert(0, str(ADDON))
    import lodestone_native as native

    busy = benching.load()
    empty = native.povray_empty_bytes(*options.size)
    found: dict = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        blends = {way: folder / f"city_{way}.blend" for way in WAYS}
        command = ["blender", "-b", "--factory-startup", "--addons", "lodestone"]
        command += ["--python-exit-code", "1", "--python"]
        command += [str(Path(__file__).with_name("bench_loose_blender.py")), "--"]
        command += [str(options.side), *map(str, blends.values())]
        environment = dict(os.environ, BLENDER_USER_SCRIPTS=str(STAGE))
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=environment)
        for way, blend in blends.items():
            (folder / way).mkdir()
            built = batch("build", blend, "--store", str(folder / way / "store"))
            made = batch(
                "render", blend, "--store", str(folder / way / "store"), "--views",
                str(views(options, folder / way)),
            )  # fmt: skip
            found[way] = {"build": built["build"], "model": made["model"], "pictures": {}}
            for picture in made["pictures"]:
                _, camera, kind = Path(picture["picture"]).stem.split("_")
                one = found[way]["pictures"].setdefault(f"{camera} {kind}", [])
                one.append(
                    {
                        "triangles": picture["cut"]["triangles"],
                        "kinds": picture["cut"]["kinds"],
                        "scene_bytes": picture["export"]["bytes"],
                        "memory_bytes": max(0, picture["povray"]["peak_bytes"] - empty),
                        "parse_cpu_s": picture["povray"]["parse_cpu_s"],
                        "trace_cpu_s": picture["povray"]["trace_cpu_s"],
                    }
                )
            for camera in CAMERAS:
                full = folder / "one" / f"0_{camera}_full.png"
                for kind in ("full", "cut"):
                    same = native.image_compare(
                        str(full), str(folder / way / f"0_{camera}_{kind}.png")
                    )
                    found[way]["pictures"][f"{camera} {kind}"][0]["ssim"] = same.ssim
                    found[way]["pictures"][f"{camera} {kind}"][0]["max"] = same.max
            if options.pictures is not None:
                options.pictures.mkdir(parents=True, exist_ok=True)
                for file in (folder / way).glob("0_*.png"):
                    shutil.copy(file, options.pictures / f"{way}_{file.name}")
    told = print_table(found, options, busy)
    data = {"side": options.side, "ways": found}
    benching.write(options.json, busy, data)
    page = benching.results_path(options, "loose")
    title = "Loose parts of a mesh as objects"
    benching.write_results(page, title, told, {"load_before": busy, **data})


def print_table(found: dict, options: argparse.Namespace, busy: float) -> benching.Told:
    told = benching.Told()
    model = found["one"]["model"]
    told.tell(
        f"{options.side} x {options.side} plots, {model['triangles_placed']:,} triangles in one "
        f"mesh; Pixel Error {options.pixel_error:g}; {benching.said(options.rounds, busy)}\n"
    )
    for way, one in found.items():
        told.tell(
            f"levels, {way}: {one['build']['cpu_s']:.1f} CPU s, {one['build']['built']} built"
        )
    told.tell(
        "\n| view | loose parts | triangles | drawn by | scene, MB | memory, MB | parse, CPU s "
        "| trace, CPU s | SSIM |"
    )
    told.tell("|---|---|---|---|---|---|---|---|---|")
    for camera in CAMERAS:
        for way, kind in ((WAYS[0], "full"), (WAYS[1], "full"), (WAYS[0], "cut"), (WAYS[1], "cut")):
            rounds = found[way]["pictures"][f"{camera} {kind}"]
            cells = [
                benching.cell(benching.spread([one[key] for one in rounds]), unit, digits)
                for key, unit, digits in (
                    ("memory_bytes", 1e6, 1),
                    ("parse_cpu_s", 1.0, 2),
                    ("trace_cpu_s", 1.0, 2),
                )
            ]
            first = rounds[0]
            drawn = sum(first["kinds"].values())
            label = "full detail" if kind == "full" else f"{options.pixel_error:g} px"
            told.tell(
                f"| {camera}, {label} | {way} | {first['triangles']:,} | {drawn} "
                f"| {first['scene_bytes'] / 1e6:.1f} | {' | '.join(cells)} | {first['ssim']:.4f} |"
            )
    return told


if __name__ == "__main__":
    main()
