# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of --log: lines of JSON, one for everything finished. Each is appended by one write and
is on the disk before work goes on, so a killed run loses at most the line it was writing.

    {"line": "run", "version": ..., "verb": ..., "files": 20, "time": ...}
    {"line": "inputs", "id": ..., "file": ..., "inputs": {...}}    what the file depends on
    {"line": "picture", "file": ..., "key": ..., "inputs": id, "out": ..., "made": {...}}
    {"line": "file", "file": ..., "key": ..., "inputs": id, "report": {...}}
"""

import json
import os
from collections.abc import Iterator
from typing import Any


class BatchLog:
    """Opens for appending; raises OSError."""

    def __init__(self, path: str) -> None:
        flags = os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC
        self._file = os.open(path, flags, 0o666)
        end = os.lseek(self._file, 0, os.SEEK_END)
        if end and os.pread(self._file, 1, end - 1) != b"\n":
            os.write(self._file, b"\n")  # after half a line of a killed run

    def add(self, line: str, **values: Any) -> None:
        """Raises OSError."""
        text = json.dumps({"line": line, **values}, ensure_ascii=True) + "\n"
        data = text.encode()
        while data:  # less than all only on a full disk, which then says so
            data = data[os.write(self._file, data) :]
        os.fsync(self._file)

    def close(self) -> None:
        os.close(self._file)


def read(path: str) -> Iterator[dict[str, Any]]:
    """The lines that are whole, of a log that may not be there. Raises OSError when it is there and
    cannot be read."""
    try:
        file = open(path, encoding="utf-8", errors="replace")
    except FileNotFoundError:
        return
    with file:
        for text in file:
            try:
                value = json.loads(text)
            except (ValueError, RecursionError):
                continue
            if isinstance(value, dict) and isinstance(value.get("line"), str):
                yield value
