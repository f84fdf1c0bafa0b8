# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of batch.py, and the pictures it asks for."""

import argparse
import json
import math
import re
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

ANTIALIAS = ("off", "final", "reference")
VIEW_KEYS = (
    "camera",
    "pixel_error",
    "antialias",
    "out",
    "false_color",
    "covered_only",
    "size",
)
_MAX_SIZE = 65536


@dataclass(frozen=True)
class PictureRequest:
    """One picture (or exported scene) of one input. `camera` "": the scene's own; `size` None: the
    scene's; `out`: the picture, or for export the folder."""

    out: str
    camera: str = ""
    pixel_error: float = 1.0
    antialias: str = "final"
    false_color: bool = False
    covered_only: bool = False
    size: tuple[int, int] | None = None

    def for_frame(self, frame: int) -> "PictureRequest":
        """out.png -> out_0001.png"""
        path = Path(self.out)
        return replace(self, out=str(path.with_name(f"{path.stem}_{frame:04}{path.suffix}")))


@dataclass(frozen=True)
class FileJob:
    """What one Blender is to do with one input."""

    verb: str
    file: str
    store: str
    report: str
    pictures: tuple[PictureRequest, ...]
    frames: tuple[int, int] | None = None
    threads: int = 0
    program: str = ""
    keep_exr: bool = False
    strict: bool = False

    def dump(self) -> str:
        return json.dumps(asdict(self))

    @classmethod
    def load(cls, text: str) -> "FileJob":
        values = json.loads(text)
        pictures = [
            PictureRequest(**{**p, "size": tuple(p["size"]) if p["size"] else None})
            for p in values["pictures"]
        ]
        frames = tuple(values["frames"]) if values["frames"] else None
        return cls(**{**values, "pictures": tuple(pictures), "frames": frames})


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(
        prog="batch.py",
        description="Builds levels, renders and exports .blend files without a window.",
        epilog="Exit codes: 0 done; 1 failed; 2 usage; 3 done, but the picture is incomplete "
        "somewhere; 4 input unreadable, or Blender died on it; 5 POV-Ray missing or failed; "
        "130 cancelled. Several files: 0, else 130, 1 or 3; each one's own code is in the report.",
    )
    verbs = top.add_subparsers(dest="verb", required=True, metavar="VERB")
    build = verbs.add_parser("build", help="build missing and changed levels into the store")
    render = verbs.add_parser("render", help="render pictures with POV-Ray")
    export = verbs.add_parser("export", help="write POV-Ray scenes")
    for verb in (build, render, export):
        verb.add_argument("files", nargs="+", metavar="FILE", help=".blend files")
        verb.add_argument("--store", metavar="DIR", help="folder of the levels (several files: a"
                          " folder in it for each); default: beside each file")  # fmt: skip
        verb.add_argument("--json", metavar="FILE", help="write the report here")
        verb.add_argument("--threads", type=_count, default=0, metavar="N", help="default: all")
        verb.add_argument("--strict", action="store_true", help="exit 1 instead of 3")
        verb.add_argument("--timeout", type=_positive, metavar="S", help="seconds for each file")
        verb.add_argument("--blender", metavar="PROGRAM", help="default: blender on the PATH")
    for verb in (render, export):
        verb.add_argument("--pixel-error", type=_pixels, default=1.0, metavar="PX",
                          help="largest deviation in the picture, in pixels; 0: originals; "
                          "default 1")  # fmt: skip
        verb.add_argument("--out", metavar="PATH", help="where it goes: for one picture the file, "
                          "else a folder")  # fmt: skip
        verb.add_argument("--frames", type=frame_range, metavar="A-B", help="default: the current")
        verb.add_argument("--camera", default="", metavar="NAME", help="default: the scene's")
        verb.add_argument("--size", type=size, metavar="WxH", help="default: the scene's")
        verb.add_argument("--antialias", choices=ANTIALIAS, default="final")
        verb.add_argument("--false-color", action="store_true", help="paint by kind and LOD number")
        verb.add_argument("--covered-only", action="store_true", help="without environment, world")
    render.add_argument("--views", metavar="FILE", help="JSON list of pictures to render from one "
                        f"reading of one file: objects of {', '.join(VIEW_KEYS)}")  # fmt: skip
    render.add_argument("--keep-exr", action="store_true", help="also keep the linear NAME.exr")
    render.add_argument("--povray", default="", metavar="PROGRAM", help="default: "
                        "$LODESTONE_POVRAY, else povray on the PATH")  # fmt: skip
    return top


def jobs(options: argparse.Namespace) -> list[FileJob]:
    """One job for each file. Raises ValueError with a sentence on what does not fit together."""
    names = [Path(file).stem for file in options.files]
    if len(set(names)) < len(names) and (options.store or options.verb != "build"):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two files are called {twice}: their results would share one name")
    return [_job(options, Path(file)) for file in options.files]


def _job(options: argparse.Namespace, file: Path) -> FileJob:
    several = len(options.files) > 1
    store = options.store or ""
    if store and several:
        store = str(Path(store) / file.stem)
    frames = getattr(options, "frames", None)
    pictures: tuple[PictureRequest, ...] = ()
    if getattr(options, "views", None):
        if several or frames:
            raise ValueError("--views goes with one file and no --frames")
        pictures = read_views(options.views, options)
    elif options.verb != "build":
        if not options.out:
            raise ValueError("--out is missing: where should it go?")
        pictures = (_request(options, file, several or frames is not None),)
    return FileJob(
        verb=options.verb,
        file=str(file.absolute()),
        store=str(Path(store).absolute()) if store else "",
        report="",
        pictures=pictures,
        frames=frames,
        threads=options.threads,
        program=getattr(options, "povray", ""),
        keep_exr=getattr(options, "keep_exr", False),
        strict=options.strict,
    )


def _request(options: argparse.Namespace, file: Path, in_folder: bool) -> PictureRequest:
    out = Path(options.out).absolute()
    if in_folder:
        out = out / (file.stem + (".png" if options.verb == "render" else ""))
    elif options.verb == "render" and out.suffix.lower() != ".png":
        raise ValueError(f"--out {options.out}: the picture is a .png")
    return PictureRequest(
        out=str(out),
        camera=options.camera,
        pixel_error=options.pixel_error,
        antialias=options.antialias,
        false_color=options.false_color,
        covered_only=options.covered_only,
        size=options.size,
    )


def read_views(path: str, options: argparse.Namespace) -> tuple[PictureRequest, ...]:
    """The pictures of a views file; what an entry leaves out comes from the command line."""
    try:
        entries = json.loads(Path(path).read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"--views {path}: {error}") from None
    if not isinstance(entries, list) or not entries:
        raise ValueError(f"--views {path}: a list of pictures is expected")
    pictures = [_view(path, number, entry, options) for number, entry in enumerate(entries)]
    if len({picture.out for picture in pictures}) < len(pictures):
        raise ValueError(f"--views {path}: two pictures have the same out")
    return tuple(pictures)


def _view(path: str, number: int, entry: Any, options: argparse.Namespace) -> PictureRequest:
    where = f"--views {path}: entry {number}"
    if not isinstance(entry, dict):
        raise ValueError(f"{where} is not an object")
    unknown = sorted(set(entry) - set(VIEW_KEYS))
    if unknown:
        raise ValueError(f"{where} has an unknown {unknown[0]} (known: {', '.join(VIEW_KEYS)})")
    out = entry.get("out")
    if not isinstance(out, str) or not out.lower().endswith(".png"):
        raise ValueError(f"{where}: out must name a .png")
    antialias = entry.get("antialias", options.antialias)
    if antialias not in ANTIALIAS:
        raise ValueError(f"{where}: antialias is one of {', '.join(ANTIALIAS)}")
    try:
        wanted = entry.get("size")
        chosen = options.size if wanted is None else size(_size_text(wanted))
        return PictureRequest(
            out=str(Path(out).absolute()),
            camera=str(entry.get("camera") or options.camera),
            pixel_error=_pixels(str(entry.get("pixel_error", options.pixel_error))),
            antialias=antialias,
            false_color=bool(entry.get("false_color", options.false_color)),
            covered_only=bool(entry.get("covered_only", options.covered_only)),
            size=chosen,
        )
    except argparse.ArgumentTypeError as error:
        raise ValueError(f"{where}: {error}") from None


def _size_text(value: Any) -> str:
    return "x".join(str(v) for v in value) if isinstance(value, list) else str(value)


def frame_range(text: str) -> tuple[int, int]:
    """A-B or one number."""
    found = re.fullmatch(r"(-?\d{1,7})(?:-(-?\d{1,7}))?", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text!r} is no range of frames like 1-24")
    first = int(found[1])
    last = int(found[2]) if found[2] is not None else first
    if last < first:
        raise argparse.ArgumentTypeError(f"{text!r} ends before it begins")
    return first, last


def size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,6})[xX](\d{1,6})", text)
    width, height = (int(found[1]), int(found[2])) if found else (0, 0)
    if not (0 < width <= _MAX_SIZE and 0 < height <= _MAX_SIZE):
        raise argparse.ArgumentTypeError(f"{text!r} is no size like 640x360")
    return width, height


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return value


def _pixels(text: str) -> float:
    value = _number(text)
    if not 0.0 <= value <= 1024.0:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 1024 pixels")
    return value


def _positive(text: str) -> float:
    value = _number(text)
    if value <= 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def _count(text: str) -> int:
    if not re.fullmatch(r"\d{1,4}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is no number of threads")
    return int(text)
