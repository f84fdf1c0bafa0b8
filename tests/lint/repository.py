# SPDX-License-Identifier: GPL-3.0-or-later
"""What all lint tests share: where the repository is and which files belong to it."""

import subprocess
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CPP_ENDINGS = (".h", ".cpp", ".c")


@lru_cache(maxsize=None)
def files() -> tuple[str, ...]:
    """Everything tracked or about to be (not ignored), relative to ROOT, sorted."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    ).stdout.split("\0")
    return tuple(sorted({name for name in listed if name and (ROOT / name).is_file()}))


def files_ending(*endings: str) -> list[str]:
    return [name for name in files() if name.endswith(endings)]


def text_of(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def run(*command: str) -> subprocess.CompletedProcess:
    """Runs a tool in ROOT; output and errors together in .stdout."""
    return subprocess.run(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
