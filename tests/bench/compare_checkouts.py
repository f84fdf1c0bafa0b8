# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two checkouts make the same bits: the stores and POV-Ray scenes of whole samples.

    /usr/bin/python3 tests/bench/compare_checkouts.py BEFORE AFTER [--quick]

Both checkouts are built. The street and the real scenes ($LODESTONE_DATA, default ../shared/data)
become .blend files once, by the samples of BEFORE. Each checkout builds their levels into a new
store and exports each camera, on one thread, for the numbers of materials go by the order in which
threads finish. All files are then compared byte by byte, up to their names (same_bits.py). What
BEFORE made is kept below --out as long as its commit and the samples are the same. Exit code 1: a
file differs or AFTER fails; 2: there is nothing to compare.
"""

import argparse
import hashlib
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from bench import same_bits  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
DATA = Path(os.environ.get("LODESTONE_DATA") or ROOT.parent / "shared" / "data")
STAGE = Path("build/release/stage")
BATCH = STAGE / "addons/lodestone/batch.py"
CAMERAS = ("far", "middle", "near")
RAYS = ("--ray-classes", "shadow,reflection", "--shadows", "1", "--reflections", "1")
RAYS += ("--off-screen", "shadows")
SMALL_SCENES = 2
MADE = (0, 3)  # exit codes of batch.py: done, and done but something is missing in the picture
SHOWN_FILES = 8
KEPT_FORMAT = 1  # raise it when the same plan makes other files


class Unusable(Exception):
    """Nothing can be compared."""


class Failed(Exception):
    """A checkout could not do its part."""


@dataclass(frozen=True)
class Scene:
    blend: Path
    exports: tuple[tuple[str, tuple[str, ...]], ...]  # folder, options of batch.py

    @property
    def name(self) -> str:
        return self.blend.stem


# ---- What is made ----


def street_exports(quick: bool) -> tuple:
    def of(camera: str, pixel_error: str, *more: str) -> tuple:
        return ("--camera", camera, "--pixel-error", pixel_error, *more)

    if quick:
        return (("far_1px", of("far", "1")), ("far_rays", of("far", "1", *RAYS)))
    each = [(f"{camera}_1px", of(camera, "1")) for camera in CAMERAS]
    each += [(f"{camera}_rays", of(camera, "1", *RAYS)) for camera in CAMERAS[1:]]
    return (*each, ("far_rays", of("far", "1", *RAYS)), ("far_0px", of("far", "0")))


def real_exports() -> tuple:
    return (("1px", ("--pixel-error", "1")), ("rays", ("--pixel-error", "1", *RAYS)))


def chosen(wanted: list[str], quick: bool, street: Path, real: list[Path]) -> list[Scene]:
    """The scenes that are compared; Unusable when one is not there."""
    known = {path.stem: path for path in real}
    unknown = set(wanted) - {"street", "real", *known}
    if unknown or ("real" in wanted and not real):
        missing = ", ".join(sorted(unknown) or ["real"])
        raise Unusable(
            f"no such scene: {missing}; there are street, {', '.join(known) or 'no real'}"
        )
    names = set(wanted)
    if "real" in wanted:
        sizes = sorted(real, key=lambda path: (path.stat().st_size, path.stem))
        names |= {path.stem for path in (sizes[:SMALL_SCENES] if quick else sizes)}
    found = [Scene(street, street_exports(quick))] if "street" in names else []
    return found + [Scene(known[name], real_exports()) for name in sorted(known.keys() & names)]


def run(command: list[str], log: Path, **environment: str) -> int:
    """The exit code; what is said goes to the log."""
    clean = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    clean |= {"PYTHONDONTWRITEBYTECODE": "1", "LC_ALL": "C.UTF-8", **environment}
    with log.open("ab") as file:
        file.write(f"\n$ {' '.join(command)}\n".encode())
        file.flush()
        done = subprocess.run(
            command, env=clean, stdin=subprocess.DEVNULL, stdout=file, stderr=file, check=False
        )
    return done.returncode


def end_of(log: Path) -> str:
    return "\n".join(log.read_text("utf-8", "replace").splitlines()[-15:])


def cpu_s() -> float:
    """CPU seconds of all that ran so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


# ---- A checkout ----


class Checkout:
    def __init__(self, path: Path) -> None:
        self.path = path.resolve()
        if not (self.path / BATCH).is_file():
            raise Unusable(
                f"{self.path} is not built; build it with:\n"
                f"    cd {self.path} && cmake --preset release && cmake --build --preset release"
            )

    def commit(self) -> str | None:
        """The commit that is checked out; None when files differ from it."""
        if self._git("status", "--porcelain") != "":
            return None
        return self._git("rev-parse", "HEAD")

    def _git(self, *arguments: str) -> str | None:
        command = ["git", "-C", str(self.path), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.stdout.strip() if done.returncode == 0 else None

    def digest(self) -> str:
        """What is staged: a checkout can be cleaner than what was built from it."""
        return digest_of((self.path / STAGE).rglob("*"), self.path / STAGE)

    def make(self, scene: Scene, folder: Path) -> list[int]:
        """Builds and exports the scene below the folder; exit codes."""
        files = folder / "files"
        store = ["--store", str(files / "store"), "--threads", "1"]
        codes = [self._batch(folder, "build", scene.blend, *store)]
        for name, options in scene.exports:
            out = ["--out", str(files / name)]
            codes.append(self._batch(folder, "export", scene.blend, *store, *options, *out))
        set_aside_logs(files, folder)
        return codes

    def _batch(self, folder: Path, verb: str, blend: Path, *options: str) -> int:
        log = folder / "log.txt"
        folder.mkdir(parents=True, exist_ok=True)
        command = ["/usr/bin/python3", str(self.path / BATCH), verb, str(blend), *options]
        code = run(command, log, LODESTONE_STAGE=str(self.path / STAGE))
        if code not in MADE:
            raise Failed(f"batch.py {verb} ended with exit code {code}:\n{end_of(log)}")
        return code


def set_aside_logs(files: Path, folder: Path) -> None:
    """batch.py writes a log with times beside a store and a scene; only what is in them counts."""
    for log in files.glob("*.log"):
        log.rename(folder / log.name)


def digest_of(paths, top: Path) -> str:
    whole = hashlib.blake2b(digest_size=16)
    for path in sorted(paths):
        if path.is_file() and "__pycache__" not in path.parts:
            whole.update(f"{path.relative_to(top)} {path.stat().st_size}\n".encode())
            whole.update(path.read_bytes())
    return whole.hexdigest()


# ---- The .blend files ----


def make_blends(before: Checkout, out: Path, street: bool, real: bool) -> tuple[Path, list[Path]]:
    """The street and the real scenes, as far as they are wanted."""
    out.mkdir(parents=True, exist_ok=True)
    samples = before.path / "samples"
    found: list[Path] = []
    if street:
        digest = digest_of((samples / "street").glob("*.py"), samples)
        found = _kept(out / "street", digest, lambda folder: _make_street(before, folder))
    if real:
        if not (DATA / "scenes").is_dir():
            raise Unusable(f"no real scenes in {DATA}: set LODESTONE_DATA, or --scenes street")
        scripts = digest_of(samples.glob("real_scenes*.py"), samples)
        digest = scripts + digest_of((DATA / "scenes").rglob("*"), DATA)
        found += _kept(out / "real", digest, lambda folder: _make_real(before, folder))
    return out / "street" / "street.blend", [path for path in found if path.stem != "street"]


def _kept(place: Path, digest: str, make) -> list[Path]:
    """The .blend files of a folder, made again when what they are made of changed."""
    mark = place / "made_of.txt"
    if not mark.is_file() or mark.read_text("utf-8") != digest:
        shutil.rmtree(place, ignore_errors=True)
        with tempfile.TemporaryDirectory(dir=place.parent) as name:
            folder = Path(name) / place.name
            folder.mkdir()
            make(folder)
            (folder / "made_of.txt").write_text(digest, "utf-8")
            folder.rename(place)
    return sorted(place.glob("*.blend"))


def _make_street(before: Checkout, folder: Path) -> None:
    command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python"]
    command += [str(before.path / "samples/street/make_street.py"), "--"]
    command += ["--out", str(folder / "street.blend"), "--json", str(folder / "street.json")]
    log = folder / "log.txt"
    if run(command, log, BLENDER_USER_SCRIPTS=str(before.path / STAGE)) != 0:
        raise Unusable(f"the street cannot be made:\n{end_of(log)}")


def _make_real(before: Checkout, folder: Path) -> None:
    command = ["/usr/bin/python3", str(before.path / "samples/real_scenes.py"), "--prepare-only"]
    command += ["--data", str(DATA), "--out", str(folder)]
    log = folder / "log.txt"
    if run(command, log, LODESTONE_STAGE=str(before.path / STAGE)) != 0:
        raise Unusable(f"the real scenes cannot be made:\n{end_of(log)}")


# ---- Comparing ----


def reference(before: Checkout, scene: Scene, out: Path) -> tuple[Path, list[int]]:
    """What BEFORE makes of a scene, and its exit codes; kept while nothing changed."""
    commit = before.commit()
    plan = [KEPT_FORMAT, commit, before.digest(), scene.exports, digest_of([scene.blend], out)]
    key = hashlib.blake2b(json.dumps(plan).encode(), digest_size=8).hexdigest()
    place = out / "before" / f"{scene.name}-{key}"
    if commit is None or not (place / "codes.json").is_file():
        _made(before, scene, place)
    return place / "files", json.loads((place / "codes.json").read_text("utf-8"))


def _made(checkout: Checkout, scene: Scene, place: Path) -> None:
    """Fills the folder; it is there only when all was made."""
    place.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=place.parent) as name:
        folder = Path(name) / "made"
        codes = checkout.make(scene, folder)
        (folder / "codes.json").write_text(json.dumps(codes), "utf-8")
        shutil.rmtree(place, ignore_errors=True)
        folder.rename(place)


def compare_scene(
    before: Checkout, after: Checkout, scene: Scene, out: Path, ignore: re.Pattern | None
) -> bool:
    """Says how the scene differs; true when it does not."""
    started = cpu_s()
    try:
        expected, codes = reference(before, scene, out)
    except Failed as error:
        raise Unusable(f"{scene.name}: BEFORE: {error}") from error
    between = cpu_s()
    place = out / "after" / after.path.name / scene.name
    try:
        _made(after, scene, place)
    except Failed as error:
        print(f"{scene.name}: AFTER: {error}", flush=True)
        return False
    verdict = same_bits.compare(expected, place / "files", ignore)
    found = json.loads((place / "codes.json").read_text("utf-8"))
    if found != codes:
        verdict.differences.append(f"exit codes: {codes}, then {found}")
    for text in verdict.differences[:SHOWN_FILES]:
        print(f"  {text}")
    if len(verdict.differences) > SHOWN_FILES:
        print(f"  ... of {same_bits.suffixes(verdict)}; {expected} and {place / 'files'}")
    took = f"CPU {between - started:.0f} s before, {cpu_s() - between:.0f} s after"
    print(f"{same_bits.summary(scene.name, verdict)} ({took})", flush=True)
    return not verdict.differences


def options_of(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", metavar="BEFORE", type=Path, help="a built checkout")
    parser.add_argument("after", metavar="AFTER", type=Path, help="another one")
    parser.add_argument(
        "--scenes", nargs="+", default=["street", "real"], metavar="NAME", help="street, real, NAME"
    )
    parser.add_argument("--out", type=Path, default=ROOT / "build/bench/compare")
    parser.add_argument(
        "--ignore", action="append", default=[], metavar="REGEX", help="lines that may differ"
    )
    parser.add_argument(
        "--quick", action="store_true", help="the far camera and the two smallest real scenes"
    )
    options = parser.parse_args(arguments)
    try:
        options.ignore = re.compile("|".join(f"(?:{text})" for text in options.ignore))
    except re.error as error:
        parser.error(f"--ignore: {error}")
    options.ignore = options.ignore if options.ignore.pattern else None
    return options


def main(arguments: list[str]) -> int:
    options = options_of(arguments)
    out = options.out.resolve()
    try:
        before, after = Checkout(options.before), Checkout(options.after)
        names = set(options.scenes)
        street, real = make_blends(before, out / "blends", "street" in names, names != {"street"})
        same = True
        for scene in chosen(options.scenes, options.quick, street, real):
            same &= compare_scene(before, after, scene, out, options.ignore)
    except Unusable as error:
        print(f"compare_checkouts.py: {error}", file=sys.stderr)
        return 2
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
