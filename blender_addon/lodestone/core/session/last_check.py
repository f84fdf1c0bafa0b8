# SPDX-License-Identifier: GPL-3.0-or-later
"""The problems that were last found in a scene, by Check Scene or by F12. Never part of the
file."""

from collections.abc import Collection
from dataclasses import dataclass, field

from .. import problem_causes
from ..problems import Problem, Subject


@dataclass(frozen=True)
class Check:
    """Problems, and which objects show each material in use."""

    problems: tuple[Problem, ...]
    users: problem_causes.Users = field(default_factory=dict)
    _splits: dict[frozenset[str], problem_causes.Split] = field(default_factory=dict, compare=False)

    def split(self, ignored: Collection[str] = ()) -> problem_causes.Split:
        """The problems by cause; made once for the same decisions, since panels ask at every
        redraw."""
        key = frozenset(ignored)
        if key not in self._splits:
            self._splits.clear()
            self._splits[key] = problem_causes.split(self.problems, self.users, key)
        return self._splits[key]

    @property
    def exact_materials(self) -> tuple[int, int]:
        """The number of materials in use that are drawn exactly, and of all in use."""
        used = {subject for subject in self.users if subject[0] == "material"}
        inexact: set[Subject] = {problem.subject for problem in self.problems}
        return len(used - inexact), len(used)
