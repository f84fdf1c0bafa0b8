# SPDX-License-Identifier: GPL-3.0-or-later
"""Temporary folders whose owner is known to live or not: what a killed run left is found by the
next one. While a folder is in use its owner holds a lock that the system drops when it dies."""

import contextlib
import fcntl
import os
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from .file_names import fitting

MARK = "in_use"
_LONGEST = 200  # bytes of a prefix: file names end at 255
_RANDOM = 8  # characters that mkdtemp() adds
_RANDOM_CHARACTERS = set("abcdefghijklmnopqrstuvwxyz0123456789_")


def prefix_of(name: str) -> str:
    """The beginning of the folders' names; short enough for any name of a file."""
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
            try:
                self._lock = _take(self._mark)
            except BlockingIOError:
                raise InUse(f"another Blender is at work in {folder}") from None

    def release(self) -> None:
        self._mark.unlink(missing_ok=True)
        os.close(self._lock)


class LockedFolder:
    """A new folder in `parent`, which exists. Ends with remove() or keep()."""

    def __init__(self, parent: Path, name: str) -> None:
        self._lock = -1
        while self._lock < 0:
            self.path = Path(tempfile.mkdtemp(prefix=prefix_of(name), dir=parent))
            try:
                self._lock = _take(self.path / MARK)
            except (FileNotFoundError, BlockingIOError):
                pass  # settle() found it before the lock was on

    def remove(self) -> None:
        _clear(self.path)
        self._close()

    def keep(self) -> None:
        """The files in it are the user's from now on."""
        (self.path / MARK).unlink(missing_ok=True)
        self._close()

    def _close(self) -> None:
        if self._lock >= 0:
            os.close(self._lock)
            self._lock = -1


def settle(parent: Path, name: str, keep: bool = False) -> None:
    """Removes the folders of that name whose owner ended without saying what is to become of them,
    or keeps them for the user."""
    prefix = prefix_of(name)
    _settle(_folders(parent, lambda named: named.startswith(prefix), len(prefix)), keep)


def settle_all(parent: Path, ending: str) -> None:
    """Removes the folders of all names with that ending, as settle() does: a file that is never
    opened again leaves nothing."""
    _settle(_folders(parent, lambda named: named[: -_RANDOM - 1].endswith(ending)), False)


def _settle(folders: Iterator[Path], keep: bool) -> None:
    for folder in folders:
        try:
            lock = os.open(folder / MARK, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
        except FileNotFoundError:
            if _is_private(folder):  # its owner died right before it was marked, or after
                _remove_empty(folder)
            continue
        except OSError:
            continue  # not ours
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not _is(lock, folder / MARK):
                continue  # it was kept, or removed, before we had the lock
            if keep:
                os.unlink(folder / MARK)
            else:
                _clear(folder)
        except OSError:
            pass  # its owner lives
        finally:
            os.close(lock)


def _take(mark: Path) -> int:
    """The mark's file with its lock on; -1 if the mark was removed in between. Raises
    BlockingIOError: another process has it."""
    lock = os.open(mark, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(lock)
        raise
    except OSError:
        pass  # a file system without locks: such a folder stays
    if _is(lock, mark):
        return lock
    os.close(lock)
    return -1


def _is(lock: int, mark: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(lock), os.lstat(mark))
    except OSError:
        return False


def _is_private(folder: Path) -> bool:
    """Whether a folder is as mkdtemp() makes them, which few people do."""
    try:
        return stat.S_IMODE(os.lstat(folder).st_mode) == 0o700
    except OSError:
        return False


def _folders(
    parent: Path, wanted: Callable[[str], bool], prefix: int | None = None
) -> Iterator[Path]:
    """Our own ones with wanted names, whose random end begins after so many characters: what a link
    leads to, or somebody else can exchange, is not cleared."""
    try:
        entries = [entry for entry in os.scandir(parent) if wanted(entry.name)]
    except OSError:
        return
    for entry in entries:
        try:
            ours = entry.stat(follow_symlinks=False).st_uid == os.geteuid()
        except OSError:
            continue
        if ours and entry.is_dir(follow_symlinks=False):
            if _is_random(entry.name[-_RANDOM - 1 :]) and (
                prefix is None or len(entry.name) == prefix + _RANDOM
            ):
                yield Path(entry.path)


def _is_random(end: str) -> bool:
    """Whether a name ends as mkdtemp() ends it after prefix_of()."""
    return end.startswith("-") and set(end[1:]) <= _RANDOM_CHARACTERS


def _clear(folder: Path) -> None:
    """The mark goes last: whoever is killed on the way leaves a folder that settle() knows."""
    try:
        for entry in list(os.scandir(folder)):
            if entry.is_dir(follow_symlinks=False):
                shutil.rmtree(entry.path, ignore_errors=True)
            elif entry.name != MARK:
                with contextlib.suppress(OSError):  # gone already, or not ours to remove
                    os.unlink(entry.path)
        if os.listdir(folder) == [MARK]:
            os.unlink(folder / MARK)
    except OSError:
        return
    _remove_empty(folder)


def _remove_empty(folder: Path) -> None:
    try:
        os.rmdir(folder)
    except OSError:
        pass  # something is in it
