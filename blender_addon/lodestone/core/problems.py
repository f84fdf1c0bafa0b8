# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems of the user's data: one per thing and cause, with its severity."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property

from . import stable_ids
from .native import lodestone_native as native
from .printable_text import valid

INFO, WARNING, ERROR = "info", "warning", "error"
SEVERITIES = (INFO, WARNING, ERROR)
KINDS = ("material", "object", "light", "camera", "world", "collection", "image", "library")
TEXTS_PER_CODE = 16  # for one thing: a bound for hostile data
MEASURED = "slow_"  # codes begin so whose texts have measurements: the last one stands for all

Subject = tuple[str, str, str]  # kind, library, name
CauseKey = tuple[str, str, str]  # severity, code, message without the name


@dataclass(frozen=True)
class Problem:
    """A problem. `object` is the user's name of the thing, "" for the setup; `code` is snake_case
    and stable. `kind` is one of KINDS or "", `library` the path the thing is linked from, "" for a
    local one.
    """

    object: str
    severity: str
    code: str
    message: str
    kind: str = ""
    library: str = ""

    @property
    def subject(self) -> Subject:
        return (self.kind, self.library, self.object)

    @property
    def sentence(self) -> str:
        """The message, with the name of the thing where it lacks it."""
        if not self.object or self.object in self.message:
            return self.message
        return f"{self.object}: {self.message}"

    @property
    def cause(self) -> CauseKey:
        """The cause, which is equal for problems that differ in nothing but the thing that has
        them."""
        return (self.severity, self.code, self.message.replace(f'"{self.object}"', '""'))

    @cached_property
    def key(self) -> str:
        """16 hex digits by which a decision about it is kept: a changed text is a new problem."""
        return stable_ids.stable_id(self.code, *self.subject, self.message)

    def as_dict(self) -> dict[str, str]:
        return asdict(self)


class Problems:
    """Collects problems in the order they were found; the same one of the same thing once."""

    def __init__(self) -> None:
        self._found: dict[tuple[Subject, str], list[Problem]] = {}
        self._order: list[Problem] = []

    def add(
        self,
        name: str,
        severity: str,
        code: str,
        message: str,
        kind: str = "",
        library: str = "",
    ) -> None:
        """Where `kind` is not given, the word before the quoted name in the message tells it:
        'Material "Bark": ...', 'Shadows of light "Lamp" ...'."""
        message = valid(message)
        self._take(Problem(name, severity, code, message, kind or _kind(name, message), library))

    def _take(self, problem: Problem) -> None:
        same = self._found.setdefault((problem.subject, problem.code), [])
        if same and problem.code.startswith(MEASURED):
            self._order[self._order.index(same[0])] = problem
            same[0] = problem
        elif len(same) < TEXTS_PER_CODE and all(p.message != problem.message for p in same):
            same.append(problem)
            self._order.append(problem)

    def extend(self, problems: Iterable[Problem]) -> None:
        for problem in problems:
            self._take(problem)

    def extend_native(self, records: Iterable[native.records.Problem]) -> None:
        """Takes what lodestone_native's Model.problems() returns."""
        for item in records:
            severity = SEVERITIES[item.severity] if 0 <= item.severity < 3 else ERROR
            self.add(item.object, severity, item.code, item.message)

    def keep(self, wanted: Callable[[Problem], bool]) -> None:
        """Keeps the wanted problems and forgets the others."""
        kept = [problem for problem in self._order if wanted(problem)]
        self._found, self._order = {}, []
        self.extend(kept)

    def __iter__(self) -> Iterator[Problem]:
        return iter(self._order)

    def __len__(self) -> int:
        return len(self._order)

    @property
    def wrong(self) -> list[Problem]:
        """The problems that make the picture wrong or incomplete."""
        return [problem for problem in self if problem.severity == ERROR]


def _kind(name: str, message: str) -> str:
    before, found, _ = message.partition(f'"{name}"') if name else ("", "", "")
    word = before.rstrip().rpartition(" ")[2].lower()
    return word if found and word in KINDS else ""
