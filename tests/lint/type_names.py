# SPDX-License-Identifier: GPL-3.0-or-later
"""The type names of the C++ sources: which are defined more than once, which are one bare word."""

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping

DEFINITION = re.compile(
    r"^[ \t]*(?:template\s*<[^>]*>\s*)?(?:struct|class|enum class|enum|union)\s+"
    r"(?:alignas\([^)]*\)\s*)?(?:\w+::)*([A-Z]\w*)\s*(?:final\s*)?(?::[^:;{][^;{]*)?\{",
    re.MULTILINE,
)
WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z][a-z0-9]*")


def is_bare(name: str) -> bool:
    """Whether a name is one word: `Part`, but not `CollapsePart`."""
    return len(WORD.findall(name)) < 2


def definitions(sources: Mapping[str, str]) -> dict[str, list[str]]:
    """By type name, the files that define it: a file once for each definition, nested ones too."""
    found: dict[str, list[str]] = defaultdict(list)
    for file, text in sources.items():
        for name in DEFINITION.findall(text):
            found[name].append(file)
    return dict(found)


def defined_twice(found: Mapping[str, Iterable[str]]) -> dict[str, list[str]]:
    return {name: sorted(files) for name, files in found.items() if len(list(files)) > 1}


def bare_words(found: Iterable[str]) -> list[str]:
    return sorted(name for name in found if is_bare(name))
