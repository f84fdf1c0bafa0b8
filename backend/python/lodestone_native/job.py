# SPDX-License-Identifier: GPL-3.0-or-later
"""A long call's progress and its off switch, shared with the library by reference."""

import ctypes
from ctypes import Structure, c_double, c_int32, c_uint32


class Job(Structure):
    """Give it to a long call; read `stage` and `fraction` and call `stop` from any thread."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("cancel", c_int32),
        ("stage", c_int32),
        ("fraction", c_double),
    ]

    def __init__(self) -> None:
        super().__init__(struct_size=ctypes.sizeof(Job))

    def stop(self) -> None:
        """The call raises CANCELLED within about 0.1 s."""
        self.cancel = 1
