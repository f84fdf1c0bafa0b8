# SPDX-License-Identifier: GPL-3.0-or-later
"""Lenses, kept in the file: a detail lens on its Empty, screen lenses and depth on their camera."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
)

from .decided_property import decided

FILTERS = (
    ("ALL", "Everything", "Whatever the lens touches is refined"),
    ("REFINE", "Refine Only", "Only what is in the collection is refined, all else is as outside"),
    (
        "SHOW",
        "Show Only",
        "Only what is in the collection is drawn inside the lens: what else has its center there "
        "is left out",
    ),
)
_STRENGTH = {
    "name": "Strength",
    "default": 4.0,
    "min": 1.0 / 64.0,
    "soft_min": 0.25,
    "soft_max": 16.0,
    "max": 64.0,
    "precision": 2,
    "step": 10,
}
_FALLOFF = {
    "name": "Fall-Off",
    "description": "How soon it fades towards the rim: 0 is the same strength everywhere inside, 1 "
    "a soft rim, larger ones a small strong middle",
    "default": 1.0,
    "min": 0.0,
    "soft_max": 8.0,
    "max": 64.0,
    "precision": 2,
    "step": 10,
}


def _holds_levels(self, collection):
    return collection.library is not None or not collection.name.startswith(".")


class LODESTONE_PG_lens(bpy.types.PropertyGroup):
    """On an Empty: its place, turn, scale and size are the lens's."""

    enabled: decided(
        BoolProperty,
        name="Detail Lens",
        description="Draw what is inside this Empty's sphere or cube finer, or coarser, than Pixel "
        "Error asks for",
        default=False,
    )
    strength: decided(
        FloatProperty,
        **_STRENGTH,
        description="What is in the middle is drawn so many times finer: 4 as from a quarter of "
        "the distance; below 1 coarser",
    )
    falloff: decided(FloatProperty, **_FALLOFF)
    filter: decided(
        EnumProperty,
        name="Works On",
        description="What the lens is about",
        items=FILTERS,
        default="ALL",
    )
    collection: decided(
        PointerProperty,
        name="Collection",
        description="The collection that the lens is about, with all that is in it",
        type=bpy.types.Collection,
        poll=_holds_levels,
    )


class LODESTONE_PG_screen_lens(bpy.types.PropertyGroup):
    """A disc on the image, in shares of it: the same at every resolution."""

    enabled: decided(BoolProperty, name="Use", description="Whether this lens counts", default=True)
    x: decided(
        FloatProperty,
        name="X",
        description="Its middle, from the image's left (0) to its right (1)",
        default=0.5,
        soft_min=0.0,
        soft_max=1.0,
        min=-8.0,
        max=8.0,
    )
    y: decided(
        FloatProperty,
        name="Y",
        description="Its middle, from the image's bottom (0) to its top (1)",
        default=0.5,
        soft_min=0.0,
        soft_max=1.0,
        min=-8.0,
        max=8.0,
    )
    radius: decided(
        FloatProperty,
        name="Radius",
        description="As a share of the image's width",
        default=0.1,
        min=0.0,
        soft_max=1.0,
        max=8.0,
    )
    strength: decided(
        FloatProperty,
        **_STRENGTH,
        description="What is in its middle is drawn so many times finer: 4 as from a quarter of "
        "the distance; below 1 coarser",
    )
    falloff: decided(FloatProperty, **_FALLOFF)


class LODESTONE_PG_camera(bpy.types.PropertyGroup):
    depth_exaggeration: decided(
        FloatProperty,
        name="Depth Exaggeration",
        description="How fast detail falls off beyond Focus Distance, and grows before it: 1 is as "
        "Pixel Error asks for, at 2 what is twice as far as that is twice as coarse",
        default=1.0,
        min=0.0,
        soft_min=1.0,
        soft_max=3.0,
        max=8.0,
        precision=2,
        step=10,
    )
    screen_lenses: CollectionProperty(type=LODESTONE_PG_screen_lens, options={"HIDDEN"})
    active_screen_lens: IntProperty(name="Active Lens", options={"HIDDEN"})


_CLASSES = (LODESTONE_PG_lens, LODESTONE_PG_screen_lens, LODESTONE_PG_camera)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


def register():
    _register()
    bpy.types.Camera.lodestone = PointerProperty(type=LODESTONE_PG_camera, options={"HIDDEN"})


def unregister():
    if hasattr(bpy.types.Camera, "lodestone"):
        del bpy.types.Camera.lodestone
    _unregister()
