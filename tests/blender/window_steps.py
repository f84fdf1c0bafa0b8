# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs steps in a Blender window, one after the other, from a timer; prints what went wrong.

A step is a generator: it yields to let the window work, and ends when it is done.
"""

import os
import sys
import time
import traceback

import bpy


def wait_until(condition, seconds=60.0):
    """Yields until condition() is true; fails after a time no step takes."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited {seconds:g} s for {condition.__name__}")
        yield


def window():
    """A context for operators called from a timer."""
    first = bpy.context.window_manager.windows[0]
    area = next(a for a in first.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    return bpy.context.temp_override(window=first, area=area, region=region)


def takes_operators():
    """Whether Blender takes operators now: not amid a panel, or while a render holds its data."""
    try:
        with window():
            bpy.ops.ed.undo_push(message="Step")
    except RuntimeError:
        return False
    return True


def press(key):
    """A key, as if pressed in the window (needs --enable-event-simulate)."""
    first = bpy.context.window_manager.windows[0]
    for value in ("PRESS", "RELEASE"):
        first.event_simulate(type=key, value=value, x=first.width // 2, y=first.height // 2)


def run(steps):
    """Runs the generator functions in order, then leaves Blender: 0 when all of them ended."""
    queue = list(steps)
    current = []

    def tick():
        try:
            if not current:
                if not queue:
                    print("WINDOW STEPS DONE", flush=True)
                    _leave(0)
                print(f"step {queue[0].__name__}", flush=True)
                current.append(queue.pop(0)())
            next(current[0])
        except StopIteration:
            current.clear()
        except BaseException:
            traceback.print_exc()
            _leave(1)
        return 0.05

    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)


def _leave(code):
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
