# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene's settings as they are in the file, else their defaults: a render stores nothing."""

from typing import Any

from . import ids


class SceneSettings:
    """Reads the attributes of `scene.lodestone` without making Blender store an empty group."""

    def __init__(self, scene: Any) -> None:
        self._stored = ids.settings_of(scene)
        self._known = scene.bl_rna.properties["lodestone"].fixed_type.properties

    def __getattr__(self, name: str) -> Any:
        if self._stored is not None:
            return getattr(self._stored, name)
        if name not in self._known:
            raise AttributeError(name)
        return self._known[name].default
