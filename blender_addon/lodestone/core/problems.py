# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems of the user's data: one per thing and cause, with its severity."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

INFO, WARNING, ERROR = "info", "warning", "error"
SEVERITIES = (INFO, WARNING, ERROR)


@dataclass(frozen=True)
class Problem:
    """`object` is the user's name of the thing; `code` is snake_case and stable."""

    object: str
    severity: str
    code: str
    message: str

    @property
    def sentence(self) -> str:
        """The message, with the name of the thing where it lacks it."""
        if not self.object or self.object in self.message:
            return self.message
        return f"{self.object}: {self.message}"

    def as_dict(self) -> dict[str, str]:
        return asdict(self)


class Problems:
    """Collects problems, each (object, code) once, in the order they were found."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, str], Problem] = {}

    def add(self, name: str, severity: str, code: str, message: str) -> None:
        self._found.setdefault((name, code), Problem(name, severity, code, message))

    def extend(self, problems: Iterable[Problem]) -> None:
        for problem in problems:
            self._found.setdefault((problem.object, problem.code), problem)

    def extend_native(self, records: Iterable[Any]) -> None:
        """Takes what lodestone_native's Model.problems() returns."""
        for item in records:
            severity = SEVERITIES[item.severity] if 0 <= item.severity < 3 else ERROR
            self.add(item.object, severity, item.code, item.message)

    def __iter__(self) -> Any:
        return iter(self._found.values())

    def __len__(self) -> int:
        return len(self._found)

    @property
    def wrong(self) -> list[Problem]:
        """Those that make the picture wrong or incomplete."""
        return [problem for problem in self if problem.severity == ERROR]
