# SPDX-License-Identifier: GPL-3.0-or-later
"""Long calls of the library on a thread of their own, watched and stopped from another."""

import threading
from collections.abc import Callable
from typing import Any, TypeVar

from .native import lodestone_native as native

Result = TypeVar("Result")


class Stopped(Exception):
    """The user stopped the work; there is nothing to report."""

    cancelled = True


class Work:
    """One run of work. `new_job` is called by the worker before each long call; `stage` and
    `fraction` may be read, and `stop` called, from any thread."""

    def __init__(self) -> None:
        self.stage = ""
        self._job = native.Job()
        self._stopping = False

    def new_job(self, stage: str) -> native.Job:
        """The Job of the next long call, already off when the work was stopped."""
        job = native.Job()
        self.stage, self._job = stage, job
        if self._stopping:
            job.stop()
        return job

    @property
    def fraction(self) -> float:
        return self._job.fraction

    @property
    def library_stage(self) -> int:
        return self._job.stage

    def stop(self) -> None:
        self._stopping = True
        self._job.stop()

    @property
    def stopping(self) -> bool:
        return self._stopping

    def run(
        self, function: Callable[[], Result], poll: Callable[[], None], interval: float = 0.05
    ) -> Result:
        """Calls function on a new thread and poll() on this one until it is done. Returns its
        result or raises what it raised; Stopped when it was cancelled. What poll() raises stops
        the work, and is raised once that has ended."""
        outcome: dict[str, Any] = {}
        thread = start(function, outcome)
        try:
            while thread.is_alive():
                poll()
                thread.join(interval)
        except BaseException:
            self.stop()
            thread.join()
            raise
        result: Result = finish(outcome, self._stopping)
        return result


def start(function: Callable[[], Any], outcome: dict[str, Any]) -> threading.Thread:
    """Runs function on a thread; its result or error ends up in outcome, for finish()."""

    def body() -> None:
        try:
            outcome["result"] = function()
        except BaseException as error:  # noqa: B902 - carried over to the waiting thread
            outcome["error"] = error

    thread = threading.Thread(target=body, name="lodestone", daemon=True)
    thread.start()
    return thread


def finish(outcome: dict[str, Any], stopping: bool) -> Any:
    """What the function returned; raises what it raised. Stopped when the work was stopped, also
    when it ended by itself before it saw that."""
    error = outcome.get("error")
    if stopping or getattr(error, "cancelled", False):
        raise Stopped from error
    if error is not None:
        raise error
    return outcome["result"]
