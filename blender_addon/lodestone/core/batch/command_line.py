# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of batch.py, and the jobs it asks for."""

import argparse
from argparse import BooleanOptionalAction
from dataclasses import replace
from pathlib import Path

from ..file_names import LONGEST, fitting, folder_name
from . import option_values
from .file_jobs import FileJob, PictureRequest
from .profile_file import read_profile
from .views_file import ANTIALIAS, NUMBERS, VIEW_KEYS, overrides_of, read_views, unseen_of

KEEP = ("failed", "never", "always")
_EPILOG = (
    "Precedence: command line, --profile, the file's own settings. "
    "Exit codes: 0 done; 1 failed, too slow or too large; 2 usage; 3 done, but the picture is "
    "incomplete somewhere; 4 input unreadable, or Blender died on it; 5 POV-Ray missing or failed; "
    "130 cancelled. Several files: 0, else 130, 1 or 3; each one's own code is in the report."
)


def parse(arguments: list[str]) -> argparse.Namespace:
    """The options, filled up from the profile. Exits with 2 and a sentence on a mistake."""
    top, verbs = _parsers()
    options = top.parse_args(arguments)
    if options.profile:
        verb = verbs[options.verb]
        try:
            values = read_profile(options.profile, verb, verbs.values())
        except ValueError as error:
            verb.error(str(error))
        verb.set_defaults(**values)
        options = top.parse_args(arguments)
    if options.resume and not options.log:
        verbs[options.verb].error("--resume goes with --log FILE: the log of the run to go on with")
    return options


def parser() -> argparse.ArgumentParser:
    return _parsers()[0]


def _parsers() -> tuple[argparse.ArgumentParser, dict[str, argparse.ArgumentParser]]:
    top = argparse.ArgumentParser(
        prog="batch.py",
        description="Builds levels, renders, compares and exports .blend files without a window.",
        epilog=_EPILOG,
    )
    verbs = top.add_subparsers(dest="verb", required=True, metavar="VERB")
    build = verbs.add_parser("build", help="build missing and changed levels into the store")
    render = verbs.add_parser("render", help="render pictures with POV-Ray")
    export = verbs.add_parser("export", help="write POV-Ray scenes")
    compare = verbs.add_parser("compare", help="render originals and levels, and tell how they "
                               "differ")  # fmt: skip
    for verb in (build, render, export, compare):
        _add_common(verb)
    for verb in (render, export, compare):
        _add_picture(verb)
    for verb in (render, export):
        _add_content(verb)
    for verb in (render, compare):
        _add_povray(verb)
    _add_render(render)
    return top, {"build": build, "render": render, "export": export, "compare": compare}


def _add_common(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("files", nargs="+", metavar="FILE", help=".blend files")
    verb.add_argument("--store", metavar="DIR", help="folder of the levels (several files: a"
                      " folder in it for each); default: beside each file")  # fmt: skip
    verb.add_argument("--profile", metavar="FILE", help="JSON object of options, by their long "
                      "names with _ for -; the command line wins over it")  # fmt: skip
    verb.add_argument("--strict", action=BooleanOptionalAction, default=False, help="exit 1 "
                      "instead of 3")  # fmt: skip
    verb.add_argument("--trust-scripts", action=BooleanOptionalAction, default=False,
                      help="run the scripts and drivers of the files; they may do anything you "
                      "may")  # fmt: skip
    run = verb.add_argument_group("the run")
    run.add_argument("--jobs", type=option_values.children, default=1, metavar="N",
                     help="files at once; default 1")  # fmt: skip
    run.add_argument("--threads", type=option_values.threads, default=0, metavar="N",
                     help="for each file; default: all, shared among the jobs")  # fmt: skip
    run.add_argument("--timeout", type=option_values.positive, metavar="S",
                     help="seconds for each file")  # fmt: skip
    run.add_argument("--max-memory", type=option_values.memory, metavar="SIZE",
                     help="8G, 500M: for each file, Blender and POV-Ray together; one above it is "
                     "stopped"
                     )  # fmt: skip
    run.add_argument("--resume", action="store_true", help="skip what --log says was done, if its "
                     "inputs and settings are unchanged")  # fmt: skip
    run.add_argument("--blender", metavar="PROGRAM", help="default: blender on the PATH")
    run.add_argument("--json", metavar="FILE", help="write the report here")
    run.add_argument("--log", metavar="FILE", help="append one line of JSON for everything "
                     "finished")  # fmt: skip
    run.add_argument("--html", metavar="FILE", help="write one page of all files, failed first")


def _add_picture(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--pixel-error", type=option_values.pixels, metavar="PX",
                      help="largest deviation in the picture, in pixels; 0: originals; "
                      "default: the file's")  # fmt: skip
    verb.add_argument("--out", metavar="PATH", help="where it goes: for one picture the file, "
                      "else a folder")  # fmt: skip
    verb.add_argument("--frames", type=option_values.frame_range, metavar="A-B",
                      help="default: the current")  # fmt: skip
    verb.add_argument("--camera", default="", metavar="NAME", help="default: the scene's")
    verb.add_argument("--size", type=option_values.size, metavar="WxH",
                      help="default: the scene's")  # fmt: skip
    verb.add_argument("--antialias", choices=ANTIALIAS, help="default: the file's")
    for control in NUMBERS:
        verb.add_argument("--" + control.key.replace("_", "-"), type=option_values.control(control),
                          metavar="PX" if control.unit else "N",
                          help=f"overrides {control.label}; default: the file's")  # fmt: skip
    verb.add_argument("--budget", type=option_values.memory, metavar="SIZE", help="50M, 2G: what "
                      "POV-Ray's scene may take; the Pixel Error grows until it fits"
                      )  # fmt: skip
    verb.add_argument("--off-screen", type=option_values.off_screen, metavar="HOW", help="how fine "
                      "what the picture does not show is: full, reflected (as shadows and mirrors "
                      "need) or shadows; default: the file's")  # fmt: skip
    verb.add_argument("--ray-classes", type=option_values.ray_classes, metavar="LIST", help="which "
                      "rays may meet coarser levels than the camera's: shadow, reflection or both "
                      "with a comma, or none; default: the file's")  # fmt: skip


def _add_content(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--false-color", action=BooleanOptionalAction, default=False,
                      help="paint by kind and LOD number")  # fmt: skip
    verb.add_argument("--covered-only", action=BooleanOptionalAction, default=False,
                      help="without environment, world")  # fmt: skip


def _add_render(render: argparse.ArgumentParser) -> None:
    render.add_argument("--views", metavar="FILE", help="JSON list of pictures to render from one "
                        f"reading: objects of {', '.join(VIEW_KEYS)}; several files: each's in "
                        "a folder of its own in --out")  # fmt: skip
    render.add_argument("--skip-existing", action=BooleanOptionalAction, default=False,
                        help="leave alone every picture that is there and whole")  # fmt: skip
    render.add_argument("--keep-exr", action=BooleanOptionalAction, default=False,
                        help="also keep the linear NAME.exr")  # fmt: skip


def _add_povray(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--keep", choices=KEEP, default="failed", help="files of the POV-Ray "
                      "scenes, beside the levels; default: of failed ones")  # fmt: skip
    verb.add_argument("--povray", default="", metavar="PROGRAM", help="default: "
                      "$LODESTONE_POVRAY, else povray on the PATH")  # fmt: skip


def jobs(options: argparse.Namespace) -> list[FileJob]:
    """One job for each file. Raises ValueError with a sentence on what does not fit together."""
    if len({Path(file).absolute() for file in options.files}) < len(options.files):
        raise ValueError("one file is named twice")
    names = [Path(file).stem for file in options.files]
    if len(set(names)) < len(names) and (options.store or options.verb != "build"):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two files are called {twice}: their results would share one name")
    return [_job(options, Path(file)) for file in options.files]


def _job(options: argparse.Namespace, file: Path) -> FileJob:
    several = len(options.files) > 1
    store = options.store or ""
    if store and several:
        store = str(Path(store) / folder_name(file))
    frames = getattr(options, "frames", None)
    pictures: tuple[PictureRequest, ...] = ()
    if getattr(options, "views", None):
        if frames:
            raise ValueError("--views goes without --frames")
        pictures = read_views(options.views, options)
        if several:
            pictures = _in_folders(pictures, options.out, file)
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
        keep=getattr(options, "keep", "failed"),
        keep_exr=getattr(options, "keep_exr", False),
        strict=options.strict,
        trust_scripts=options.trust_scripts,
    )


def _in_folders(
    pictures: tuple[PictureRequest, ...], out: str | None, file: Path
) -> tuple[PictureRequest, ...]:
    """The views of one of several files: their names, in a folder of the file's."""
    if not out:
        raise ValueError("--views of several files needs --out, a folder: theirs go into it")
    folder = Path(out).absolute() / folder_name(file)
    moved = tuple(replace(p, out=str(folder / Path(p.out).name)) for p in pictures)
    if len({picture.out for picture in moved}) < len(moved):
        raise ValueError("--views: two pictures have the same name, so they need one file each")
    return moved


def _request(options: argparse.Namespace, file: Path, in_folder: bool) -> PictureRequest:
    out = Path(options.out).absolute()
    if in_folder:
        picture = options.verb != "export"
        out = out / (fitting(file.stem, LONGEST - 4) + ".png" if picture else folder_name(file))
    elif options.verb != "export" and out.suffix.lower() != ".png":
        raise ValueError(f"--out {options.out}: the picture is a .png")
    return PictureRequest(
        out=str(out),
        camera=options.camera,
        pixel_error=options.pixel_error,
        antialias=options.antialias,
        overrides=overrides_of(vars(options)),
        budget=options.budget,
        **unseen_of(vars(options)),
        false_color=getattr(options, "false_color", False),
        covered_only=getattr(options, "covered_only", False),
        size=options.size,
    )
