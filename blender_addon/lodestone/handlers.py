# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's application handlers: a module's own are added together and removed together."""

import bpy


def add(handlers):
    """`handlers`: pairs of the name of a list in bpy.app.handlers and a persistent function."""
    for name, handler in handlers:
        getattr(bpy.app.handlers, name).append(handler)


def remove(handlers):
    """Those that are not there any more are passed over."""
    for name, handler in handlers:
        present = getattr(bpy.app.handlers, name)
        if handler in present:
            present.remove(handler)
