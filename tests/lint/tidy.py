# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs clang-tidy on files of a compile database and remembers the clean ones by content."""

import hashlib
import json
import os
import re
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)

# The analyzer takes half of the time and sees little but GoogleTest's macros in a test.
FOR_TESTS = ("--checks=-clang-analyzer-*",)
# It follows fewer paths: two thirds of its time less. Deep ones are for who has the time.
SHALLOW = tuple(
    f"--extra-arg={word}"
    for setting in ("mode=shallow", "max-nodes=20000")
    for word in ("-Xclang", "-analyzer-config", "-Xclang", setting)
)


class Checked(NamedTuple):
    complaints: str  # in the order of the names
    ran: int  # files that were not known to be clean
    left: int  # files for which there was no time


class Tidy:
    def __init__(self, root: Path, build: Path, cache: Path, deep: bool = False):
        """root: the repository; build: folder of compile_commands.json; cache: may be missing;
        deep: the analyzer follows all the paths it would by itself."""
        self.root = root
        self.build = build
        self.cache = cache
        self.depth = () if deep else SHALLOW
        entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
        self.commands = {entry["file"]: entry["command"] for entry in entries}
        version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True)
        self.common = version.stdout + (root / ".clang-tidy").read_bytes()
        self.common += " ".join(self.depth).encode()

    def own_headers(self, file: Path, command: str) -> list[Path]:
        """The headers of ours that a file includes, directly or not, sorted."""
        places = [Path(place) for place in re.findall(r"-I\s*(\S+)", command)]
        found: set[Path] = set()
        waiting = [file]
        while waiting:
            source = waiting.pop()
            for name in INCLUDE.findall(source.read_text(encoding="utf-8")):
                for place in (source.parent, *places):
                    header = (place / name).resolve()
                    if header.is_file():
                        if header not in found:
                            found.add(header)
                            waiting.append(header)
                        break
        return sorted(found)

    def key(self, file: Path) -> str:
        """Changes when anything does that clang-tidy's answer on this file depends on."""
        command = self.commands[str(file)]
        digest = hashlib.sha256(self.common)
        digest.update(command.encode())
        for part in (file, *self.own_headers(file, command)):
            content = part.read_bytes()
            digest.update(f"{part} {len(content)}\n".encode() + content)
        return digest.hexdigest()

    def check(self, name: str) -> tuple[str, bool]:
        """(what clang-tidy complains about, whether it ran at all) for one file of root."""
        file = self.root / name
        if str(file) not in self.commands:
            return f"{name}: is not part of the build, so clang-tidy cannot check it\n", False
        known = self.cache / self.key(file)
        if known.exists():
            return "", False
        done = subprocess.run(
            ["clang-tidy", "-p", str(self.build), "--quiet"]
            + list(FOR_TESTS if name.startswith("tests/") else self.depth)
            + [str(file)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        if done.returncode != 0:
            return done.stdout or done.stderr or f"{name}: clang-tidy failed\n", True
        self.cache.mkdir(parents=True, exist_ok=True)
        known.touch()
        return "", True

    def check_all(
        self, names: list[str], seconds: float = float("inf"), at_least: int = 0
    ) -> Checked:
        """The files in their order, `at_least` so many, then as long as there is time to begin
        another one."""
        end = time.monotonic() + seconds

        def check(place: int) -> tuple[str, bool] | None:
            if place >= at_least and time.monotonic() > end:
                return None
            return self.check(names[place])

        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            answers = list(pool.map(check, range(len(names))))
        done = [answer for answer in answers if answer is not None]
        return Checked(
            "".join(text for text, _ in done),
            sum(ran for _, ran in done),
            len(answers) - len(done),
        )
