# SPDX-License-Identifier: GPL-3.0-or-later
"""What every struct has: its size, ids of objects, and the ways in and out of it."""

from __future__ import annotations

import ctypes
from array import array
from ctypes import Structure
from typing import TYPE_CHECKING, Any, TypeVar, Union

if TYPE_CHECKING:
    from ctypes import Array, _CData, _Pointer, _SimpleCData

    Pointer = _Pointer
    Data = TypeVar("Data", bound=_CData)
    Item = TypeVar("Item", bound=_SimpleCData[Any])
    # ctypes takes the thing itself where a pointer to it is wanted.
    Ref = Union[Data, Pointer[Data], Array[Data], None]
    Buffer = Union[array[Any], memoryview]  # writable and contiguous

Text = Union[bytes, None]


class Sized(Structure):
    """A struct that starts with struct_size; the constructor fills it."""

    struct_size: int

    def __init__(self, **fields: Any) -> None:
        super().__init__(struct_size=ctypes.sizeof(type(self)), **fields)


class Id(Structure):
    """An id of something in one model. {0, 0} is none."""

    index: int
    generation: int

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Id) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def __bool__(self) -> bool:
        return self.key != (0, 0)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.index}, {self.generation})"

    @property
    def key(self) -> tuple[int, int]:
        return (self.index, self.generation)


def text_in(text: str | None) -> Text:
    """UTF-8 for the library; bytes of a name that is no UTF-8 travel through unchanged."""
    return None if text is None else text.encode("utf-8", "surrogateescape")


def text_out(data: Text) -> str:
    return "" if data is None else data.decode("utf-8", "replace")


def plain(struct: Structure) -> dict[str, Any]:
    """The struct's values by name, which stay valid: strings and arrays are copied."""
    names = (field[0] for field in struct._fields_ if field[0] != "struct_size")
    return {name: _copied(getattr(struct, name)) for name in names}


def _copied(value: Any) -> Any:
    if isinstance(value, bytes) or value is None:
        return text_out(value)
    if isinstance(value, ctypes.Array):
        return tuple(value)
    if isinstance(value, Id):
        return type(value)(value.index, value.generation)
    return value


def pointer_to(buffer: Buffer | None, kind: type[Item]) -> Pointer[Item] | None:
    """Points to the items of a buffer, which is to be kept until the call is over."""
    if buffer is None or not len(buffer):
        return None
    if isinstance(buffer, memoryview):
        start = ctypes.addressof(ctypes.c_char.from_buffer(buffer))
    else:
        start = buffer.buffer_info()[0]
    return ctypes.cast(start, ctypes.POINTER(kind))
