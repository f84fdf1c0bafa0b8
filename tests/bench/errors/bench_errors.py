# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether errors are true: every level of real scenes, seen from as near as it is used.

    /usr/bin/python3 tests/bench/errors/bench_errors.py [--scenes NAME ...] [--most 400]
        [--cache FOLDER] [--json FILE] [--write]

Builds `bench_errors` in build/release and the levels of each scene (those of bench_real.py), anew.
Every level, or `most` of a scene's, evenly, is looked at from 26 directions, from the nearest place
from which a pixel is as large as its error: how far is what a pixel shows of the finest from the
level, or of the level from the finest? The 99.9 % quantile of the pixels of the worst direction,
over the error, is to be 1.5 at most. The ten worst are drawn in build/bench/errors/worst.png: the
finest, the level, and red what is farther off. Composites, and what is seen through, are told
apart: their errors are those of pictures, and the edge of a mask is known to an eighth of its
triangle alone. No number makes it fail.
"""

import argparse
import json
import shutil
import subprocess
import sys
from array import array
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
from bench.peers import bench_real  # noqa: E402

BUILD = benching.ROOT / "build" / "release"
PROGRAM = BUILD / "tests" / "bench_errors"
SCENES = (
    "armory-race-track", "kaykit-city-bits", "tps-forklift", "zengarden", "ravenbridge_mansion",
    "cocoa_temple", "minigolf", "black_forest",
)  # fmt: skip
GOAL = 1.5
WORST = 10


class LevelSeen(NamedTuple):
    """A level, and what is seen of it: a line of the program."""

    scene: str
    line: dict

    @property
    def times(self) -> float:
        """What is seen, over the error. Where one of both shows nothing, it is as far as it is
        large."""
        seen = self.line["seen"]
        return (self.line["size"] if seen is None else seen) / self.line["error"]

    @property
    def kind(self) -> str:
        if self.line["kind"] == "composite":
            return "composites"
        if self.line["clear"]:
            return "seen through"
        return "groups" if self.line["group"] else "objects"


KINDS = ("objects", "groups", "seen through", "composites")


def levels_of(scene: str, store: Path, most: int) -> list[LevelSeen]:
    run = subprocess.run(
        [PROGRAM, store, "--most", str(most)], check=True, capture_output=True, text=True
    )
    return [LevelSeen(scene, json.loads(line)) for line in run.stdout.splitlines()]


def row(name: str, levels: list[LevelSeen]) -> list[str]:
    times = sorted(level.times for level in levels)
    if not times:
        return []
    at95 = times[int(0.95 * (len(times) - 1))]
    within = [sum(one <= most for one in times) for most in (1.05, GOAL)]
    cells = [name, levels[0].kind, len(times), *within, f"{at95:.2f}", f"{times[-1]:.3g}"]
    return [" | ".join(map(str, cells)).join(("| ", " |"))]


def table(found: dict[str, list[LevelSeen]]) -> list[str]:
    lines = [
        f"| scene | levels of | levels | within the error | within {GOAL} times | 95 % | worst |",
        "|---|---|---|---|---|---|---|",
    ]
    everything = [level for levels in found.values() for level in levels]
    for name, levels in [*found.items(), ("all", everything)]:
        for kind in KINDS:
            lines += row(name, [level for level in levels if level.kind == kind])
    return lines


def worst_lines(worst: list[LevelSeen]) -> list[str]:
    lines = [
        "| scene | object | LOD | kind | triangles | error, m | seen, m | times | of the picture |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for level in worst:
        one = level.line
        name = one["object"].replace("|", "/")
        seen = level.times * one["error"]
        lines.append(
            f"| {level.scene} | {name} | {one['lod']} | {one['kind']} | {one['triangles']:,} of "
            f"{one['of']:,} | {one['error']:.3g} | {seen:.3g} | {level.times:.2f} | "
            f"{100 * one['share']:.1f} % |"
        )
    return lines


def draw(worst: list[LevelSeen], stores: dict[str, Path], out: Path) -> None:
    """The worst levels below each other, two in a row."""
    native = bench_real.staged_native()
    tiles = []
    for number, level in enumerate(worst):
        tile = out / f"worst_{number}.png"
        one = level.line
        asked = ["--picture", tile, "--object", one["object"], "--lod", str(one["lod"])]
        subprocess.run([PROGRAM, stores[level.scene], *asked], check=True)
        tiles.append(native.image_read(str(tile)))
    if not tiles:
        return
    width, height = tiles[0].width, tiles[0].height
    rows = (len(tiles) + 1) // 2
    white = array("f", [1.0]) * (8 * width * rows * height)
    sheet = native.Image(2 * width, rows * height, white)
    for number, tile in enumerate(tiles):
        left, top = number % 2 * width, number // 2 * height
        for y in range(height):
            to = 4 * ((top + y) * sheet.width + left)
            sheet.pixels[to : to + 4 * width] = tile.pixels[4 * y * width : 4 * (y + 1) * width]
    native.image_write_png(str(out / "worst.png"), sheet)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--most", type=int, default=400, help="levels of a scene")
    parser.add_argument("--cache", type=Path, default=bench_real.CACHE)
    parser.add_argument("--json", type=Path)
    benching.add_write(parser, "backend")
    options = parser.parse_args()
    build = ["cmake", "--build", "--preset", "release", "--target", "bench_errors"]
    subprocess.run(build, check=True, cwd=benching.ROOT, capture_output=True)
    out = benching.ROOT / "build" / "bench" / "errors"
    scenes = bench_real.Scenes(options.cache)
    found: dict[str, list[LevelSeen]] = {}
    stores: dict[str, Path] = {}
    for scene in options.scenes:
        stores[scene] = out / scene
        shutil.rmtree(stores[scene], ignore_errors=True)
        stores[scene].parent.mkdir(parents=True, exist_ok=True)
        try:
            command = ["/usr/bin/python3", bench_real.ADDON / "batch.py", "build"]
            command += [scenes.blend(scene), "--store", stores[scene]]
            bench_real.cpu_of(command, out / f"{scene}.log")
        except bench_real.Missing as why:
            print(f"{scene}: skipped: {why}")
            continue
        found[scene] = levels_of(scene, stores[scene], options.most)
        print("\n".join(table({scene: found[scene]})[2:]), flush=True)
    solid = [level for levels in found.values() for level in levels if level.kind in KINDS[:2]]
    worst = sorted(solid, key=lambda level: -level.times)[:WORST]
    draw(worst, stores, out)
    lines = [*table(found), "", f"The {WORST} worst of what is solid:", "", *worst_lines(worst)]
    print("\n".join(lines))
    data = {scene: [level.line for level in levels] for scene, levels in found.items()}
    if options.json:
        benching.write(options.json, benching.load(), {"levels": data})
    if options.write:
        counts = {kind: sum(level.kind == kind for level in solid) for kind in KINDS[:2]}
        path = benching.results_path(options, "errors")
        benching.write_results(path, "True errors", lines, {"levels": counts, "goal": GOAL})


if __name__ == "__main__":
    main()
