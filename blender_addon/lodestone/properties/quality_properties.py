# SPDX-License-Identifier: GPL-3.0-or-later
"""The controls below Pixel Error as properties: one that is drawn, which shows what it inherits
until it is set, and one that is stored, which is below 0 while it inherits."""

from bpy.props import BoolProperty, FloatProperty, IntProperty

from ..bridge import quality_settings
from ..core.picture import quality_tree, unseen_detail


def _reader(key):
    def read(settings):
        return getattr(quality_settings.of_scene(settings), key)

    return read


def _writer(key):
    def write(settings, value):
        setattr(settings, quality_settings.OWN + key, value)

    return write


def _drawn(control):
    whole = isinstance(control.least, int)
    limits = {"min": control.least, "max": control.most}
    own = {
        "name": control.label,
        "description": control.description,
        "get": _reader(control.key),
        "set": _writer(control.key),
        "options": set(),  # what is computed cannot be animated
    }
    if whole:
        return IntProperty(**own, **limits)
    return FloatProperty(**own, **limits, soft_max=16.0, subtype="PIXEL", precision=2, step=10)


def _stored(control):
    own = {
        "name": control.label,
        "description": f"The {control.label} of this scene; below 0 it inherits",
        "options": {"HIDDEN"},
    }
    if isinstance(control.least, int):
        return IntProperty(**own, default=-1, min=-1, max=control.most)
    return FloatProperty(**own, default=-1.0, min=-1.0, max=control.most)


class Overrides:
    """Annotations for a property group."""

    __annotations__ = {}


for _control in quality_tree.CONTROLS:
    if _control.least is not None:
        Overrides.__annotations__[_control.key] = _drawn(_control)
        Overrides.__annotations__[quality_settings.OWN + _control.key] = _stored(_control)


class RayClasses:
    """The same: which classes of rays may meet coarser levels than the camera's."""

    __annotations__ = {
        one.key: BoolProperty(name=one.label, description=one.description, default=False)
        for one in unseen_detail.CLASSES
    }
