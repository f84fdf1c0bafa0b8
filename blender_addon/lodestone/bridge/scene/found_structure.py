# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups that the backend finds in a collection, as child collections of it.

Nothing here changes a file but make_collections().
"""

from dataclasses import dataclass, field
from typing import Any

import bpy

from .. import datablock_ids


@dataclass
class Found:
    """A group below a collection: what of the collection is in it."""

    members: list[Any] = field(default_factory=list)  # objects and collections
    groups: list["Found"] = field(default_factory=list)

    def count(self) -> int:
        return len(self.groups) + sum(group.count() for group in self.groups)


def group_of(extraction: Any, collection: Any) -> Any | None:
    """The model's group of a collection; of several the one with most children. None when it shows
    nothing, or a thing that changes in an animation alone."""
    if collection == bpy.context.scene.collection:
        uid = datablock_ids.scene_uid(bpy.context.scene.name)
        return extraction.model.find_object(uid)
    model, best, most = extraction.model, None, -1
    uid = datablock_ids.uid_of("collection", collection)
    for item in extraction.parts.get(datablock_ids.key_of("collection", collection), ()):
        summary = model.object_summary(item)
        if summary.group and summary.child_count > most:
            if summary.uid == uid or best is None:
                best, most = item, summary.child_count
    return best


def found_groups(extraction: Any, group: Any, collection: Any, known: int) -> Found:
    """The groups that were found in a structured group: they are the model's objects from `known`
    on."""
    parts = extraction.parts
    waiting: dict[tuple[str, Any], Any] = {}
    for kind, items in (("object", collection.objects), ("collection", collection.children)):
        for item in items:
            for part in parts.get(datablock_ids.key_of(kind, item), ()):
                waiting.setdefault((item.name, part.key), item)
    done: set[int] = set()

    def below(of: Any) -> Found:
        found = Found()
        for child, _, name, _ in extraction.model.children(of):
            if child.index >= known:
                inner = below(child)
                if len(inner.members) + len(inner.groups) > 1:
                    found.groups.append(inner)
                else:  # other things in it are no objects of the collection's own
                    found.members += inner.members
                    found.groups += inner.groups
                continue
            item = waiting.get((name, child.key))
            if item is not None and item.as_pointer() not in done:
                done.add(item.as_pointer())
                found.members.append(item)
        return found

    return below(group)


def make_collections(collection: Any, found: Found) -> list[Any]:
    """Moves what was found into new collections below `collection`; returns these. Objects keep
    every other collection they are in."""
    made: list[Any] = []

    def fill(target: Any, of: Found) -> None:
        for inner in of.groups:
            child = bpy.data.collections.new(f"{collection.name} Group")
            target.children.link(child)
            made.append(child)
            for item in inner.members:
                objects = isinstance(item, bpy.types.Object)
                (child.objects if objects else child.children).link(item)
                (collection.objects if objects else collection.children).unlink(item)
            fill(child, inner)

    fill(collection, found)
    return made
