# SPDX-License-Identifier: GPL-3.0-or-later
"""Names and paths of others, made fit to be shown."""

import unicodedata

_JOINERS = "\u200c\u200d"  # Persian, Hindi and others need them
_LINES = "\r\n\t\u2028\u2029"


def printable(text: str) -> str:
    """The text on one line, and without what steers a terminal or turns the direction of
    reading."""

    def shown(c: str) -> str:
        if c in _LINES:
            return " "
        steers = unicodedata.category(c) in ("Cc", "Cf", "Cs") and c not in _JOINERS
        return "\ufffd" if steers else c

    return "".join(map(shown, text))


def valid(text: str) -> str:
    """The text without what UTF-8, and so Blender, cannot hold: paths may be any bytes."""
    return text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")


def readable(name: bytes) -> str:
    """A name out of a damaged or very old file, whose bytes need not be text."""
    return name.decode("utf-8", "backslashreplace")


def sentence(error: Exception) -> str:
    """The sentence to tell of an error. Blender gives names only of what is UTF-8, else a
    UnicodeDecodeError."""
    if isinstance(error, UnicodeDecodeError):
        return f'The name "{readable(error.object)}" is not valid text (UTF-8): rename what has it'
    return valid(str(error))
