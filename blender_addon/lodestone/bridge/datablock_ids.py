# SPDX-License-Identifier: GPL-3.0-or-later
"""The names of Blender's datablocks outside Blender: their uids, and their roles."""

from itertools import repeat
from operator import contains
from typing import Any

import bpy

from ..core import stable_ids
from ..core.native import lodestone_native as native
from ..core.placement_decision import UNDECIDED, Decision, decision
from ..core.printable_text import readable


_STORED_AMONG_CUSTOM = bpy.app.version < (5, 0, 0)  # where Blender keeps what add-ons store


def name_of(thing: Any, field: str = "name") -> str:
    """The name that Blender has for something, or another text of it, made readable where it is no
    text: damaged and very old files hold any bytes. Never look such things up by get(), keys() or
    repr(): these leave an error behind that takes Blender down."""
    try:
        return getattr(thing, field)
    except UnicodeDecodeError as error:
        return readable(error.object)


def called(things: Any, name: str) -> Any | None:
    """The first of them with that name, as name_of() gives it."""
    return next((thing for thing in things if name_of(thing) == name), None)


def library_of(datablock: Any) -> str:
    """The path of the library it is linked from; "" for a local one."""
    return datablock.library.filepath if datablock.library else ""


AUTOMATIC = "AUTOMATIC"
Key = tuple[str, str, str]  # "object" or "collection", library, name


def key_of(kind: str, datablock: Any) -> Key:
    return (kind, library_of(datablock), name_of(datablock))


def key_of_local(name: str) -> Key:
    """The key of an object of this file."""
    return ("object", "", name)


def settings_of(datablock: Any) -> Any | None:
    """Its `.lodestone`, or None when the file holds none: merely reading the attribute would make
    Blender store an empty group."""
    try:
        return datablock.lodestone if datablock.is_property_set("lodestone") else None
    except TypeError:  # a kind of datablock that has no such settings
        return None


def has_settings(datablock: Any) -> bool:
    """Whether the file holds any settings of an object or collection."""
    if _STORED_AMONG_CUSTOM:
        return "lodestone" in datablock  # a sixth of the time
    return settings_of(datablock) is not None


def have_settings(datablocks: list[Any]) -> list[bool]:
    """The answer of has_settings() for each."""
    if _STORED_AMONG_CUSTOM:
        return list(map(contains, datablocks, repeat("lodestone")))
    return list(map(has_settings, datablocks))


def stored_uid(datablock: Any) -> str:
    """The uid that is stored, valid or not; "" when there is none."""
    settings = settings_of(datablock)
    return settings.uid if settings is not None else ""


def uid_of(kind: str, datablock: Any) -> str:
    """The stored uid of an object or collection, else one made of its library and name."""
    stored = stored_uid(datablock)
    if stable_ids.is_uid(stored):
        return stored
    return stable_ids.named_id(kind, library_of(datablock), name_of(datablock))


def scene_uid(name: str) -> str:
    return stable_ids.named_id("scene", "", name)


def named_id_of(material: Any | None) -> str:
    """A material's id by library and name; "" for an empty slot."""
    if material is None:
        return ""
    return stable_ids.named_id("material", library_of(material), name_of(material))


def role_of(datablock: Any) -> str:
    """The role in the file: AUTOMATIC, ENVIRONMENT or ORDINARY."""
    settings = settings_of(datablock)
    return AUTOMATIC if settings is None else settings.role


def decision_of(datablock: Any, viewport: bool = False) -> Decision:
    """About how finely an object or collection is drawn, in renders or in viewports."""
    settings = settings_of(datablock)
    if settings is None:
        return UNDECIDED
    if viewport:
        pin = settings.pin_viewport if settings.use_pin_viewport else -1
    else:
        pin = settings.pin_render if settings.use_pin_render else -1
    return decision(settings.use, settings.coarsest, settings.importance, pin)


def loose_parts(datablock: Any) -> str:
    """The way an object's loose parts are drawn: AUTOMATIC, ONE or OBJECTS."""
    settings = settings_of(datablock)
    return AUTOMATIC if settings is None else settings.loose_parts


class Roles:
    """Roles as one scene sees them: what is linked has the one decided here, if any."""

    def __init__(self, scene: Any) -> None:
        settings = settings_of(scene)
        decided = settings.linked if settings is not None else ()
        self._linked = [((item.kind, item.library, item.name), item.role) for item in decided]

    def of(self, datablock: Any) -> str:
        if datablock.library and self._linked:
            kind = "collection" if datablock.bl_rna.identifier == "Collection" else "object"
            key = key_of(kind, datablock)
            for decided, role in self._linked:
                if same_linked(decided, key):
                    return role
        return role_of(datablock)

    def is_environment(self, datablock: Any) -> bool:
        return self.of(datablock) == "ENVIRONMENT"

    def is_ordinary(self, datablock: Any) -> bool:
        return self.of(datablock) == "ORDINARY"


def same_linked(a: Key, b: Key) -> bool:
    """Whether two keys of linked things mean one: Blender makes a library's path relative or
    absolute as files are saved and moved."""
    return a[0] == b[0] and a[2] == b[2] and stable_ids.same_library(a[1], b[1])


def role(environment: bool, ordinary: bool) -> int:
    """`environment`: it, or a collection around it; `ordinary`: itself."""
    if environment:
        return native.Role.ENVIRONMENT
    return native.Role.ORDINARY if ordinary else native.Role.AUTOMATIC


class Uids:
    """Gives out uids, each once in a model: a second thing that claims one gets the next best."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def claim(self, uid: str) -> str:
        chosen, attempt = uid, 0
        while chosen in self._taken:
            attempt += 1
            chosen = stable_ids.stable_id(uid, "again", attempt)
        self._taken.add(chosen)
        return chosen
