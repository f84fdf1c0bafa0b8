# SPDX-License-Identifier: GPL-3.0-or-later
"""Render jobs of the window: what has to wait until none runs.

Blender crashes when the class of an engine goes while a job uses it, and a job that was told to
stop ends only when the window is back at its events: nothing can wait for it.
"""

import bpy

_STEP_S = 0.1
_waiting = {}  # the timer of each function


def runs():
    return bpy.app.is_job_running("RENDER")


def when_none_runs(function):
    """Calls it now, or as soon as no job runs any more."""
    if not runs():
        function()
        return

    def look():
        if runs():
            return _STEP_S
        del _waiting[function]
        function()
        return None

    _waiting[function] = look
    bpy.app.timers.register(look, first_interval=_STEP_S, persistent=True)


def take_back(function):
    """Whether it still waited; then it is not called any more."""
    look = _waiting.pop(function, None)
    if look is None:
        return False
    bpy.app.timers.unregister(look)
    return True
