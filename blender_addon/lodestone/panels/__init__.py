# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels in Properties. Those of our engine stand where Cycles has its own."""

import importlib

ENGINE = "LODESTONE_POVRAY"
# In the order in which they appear within a tab
_MODULES = (
    "sampling",
    "simplify",
    "render_levels",
    "view_statistics",
    "unseen",
    "overrides",
    "levels",
    "lens",
    "why",
    "cost",
    "comparison",
    "problems",
    "film",
    "visibility",
    "material",
    "light",
    "world",
    "camera",
)
_loaded: list = []


class EnginePanel:
    """A panel that only our engine has. `shows` names the attribute of the context that it is
    about, if any: without it there is no panel."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    shows: str | None = None
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        shown = cls.shows is None or getattr(context, cls.shows, None) is not None
        return shown and context.engine in cls.COMPAT_ENGINES


def register():
    try:
        for name in _MODULES:
            module = importlib.import_module(f"{__name__}.{name}")
            module.register()
            _loaded.append(module)
    except Exception:
        unregister()
        raise


def unregister():
    while _loaded:
        _loaded.pop().unregister()
