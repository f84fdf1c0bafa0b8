# SPDX-License-Identifier: GPL-3.0-or-later
"""The classes of rays that see an object: Blender's ray visibility, indirect-only and holdout, as
POV-Ray can do it."""

from collections.abc import Iterator
from operator import attrgetter
from typing import Any, NamedTuple

from ...core.native import lodestone_native as native
from ...core.problems import INFO, WARNING, Problems
from ..datablock_ids import name_of

RayClass = native.RayClass


class RaySwitch(NamedTuple):
    """`name`: Blender's property of an object. `label`: the panel's word for it."""

    name: str
    label: str
    ray_class: native.RayClass


SWITCHES = (
    RaySwitch("visible_camera", "Camera", RayClass.CAMERA),
    RaySwitch("visible_glossy", "Glossy", RayClass.REFLECTION),
    RaySwitch("visible_shadow", "Shadow", RayClass.SHADOW),
    RaySwitch("visible_diffuse", "Diffuse", RayClass.RADIOSITY),
)
# What nearly all objects have: all rays see them
SEEN_BY_ALL = {
    **dict.fromkeys((switch.name for switch in SWITCHES), True),
    "visible_transmission": True,
    "is_shadow_catcher": False,
}
# The classes with a switch, and all classes
_SWITCHED = int(sum(switch.ray_class for switch in SWITCHES))
_ALL = int(sum(RayClass))
_SEEN = attrgetter(*SEEN_BY_ALL)
_SEEN_VALUES = tuple(SEEN_BY_ALL.values())


class Visibility:
    """The visibility of evaluated objects as one view layer shows them."""

    def __init__(self, view_layer: Any, problems: Problems) -> None:
        self._view_layer = view_layer
        self._problems = problems
        layers = list(_all_layers(view_layer.layer_collection))
        # Most view layers have none, and asking every object takes longer than all its switches.
        self._any = {
            "indirect_only_get": any(layer.indirect_only for layer in layers),
            "holdout_get": any(layer.holdout for layer in layers),
        }

    @property
    def by_layer(self) -> bool:
        """Whether collections of the view layer hide any of its objects from some rays."""
        return any(self._any.values())

    def hidden(self, item: Any, in_scene: bool) -> int:
        """The ray classes that do not see it. `in_scene`: it is an object of the scene itself, not
        of a collection that is instanced (only then does its place in the view layer count)."""
        if _plain(item) and not (in_scene and self._any["indirect_only_get"]):
            return 0
        hidden = 0
        for name, _, ray_class in SWITCHES:
            if not getattr(item, name, True):
                hidden |= ray_class
        if getattr(item, "visible_transmission", True) != getattr(item, "visible_camera", True):
            text = f'Object "{name_of(item)}" is seen through glass just as the camera sees it'
            self._problems.add(name_of(item), INFO, "visible_transmission", text)
        if getattr(item, "is_shadow_catcher", False):
            hidden |= RayClass.CAMERA | RayClass.REFLECTION
            text = f'Object "{name_of(item)}" is a shadow catcher: left out with the shadows on it'
            self._problems.add(name_of(item), WARNING, "shadow_catcher", text)
        if in_scene and self._in_layer(item, "indirect_only_get"):
            hidden |= RayClass.CAMERA
        # Without this, a class without a switch would still see what is hidden from all others.
        return _ALL if hidden & _SWITCHED == _SWITCHED else int(hidden)

    def holdout(self, item: Any, in_scene: bool) -> bool:
        """Whether it cuts a hole into the picture."""
        if getattr(item, "is_holdout", False):
            return True
        return in_scene and self._in_layer(item, "holdout_get")

    def name_holdout(self, name: str) -> None:
        text = f'Object "{name}" is a holdout: drawn black, which is right but for its alpha of 1'
        self._problems.add(name, WARNING, "holdout", text)

    def _in_layer(self, item: Any, question: str) -> bool:
        if not self._any[question]:
            return False
        try:
            return bool(getattr(item, question)(view_layer=self._view_layer))
        except RuntimeError:  # it is in no collection of this layer
            return False


def _plain(item: Any) -> bool:
    """Seen by all rays, as nearly everything is: asked for every object."""
    try:
        return bool(_SEEN(item) == _SEEN_VALUES)
    except AttributeError:  # a Blender that lacks one of them
        return False


def _all_layers(layer: Any) -> Iterator[Any]:
    yield layer
    for child in layer.children:
        yield from _all_layers(child)
