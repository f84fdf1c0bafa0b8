# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of batch.py's verbs, in the groups that verbs share."""

from argparse import ArgumentParser, BooleanOptionalAction

from ...picture.unseen_detail import CLASSES
from .. import option_values
from ..views_file import ANTIALIAS, NUMBERS, VIEW_KEYS

KEEP = ("failed", "never", "always")


def add_common(verb: ArgumentParser) -> None:
    """Declares what every verb takes."""
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


def add_picture(verb: ArgumentParser) -> None:
    """Declares what every picture or scene for a camera takes."""
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
                      "rays may meet coarser levels than the camera's: any of "
                      f"{', '.join(one.word for one in CLASSES)}, with commas between, or none; "
                      "default: the file's")  # fmt: skip


def add_content(verb: ArgumentParser) -> None:
    """Declares what is to be in the picture."""
    verb.add_argument("--false-color", action=BooleanOptionalAction, default=False,
                      help="paint by kind and LOD number")  # fmt: skip
    verb.add_argument("--covered-only", action=BooleanOptionalAction, default=False,
                      help="without environment, world")  # fmt: skip


def add_render(render: ArgumentParser) -> None:
    """Declares what only single pictures take."""
    render.add_argument("--views", metavar="FILE", help="JSON list of pictures to render from one "
                        f"reading: objects of {', '.join(VIEW_KEYS)}; several files: each's in "
                        "a folder of its own in --out")  # fmt: skip
    render.add_argument("--skip-existing", action=BooleanOptionalAction, default=False,
                        help="leave alone every picture that is there and whole")  # fmt: skip
    render.add_argument("--keep-exr", action=BooleanOptionalAction, default=False,
                        help="also keep the linear NAME.exr")  # fmt: skip


def add_povray(verb: ArgumentParser) -> None:
    """Declares how POV-Ray is run."""
    verb.add_argument("--keep", choices=KEEP, default="failed", help="files of the POV-Ray "
                      "scenes, beside the levels; default: of failed ones")  # fmt: skip
    verb.add_argument("--povray", default="", metavar="PROGRAM", help="default: "
                      "$LODESTONE_POVRAY, else povray on the PATH")  # fmt: skip
