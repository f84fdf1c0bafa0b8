# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems by cause: what a panel shows in one row, however many things have it."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from . import stable_ids
from .problems import ERROR, SEVERITIES, WARNING, CauseKey, Problem, Subject

_PLURALS = {"library": "libraries", "": "things"}
Users = Mapping[Subject, Sequence[Subject]]  # the objects that show a material


@dataclass(frozen=True)
class Cause:
    """Problems that differ in nothing but their subjects; `objects` are those to select."""

    problems: tuple[Problem, ...]
    objects: tuple[Subject, ...]

    @property
    def severity(self) -> str:
        return self.problems[0].severity

    @property
    def code(self) -> str:
        return self.problems[0].code

    @cached_property
    def key(self) -> str:
        """Stays the same as long as the cause is there, whoever has it."""
        return stable_ids.stable_id(*self.problems[0].cause)

    @property
    def about_setup(self) -> bool:
        """Not of anything in the scene: it cannot be selected, and ignoring it would not help."""
        return not self.problems[0].object

    @cached_property
    def sentence(self) -> str:
        """One line: who, what, and how many."""
        first, count = self.problems[0], len(self.problems)
        kinds = {problem.kind for problem in self.problems}
        kind = kinds.pop() if len(kinds) == 1 else ""
        if count == 1:
            text = first.sentence
        elif first.message.startswith(f'{kind.capitalize()} "{first.object}": '):
            what = first.message[len(f'{kind} "{first.object}": ') :]
            text = f"{count:,} {_plural(kind)}: {what}"
        else:
            text = f"{first.sentence} (and {count - 1:,} more)"
        if kind == "material" and self.objects:
            shown = len(self.objects)
            text += f" ({shown:,} object{'s' if shown > 1 else ''})"
        return text

    @cached_property
    def report(self) -> str:
        """Everything known of it, as text: the line, then who has it and where it is seen."""
        lines = [f"{self.severity}: {self.sentence}"]
        if len(self.problems) > 1:
            lines += [f"    {_told(problem.subject)}" for problem in self.problems]
        if self.problems[0].kind == "material" and self.objects:
            lines.append("    objects: " + ", ".join(_told(item) for item in self.objects))
        return "\n".join(lines)


@dataclass(frozen=True)
class Split:
    """The rows that are shown, and those that the designer has chosen to ignore."""

    shown: tuple[Cause, ...]
    ignored: tuple[Cause, ...]

    def count(self, severity: str) -> int:
        return sum(cause.severity == severity for cause in self.shown)


def split(problems: Iterable[Problem], users: Users, ignored: Collection[str] = ()) -> Split:
    """Causes in order of severity, worst first, then as found. `ignored` are keys of problems;
    what is about the setup is never ignored."""
    shown: dict[CauseKey, list[Problem]] = {}
    hidden: dict[CauseKey, list[Problem]] = {}
    for problem in problems:
        chosen = hidden if problem.object and problem.key in ignored else shown
        chosen.setdefault(problem.cause, []).append(problem)
    return Split(_causes(shown, users), _causes(hidden, users))


def _causes(grouped: Mapping[CauseKey, list[Problem]], users: Users) -> tuple[Cause, ...]:
    made = [Cause(tuple(problems), _objects(problems, users)) for problems in grouped.values()]
    return tuple(sorted(made, key=lambda cause: -SEVERITIES.index(cause.severity)))


def _objects(problems: Iterable[Problem], users: Users) -> tuple[Subject, ...]:
    """Each once: the users of materials; else the thing itself, which the scene knows by name."""
    found: dict[Subject, None] = {}
    for problem in problems:
        if problem.kind == "material":
            found.update(dict.fromkeys(users_of(problem, users)))
        elif problem.kind in {"object", "light", "camera", "library", ""} and problem.object:
            found[problem.subject] = None
    return tuple(found)


def users_of(problem: Problem, users: Users) -> Sequence[Subject]:
    """The objects that show a problem's material."""
    return users.get(problem.subject, ())


def headline(found: Split) -> str:
    """The result of a check in one line."""
    errors, warnings = found.count(ERROR), found.count(WARNING)
    parts = [_number(errors, "error"), _number(warnings, "warning")]
    told = ", ".join(part for part in parts if part)
    return told or "No problems"


def exact_line(exact: int, total: int) -> str:
    """A line that tells how many materials are drawn exactly; "" where there are none."""
    if total == 0:
        return ""
    percent = 100 if exact == total else min(99, round(100 * exact / total))
    return f"{exact:,} of {total:,} materials exact ({percent} %)"


def _number(count: int, word: str) -> str:
    return f"{count:,} {word}{'s' if count > 1 else ''}" if count else ""


def _plural(kind: str) -> str:
    return _PLURALS.get(kind, f"{kind}s")


def _told(subject: Subject) -> str:
    _, library, name = subject
    return f'"{name}" ({library})' if library else f'"{name}"'
