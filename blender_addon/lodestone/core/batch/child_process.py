# SPDX-License-Identifier: GPL-3.0-or-later
"""One supervised child process: its output, its time, its memory, and how it is stopped."""

import os
import select
import signal
import subprocess
import time
from collections.abc import Callable

from .. import progress_text
from . import process_session
from .child_log import ChildLog
from .process_session import Member

TIMEOUT, MEMORY, CANCELLED = "timeout", "memory", "cancelled"  # why it was stopped
_LONGEST_LINE = 64 << 10


class Child:
    """Started by its constructor, which raises OSError. `cause` says why it was stopped, "" if it
    ended by itself; `returncode` is there after finish()."""

    def __init__(
        self,
        command: list[str],
        environment: dict[str, str],
        log: ChildLog,
        said: Callable[[str], None],
        timeout_s: float | None = None,
        max_bytes: int | None = None,
    ) -> None:
        self.log = log
        self.cause = ""
        self.explanation = ""
        self.peak_bytes = 0
        self.returncode: int | None = None
        self._said = said
        self._timeout_s = timeout_s
        self._max_bytes = max_bytes
        self._rest = b""
        self._kill_at: float | None = None
        self._members: list[int] = []
        self.started = time.monotonic()
        # A session of its own: Ctrl-C reaches us alone, and its processes are known to be its.
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=environment,
            start_new_session=True,
            preexec_fn=process_session.death_with_parent(),
        )
        assert self._process.stdout is not None
        self._output = self._process.stdout
        os.set_blocking(self._output.fileno(), False)

    @property
    def pid(self) -> int:
        """The number of the process, which is also that of its session."""
        return self._process.pid

    def fileno(self) -> int:
        return self._output.fileno()

    # ---- Output ----

    def read(self) -> bool:
        """Takes what it said by now; False when there can be no more."""
        for _ in range(16):  # a flood must not keep us from the others
            try:
                data = os.read(self.fileno(), 1 << 16)
            except BlockingIOError:
                return True
            except OSError:
                data = b""
            if not data:
                self._lines(b"\n" if self._rest else b"")
                return False
            self.log.write(data)
            self._lines(data)
        return True

    def _lines(self, data: bytes) -> None:
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > _LONGEST_LINE:
            lines, self._rest = [*lines, self._rest], b""
        for line in lines:
            self._said(line.decode("utf-8", "replace"))

    # ---- Watching ----

    def members(self, pids: list[int]) -> None:
        """Takes the processes of its session, which a walk through all processes has found."""
        self._members = pids

    def watch(self, now: float) -> None:
        """Looks at the clock and at its memory, and stops it when there is a reason."""
        members = process_session.measure(self._members or [self.pid])
        used = sum(member.bytes for member in members)
        self.peak_bytes = max(self.peak_bytes, used)
        if self._max_bytes is not None and used > self._max_bytes and not self.cause:
            self.cause = MEMORY
            self.explanation = _too_large(used, self._max_bytes, members)
            self._kill_at = now  # whatever it does next needs more of it
        elif self._timeout_s is not None and now - self.started > self._timeout_s:
            self.stop(TIMEOUT, f"stopped after the {self._timeout_s:g} s of --timeout", 2.0)
        if self._kill_at is not None and now >= self._kill_at:
            process_session.kill(self.pid)

    def stop(self, cause: str, explanation: str, grace_s: float) -> None:
        """Asks the child to stop, so that it clears up; watch() kills it when it does not. A second
        call only shortens the time."""
        if not self.cause:
            self.cause, self.explanation = cause, explanation
            self._process.send_signal(signal.SIGTERM)
        at = time.monotonic() + grace_s
        self._kill_at = at if self._kill_at is None else min(at, self._kill_at)

    def ended(self) -> bool:
        """Does not wait for it: its number must stay its own until finish()."""
        options = os.WEXITED | os.WNOHANG | os.WNOWAIT
        return os.waitid(os.P_PID, self.pid, options) is not None

    def finish(self) -> None:
        """After it ended: ends what it left running and takes its last words."""
        process_session.kill(self.pid)
        while self.read() and self._more():
            pass
        self.returncode = self._process.wait()
        self._output.close()

    def _more(self) -> bool:
        """All writers are dead, so what is not there now never comes."""
        return bool(select.select([self.fileno()], [], [], 0)[0])


def _too_large(used: int, limit: int, members: list[Member]) -> str:
    parts = [
        f"{member.name} {progress_text.memory(member.bytes)}"
        for member in sorted(members, key=lambda member: -member.bytes)[:3]
    ]
    return (
        f"stopped at {progress_text.memory(used)} of memory, more than the "
        f"{progress_text.memory(limit)} of --max-memory ({', '.join(parts)})"
    )
