# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of batch.py, and the jobs it asks for."""

import argparse
from pathlib import Path

from .file_jobs import FileJob
from .profile_file import read_profile
from .verbs import VERBS, verb_of

_EPILOG = (
    "Precedence: command line, --profile, the file's own settings. "
    "Exit codes: 0 done; 1 failed, too slow or too large; 2 usage; 3 done, but the picture is "
    "incomplete somewhere; 4 input unreadable, or Blender died on it; 5 POV-Ray missing or failed; "
    "130 cancelled. Several files: 0, else 130, 1 or 3; each one's own code is in the report."
)


def parse(arguments: list[str]) -> argparse.Namespace:
    """The options, filled up from the profile. Exits with 2 and a sentence on a mistake."""
    top, verbs = _parsers()
    options = top.parse_args(arguments)
    if options.profile:
        verb = verbs[options.verb]
        try:
            values = read_profile(options.profile, verb, verbs.values())
        except ValueError as error:
            verb.error(str(error))
        verb.set_defaults(**values)
        options = top.parse_args(arguments)
    if options.resume and not options.log:
        verbs[options.verb].error("--resume goes with --log FILE: the log of the run to go on with")
    return options


def parser() -> argparse.ArgumentParser:
    return _parsers()[0]


def _parsers() -> tuple[argparse.ArgumentParser, dict[str, argparse.ArgumentParser]]:
    top = argparse.ArgumentParser(
        prog="batch.py",
        description="Works on .blend files without a window.",
        epilog=_EPILOG,
    )
    subparsers = top.add_subparsers(dest="verb", required=True, metavar="VERB")
    parsers = {verb.name: subparsers.add_parser(verb.name, help=verb.help) for verb in VERBS}
    for verb in VERBS:
        verb.add_options(parsers[verb.name])
    return top, parsers


def jobs(options: argparse.Namespace) -> list[FileJob]:
    """One job for each file. Raises ValueError with a sentence on what does not fit together."""
    if len({Path(file).absolute() for file in options.files}) < len(options.files):
        raise ValueError("one file is named twice")
    verb = verb_of(options.verb)
    names = [Path(file).stem for file in options.files]
    if len(set(names)) < len(names) and (options.store or verb.asks_for_pictures):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two files are called {twice}: their results would share one name")
    return [verb.job(options, Path(file)) for file in options.files]
