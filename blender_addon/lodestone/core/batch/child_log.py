# SPDX-License-Identifier: GPL-3.0-or-later
"""The words of one child process, in a file of bounded size: its beginning and its end."""

from collections import deque
from pathlib import Path
from typing import BinaryIO

_HEAD_BYTES = 4 << 20
_TAIL_BYTES = 256 << 10
LAST_LINES = 20


class ChildLog:
    """A log of bounded size. Where `path` cannot be written, only the last lines are kept, in
    memory."""

    def __init__(self, path: Path) -> None:
        self._file = None
        self._written = 0
        self._left_out = 0
        self._tail: deque[bytes] = deque()
        self._tail_bytes = 0
        try:
            self._file = open(path, "wb")
        except OSError:
            pass

    def write(self, data: bytes) -> None:
        """Any part of what it said."""
        room = _HEAD_BYTES - self._written if not self._left_out else 0
        if self._file is None or room <= 0:
            room = 0
        else:
            self._put(self._file, data[:room])
        self._left_out += max(0, len(data) - room)
        data = data[-_TAIL_BYTES:]
        self._tail.append(data)
        self._tail_bytes += len(data)
        while self._tail_bytes - len(self._tail[0]) >= _TAIL_BYTES:
            self._tail_bytes -= len(self._tail.popleft())

    def _put(self, file: BinaryIO, data: bytes) -> None:
        try:
            file.write(data)
            file.flush()  # it may be looked at while the child runs
            self._written += len(data)
        except OSError:  # a full disk must not stop the pictures
            self._left_out += len(data)

    def add_file(self, path: Path) -> None:
        """Adds the beginning of another log, such as Blender's crash report."""
        try:
            with open(path, "rb") as file:
                self.write(file.read(64 << 10))
        except OSError:
            pass

    @property
    def last_lines(self) -> str:
        """The end of the log, for the terminal."""
        lines = b"".join(self._tail).splitlines(keepends=True)[-LAST_LINES:]
        return b"".join(lines).decode("utf-8", "replace")

    def close(self) -> None:
        """Completes the file by the end of what was said."""
        if self._file is None:
            return
        if self._left_out:
            tail = b"".join(self._tail)[-self._left_out :]
            cut = self._left_out - len(tail)
            self._put(self._file, b"\n[... %d bytes left out ...]\n" % cut if cut else b"")
            self._put(self._file, tail)
        try:
            self._file.close()
        except OSError:
            pass
        self._file = None
