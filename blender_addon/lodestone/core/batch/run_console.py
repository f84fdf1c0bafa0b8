# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines that a batch run prints: where each file is, and each problem once."""

import sys
from pathlib import Path
from typing import Any

from .. import progress_text
from ..printable_text import printable
from ..problems import Problem
from .report_rows import Row
from .verbs import verb_of


class Console:
    """Prints the lines of a run of `total` files."""

    def __init__(self, total: int) -> None:
        self._total = total
        self._terminal = sys.stdout.isatty()
        self._running: dict[int, str] = {}
        self._shown = False

    def line(self, text: str, error: bool = False) -> None:
        self._clear()
        print(text, file=sys.stderr if error else sys.stdout, flush=True)

    def began(self, number: int, file: str) -> None:
        if self._total > 1:
            self.line(f"{self._place(number)} {printable(file)}")

    def progress(self, number: int, file: str, text: str) -> None:
        if not self._terminal:
            return
        name = f"{printable(Path(file).name)}: " if self._total > 1 else ""
        self._running[number] = name + printable(text)
        self._clear()
        print(f"{'   '.join(self._running.values())[:200]}", end="", flush=True)
        self._shown = True

    def finished(self, number: int, report: dict[str, Any]) -> None:
        self._running.pop(number, None)
        name = printable(Path(report["input"]).name)
        prefix = f"{name}: " if self._total > 1 else ""
        for problem in report.get("problems", []):
            if problem["severity"] != "info":
                sentence = printable(Problem(**problem).sentence)
                self.line(f"{problem['severity']}: {prefix}{sentence}", error=True)
        if report.get("log_tail"):
            self.line("\n".join(map(printable, report["log_tail"].splitlines())), error=True)
        if "message" in report:
            text = f"batch.py: {printable(report['input'])}: {printable(report['message'])}"
            self.line(text, error=True)
        for line in verb_of(report["verb"]).lines(report):
            self.line(printable(line))
        compared = Row.of(report).compared
        if compared and self._total == 1:  # the table tells it where there are several
            self.line(compared.sentence)
        if self._total > 1:
            took = f" in {progress_text.clock(report['wall_s'])}" if "wall_s" in report else ""
            again = " by an earlier run" if report.get("resumed") is True else ""
            status = report.get("cause") or report["status"]
            self.line(f"{self._place(number)} {name}: {status}{again or took}")

    def _place(self, number: int) -> str:
        return f"[{number + 1}/{self._total}]"

    def _clear(self) -> None:
        if self._shown:
            print("\r\x1b[K", end="", flush=True)
            self._shown = False
