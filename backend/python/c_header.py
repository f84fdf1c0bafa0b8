# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a C header that is written as lodestone.h is: constants, enums, structs and functions with
the comments before and behind them. A declaration that is not understood is an error that names its
line; nothing is ever left out."""

from __future__ import annotations

import keyword
import re
import textwrap
from dataclasses import dataclass, field
from typing import NoReturn

NUMBERS = ("int16_t", "int32_t", "uint8_t", "uint32_t", "uint64_t", "size_t", "float", "double")
LIMITS = {"UINT32_MAX": 2**32 - 1}
# What makes a header of the declarations.
PLUMBING = (
    r"#(if|ifdef|ifndef|else|endif)\b[^\n]*|#include <std(int|def)\.h>"
    r'|#define (LDS_API\b[^\n]*|\w+_H\b)|extern "C" \{|\}'
)


class HeaderError(Exception):
    """A line of the header that is not understood."""


@dataclass(frozen=True)
class Type:
    """`base` with so many stars; `size`: that of an array."""

    base: str
    stars: int = 0
    size: int | None = None


@dataclass(frozen=True)
class Variable:
    """A field or an argument."""

    name: str
    type: Type
    doc: str = ""


@dataclass(frozen=True)
class Function:
    name: str
    result: Type
    arguments: list[Variable]
    doc: str


@dataclass
class Header:
    """All that a header declares, in its order."""

    name: str
    text: str
    constants: dict[str, tuple[int, str]] = field(default_factory=dict)
    enums: dict[str, tuple[str, list[tuple[str, int, str]]]] = field(default_factory=dict)
    opaque: set[str] = field(default_factory=set)
    structs: dict[str, tuple[str, list[Variable]]] = field(default_factory=dict)
    functions: list[Function] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.named = re.findall(r"typedef struct (\w+)\s*\{", self.text)  # also those further down

    def fail(self, position: int, sentence: str) -> NoReturn:
        line = self.text.count("\n", 0, position) + 1
        raise HeaderError(f"{self.name}:{line}: {sentence}")

    def variable(self, declared: str, position: int, doc: str = "") -> Variable:
        """A field or an argument as C declares it."""
        found = re.fullmatch(r"\s*([\w\s*]+?)\b(\w+)\s*(?:\[(\w+)\])?\s*", declared)
        if not found:
            self.fail(position, f"not understood: '{declared.strip()}'")
        if keyword.iskeyword(found[2]):
            self.fail(position, f"'{found[2]}' is a word of Python's")
        size = None if found[3] is None else self.number(found[3], position)
        return Variable(found[2], self.type(found[1], position, size), doc)

    def type(self, spelled: str, position: int, size: int | None = None) -> Type:
        words = [w for w in re.findall(r"\w+", spelled) if w not in ("const", "struct")]
        found = Type(" ".join(words), spelled.count("*"), size)
        known = found.base in NUMBERS or found.base in self.enums or found.base in self.named
        pointer = found.base in ("char", "void", *self.opaque) and found.stars > 0
        if not (known or pointer) or found.stars > 1 + pointer or (size and found.stars):
            self.fail(position, f"unknown type '{spelled.strip()}'")
        return found

    def number(self, word: str, position: int) -> int:
        if word in self.constants:
            return self.constants[word][0]
        if word not in LIMITS and not word.isdecimal():
            self.fail(position, f"'{word}' is no number")
        return LIMITS.get(word) or int(word)


def plain(comment: str) -> str:
    """The text of a comment; headlines have none."""
    text = textwrap.dedent("   " + comment.strip("* \n")).strip()
    return "" if text.startswith("----") else text


def members(
    body: str, start: int, pattern: str, header: Header
) -> list[tuple[re.Match[str], int, str]]:
    """The declarations in the braces of a struct or an enum, where they begin, and their comments:
    those on lines of their own before, and the one that begins on the same line after."""
    found: list[tuple[re.Match[str], int, str]] = []
    at, before = 0, ""
    while body[at:].strip():
        at += len(body[at:]) - len(body[at:].lstrip())
        comment = re.compile(r"/\*(.*?)\*/", re.DOTALL).match(body, at)
        if comment and found and "\n" not in body[found[-1][1] - start + len(found[-1][0][0]) : at]:
            match, position, doc = found[-1]
            found[-1] = (match, position, f"{doc} {plain(comment[1])}".strip())
        elif comment:
            before = plain(comment[1])
        else:
            declared = re.compile(pattern).match(body, at)
            if not declared:
                header.fail(start + at, f"not understood: '{body[at:].splitlines()[0]}'")
            found.append((declared, start + at, before))
            at, before = declared.end(), ""
            continue
        at = comment.end()
    return found


def read(name: str, text: str) -> Header:
    """Throws HeaderError."""
    header, at, doc = Header(name, text), 0, ""
    kinds = (
        ("space", r"\s+"),
        ("comment", r"/\*(.*?)\*/"),
        ("constant", r"#define (LDS_\w+)[ \t]+(\w+)[ \t]*(?=\n)"),
        ("plumbing", PLUMBING),
        ("enum", r"typedef enum (\w+)\s*\{(.*?)\}\s*\1\s*;"),
        ("struct", r"typedef struct (\w+)\s*\{(.*?)\}\s*\1\s*;"),
        ("opaque", r"typedef struct (\w+)\s+\1\s*;"),
        ("function", r"LDS_API\s+([\w\s*]+?)\b(\w+)\s*\(([\w\s*,\[\]]*)\)\s*;"),
    )
    patterns = [(kind, re.compile(pattern, re.DOTALL)) for kind, pattern in kinds]
    while at < len(text):
        kind, found = next(((k, m) for k, p in patterns if (m := p.match(text, at))), ("", None))
        if found is None:
            header.fail(at, f"not understood: '{text[at:].splitlines()[0]}'")
        if kind == "comment":
            doc = plain(found[1])
        elif kind == "constant":
            header.constants[found[1]] = (header.number(found[2], at), doc)
        elif kind == "enum":
            rows = members(found[2], found.start(2), r"(\w+)\s*=\s*(\w+)[ \t]*,?", header)
            values = [(row[1], header.number(row[2], where), said) for row, where, said in rows]
            header.enums[found[1]] = (doc, values)
        elif kind == "struct":
            rows = members(found[2], found.start(2), r"([^;/]*);", header)
            fields = [header.variable(row[1], where, said) for row, where, said in rows]
            if not fields:
                header.fail(at, f"{found[1]} has no fields")
            header.structs[found[1]] = (doc, fields)
        elif kind == "opaque":
            header.opaque.add(found[1])
        elif kind == "function":
            listed = [] if found[3].strip() in ("", "void") else found[3].split(",")
            arguments = [header.variable(one, found.start(3)) for one in listed]
            result = Type("void") if found[1].strip() == "void" else header.type(found[1], at)
            header.functions.append(Function(found[2], result, arguments, doc))
        if kind not in ("space", "comment", "plumbing"):
            doc = ""
        at = found.end()
    return header
