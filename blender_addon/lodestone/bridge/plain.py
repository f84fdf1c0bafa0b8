# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain objects: those of which nothing but their mesh, their materials and their place counts.

Most objects of large scenes are. What makes one plain is asked of Blender at a stroke: question by
question it is most of what extracting many small objects takes.
"""

from operator import attrgetter
from typing import Any

from . import ids

_ASKED = attrgetter(
    "parent",
    "rigid_body",
    "type",
    "library",
    "animation_data",
    "instance_type",
    "is_holdout",
    "is_shadow_catcher",
    "visible_camera",
    "visible_glossy",
    "visible_shadow",
    "visible_diffuse",
    "visible_transmission",
)
_PLAIN = ("MESH", None, None, "NONE", False, False, True, True, True, True, True)
_LOOSE = (None, None, *_PLAIN)


def plain(item: Any) -> bool | None:
    """Whether nothing can move an evaluated object that is plain: a mesh without modifiers (so
    without particles) and actions, seen by all rays, instancing nothing, local, not decided upon.
    None: it is not plain."""
    try:
        asked = _ASKED(item)
    except AttributeError:  # another Blender
        return None
    loose = asked == _LOOSE
    if not loose and asked[2:] != _PLAIN or item.modifiers or ids.has_settings(item):
        return None
    return loose and not item.constraints
