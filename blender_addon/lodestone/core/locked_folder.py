# SPDX-License-Identifier: GPL-3.0-or-later
"""Temporary folders whose owner is known to live or not: what a killed run left is found by the
next one. While a folder is in use its owner holds a lock that the system drops when it dies."""

import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from .file_names import fitting

MARK = "in_use"
_LONGEST = 200  # bytes of a prefix: file names end at 255


def prefix_of(name: str) -> str:
    """What the names of the folders begin with; short enough for any name of a file."""
    return fitting(name, _LONGEST) + "-"


class InUse(OSError):
    """Another process works in a folder."""


class Hold:
    """The user's own folder, which exists, while one process works in it: two would make pictures
    of each other's files. Raises InUse."""

    def __init__(self, folder: Path) -> None:
        self._mark = folder / MARK
        self._lock = -1
        while self._lock < 0:
            lock = os.open(self._mark, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                os.close(lock)
                raise InUse(f"another Blender is at work in {folder}") from None
            except OSError:
                pass  # a file system without locks
            if self._is(lock):
                self._lock = lock
            else:  # the one before removed the mark while we looked at it
                os.close(lock)

    def _is(self, lock: int) -> bool:
        try:
            return os.path.samestat(os.fstat(lock), os.lstat(self._mark))
        except OSError:
            return False

    def release(self) -> None:
        self._mark.unlink(missing_ok=True)
        os.close(self._lock)


class LockedFolder:
    """A new folder in `parent`, which exists. Ends with remove() or keep()."""

    def __init__(self, parent: Path, name: str) -> None:
        self.path = Path(tempfile.mkdtemp(prefix=prefix_of(name), dir=parent))
        # The mark appears with its lock on: nobody may take it for a dead one's in between.
        early = self.path / f".{MARK}"
        self._lock = os.open(early, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            pass  # a file system without locks: such a folder stays
        os.rename(early, self.path / MARK)

    def remove(self) -> None:
        shutil.rmtree(self.path, ignore_errors=True)
        self._close()

    def keep(self) -> None:
        """It is the user's from now on."""
        (self.path / MARK).unlink(missing_ok=True)
        self._close()

    def _close(self) -> None:
        if self._lock >= 0:
            os.close(self._lock)
            self._lock = -1


def abandoned(parent: Path, name: str) -> Iterator[Path]:
    """The folders of that name whose owner ended without saying what is to become of them."""
    prefix = prefix_of(name)
    try:
        entries = [entry.name for entry in os.scandir(parent) if entry.name.startswith(prefix)]
    except OSError:
        return
    for entry in entries:
        if _without_owner(parent / entry / MARK):
            yield parent / entry


def settle(parent: Path, name: str, keep: bool = False) -> None:
    """Removes abandoned folders, or keeps them for the user."""
    for folder in abandoned(parent, name):
        if keep:
            (folder / MARK).unlink(missing_ok=True)
        else:
            shutil.rmtree(folder, ignore_errors=True)


def _without_owner(mark: Path) -> bool:
    try:
        file = os.open(mark, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
    except OSError:
        return False  # none, or not ours
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return True
    except OSError:
        return False
    finally:
        os.close(file)
