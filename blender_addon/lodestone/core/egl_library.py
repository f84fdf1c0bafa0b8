# SPDX-License-Identifier: GPL-3.0-or-later
"""The library libEGL, through which Blender draws on the GPU where it has no display. It opens it
when it first draws so; where the library is missing, it ends on the spot with all its work."""

import ctypes
import functools

LIBRARY = "libEGL.so.1"
PACKAGE = "libegl1"
_X11_LIBRARY = "libX11.so.6"


def missing() -> bool:
    """Whether a Blender in the background would end as soon as it draws on the GPU. Where it
    reaches an X display it draws through that and needs no libEGL."""
    return not _opens(LIBRARY) and not _reaches_display()


@functools.cache
def _opens(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _reaches_display() -> bool:
    """Whether the X display that $DISPLAY names answers, as Blender itself tries it."""
    try:
        x11 = ctypes.CDLL(_X11_LIBRARY)
    except OSError:
        return False
    x11.XOpenDisplay.argtypes, x11.XOpenDisplay.restype = [ctypes.c_char_p], ctypes.c_void_p
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = x11.XOpenDisplay(None)
    if display is None:
        return False
    x11.XCloseDisplay(display)
    return True
