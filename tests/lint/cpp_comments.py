# SPDX-License-Identifier: GPL-3.0-or-later
"""The comments of C++ sources: apart from the code, as blocks, and beside the named numbers."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

from repository import ROOT, files_ending

SOURCES = ("backend/", "povray_export/")
TOKEN = re.compile(
    r'(?P<raw>R"(?P<tag>[^()\s\\"]{0,16})\(.*?\)(?P=tag)")'
    r'|(?P<string>"(?:\\.|[^"\\\n])*")'
    r"|(?P<number>\d(?:'?[\w.])*)"
    r"|(?P<char>'(?:\\.|[^'\\\n])+')"
    r"|(?P<line>//[^\n]*)"
    r"|(?P<block>/\*.*?\*/)",
    re.DOTALL,
)
CONSTANT = re.compile(r"^[ \t]*(?!using\b)[^;{}()=#]*\bconst(?:expr)?\b[^;{}()=]*?\b(k[A-Z]\w*)\b")
# A value that picks no number: ~0, as "none", is said by the name.
NO_NUMBER = re.compile(r"~\s*\w+\s*\{\s*0\s*\}|\b[A-Za-z_]\w*")
REASON = re.compile(r"(?:^|[.:;)] )(?:Law|Fitted|Taste): \S")


def product_sources() -> list[str]:
    return [name for name in files_ending(".h", ".cpp", ".c") if name.startswith(SOURCES)]


def to_do(name: str) -> set[str]:
    """A list of files that still fail, one a line. Such a list only ever shrinks."""
    return set((ROOT / "tests" / "lint" / name).read_text("utf-8").split())


def not_agreed(found: Mapping[str, list[str]], late: set[str]) -> dict[str, list[str]]:
    """Files whose faults no list allows, and listed files that have none."""
    done = {name: ["clean or gone: take it off the list"] for name in late - set(found)}
    return {name: faults for name, faults in found.items() if name not in late} | done


def _blank(text: str) -> str:
    return re.sub(r"[^\n]", " ", text)


@lru_cache(maxsize=None)
def split(text: str) -> tuple[str, str]:
    """Code without comments and texts, and comments alone, every character in its place."""
    code, comments, at = [], [], 0
    for token in TOKEN.finditer(text):
        between = text[at : token.start()]
        code.append(between)
        comments.append(_blank(between))
        is_comment = token["line"] is not None or token["block"] is not None
        is_code = token["number"] is not None
        code.append(token[0] if is_code else _blank(token[0]))
        comments.append(token[0] if is_comment else _blank(token[0]))
        at = token.end()
    return "".join(code) + text[at:], "".join(comments) + _blank(text[at:])


def said(comment: str) -> str:
    """What a line of a comment says, without its marks."""
    return re.sub(r"^(///?<?!?|/\*+)|\*/$", "", comment.strip()).strip()


@dataclass(frozen=True)
class CommentBlock:
    line: int  # of its first line, from 1
    alone: bool  # on lines of its own, not behind code
    text: str  # without its marks, lines joined by spaces


def blocks(text: str) -> Iterator[CommentBlock]:
    """Whole comments: lines of their own that follow each other are one, behind code each its own.
    The license's line is none."""
    code, comments = (part.split("\n") for part in split(text))
    start, lines = 0, []
    for number, (beside, comment) in enumerate(zip(code + [""], comments + [""]), 1):
        is_license = "SPDX-License-Identifier" in comment
        alone = bool(comment.strip()) and not beside.strip() and not is_license
        if alone:
            start = start or number
            lines.append(said(comment))
        elif lines:
            yield CommentBlock(start, True, " ".join(lines))
            start, lines = 0, []
        if comment.strip() and beside.strip():
            yield CommentBlock(number, False, said(comment))


def holds_number(value: str) -> bool:
    return any(char.isdigit() for char in NO_NUMBER.sub(" ", value))


@dataclass(frozen=True)
class NamedNumber:
    line: int  # from 1
    name: str
    has_reason: bool


def named_numbers(text: str) -> Iterator[NamedNumber]:
    """The constants whose value holds a number of its own: not those made of others, of texts or
    of ~0 for none. The reason stands in the comment above or behind."""
    code, comments = split(text)
    code_lines, comment_lines = code.split("\n"), comments.split("\n")
    for at, line in enumerate(code_lines):
        found = CONSTANT.match(line)
        if not found:
            continue
        last, depth, statement = at, 0, []
        rest = line[found.end() :]
        if not re.match(r"\s*(\[[^\]]*\])?\s*(=|\{|\(|$)", rest):
            continue
        while True:
            depth += sum(rest.count(c) for c in "({[") - sum(rest.count(c) for c in ")}]")
            statement.append(rest)
            if (depth <= 0 and ";" in rest) or last + 1 == len(code_lines):
                break
            last += 1
            rest = code_lines[last]
        value = re.sub(r"^\s*\[[^\]]*\]", "", "\n".join(statement))
        if not holds_number(value):
            continue
        beside = [said(comment) for comment in comment_lines[at : last + 1]]
        above = at - 1
        while above >= 0 and comment_lines[above].strip() and not code_lines[above].strip():
            beside.append(said(comment_lines[above]))
            above -= 1
        yield NamedNumber(at + 1, found[1], any(map(REASON.search, beside)))
