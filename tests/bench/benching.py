# SPDX-License-Identifier: GPL-3.0-or-later
"""What all benches share: the spread of rounds, how a table tells it, the JSON beside it."""

import argparse
import datetime
import json
import os
import platform
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
ORDER = ("min", "median", "max")


def turns(rounds: int, kinds: Sequence[str]) -> list[tuple[int, str]]:
    """Which kind runs when: now the one first, now the other, so that a busy machine slows both."""
    return [
        (number, kind)
        for number in range(rounds)
        for kind in (kinds if number % 2 == 0 else tuple(reversed(kinds)))
    ]


def spread(numbers: Sequence[float]) -> dict[str, float]:
    return {"min": min(numbers), "median": statistics.median(numbers), "max": max(numbers)}


def cell(found: dict[str, float], unit: float = 1.0, digits: int = 2) -> str:
    """Minimum / median / maximum."""
    return " / ".join(f"{found[key] / unit:.{digits}f}" for key in ORDER)


def load() -> float:
    """Processes that want a core, on average of the last minute: above 1, times are noisy."""
    return os.getloadavg()[0]


def said(rounds: int, busy: float) -> str:
    return (
        f"minimum / median / maximum of {rounds} rounds; {os.cpu_count()} cores, load {busy:.1f} "
        "before the first"
    )


def write(path: Path, busy: float, data: dict[str, Any]) -> None:
    """The report of a bench, with what all of them have."""
    path.parent.mkdir(parents=True, exist_ok=True)
    whole = {
        "schema": 1,
        "verb": "bench",
        "cores": os.cpu_count(),
        "load_before": busy,
        **data,
    }
    path.write_text(json.dumps(whole, indent=1) + "\n", "utf-8")
    print(f"\n{path}")


def add_write(parser: argparse.ArgumentParser, room: str) -> None:
    """The option by which a bench writes its page of results into the room's docs."""
    parser.add_argument(
        "--write", action="store_true", help=f"the results into {room}/docs/results"
    )
    parser.set_defaults(results_room=room)


def results_path(options: argparse.Namespace, name: str) -> Path:
    """Where the page of results of this name goes, without an ending."""
    if options.write:
        return ROOT / options.results_room / "docs" / "results" / name
    return ROOT / "build" / "bench" / "results" / name


class Told(list[str]):
    """Lines that a bench prints and that its page of results shows, too."""

    def tell(self, text: str = "") -> None:
        print(text, flush=True)
        self.extend(text.split("\n"))


def processor() -> str:
    """The name of the processor."""
    try:
        for line in Path("/proc/cpuinfo").read_text("utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.machine()


def system() -> str:
    """The name of the operating system and its version."""
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except OSError:
        return platform.system()


def commit() -> str:
    """The commit that is measured, "+ changes" where files differ from it; "" outside of git."""

    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True)
        return done.stdout.strip() if done.returncode == 0 else ""

    found = git("rev-parse", "--short=10", "HEAD")
    changed = git("status", "--porcelain", "--untracked-files=no")
    return f"{found} + changes" if found and changed else found


def _from_root(text: str) -> str:
    """A text whose paths begin at the repository, wherever that lies."""
    return text.replace(f"{ROOT}/", "").replace(f"{ROOT.parent}/", "../")


def write_results(path: Path, title: str, table: Sequence[str], data: dict[str, Any]) -> None:
    """NAME.md, a page with the table, and NAME.json beside it; both tell the machine, the date, the
    commit and the command. `path` is without an ending."""
    words = [str(Path(sys.argv[0]).resolve()), *(one for one in sys.argv[1:] if one != "--write")]
    known = {
        "schema": 1,
        "title": title,
        "command": _from_root(" ".join(words)),
        "machine": f"{processor()}, {os.cpu_count()} cores, {system()}",
        "date": datetime.datetime.now().astimezone().isoformat(timespec="minutes"),
        "commit": commit() or "unknown",
    }
    load_before = f", load {data['load_before']:.1f}" if "load_before" in data else ""
    lines = [
        f"# {title}",
        "",
        f"Written by `{known['command']}`; not edited by hand.",
        "",
        f"{known['date']}, commit {known['commit']}; {known['machine']}{load_before}.",
        "",
        *table,
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps({**data, **known}, indent=1)
    path.with_suffix(".json").write_text(_from_root(text) + "\n", "utf-8")
    path.with_suffix(".md").write_text("\n".join(lines).rstrip() + "\n", "utf-8")
    print(f"\n{_from_root(str(path.with_suffix('.md')))}")
