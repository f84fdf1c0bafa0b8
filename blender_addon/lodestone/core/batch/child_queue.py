# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs tasks in children, several at once, from one thread: children die with the thread that
started them, so it must be the one that lives as long as the program."""

import selectors
import signal
import time
from collections.abc import Iterable
from typing import Any, Protocol

from . import process_session
from .child_process import CANCELLED, Child

_TICK_S = 0.1  # how often the clock, the memory and the signals are looked at
_WALK_S = 0.5  # how often new processes are looked for
_GRACE_S = 0.6  # everything has stopped a second after it was asked to


class Task(Protocol):
    """Something to do in a child."""

    def start(self) -> Child | None:
        """Starts the child. None: there is nothing to do, or it cannot be started; it has said
        so."""

    def look(self) -> None:
        """Called at every tick while its child runs."""

    def finish(self) -> None:
        """Called when its child has ended."""


class Interrupts:
    """Counts Ctrl-C, SIGTERM and a closed terminal instead of dying of them. A context."""

    _NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

    def __init__(self) -> None:
        self.count = 0
        self._before: dict[int, Any] = {}

    def __enter__(self) -> "Interrupts":
        for number in self._NUMBERS:
            if number == signal.SIGHUP and signal.getsignal(number) == signal.SIG_IGN:
                continue  # nohup
            self._before[number] = signal.signal(number, self._counted)
        return self

    def __exit__(self, *error: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _counted(self, number: int, frame: object) -> None:
        self.count += 1


class Queue:
    """Runs tasks in their children. `slots`: how many children at once."""

    def __init__(self, tasks: Iterable[Task], slots: int, interrupts: Interrupts) -> None:
        self._waiting = list(tasks)
        self._slots = slots
        self._interrupts = interrupts
        self._running: dict[Child, Task] = {}
        self._selector = selectors.DefaultSelector()
        self._walked = 0.0

    def run(self) -> list[Task]:
        """Returns the tasks that were not begun, because of an interrupt."""
        seen = 0
        try:
            while self._running or (self._waiting and not self._interrupts.count):
                self._fill()
                for key, _ in self._selector.select(_TICK_S if self._running else 0):
                    child: Child = key.data
                    if not child.read():
                        self._selector.unregister(child)
                if self._interrupts.count > seen:
                    grace = _GRACE_S if seen == 0 else 0.0
                    seen = self._interrupts.count
                    for child in self._running:
                        child.stop(CANCELLED, "cancelled", grace)
                self._watch()
        finally:
            for child in list(self._running):  # an error of ours: nothing may be left running
                process_session.kill(child.pid)
                child.finish()
            self._selector.close()
        return self._waiting

    def _fill(self) -> None:
        while self._waiting and len(self._running) < self._slots and not self._interrupts.count:
            task = self._waiting.pop(0)
            child = task.start()
            if child is not None:
                self._running[child] = task
                self._selector.register(child, selectors.EVENT_READ, child)

    def _watch(self) -> None:
        now = time.monotonic()
        if now - self._walked >= _WALK_S and self._running:
            self._walked = now
            found = process_session.sessions(child.pid for child in self._running)
            for child in self._running:
                child.members(found[child.pid])
        for child, task in list(self._running.items()):
            child.watch(now)
            task.look()
            if child.ended():
                del self._running[child]
                if child in {key.fileobj for key in self._selector.get_map().values()}:
                    self._selector.unregister(child)
                child.finish()
                task.finish()
