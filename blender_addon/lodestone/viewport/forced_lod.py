# SPDX-License-Identifier: GPL-3.0-or-later
"""Force LOD: a viewport in which every object shows its n-th level, for looking at levels. Each
viewport has its own; none is ever saved."""

import bpy
from bpy.props import BoolProperty, IntProperty

from ..core.preview.preview_tree import NOT_FORCED
from ..core.session.addon_session import addon_session

_DEFAULT = 1


class ForcedViewports:
    """Viewports that force a level, by their addresses; part of the session."""

    def __init__(self):
        self.on = set()
        self.lods = {}  # also of viewports where it is off


def _forced():
    return addon_session().part(ForcedViewports)


def of_view(space):
    """The LOD number that a 3D viewport forces, or NOT_FORCED."""
    key, forced = space.as_pointer(), _forced()
    return forced.lods.get(key, _DEFAULT) if key in forced.on else NOT_FORCED


def _key():
    """Of the viewport whose popover is drawn or used."""
    space = bpy.context.space_data
    return space.as_pointer() if space is not None and space.type == "VIEW_3D" else None


def _redraw():
    if bpy.context.area is not None:
        bpy.context.area.tag_redraw()


def _is_on(settings):
    return _key() in _forced().on


def _turn(settings, value):
    key = _key()
    if key is not None:
        (_forced().on.add if value else _forced().on.discard)(key)
        _redraw()


def _lod(settings):
    return _forced().lods.get(_key(), _DEFAULT)


def _set_lod(settings, value):
    key = _key()
    if key is not None:
        _forced().lods[key] = value
        _redraw()


class ForcedLod:
    """Annotations for a property group."""

    use_force_lod: BoolProperty(
        name="Force LOD",
        description="Draw every object with one and the same level in this viewport, whatever is "
        "near or decided: for looking at levels. What has no such one shows its coarsest. "
        "Renders are not affected",
        get=_is_on,
        set=_turn,
        options={"SKIP_SAVE"},
    )
    force_lod: IntProperty(
        name="LOD",
        description="The number of the level that every object shows; 0 is the original",
        min=0,
        max=31,
        get=_lod,
        set=_set_lod,
        options={"SKIP_SAVE"},
    )
