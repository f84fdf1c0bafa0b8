# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene's settings as they are in the file, else their defaults: a render stores nothing."""

from typing import Any

from . import datablock_ids


class SceneSettings:
    """Reads the attributes of `scene.lodestone` without making Blender store an empty group. A word
    that this version does not know, from a file of another one, is the default, too."""

    def __init__(self, scene: Any) -> None:
        self._stored = datablock_ids.settings_of(scene)
        self._known = scene.bl_rna.properties["lodestone"].fixed_type.properties

    def __getattr__(self, name: str) -> Any:
        if self._stored is not None:
            value = getattr(self._stored, name)
            if value != "" or self._known[name].type != "ENUM":
                return value
        if name not in self._known:
            raise AttributeError(name)
        return self._known[name].default
