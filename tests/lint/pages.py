# SPDX-License-Identifier: GPL-3.0-or-later
"""The check of pages: measured figures, lengths, links and names of files. What a check returns is
wrong; empty = right."""

import re
from collections.abc import Collection
from pathlib import PurePosixPath

from check_layers import FLOORS

LONGEST_README = 90
# Pages that may hold figures: results, the notebook, what has changed.
MAY_HOLD_FIGURES = re.compile(r"(.*/)?docs/results/[^/]+\.md|(.*/)?(EXPERIMENTS|CHANGELOG)\.md")
# Pages that tell of earlier days name files by the names of their day.
TELL_OF_OTHER_DAYS = MAY_HOLD_FIGURES
# What a program writes into a page stands between two such marks.
WRITTEN = re.compile(r"<!-- (\w+):begin -->.*?<!-- \1:end -->", re.DOTALL)
FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)

NUMBER = r"(?<![\w.,/-])\d*[.,]?\d+"
FIGURES = [
    re.compile(pattern)
    for pattern in (
        rf"{NUMBER}\s?CPU (ms|s|min|seconds?|minutes?)\b",
        rf"{NUMBER}\s?(ms|µs|us|ns|(milli|micro|nano)seconds?)\b",
        rf"{NUMBER}\s?(kB|MB|GB)\b",
        r"\bSSIM\b[^|\n]{0,20}?(?<![\d.])[01]?\.\d{2,}",
        r"(?<![\w/-])\d*\.\d+ times\b",
        rf"{NUMBER} % (less|more|fewer|faster|slower|larger|smaller|lower|higher)\b",
        rf"{NUMBER} % (off|better|worse)\b",
        rf"{NUMBER}/255\b|{NUMBER} of 255\b(?! steps)",
    )
]
# A column of a table with such a head holds measures.
MEASURE_HEAD = re.compile(r"\b(CPU|SSIM|kB|MB|GB|ms|ns|seconds)\b")
NUMBER_CELL = re.compile(r"[*~<>= ]*\d*[.,]?\d")

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")
TOP = r"(?:backend|povray_export|blender_addon|samples|tests)"
PATH = re.compile(rf"(?<![\w/.$-]){TOP}/[\w./-]*\w")
QUOTED = re.compile(r"`([^`\n]+)`")
ROOM_FILE = re.compile(rf"(?:{'|'.join(FLOORS)})(?:/\w+)+")
ADDON_FILE = re.compile(r"(?:core|bridge|engines|viewport|operators|panels|properties)/[\w/.]*")
BARE_FILE = re.compile(r"\w+\.(?:py|cpp|h|c|sh)")
# What stands for a name: NAME, test_FILE, ...
PLACEHOLDER = re.compile(r"[A-Z]{4,}|\.\.\.")


def plain(text: str) -> str:
    """A page without what programs write into it and without blocks of code."""
    return FENCED.sub("", WRITTEN.sub("", text))


def measured_figures(text: str) -> list[str]:
    """The lines of a page that hold a measured figure."""
    lines = plain(text).splitlines()
    found = [line for line in lines if any(figure.search(line) for figure in FIGURES)]
    head: list[str] = []
    for line in lines:
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|"):
            head = []
        elif not head:
            head = cells
        elif line not in found and any(
            MEASURE_HEAD.search(name) and NUMBER_CELL.match(cell) for name, cell in zip(head, cells)
        ):
            found.append(line)
    return found


def is_too_long(name: str, text: str) -> bool:
    return PurePosixPath(name).name == "README.md" and len(text.splitlines()) > LONGEST_README


def anchors(text: str) -> set[str]:
    """The anchors of a page's headings, as web pages of repositories make them."""
    found = set()
    for line in FENCED.sub("", text).splitlines():
        if re.match(r"#{1,6} ", line):
            words = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", line.lstrip("#").strip())
            found.add(re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-"))
    return found


def normal(path: str) -> str:
    """A path without `.` and `..`; those that climb out of the repository stay."""
    parts: list[str] = []
    for part in path.split("/"):
        if part == ".." and parts and parts[-1] != "..":
            parts.pop()
        elif part not in ("", "."):
            parts.append(part)
    return "/".join(parts)


def broken_links(name: str, pages: dict[str, str], known: Collection[str]) -> list[str]:
    """The targets of a page's links that are not there. `known`: all files and folders."""
    found = []
    for target in LINK.findall(FENCED.sub("", pages[name])):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        full = normal(f"{PurePosixPath(name).parent}/{path}") if path else name
        if full not in known or (anchor and anchor not in anchors(pages.get(full, ""))):
            found.append(target)
    return found


def missing_files(text: str, known: Collection[str]) -> list[str]:
    """The names of files in a page that no file has: whole paths anywhere, and in quotes a file of
    a room (`choose/cut`) or of the add-on (`core/store`), or by its own name (`test_cut.cpp`)."""
    own = {PurePosixPath(one).name for one in known}
    cut_off = ("...", "*", "<")  # the rest of the name may be anything
    names = {one[0] for one in PATH.finditer(text) if not text.startswith(cut_off, one.end())}
    for quoted in QUOTED.findall(text):
        if ADDON_FILE.fullmatch(quoted):
            names.add(f"blender_addon/lodestone/{quoted.rstrip('/')}")
        elif ROOM_FILE.fullmatch(quoted) or BARE_FILE.fullmatch(quoted):
            names.add(quoted)
    found = []
    for one in sorted(names):
        if PLACEHOLDER.search(one) and one not in known:
            continue
        if ROOM_FILE.fullmatch(one) and not re.match(TOP, one):
            below = f"backend/src/{one}"
            there = any(f"{below}{ending}" in known for ending in ("", ".h", ".cpp"))
        elif "/" not in one:
            there = one in own
        else:
            there = any(f"{one}{ending}" in known for ending in ("", ".h", ".cpp"))
        if not there:
            found.append(one)
    return found


def with_folders(files: Collection[str]) -> set[str]:
    """The files and all folders above them."""
    found = set(files)
    for name in files:
        found.update(str(parent) for parent in PurePosixPath(name).parents)
    return found
