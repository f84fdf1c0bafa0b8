# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders scenes made by others at full detail and at Pixel Error 1, and compares.

    /usr/bin/python3 samples/real_scenes.py --data FOLDER [--out build/real_scenes] [--write]

FOLDER holds scenes/ as listed below: .blend files, and glTF files that Blender imports (with
python3-numpy). Each becomes a .blend under --out, with a camera and a light where it has none; all
of them go through batch.py in one call. Writes report.md and prints its table; with --write also
samples/docs/results/real_scenes.md.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

HERE = Path(__file__).resolve().parent
STAGE = Path(os.environ.get("LODESTONE_STAGE") or HERE.parent / "build/release/stage")
ADDON = STAGE / "addons/lodestone"

# Name of the .blend, and what it is made of: all files that fit are one scene
SCENES = {
    "armory-platformer": "armory-platformer/platformer.blend",
    "armory-race-track": "armory-race-track/race_track.blend",
    "cityjson-3dbag": "cityjson-3dbag/city.blend",
    "godot-mesh-lod-room": "godot-mesh-lod-room/room.glb",
    "kaykit-city-bits": "kaykit-city-bits/*.gltf",
    "stk-cocoa_temple": "stk-cocoa_temple/cocoa_temple.blend",
    "tps-forklift": "tps-forklift/flying_forklift.blend",
}
PIXEL_ERRORS = (0.0, 1.0)


def prepare(data: Path, out: Path) -> list[Path]:
    """Makes the .blend files of all scenes that are there; exits with what is wrong."""
    out.mkdir(parents=True, exist_ok=True)
    jobs = []
    for name, pattern in SCENES.items():
        files = sorted(map(str, (data / "scenes").glob(pattern)))
        if files:
            jobs.append({"files": files, "out": str(out / f"{name}.blend")})
    if not jobs:
        sys.exit(f"real_scenes.py: no scene in {data / 'scenes'}")
    listed = out / "scenes.json"
    listed.write_text(json.dumps(jobs), "utf-8")
    command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
    command += ["--python", str(HERE / "real_scenes_in_blender.py"), "--", str(listed)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stdout[-3000:] + done.stderr[-3000:])
    return [Path(job["out"]) for job in jobs]


def render(
    blends: list[Path], out: Path, size: str, pixel_errors: Iterable[float]
) -> dict[str, dict[float, dict]]:
    """{scene: {Pixel Error: what batch.py reports on that picture}}"""
    shutil.rmtree(out / "store", ignore_errors=True)
    views, report = out / "views.json", out / "report.json"
    first = out / blends[0].stem  # of several files, each has its own
    wanted = [{"out": str(first / f"{t:g}px.png"), "pixel_error": t} for t in pixel_errors]
    views.write_text(json.dumps(wanted), "utf-8")
    command = ["/usr/bin/python3", str(ADDON / "batch.py"), "render", *map(str, blends)]
    command += ["--views", str(views), "--out", str(out), "--store", str(out / "store")]
    command += ["--size", size, "--json", str(report)]
    subprocess.run(command, check=False)
    whole = json.loads(report.read_text("utf-8"))
    found = {}
    for file in whole.get("files", [whole]):
        if len(file.get("pictures", ())) < len(wanted):
            sys.exit(f"real_scenes.py: {file['input']}: {file.get('message', 'no picture')}")
        pictures = {picture["pixel_error"]: picture for picture in file["pictures"]}
        found[Path(file["input"]).stem] = pictures
    return found


def header(made: dict) -> str:
    return (
        f"| scene, Pixel Error | occurrences ({' / '.join(made['cut']['kinds'])}) | triangles "
        "| scene MB | export | parse | trace | memory MB | mean | SSIM |\n"
        "|---|---|---|---|---|---|---|---|---|---|"
    )


def row(name: str, made: dict, empty: int, difference) -> str:
    cut, export, povray = made["cut"], made["export"], made["povray"]
    kinds = " / ".join(f"{count:,}" for count in cut["kinds"].values())
    memory = max(0, povray["peak_bytes"] - empty) / 1e6
    compared = " | " if difference is None else f"{difference.mean:.4f} | {difference.ssim:.3f}"
    return (
        f"| {name}, {made['pixel_error']:g} | {cut['occurrences']:,} ({kinds}) "
        f"| {cut['triangles']:,} | {export['bytes'] / 1e6:.1f} | {export['cpu_s']:.2f} "
        f"| {povray['parse_cpu_s']:.2f} | {povray['trace_cpu_s']:.2f} | {memory:.1f} "
        f"| {compared} |"
    )


def table(found: dict[str, dict[float, dict]], size: str) -> str:
    """A row for each picture: the first of a scene is what the others are compared with."""
    sys.path.insert(0, str(ADDON))
    import lodestone_native as native

    empty = native.povray_empty_bytes(*map(int, size.split("x")))
    lines = []
    for name, pictures in found.items():
        full, *others = pictures.values()
        lines = lines or [header(full)]
        lines.append(row(name, full, empty, None))
        for made in others:
            difference = native.image_compare(full["picture"], made["picture"])
            lines.append(row(name, made, empty, difference))
    return "\n".join(lines) + "\n"


def write_page(name: str, title: str, text: str, found: dict[str, dict[float, dict]]) -> None:
    """The page of samples/docs/results that shows these pictures' table."""
    sys.path.insert(0, str(HERE.parent / "tests" / "bench"))
    from benching import write_results

    measured = {
        scene: {
            f"{pixel_error:g}": {part: made[part] for part in ("cut", "export", "povray")}
            for pixel_error, made in pictures.items()
        }
        for scene, pictures in found.items()
    }
    lines = text.splitlines()
    write_results(HERE / "docs" / "results" / name, title, lines, {"scenes": measured})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder with scenes/ in it")
    parser.add_argument("--out", type=Path, default=HERE.parent / "build/real_scenes")
    parser.add_argument("--size", default="640x360", metavar="WxH")
    parser.add_argument("--prepare-only", action="store_true", help="only make the .blend files")
    parser.add_argument("--write", action="store_true", help="also the page of results")
    options = parser.parse_args()
    out = options.out.resolve()
    blends = prepare(options.data.resolve(), out)
    for blend in blends:
        print(blend)
    if options.prepare_only:
        return
    found = render(blends, out, options.size, PIXEL_ERRORS)
    text = table(found, options.size)
    (out / "report.md").write_text("# Real scenes\n\n" + text, "utf-8")
    print("\n" + text + f"\nreport: {out / 'report.md'}")
    if options.write:
        write_page("real_scenes", "Real scenes", text, found)


if __name__ == "__main__":
    main()
