# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that nobody tuned to, beside Cycles: what a picture takes, and how far it is from Cycles'.

    /usr/bin/python3 tests/bench/peers/bench_real.py [--views zengarden/near ...] [--resume]
        [--pixel-errors 0 1 4] [--without-full SCENE/near ...] [--size 320 180] [--cache FOLDER]
        [--write]

A view is SCENE/near, SCENE/far or SCENE/over. Scenes are tracks of SuperTuxKart (the Debian package
supertuxkart-data, fetched into the cache, and LODESTONE_TOOLS/stk_scenes), files of LODESTONE_DATA
(scene cameras, so near alone) and three nights made here. Scenes, and the pictures of Cycles with
256 samples, are kept in the cache (LODESTONE_BENCH_CACHE, default ~/.cache/lodestone-bench).

Seconds are CPU of the whole process, without what opening the file takes; of what takes less than
4 s, opening included, the least of five rounds in which all are run in turns. Levels are built
before (the column says at which price); what earlier pictures found of the sky, masks and textures
is not there, as in the first picture of a scene.

Differences are the mean over covered pixels of the absolute difference of displayed values, 0...1,
to Cycles with 256 samples and the same diffuse bounces, by which Cycles with 16 samples is judged,
too; brightness is the ratio of the means. SSIM is that to our own full detail with 16 samples in
every pixel; views --without-full have neither it nor Pixel Error 0, which takes an hour there. What
is missing is skipped with a sentence; no number makes it fail.
"""

import argparse
import functools
import json
import math
import os
import resource
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

ROOT = benching.ROOT
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
ADDON = STAGE / "addons" / "lodestone"
TOOLS = Path(os.environ.get("LODESTONE_TOOLS") or ROOT.parent / "shared" / "tools")
DATA = Path(os.environ.get("LODESTONE_DATA") or ROOT.parent / "shared" / "data")
CACHE = Path(os.environ.get("LODESTONE_BENCH_CACHE") or Path.home() / ".cache" / "lodestone-bench")
INSIDE = Path(__file__).with_name("bench_real_blender.py")
GAME = Path("usr/share/games/supertuxkart/data")
TRACKS = (
    "black_forest", "cocoa_temple", "hacienda", "lighthouse", "minigolf", "ravenbridge_mansion",
    "snowmountain", "stk_enterprise", "zengarden",
)  # fmt: skip
NIGHTS = ("night_street", "night_tree", "night_hotel")
CAMERAS = {"near": "CamNear", "far": "CamFar", "over": "CamOver"}
DEFAULT = (
    "zengarden/near", "ravenbridge_mansion/near", "black_forest/far", "cocoa_temple/near",
    "snowmountain/over", "night_tree/near",
)  # fmt: skip
SAMPLES, CONVERGED = 16, 256
ROUNDS = 5
SHORT_S = 4.0  # two runs of one process differ by some 0.3 s: a tenth of this
TIMEOUT = 3600
# A user's: where Python may not keep what it compiled, every start compiles the add-on anew.
PLAIN = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}


class Missing(Exception):
    """What a view needs is not there; says what."""


def children_cpu() -> float:
    """CPU seconds of all processes that this one started and waited for, until now."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def cpu_of(command: list, log: Path, environment: dict | None = None) -> float:
    """CPU seconds of a command and all that it started and waited for. Raises Missing."""
    before = children_cpu()
    log.parent.mkdir(parents=True, exist_ok=True)
    with open(log, "wb") as out:
        done = subprocess.run(
            list(map(str, command)), stdin=subprocess.DEVNULL, stdout=out,
            stderr=subprocess.STDOUT, env={**PLAIN, **(environment or {})},
            timeout=TIMEOUT, check=False,
        )  # fmt: skip
    if done.returncode not in (0, 3):  # 3: incomplete, and named in the report
        raise Missing(f"{Path(str(command[0])).name} failed: {log}")
    return children_cpu() - before


class Timed(NamedTuple):
    """The CPU seconds of a process, and what it made."""

    cpu: float
    picture: Path = Path()
    report: dict = {}


def least_of_rounds(measures: dict[str, Callable[[], Timed]]) -> dict[str, Timed]:
    """The fastest of ROUNDS of each, in turns; what takes longer than SHORT_S is measured once."""
    least: dict[str, Timed] = {}
    for _ in range(ROUNDS):
        for name, measure in measures.items():
            before = least.get(name)
            if before is None or before.cpu <= SHORT_S:
                one = measure()
                least[name] = one if before is None or one.cpu < before.cpu else before
    return least


class Scenes:
    """The .blend files of scenes, made once."""

    def __init__(self, cache: Path) -> None:
        self.cache = cache

    def blend(self, name: str) -> Path:
        """The file of a scene. Raises Missing."""
        path = self.cache / "scenes" / name / f"{name}.blend"
        if name not in TRACKS and name not in NIGHTS:
            # Where it is made: the paths of its images are relative to that.
            path = self.cache / "data" / f"{name}.blend"
        if not path.is_file():
            path.parent.mkdir(parents=True, exist_ok=True)
            if name in TRACKS:
                self._track(name, path)
            elif name in NIGHTS:
                inside = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
                inside += ["--python", INSIDE, "--", "night", name, path]
                cpu_of(inside, path.with_suffix(".log"))
            else:
                self._of_data(path.parent)
        if not path.is_file():
            raise Missing(f"there is no scene {name}")
        return path

    def _track(self, name: str, path: Path) -> None:
        maker = TOOLS / "stk_scenes" / "stk_scenes.py"
        if not maker.is_file():
            raise Missing(f"there is no {maker}")
        command = ["blender", "-b", "--python-exit-code", "1", "-P", maker, "--"]
        cpu_of([*command, self.game(), name, path], path.with_suffix(".log"))

    def game(self) -> Path:
        """The game's data, unpacked from Debian's package; nothing is installed."""
        folder = self.cache / "supertuxkart"
        if not (folder / GAME / "tracks").is_dir():
            folder.mkdir(parents=True, exist_ok=True)
            get = ["apt-get", "download", "supertuxkart-data"]
            if subprocess.run(get, cwd=folder, capture_output=True, check=False).returncode != 0:
                raise Missing("apt-get download supertuxkart-data failed")
            for package in folder.glob("*.deb"):
                subprocess.run(["dpkg", "-x", package, folder], check=True)
                package.unlink()
        return folder / GAME

    @staticmethod
    def _of_data(out: Path) -> None:
        """The .blend files of the shared scenes, as samples/real_scenes.py makes them."""
        command = ["/usr/bin/python3", ROOT / "samples" / "real_scenes.py", "--prepare-only"]
        cpu_of([*command, "--data", DATA, "--out", out], out / "prepare.log")


class View:
    """One view of one scene: its pictures, and what they took."""

    def __init__(self, name: str, scenes: Scenes, options: argparse.Namespace) -> None:
        self.name, self.options = name, options
        scene, _, camera = name.partition("/")
        self.blend = scenes.blend(scene)
        self.camera = CAMERAS[camera or "near"] if scene in (*TRACKS, *NIGHTS) else ""
        size = "x".join(map(str, options.size))
        self.kept = scenes.cache / "cycles" / scene / f"{camera or 'near'}_{size}"
        self.out = options.out / scene / (camera or "near")
        self.kept.mkdir(parents=True, exist_ok=True)
        self.out.mkdir(parents=True, exist_ok=True)

    def opening(self) -> float:
        """What opening the file takes, Blender's start included."""
        command = ["blender", "-b", "--factory-startup", self.blend, "--python-expr", "pass"]
        return cpu_of(command, self.out / "open.log")

    def cycles(self, samples: int, transparent: bool = False) -> Path:
        """A picture by Cycles; kept, for it depends on nothing here."""
        kind = "mask" if transparent else "picture"
        picture = self.kept / f"cycles_{kind}_{samples}.png"
        if not picture.is_file():
            drawn = self.out / picture.name
            self.cycles_cpu(samples, drawn, transparent)
            shutil.move(drawn, picture)
        return picture

    def cycles_cpu(self, samples: int, picture: Path, transparent: bool = False) -> float:
        """The CPU of Cycles' process for a picture. Never kept: a machine is not as fast at one
        time as at another, so both programs are timed in one run."""
        job = {
            "camera": self.camera, "size": self.options.size, "out": str(picture),
            "samples": samples, "bounces": 0, "transparent": transparent,
        }  # fmt: skip
        asked = self.out / f"{picture.stem}.job"
        asked.write_text(json.dumps(job), "utf-8")
        command = ["blender", "-b", "--factory-startup", self.blend]
        command += ["--python-exit-code", "1", "--python", INSIDE, "--", "cycles", asked]
        return cpu_of(command, asked.with_suffix(".log"))

    @property
    def store(self) -> Path:
        return self.options.out / self.name.partition("/")[0] / "store"

    def forget(self) -> None:
        """Removes from the store what earlier pictures found."""
        for name in ("sky_light.bin", "masks.bin"):
            (self.store / name).unlink(missing_ok=True)
        shutil.rmtree(self.store / "baked", ignore_errors=True)

    def batch(self, verb: str, name: str, *more: str) -> tuple[dict, float]:
        """The report of batch.py and the CPU of all its processes."""
        report = self.out / f"{name}.json"
        command = ["/usr/bin/python3", ADDON / "batch.py", verb, self.blend, "--json", report]
        command += ["--store", self.store, *more]
        cpu = cpu_of(command, self.out / f"{name}.log")
        return json.loads(report.read_text("utf-8")), cpu

    def drawn(self, name: str, pixel_error: float, *more: str) -> Timed:
        """A picture, as the first one of its scene."""
        picture = self.out / f"{name}.png"
        report, cpu = self.seen("render", name, picture, pixel_error, *more)
        return Timed(cpu, picture, report)

    def seen(self, verb: str, name: str, out: Path, pixel_error: float, *more: str) -> tuple:
        """What batch() returns of a verb that looks through the camera, without earlier finds."""
        self.forget()
        words = ["--out", out, "--pixel-error", pixel_error, *more]
        words += ["--size", "x".join(map(str, self.options.size))]
        if self.camera:
            words += ["--camera", self.camera]
        return self.batch(verb, name, *map(str, words))

    def timed(self) -> dict[str, Timed]:
        """What opening the file, Cycles' picture and ours by their Pixel Errors take."""
        full = self.name not in self.options.without_full
        errors = [error for error in self.options.pixel_errors if full or error > 0]
        return least_of_rounds(
            {
                "opening": lambda: Timed(self.opening()),
                "cycles": lambda: Timed(self.cycles_cpu(SAMPLES, self.out / "cycles.png")),
                **{
                    f"{error:g}": functools.partial(self.drawn, f"{error:g}px", error)
                    for error in errors
                },
            }
        )

    def measure(self) -> dict:
        """All numbers of the view."""
        mask = self.cycles(4, transparent=True)
        converged = self.cycles(CONVERGED)
        noisy = self.cycles(SAMPLES)
        covered = pixels(mask)[:, :, 3] >= 0.5
        build, _ = self.batch("build", "build")
        full = self.name not in self.options.without_full
        if full:
            reference = self.drawn("reference", 0, "--antialias", "reference").picture
        timed = self.timed()
        opening, took = timed.pop("opening").cpu, timed.pop("cycles").cpu
        return {
            "opening_s": opening,
            "cycles_s": took - opening,
            "cycles": compared(noisy, converged, covered),
            "build_s": build.get("build", {}).get("cpu_s", 0.0),
            "ours": {
                error: {
                    "cpu_s": cpu - opening,
                    "reading_s": report["extract"]["cpu_s"],
                    "export_s": report["export"]["cpu_s"],
                    "parse_s": report["povray"]["parse_cpu_s"],
                    "trace_s": report["povray"]["trace_cpu_s"],
                    "memory_bytes": max(0, report["povray"]["peak_bytes"] - self.options.empty),
                    "triangles": report["cut"]["triangles"],
                    "ssim": self.options.native.image_compare(
                        str(reference), str(picture), str(mask)
                    ).ssim
                    if full
                    else None,
                    **compared(picture, converged, covered),
                }
                for error, (cpu, picture, report) in timed.items()
            },
        }


def pixels(path: Path) -> numpy.ndarray:
    """Displayed values, [rows][columns][4], 0...1. Raises Missing."""
    try:
        from PIL import Image
    except ModuleNotFoundError:
        raise Missing("there is no PIL (Debian: python3-pil)") from None

    return numpy.asarray(Image.open(path).convert("RGBA"), dtype=float) / 255


def compared(picture: Path, reference: Path, covered: numpy.ndarray) -> dict[str, float]:
    """Mean absolute difference and ratio of brightness over covered pixels."""
    ours, theirs = (pixels(path)[covered][:, :3] for path in (picture, reference))
    return {
        "difference": float(numpy.abs(ours - theirs).mean()),
        "brightness": float(ours.mean() / max(theirs.mean(), 1e-6)),
    }


def mean_ratio(ratios: Iterable[float]) -> float:
    """The geometric mean; 0 of nothing."""
    logs = [math.log(max(ratio, 1e-9)) for ratio in ratios]
    return math.exp(sum(logs) / len(logs)) if logs else 0.0


def table(found: dict[str, dict]) -> list[str]:
    """The rows of all views, and the goals below."""
    lines = [
        "| view | Pixel Error | CPU s | over Cycles | reading + export + parse + trace | memory MB "
        "| triangles | difference | Cycles' own | brightness | SSIM | levels built in |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name, view in found.items():
        for error, one in view["ours"].items():
            parts = " + ".join(
                f"{one[part + '_s']:.1f}" for part in ("reading", "export", "parse", "trace")
            )
            ssim = "-" if one["ssim"] is None else f"{one['ssim']:.3f}"
            lines.append(
                f"| {name} | {error} | {one['cpu_s']:.1f} "
                f"| {one['cpu_s'] / max(view['cycles_s'], 1e-3):.2f} | {parts} "
                f"| {one['memory_bytes'] / 1e6:.0f} | {one['triangles']:,} "
                f"| {one['difference']:.3f} | {view['cycles']['difference']:.3f} "
                f"| {one['brightness']:.2f} | {ssim} | {view['build_s']:.1f} |"
            )
    at_one = [view for view in found.values() if "1" in view["ours"]]
    if at_one:
        times = [view["ours"]["1"]["cpu_s"] / max(view["cycles_s"], 1e-3) for view in at_one]
        off = [
            view["ours"]["1"]["difference"] / max(view["cycles"]["difference"], 1e-3)
            for view in at_one
        ]
        bright = [view["ours"]["1"]["brightness"] for view in at_one]
        lines += [
            "",
            f"At 1 px, {len(at_one)} views: CPU over that of Cycles with {SAMPLES} samples "
            f"{mean_ratio(times):.2f} in the geometric mean (goal: <= 1, aim 0.5), at most "
            f"{max(times):.2f} (goal: <= 2); difference over Cycles' own {mean_ratio(off):.2f} "
            f"(goal: <= 1.5); brightness {mean_ratio(bright):.2f} in the geometric mean, "
            f"{min(bright):.2f} to {max(bright):.2f} (goal: within 0.05).",
        ]
    return lines


def options_of(
    arguments: list[str] | None = None, about: str = __doc__, errors: tuple[float, ...] = (0, 1, 4)
) -> argparse.Namespace:
    """The options of a bench of views; `errors`: its Pixel Errors where none are asked for."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("--views", nargs="+", default=list(DEFAULT), metavar="SCENE/CAMERA")
    parser.add_argument("--pixel-errors", nargs="+", type=float, default=list(errors))
    parser.add_argument(
        "--without-full", nargs="+", default=["black_forest/far"], metavar="SCENE/CAMERA"
    )
    parser.add_argument("--size", nargs=2, type=int, default=[320, 180], metavar=("W", "H"))
    parser.add_argument("--cache", type=Path, default=CACHE)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "bench" / "real")
    parser.add_argument("--resume", action="store_true", help="keep views that were measured")
    benching.add_write(parser, "povray_export")
    options = parser.parse_args(arguments)
    for view in options.views:
        if view.partition("/")[2] not in ("", *CAMERAS):
            parser.error(f"--views {view}: SCENE/near, SCENE/far or SCENE/over")
    options.cache, options.out = options.cache.resolve(), options.out.resolve()
    return options


def measured(
    options: argparse.Namespace, kept: str, measure: Callable[[str, Scenes], dict],
    table_of: Callable[[dict], list[str]],
) -> dict[str, dict]:  # fmt: skip
    """What `measure` finds of all views that are asked for, kept in a file of the bench's folder
    after each; a view of which something is missing is named and left out."""
    options.out.mkdir(parents=True, exist_ok=True)
    known = options.out / kept
    found: dict[str, dict] = {}
    if options.resume and known.is_file():
        found = json.loads(known.read_text("utf-8"))
    scenes = Scenes(options.cache)
    for name in options.views:
        if name in found:
            continue
        try:
            found[name] = measure(name, scenes)
        except Missing as error:
            print(f"{Path(sys.argv[0]).name}: {name} is skipped: {error}", file=sys.stderr)
            continue
        known.write_text(json.dumps(found, indent=1), "utf-8")
        print(*table_of({name: found[name]})[2:3], flush=True)
    return {name: found[name] for name in options.views if name in found}


def staged_native() -> ModuleType:
    """The binding of the built add-on. Exits where there is none."""
    if not ADDON.is_dir():
        sys.exit("build first (cmake --build --preset release)")
    sys.path.insert(0, str(ADDON))
    import lodestone_native as native

    return native


def main() -> None:
    options = options_of()
    options.native = staged_native()
    options.empty = options.native.povray_empty_bytes(*options.size)
    busy = benching.load()
    shown = measured(
        options, "views.json", lambda name, scenes: View(name, scenes, options).measure(), table
    )
    told = benching.Told()
    told.tell(f"{options.size[0]} x {options.size[1]}, Cycles with {SAMPLES} samples.\n")
    told.tell("\n".join(table(shown)))
    page = benching.results_path(options, "real_light")
    benching.write_results(
        page, "Real scenes beside Cycles", told, {"load_before": busy, "views": shown}
    )


if __name__ == "__main__":
    main()
