# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems the designer has chosen to ignore, kept in the scene's `.lodestone`."""

from collections.abc import Iterable
from typing import Any

from ..core.problems import Problem
from . import datablock_ids, object_decisions


def keys(scene: Any) -> frozenset[str]:
    settings = datablock_ids.settings_of(scene)
    return frozenset(item.key for item in settings.ignored) if settings is not None else frozenset()


def add(scene: Any, problems: Iterable[Problem]) -> None:
    known = keys(scene)
    for problem in problems:
        if problem.key not in known:
            item = scene.lodestone.ignored.add()
            item.key, item.text = problem.key, problem.sentence


def clear(scene: Any) -> None:
    settings = datablock_ids.settings_of(scene)
    if settings is not None:
        settings.property_unset("ignored")
        object_decisions.drop_empty(scene)
