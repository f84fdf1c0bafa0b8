# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing and clearing `.lodestone` on objects and collections; only local ones are touched."""

from collections.abc import Iterable
from typing import Any

import bpy

from ..core import stable_ids
from ..core.session.addon_session import addon_session
from . import datablock_ids, quality_settings
from .datablock_ids import name_of

_INHERITED = {"rna_type", "name"}
_COMPUTED = {"environment"}  # properties behind `role`, which always count as set

Thing = tuple[str, Any]  # "object" or "collection", the datablock


def reachable(collections: Iterable[Any], objects: Iterable[Any]) -> list[Thing]:
    """These objects and collections and all they hold or instance, each once, by kind and name."""
    found: dict[int, Thing] = {}
    waiting: list[Thing] = [("collection", c) for c in collections]
    waiting += [("object", o) for o in objects]
    while waiting:
        kind, item = waiting.pop()
        if item.as_pointer() in found:
            continue
        found[item.as_pointer()] = (kind, item)
        if kind == "collection":
            waiting += [("collection", child) for child in item.children]
            waiting += [("object", member) for member in item.objects]
        elif item.instance_type == "COLLECTION" and item.instance_collection is not None:
            waiting.append(("collection", item.instance_collection))
    return sorted(found.values(), key=lambda thing: (thing[0], name_of(thing[1], "name_full")))


def scope_keys(context: Any, scope: str) -> list[datablock_ids.Key] | None:
    """The datablocks whose levels are to be built with all they hold; None for everything."""
    if scope == "SELECTED":
        return [datablock_ids.key_of("object", item) for item in context.selected_objects]
    if scope == "COLLECTION" and context.collection != context.scene.collection:
        return [datablock_ids.key_of("collection", context.collection)]
    return None


def in_scope(context: Any, scope: str) -> list[Thing]:
    """The things that Update Levels may give uids to: scope is SCENE, COLLECTION or SELECTED."""
    if scope == "SELECTED":
        things = reachable([], context.selected_objects)
    elif scope == "COLLECTION":
        things = reachable([context.collection], [])
    else:
        things = reachable([context.scene.collection], [])
    masters = {scene.collection.as_pointer() for scene in bpy.data.scenes}
    return [thing for thing in things if thing[1].as_pointer() not in masters]


def issue_uids(things: Iterable[Thing]) -> list[tuple[Any, str]]:
    """Stores a uid on the local things that hold a decision or that their name does not tell from
    others; copies lose the one they were copied with. Returns (datablock, uid before) of those that
    changed, for take_back()."""
    local = [(kind, item) for kind, item in things if item.library is None]
    pointers = {item.as_pointer() for _, item in local}
    others = [
        datablock_ids.stored_uid(item)
        for item in (*bpy.data.collections, *bpy.data.objects)
        if item.as_pointer() not in pointers
    ]
    before = [datablock_ids.stored_uid(item) for _, item in local]
    described = [
        (kind, "", name_of(item), stored, decided(item))
        for (kind, item), stored in zip(local, before)
    ]
    uids = stable_ids.assign_uids(described, filter(None, others))
    changed = []
    for (_, item), old, uid in zip(local, before, uids):
        if old != uid:
            changed.append((item, old))
            _store(item, uid)
    return changed


def take_back(changed: Iterable[tuple[Any, str]]) -> None:
    """Undoes issue_uids()."""
    for item, uid in changed:
        _store(item, uid)


def _store(item: Any, uid: str) -> None:
    if uid:
        item.lodestone.uid = uid
    else:
        forget(item, False)


def _set_names(settings: Any) -> list[str]:
    """The properties of ours that the file holds a value of."""
    own = {p.identifier for p in settings.bl_rna.properties} - _INHERITED - _COMPUTED
    computed = {name for name in own if quality_settings.OWN + name in own}  # as well
    found = [name for name in sorted(own - computed) if settings.is_property_set(name)]
    return [name for name in found if name != "lens" or _set_names(settings.lens)]


def decided(item: Any) -> bool:
    """Whether it holds anything that the designer decided."""
    settings = datablock_ids.settings_of(item)
    return settings is not None and any(name != "uid" for name in _set_names(settings))


def forget(item: Any, decisions: bool) -> bool:
    """Removes the uid, with `decisions` all that was decided. True when something was there."""
    settings = datablock_ids.settings_of(item)
    if settings is None:
        return False
    found = [name for name in _set_names(settings) if decisions or name == "uid"]
    for name in found:
        settings.property_unset(name)
    drop_empty(item)
    return bool(found)


def tag(item: Any) -> None:
    """Tells the depsgraph that something else is decided: writing to a property group may not. It
    will say that there is another shape, too, which must not be believed."""
    if isinstance(item, bpy.types.Object):
        addon_session().changed_shapes.decided(*filter(None, edits_of(item)))
    item.update_tag()


def edits_of(item: Any) -> tuple[str, str]:
    """The names by which changed_shapes.py knows an object: its own and that of its data."""
    data = item.original.data
    name = "" if data is None else f"{type(data).__name__} {name_of(data, 'name_full')}"
    return name_of(item), name


def copy(source: Any, target: Any) -> None:
    """Copies the decisions about an object or collection; those that the source lacks are taken
    back."""
    settings, before = datablock_ids.settings_of(source), datablock_ids.settings_of(target)
    decided_here = _set_names(settings) if settings is not None else []
    for name in _set_names(before) if before is not None else []:
        if name != "uid":
            before.property_unset(name)
    for name in decided_here:
        if name == "lens":
            _copy_group(settings.lens, target.lodestone.lens)
        elif name != "uid":
            setattr(target.lodestone, name, getattr(settings, name))
    tag(target)
    drop_empty(target)


def _copy_group(source: Any, target: Any) -> None:
    for name in _set_names(source):
        setattr(target, name, getattr(source, name))


def drop_empty(item: Any) -> None:
    """Leaves a datablock without any decision as if we had never been there: a panel that shows
    `.lodestone` is enough for Blender to store an empty group."""
    settings = datablock_ids.settings_of(item)
    if settings is not None and not _set_names(settings):
        try:
            del item["lodestone"]
        except KeyError:  # a Blender that keeps it elsewhere
            pass


def linked_role(scene: Any, kind: str, item: Any) -> str | None:
    """The role decided in this file on a linked thing; None: it has the one of its library."""
    settings = datablock_ids.settings_of(scene)
    for one in settings.linked if settings is not None else ():
        if datablock_ids.same_linked(
            (one.kind, one.library, one.name), datablock_ids.key_of(kind, item)
        ):
            return one.role
    return None


def decide_linked(scene: Any, kind: str, item: Any, role: str | None) -> None:
    """Decides it, or with None takes the decision back."""
    entries = scene.lodestone.linked
    key = datablock_ids.key_of(kind, item)
    same = (datablock_ids.same_linked((e.kind, e.library, e.name), key) for e in entries)
    found = next((number for number, hit in enumerate(same) if hit), None)
    if role is None:
        if found is not None:
            entries.remove(found)
        if not len(entries):
            scene.lodestone.property_unset("linked")
        drop_empty(scene)
        return
    entry = entries.add() if found is None else entries[found]
    entry.kind, entry.library, entry.name = key
    entry.role = role


def forget_linked(scene: Any) -> bool:
    """Takes back all decisions on linked things. True when there were some."""
    settings = datablock_ids.settings_of(scene)
    if settings is None or not len(settings.linked):
        return False
    settings.property_unset("linked")
    return True


def levels_uids(item: Any, roles: datablock_ids.Roles | None = None) -> list[str]:
    """The uids under which an object's or collection's levels may be in the store, likeliest
    first: an unmodified mesh is shared and has its own. `roles`: of the scene that shows it."""
    if isinstance(item, bpy.types.Collection):
        return [datablock_ids.uid_of("collection", item)]
    own = datablock_ids.uid_of("object", item)
    uids = [own]
    if item.type == "MESH" and item.data is not None:
        shared = datablock_ids.uid_of("mesh", item.data)
        slots = [slot.material for slot in item.material_slots]
        linked = stable_ids.stable_id(shared, *(datablock_ids.named_id_of(m) for m in slots))
        uids = [shared, linked, own]
    role_of = roles.of if roles else datablock_ids.role_of
    if "ENVIRONMENT" in map(role_of, (item, *item.users_collection)):
        uids = [stable_ids.stable_id(uid, "environment") for uid in uids] + uids
    elif role_of(item) == "ORDINARY":
        uids = [stable_ids.stable_id(uid, "ordinary") for uid in uids] + uids
    loose = datablock_ids.loose_parts(item)
    if loose != datablock_ids.AUTOMATIC:
        uids = [stable_ids.stable_id(uid, "loose", loose) for uid in uids] + uids
    if item.instance_collection is not None:
        uids.append(datablock_ids.uid_of("collection", item.instance_collection))
    uids += [stable_ids.stable_id(own, "instances"), stable_ids.stable_id(own, "hair")]
    return uids
