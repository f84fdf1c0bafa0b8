# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems the designer has chosen to ignore, kept in the scene's `.lodestone`."""

from collections.abc import Iterable
from typing import Any

from ..core.problems import Problem
from . import decisions, ids


def keys(scene: Any) -> frozenset[str]:
    settings = ids.settings_of(scene)
    return frozenset(item.key for item in settings.ignored) if settings is not None else frozenset()


def add(scene: Any, problems: Iterable[Problem]) -> None:
    known = keys(scene)
    for problem in problems:
        if problem.key not in known:
            item = scene.lodestone.ignored.add()
            item.key, item.text = problem.key, problem.sentence


def clear(scene: Any) -> None:
    settings = ids.settings_of(scene)
    if settings is not None:
        settings.property_unset("ignored")
        decisions.drop_empty(scene)
