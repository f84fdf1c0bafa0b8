# SPDX-License-Identifier: GPL-3.0-or-later
"""What the designer decides, kept in the file: `.lodestone` on scenes, collections and objects."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..bridge import object_decisions
from ..core import kind_words
from .decided_property import decided
from .lens_properties import LODESTONE_PG_lens
from .quality_properties import Overrides, RayClasses

ROLES = (  # the last ones are what files hold
    (
        "AUTOMATIC",
        "Automatic",
        "Ordinary, but the ground that most of its collection stands on is never replaced by one "
        "shape, and neither are both together",
        2,
    ),
    (
        "ENVIRONMENT",
        "Environment",
        "Wall, ground or sky: simplified, but never replaced by one shape",
        1,
    ),
    (
        "ORDINARY",
        "Ordinary",
        f"May be drawn as a simpler mesh, {kind_words.any_solid()}, whatever stands on it",
        0,
    ),
)
USES = (
    ("AUTOMATIC", "Automatic", "The coarsest level that is good enough"),
    (
        "ORIGINAL",
        "Always Original",
        "At full detail wherever it is; what it is in is never drawn by one level for all",
    ),
    (
        "LIMIT",
        "Never Coarser Than",
        "No level beyond this one; what it is in is never drawn by one level for all",
    ),
    (
        "EXCLUDE",
        "Exclude",
        "At full detail wherever it is, and drawn apart from what it is in, whose levels are made "
        "without it",
    ),
)
SCOPES = (
    ("SCENE", "Scene", "Everything the scene renders"),
    ("COLLECTION", "Active Collection", "The active collection and what it instances"),
    ("SELECTED", "Selected", "The selected objects and what they instance"),
)
ANTIALIAS = (
    ("AUTOMATIC", "From Pixel Error", "Final up to 1 pixel, then rougher, off from 8 pixels on", 3),
    ("OFF", "Off", "One sample per pixel: for drafts", 0),
    ("FINAL", "Final", "Adaptive: more samples where the picture needs them", 1),
    ("REFERENCE", "Reference", "16 samples in every pixel: slow, for comparing", 2),
)
OFF_SCREEN = (
    ("FULL", "Full Detail", "As if the picture showed them; nothing is left out", 0),
    (
        "REFLECTED",
        "As Shadows and Mirrors Need",
        "Coarser, as far as the picture shows their shadows and as anything in it may mirror or "
        "refract them. Saves little where many things mirror",
        1,
    ),
    (
        "SHADOWS",
        "As Shadows Need",
        "Coarser, as far as the picture shows their shadows. What it mirrors of them may be coarse",
        2,
    ),
)
DEFORMING = (
    (
        "FOLLOW",
        "Follow",
        "Levels are made once, to suit a few frames of the scene's range, and follow the surface "
        "in every frame. What changes its faces (not only their shape) in other frames is drawn as "
        "it is there",
    ),
    (
        "ORIGINAL",
        "Original",
        "What an animation changes the shape of is drawn as it is in all frames",
    ),
    (
        "FRAME",
        "Simplify Each Frame",
        "Levels are made anew for every frame, also of groups with what moves: building takes time "
        "in each, and levels may flicker. For stills",
    ),
)
BUILD_ON_RENDER = (
    (
        "HELPFUL",
        "What Helps",
        "Before a still, only what saves it time, for at most a fifth of the time that it takes: "
        "the first picture comes about as soon as one of full detail, the next ones sooner. "
        "Animations build everything first, for all their frames gain from it",
    ),
    ("ALL", "Everything", "Levels of everything that has none yet or has changed"),
    ("NONE", "Nothing", "Use the levels that there are; only Update Levels makes them"),
)
LOOSE_PARTS = (
    (
        "AUTOMATIC",
        "Automatic",
        "As objects where a mesh has more than 50,000 triangles, most of them in parts that are "
        "small beside the whole: a town or strewn rocks, joined",
    ),
    ("ONE", "One Object", "Levels are made of the whole mesh: all of it is drawn equally fine"),
    (
        "OBJECTS",
        "Objects",
        "Neighboring parts get levels of their own, so that what is far is drawn simpler than what "
        "is near. Glass and what deforms stay one object",
    ),
)
STRUCTURE = (
    (
        "AUTOMATIC",
        "Automatic",
        "Collections of more than 64 children get groups of what is near and alike below them, "
        "which have levels of their own. Nothing in the Outliner changes",
    ),
    ("COLLECTIONS", "Collections Only", "Groups are the collections, as they are"),
)
KEEP = (
    ("NEVER", "Never", "Remove the files of the POV-Ray scene after each render"),
    ("FAILED", "If Failed", "Keep them when POV-Ray fails, to look at what it was given"),
    ("ALWAYS", "Always", "Keep them in a folder beside the levels; what did not change is reused"),
)


class LODESTONE_PG_ignored(bpy.types.PropertyGroup):
    """A problem that is not to be shown: its key, and its text for who reads the file."""

    key: StringProperty(maxlen=16, options={"HIDDEN"})
    text: StringProperty(options={"HIDDEN"})


class LODESTONE_PG_linked(bpy.types.PropertyGroup):
    """A decision on a collection or object linked from a library, which this file cannot hold: by
    its kind, its library's path and its name (the group's own)."""

    kind: StringProperty(options={"HIDDEN"})  # "collection" or "object"
    library: StringProperty(subtype="FILE_PATH", options={"HIDDEN"})  # may be any bytes
    role: EnumProperty(items=ROLES, default="ORDINARY", options={"HIDDEN"})


class LODESTONE_PG_scene(Overrides, RayClasses, bpy.types.PropertyGroup):
    use_levels: BoolProperty(
        name="Levels of Detail",
        description="Draw simpler levels of what is far or small. Off: the originals, as with a "
        "Pixel Error of 0",
        default=True,
    )
    pixel_error_render: FloatProperty(
        name="Pixel Error",
        description="Largest deviation from the original on the rendered image, in pixels. "
        "Lower is finer; 0 renders the originals",
        default=1.0,
        min=0.0,
        soft_max=16.0,
        max=1024.0,
        subtype="PIXEL",
        precision=2,
        step=10,
    )
    pixel_error_viewport: FloatProperty(
        name="Pixel Error Viewport",
        description="The same for what is shown in the viewport, in screen pixels",
        default=4.0,
        min=0.0,
        soft_max=16.0,
        max=1024.0,
        subtype="PIXEL",
        precision=2,
        step=10,
    )
    budget_render: IntProperty(
        name="Memory Budget",
        description="What POV-Ray's scene may take, in megabytes: Pixel Error grows until it fits. "
        "0: any amount",
        default=0,
        min=0,
        soft_max=65536,
        max=16777216,
    )
    budget_viewport: FloatProperty(
        name="Triangle Budget",
        description="How many million triangles the viewport may be given: its Pixel Error grows "
        "until they fit. 0: any number",
        default=0.0,
        min=0.0,
        soft_max=50.0,
        max=1e6,
        precision=2,
        step=10,
    )
    coarser_moving_dark: BoolProperty(
        name="Coarser When Moving or Dark",
        description="Draw coarser what crosses the picture fast while the shutter is open, and "
        "what little light falls on, unless it stands before a bright background",
        default=False,
    )
    off_screen: EnumProperty(
        name="Off Screen",
        description="How fine things are that the picture does not show",
        items=OFF_SCREEN,
        default="REFLECTED",
    )
    antialias: EnumProperty(
        name="Antialiasing",
        description="How many samples POV-Ray takes in a pixel",
        items=ANTIALIAS,
        default="AUTOMATIC",
    )
    scope: EnumProperty(
        name="Build",
        description="What Update Levels and Clear work on",
        items=SCOPES,
        default="SCENE",
    )
    deforming: EnumProperty(
        name="Deforming Objects",
        description="What becomes of objects that move, grow, wave or are posed in an animation",
        items=DEFORMING,
        default="FOLLOW",
    )
    build_on_render: EnumProperty(
        name="Build on Render",
        description="Which levels are made before a picture",
        items=BUILD_ON_RENDER,
        default="HELPFUL",
    )
    structure: EnumProperty(
        name="Groups",
        description="Which groups get levels that stand for all that is in them",
        items=STRUCTURE,
        default="AUTOMATIC",
    )
    keep_scene_files: EnumProperty(
        name="Keep Scene Files",
        description="Whether the files written for POV-Ray stay",
        items=KEEP,
        default="FAILED",
    )
    ignored: CollectionProperty(type=LODESTONE_PG_ignored, options={"HIDDEN"})
    linked: CollectionProperty(type=LODESTONE_PG_linked, options={"HIDDEN"})


def _is_environment(settings):
    return settings.role == "ENVIRONMENT"


def _make_environment(settings, value):
    if value or settings.id_data.override_library is not None:
        settings.role = "ENVIRONMENT" if value else "AUTOMATIC"
    else:  # as if it had never been decided
        settings.property_unset("role")
        object_decisions.tag(settings.id_data)


class _Identified:
    uid: StringProperty(
        name="ID",
        description="16 hexadecimal digits that know this thing through renaming; empty while its "
        "name is enough",
        maxlen=16,
        options={"HIDDEN"},
    )
    role: decided(
        EnumProperty,
        name="Role",
        description="What kind of thing this is",
        items=ROLES,
        default="AUTOMATIC",
    )
    environment: BoolProperty(
        name="Environment",
        description="Wall, ground or sky: simplified, but never replaced by one shape",
        get=_is_environment,
        set=_make_environment,
        options=set(),  # what is computed cannot be animated
        override={"LIBRARY_OVERRIDABLE"},
    )
    use: decided(
        EnumProperty,
        name="Use",
        description="Which of its levels pictures may use",
        items=USES,
        default="AUTOMATIC",
    )
    coarsest: decided(
        IntProperty,
        name="Coarsest Level",
        description="The number of the coarsest level (LOD) that it is drawn with",
        default=1,
        min=1,
        max=31,
    )
    importance: decided(
        FloatProperty,
        name="Importance",
        description="It and all that is in it are drawn so many times finer than Pixel Error asks "
        "for: 2 as from half the distance. Importances of collections, instances and objects "
        "multiply",
        default=1.0,
        min=1.0 / 64.0,
        soft_min=0.25,
        soft_max=4.0,
        max=64.0,
        precision=2,
        step=10,
    )


for _where, _pinned in (
    ("render", "Always draw it with this level in renders, from wherever it is seen"),
    (
        "viewport",
        "Always draw it with this level in viewports that show levels, from wherever it is seen. "
        "Renders are not affected",
    ),
):
    _Identified.__annotations__[f"use_pin_{_where}"] = decided(
        BoolProperty, name=f"Pin in {_where.title()}s", description=_pinned, default=False
    )
    _Identified.__annotations__[f"pin_{_where}"] = decided(
        IntProperty,
        name="Pinned Level",
        description=f"The number of the level (LOD) that {_where}s always draw it with. Where it "
        "has no such one, its coarsest",
        default=0,
        min=0,
        max=31,
    )


class LODESTONE_PG_collection(_Identified, bpy.types.PropertyGroup):
    pass


class LODESTONE_PG_object(_Identified, bpy.types.PropertyGroup):
    lens: PointerProperty(
        type=LODESTONE_PG_lens, options={"HIDDEN"}, override={"LIBRARY_OVERRIDABLE"}
    )
    loose_parts: decided(
        EnumProperty,
        name="Loose Parts",
        description="How the unconnected parts of this object's mesh are drawn. It stays one "
        "object, and at full detail its picture is the same",
        items=LOOSE_PARTS,
        default="AUTOMATIC",
    )


_GROUPS = (LODESTONE_PG_scene, LODESTONE_PG_collection, LODESTONE_PG_object)
_OWNERS = (bpy.types.Scene, bpy.types.Collection, bpy.types.Object)
_CLASSES = (LODESTONE_PG_ignored, LODESTONE_PG_linked, *_GROUPS)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


def register():
    _register()
    try:
        for owner, group in zip(_OWNERS, _GROUPS):
            owner.lodestone = PointerProperty(
                type=group, override={"LIBRARY_OVERRIDABLE"}, options={"HIDDEN"}
            )
    except Exception:
        unregister()
        raise


def unregister():
    for owner in _OWNERS:
        if hasattr(owner, "lodestone"):
            del owner.lodestone
    _unregister()
