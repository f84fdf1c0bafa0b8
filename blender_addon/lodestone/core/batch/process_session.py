# SPDX-License-Identifier: GPL-3.0-or-later
"""All processes of one session (Linux): a child started in a session of its own, and whatever it
started in turn, in whichever process groups; how much memory they take, and their end."""

import ctypes
import os
import signal
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NoReturn

_PR_SET_PDEATHSIG = 1
_STEP_S = 0.01


@dataclass(frozen=True)
class Member:
    """One living process; `bytes` is what it has in memory and in swap."""

    pid: int
    name: str
    bytes: int


def death_with_parent() -> Callable[[], None]:
    """Returns a function for subprocess's preexec_fn: the system kills the child when the thread
    that started it ends, however that ends."""
    libc = ctypes.CDLL(None)  # before the fork, after which nothing may be loaded
    parent = os.getpid()

    def ask() -> None:
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it ended before we asked
            os._exit(1)

    return ask


def follow(supervisor: int) -> None:
    """Ties a child that a wrapper may have started to its parent: it ends with it, and at once when
    the supervisor is gone already. 0: there is no supervisor."""
    if supervisor <= 0:
        return
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    if not os.path.exists(f"/proc/{supervisor}"):
        os._exit(1)


def speak_in_lines() -> None:
    """Makes this process print line by line, in C too: else the last words of one that is killed
    would never reach its log."""
    libc = ctypes.CDLL(None)
    line_buffered = 1  # _IOLBF
    libc.setvbuf(ctypes.c_void_p.in_dll(libc, "stdout"), None, line_buffered, ctypes.c_size_t(0))
    libc.fflush(None)


def end_at_once() -> NoReturn:
    """Ends this process, whose work is done and written: Blender would first free the file."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)
    os._exit(0)


def sessions(wanted: Iterable[int]) -> dict[int, list[int]]:
    """The processes of each wanted session that are not over yet, in one walk through /proc."""
    found: dict[int, list[int]] = {session: [] for session in wanted}
    if not found:
        return found
    for name in os.listdir("/proc"):
        if not name.isdecimal():
            continue
        state, session = _state_and_session(name)
        if session in found and state not in "ZX":
            found[session].append(int(name))
    return found


def _state_and_session(pid: str) -> tuple[str, int]:
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            text = file.read()
    except OSError:
        return "X", -1
    fields = text[text.rindex(b")") + 2 :].split(b" ", 4)  # the name before may hold anything
    return fields[0].decode(), int(fields[3])


def measure(pids: Iterable[int]) -> list[Member]:
    """The memory of those processes that are still there."""
    found = []
    for pid in pids:
        try:
            with open(f"/proc/{pid}/status", encoding="utf-8", errors="replace") as file:
                lines = dict(line.split(":", 1) for line in file if ":" in line)
        except OSError:
            continue
        kilobytes = sum(int(lines[key].split()[0]) for key in ("VmRSS", "VmSwap") if key in lines)
        found.append(Member(pid, lines.get("Name", "").strip(), kilobytes * 1024))
    return found


def kill(session: int, patience_s: float = 0.5) -> None:
    """SIGKILL to every process of the session until none is left. The session's leader must not
    have been waited for yet, or its number may be somebody else's."""
    end = time.monotonic() + patience_s
    while True:
        left = sessions([session])[session]
        for pid in left:
            try:
                os.kill(pid, signal.SIGKILL)
            except (ProcessLookupError, PermissionError):
                pass
        if not left or time.monotonic() > end:
            return
        time.sleep(_STEP_S)
