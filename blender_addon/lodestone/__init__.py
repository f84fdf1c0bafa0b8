# SPDX-License-Identifier: GPL-3.0-or-later
"""Lodestone: author at full detail, render with just the detail each picture needs.

Importing this package needs no Blender: batch.py and the tests of core/ use it from plain Python.
"""

import importlib
from types import ModuleType

bl_info = {
    "name": "Lodestone",
    "author": "The Lodestone authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Levels of Detail",
    "description": "POV-Ray pictures that use just the detail they need",
    "category": "Render",
    "support": "COMMUNITY",
}

_DATA_MODULES = ("properties.lens_properties", "properties.property_groups", "preferences")
_MODULES = (
    *_DATA_MODULES,
    "viewport.levels_preview",
    "engines.render_engine",
    "operators.window_run",
    "operators.update_levels",
    "operators.auto_structure",
    "operators.clear_levels",
    "operators.select_object",
    "operators.linked_role",
    "operators.copy_decisions",
    "operators.inherit_control",
    "operators.detail_lens",
    "operators.screen_lenses",
    "operators.check_scene",
    "operators.problems",
    "operators.compare",
    "operators.read_levels",
    "operators.false_color_picture",
    "operators.show_levels",
    "viewport.false_color_overlay",
    "panels",
    "viewport.lens_overlay",
    "panels.stock_panels",
)
_loaded: list[ModuleType] = []


def register(data_only: bool = False) -> None:
    """`data_only`: what files hold of Lodestone, for jobs that draw nothing in Blender."""
    try:
        for name in _DATA_MODULES if data_only else _MODULES:
            module = importlib.import_module(f"{__name__}.{name}")
            module.register()
            _loaded.append(module)
    except Exception:
        unregister()  # leave Blender as it was, then let the error be seen
        raise


def unregister() -> None:
    while _loaded:
        _loaded.pop().unregister()
