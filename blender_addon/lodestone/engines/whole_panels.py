# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels that are drawn in one go wherever a render may call the engine.

Blender keeps in one variable, for all its threads, whether Python may change anything: a panel that
is drawn forbids it, and every call of a Python class puts back what it found. A render that calls
its engine amid a panel, and ends after it, puts back that it is forbidden: from then on timers,
handlers and operators of every add-on fail, until Blender is left. So while a call may begin, no
thread interrupts another that runs Python.
"""

import contextlib
import sys

import bpy

_WHOLE_S = 5.0  # Law: longer than any panel takes to draw
_usual_s = None  # the interval of Blender, while there is another


def _begin():
    global _usual_s
    if _usual_s is None and not bpy.app.background:
        _usual_s = sys.getswitchinterval()
        sys.setswitchinterval(_WHOLE_S)


def end():
    """The engine is called no more."""
    global _usual_s
    if _usual_s is not None:
        sys.setswitchinterval(_usual_s)
        _usual_s = None


@contextlib.contextmanager
def engine_works():
    """Threads take turns as usual meanwhile; afterwards the engine may be called again."""
    end()
    try:
        yield
    finally:
        _begin()


@bpy.app.handlers.persistent
def _on_begin(rendered, *_):
    if rendered.render.engine == "LODESTONE_POVRAY":
        _begin()


@bpy.app.handlers.persistent
def _on_end(*_):
    end()


HANDLERS = (("render_init", _on_begin), ("render_complete", _on_end), ("render_cancel", _on_end))
