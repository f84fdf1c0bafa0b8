# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs clang-tidy on files of a compile database and remembers the clean ones by content."""

import hashlib
import json
import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)

# The analyzer takes half of the time and sees little but GoogleTest's macros in a test.
FOR_TESTS = ("--checks=-clang-analyzer-*",)


class Tidy:
    def __init__(self, root: Path, build: Path, cache: Path):
        """root: the repository; build: folder of compile_commands.json; cache: may be missing."""
        self.root = root
        self.build = build
        self.cache = cache
        entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
        self.commands = {entry["file"]: entry["command"] for entry in entries}
        version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True)
        self.common = version.stdout + (root / ".clang-tidy").read_bytes()

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
            + list(FOR_TESTS if name.startswith("tests/") else ())
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

    def check_all(self, names: list[str]) -> tuple[str, int]:
        """All complaints in the order of names, and how many files were not known yet."""
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            answers = list(pool.map(self.check, names))
        return "".join(text for text, _ in answers), sum(ran for _, ran in answers)
