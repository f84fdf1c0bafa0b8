# SPDX-License-Identifier: GPL-3.0-or-later
"""What every struct has: its size, ids of objects, and the ways in and out of it."""

import ctypes
from ctypes import Structure, c_uint32
from types import SimpleNamespace
from typing import Any


class Sized(Structure):
    """A struct that starts with struct_size; the constructor fills it."""

    def __init__(self, **fields: Any) -> None:
        super().__init__(struct_size=ctypes.sizeof(type(self)), **fields)


class Object(Structure):
    """An id: an object of one model. {0, 0} is none."""

    _fields_ = [("index", c_uint32), ("generation", c_uint32)]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Object) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def __bool__(self) -> bool:
        return self.key != (0, 0)

    def __repr__(self) -> str:
        return f"Object({self.index}, {self.generation})"

    @property
    def key(self) -> tuple[int, int]:
        return (self.index, self.generation)


def text_in(text: str | None) -> bytes | None:
    """UTF-8 for the library; bytes of a name that is no UTF-8 travel through unchanged."""
    return None if text is None else text.encode("utf-8", "surrogateescape")


def text_out(data: bytes | None) -> str:
    return "" if data is None else data.decode("utf-8", "replace")


def record(struct: Structure) -> Any:
    """The struct's values by name, which stay valid: strings and arrays are copied."""
    names = (field[0] for field in struct._fields_ if field[0] != "struct_size")
    return SimpleNamespace(**{name: _plain(getattr(struct, name)) for name in names})


def _plain(value: Any) -> Any:
    if isinstance(value, bytes) or value is None:
        return text_out(value)
    if isinstance(value, ctypes.Array):
        return tuple(value)
    if isinstance(value, Object):
        return Object(value.index, value.generation)
    return value
