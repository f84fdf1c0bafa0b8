# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of --profile: options of batch.py as JSON, between the command line and the .blend."""

import argparse
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from .views_file import size_text

# The metavars of what belongs to one run and never to a profile: its inputs and results. The
# folder of levels (DIR) and a PROGRAM serve many runs.
ONE_RUN = ("FILE", "PATH")


def read_profile(
    path: str, verb: argparse.ArgumentParser, all_verbs: Iterable[argparse.ArgumentParser]
) -> dict[str, Any]:
    """The values for one verb, checked as on the command line. Options of the other verbs may be in
    it, so that one profile serves all; anything else raises ValueError that names the key."""
    try:
        values = json.loads(Path(path).read_text("utf-8"), object_pairs_hook=_once)
    except (OSError, ValueError) as error:
        raise ValueError(f"--profile {path}: {error}") from None
    if not isinstance(values, dict):
        raise ValueError(f"--profile {path}: an object of options is expected")
    own = _options(verb)
    known: dict[str, argparse.Action] = {}
    one_run: set[str] = set()
    for parser in all_verbs:
        known.update(_options(parser))
        one_run.update(action.dest for action in parser._actions if _of_one_run(action))
    found = {}
    for key, value in values.items():
        if key in one_run:
            raise ValueError(f"--profile {path}: {key} goes on the command line only")
        if key not in known:
            names = ", ".join(sorted(known))
            raise ValueError(f"--profile {path}: unknown key {key!r} (known: {names})")
        checked = _checked(f"--profile {path}: {key}", known[key], value)
        if key in own:
            found[key] = checked
    return found


def _options(parser: argparse.ArgumentParser) -> Mapping[str, argparse.Action]:
    return {action.dest: action for action in parser._actions if not _of_one_run(action)}


def _of_one_run(action: argparse.Action) -> bool:
    """Whether an option is for the command line alone. A switch that has no opposite is: a profile
    could not be overruled."""
    switch = action.nargs == 0 and not isinstance(action, argparse.BooleanOptionalAction)
    return switch or action.metavar in ONE_RUN


def _checked(where: str, action: argparse.Action, value: Any) -> Any:
    if isinstance(action, argparse.BooleanOptionalAction):
        if not isinstance(value, bool):
            raise ValueError(f"{where} is true or false")
        return value
    if isinstance(value, bool) or value is None:
        raise ValueError(f"{where} cannot be {json.dumps(value)}")
    if action.type is None:
        if not isinstance(value, str):
            raise ValueError(f"{where} is a text")
        if action.choices is not None and value not in action.choices:
            raise ValueError(f"{where} is one of {', '.join(action.choices)}")
        return value
    try:
        return action.type(size_text(value))
    except argparse.ArgumentTypeError as error:
        raise ValueError(f"{where}: {error}") from None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"{twice!r} is in it twice")
    return found
