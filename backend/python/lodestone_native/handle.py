# SPDX-License-Identifier: GPL-3.0-or-later
"""What Model and Cut share: an opaque pointer of the library and its end."""

import ctypes
from typing import TypeVar

from .library import library

Self = TypeVar("Self", bound="Handle")


class Handle:
    """Close it (or leave the `with` block) to free its memory; closing twice is fine."""

    _destroy: str  # the C function that frees it
    _handle: ctypes.c_void_p | None = None

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        handle, self._handle = self._handle, None
        if handle:
            getattr(library(), self._destroy)(handle)

    @property
    def handle(self) -> ctypes.c_void_p:
        if not self._handle:
            raise ValueError(f"the {type(self).__name__.lower()} is closed")
        return self._handle
