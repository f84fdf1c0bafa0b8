# SPDX-License-Identifier: GPL-3.0-or-later
"""Grease pencil where Blender cannot draw it over a picture: left out of the render, and named."""

from collections.abc import Iterator
from typing import Any

from ...core import egl_library
from ...core.problems import ERROR, Problems
from ..datablock_ids import name_of
from ..scene.leaf_objects import GREASE_PENCIL
from .scene_check import rendered_layers, rendered_objects

_SWITCH = "hide_render"


class HiddenGreasePencil:
    """All grease pencil of a file while it is hidden from renders. Blender looks for it before it
    asks an engine for a picture, draws it after, and has no switch of its own for that."""

    def __init__(self) -> None:
        self._hidden: list[Any] = []
        self._muted: list[Any] = []  # curves that would show it again
        self.problems = Problems()

    def hide(self, data: Any, scene: Any, view_layer: Any) -> None:
        """`data` is Blender's; the render of `scene` was started in `view_layer`."""
        self.put_back()
        for item in _shown(scene, view_layer):
            text = (
                f'Object "{name_of(item)}" is left out: Blender draws grease pencil with '
                f"{egl_library.LIBRARY}, which is missing: install {egl_library.PACKAGE}"
            )
            self.problems.add(name_of(item), ERROR, "egl_missing", text)
        every = [item for item in data.objects if item.type == GREASE_PENCIL]
        self._muted = [curve for item in every for curve in _switching(item) if not curve.mute]
        for curve in self._muted:
            curve.mute = True
        self._hidden = [item for item in every if not item.hide_render]
        for item in self._hidden:
            item.hide_render = True

    def put_back(self) -> None:
        while self._hidden:
            self._hidden.pop().hide_render = False
        while self._muted:
            self._muted.pop().mute = False
        self.problems = Problems()


def _shown(scene: Any, view_layer: Any) -> list[Any]:
    """The grease pencil of a render, also that of collections that are instanced in it."""
    waiting = list(rendered_objects(rendered_layers(scene, view_layer)))
    found, seen = {}, set()
    for item in waiting:
        if item.type == GREASE_PENCIL:
            found[item] = item
        collection = item.instance_collection if item.instance_type == "COLLECTION" else None
        if collection is not None and collection not in seen:
            seen.add(collection)
            waiting.extend(member for member in collection.all_objects if not member.hide_render)
    return list(found)


def _switching(item: Any) -> Iterator[Any]:
    """The curves that animate whether renders show an object."""
    animation = item.animation_data
    if animation is None:
        return
    strips = [strip for track in animation.nla_tracks for strip in track.strips]
    actions = [animation.action, *(strip.action for strip in strips)]
    curves = [curve for action in actions if action is not None for curve in action.fcurves]
    for curve in (*animation.drivers, *curves):
        if curve.data_path == _SWITCH:
            yield curve
