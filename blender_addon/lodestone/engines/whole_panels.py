# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels that are drawn in one go wherever a render may call the engine.

Blender keeps in one variable, for all its threads, whether Python may change anything: a panel that
is drawn forbids it, and every call of a Python class puts back what it found. A render that calls
its engine amid a panel, and ends after it, puts back that it is forbidden: from then on timers,
handlers and operators of every add-on fail, until Blender is left. So a render waits, before its
first call, until no panel is drawn; and while a call may begin, no thread interrupts another that
runs Python. (The wait is for the panel that the handlers of the render interrupted themselves:
on a busy machine the render is back at Python before it.)
"""

import contextlib
import sys
import threading
import time

import bpy

from ..core.session.addon_session import addon_session

# Taste: longer than panels take to draw, and not felt where a render never says that it ended.
_WHOLE_S = 0.5
# Taste: a script that waits in the window for the render it began is not waited for longer.
_LONGEST_WAIT_S = 2.0
_LOOKS_S = 0.001  # between two looks at the window
_ENGINES = {"LODESTONE_POVRAY", "LODESTONE_EXTRACT"}


class _Turns:
    """How long a thread runs Python before another one may; part of the session."""

    def __init__(self):
        self._usual_s = None  # Blender's own, while there is another

    def lengthen(self):
        """The engine may be called."""
        if self._usual_s is None and not bpy.app.background:
            self._usual_s = sys.getswitchinterval()
            sys.setswitchinterval(_WHOLE_S)

    def close(self):
        """It is not called any more, or works."""
        if self._usual_s is not None:
            sys.setswitchinterval(self._usual_s)
            self._usual_s = None


def _turns():
    return addon_session().part(_Turns)


@contextlib.contextmanager
def engine_works():
    """Threads take turns as usual meanwhile; afterwards the engine may be called again."""
    _turns().close()
    try:
        yield
    finally:
        _turns().lengthen()


@bpy.app.handlers.persistent
def _on_begin(rendered, *_):
    if rendered.render.engine in _ENGINES:
        _turns().lengthen()
        _let_the_window_finish()


def _let_the_window_finish():
    """Waits until the thread of the window runs no Python, where this is another one."""
    window = threading.main_thread().ident
    if bpy.app.background or threading.get_ident() == window:
        return
    end = time.monotonic() + _LONGEST_WAIT_S
    while window in sys._current_frames() and time.monotonic() < end:
        time.sleep(_LOOKS_S)


@bpy.app.handlers.persistent
def _on_end(*_):
    _turns().close()


_ENDS = ("render_complete", "render_cancel", "load_pre")
_BEGINS = ("render_init", "render_pre")
HANDLERS = (*((name, _on_begin) for name in _BEGINS), *((name, _on_end) for name in _ENDS))
