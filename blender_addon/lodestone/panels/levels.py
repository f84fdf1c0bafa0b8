# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of Detail in Properties > Object and Collection."""

import bpy
from bpy.types import Panel

from ..bridge import datablock_ids, object_decisions
from ..core import progress_text
from ..core.kind_words import level_word
from ..core.session.addon_session import addon_session
from ..core.store import store_path


def _draw_decisions(layout, context, item):
    settings = item.lodestone
    column = layout.column()
    column.prop(settings, "use")
    if settings.use == "LIMIT":
        column.prop(settings, "coarsest", text="LOD")
    for where in ("render", "viewport"):
        row = column.row(heading=f"Pin in {where.title()}s")
        row.prop(settings, f"use_pin_{where}", text="")
        sub = row.row()
        sub.active = getattr(settings, f"use_pin_{where}")
        sub.prop(settings, f"pin_{where}", text="LOD")
    sub = column.column()
    sub.active = settings.use in {"AUTOMATIC", "LIMIT"} and not settings.use_pin_render
    sub.prop(settings, "importance")
    column.prop(settings, "role")
    if getattr(item, "type", "") == "MESH":
        column.prop(settings, "loose_parts")
    if len(context.selected_objects) > 1 and item == context.object:
        layout.operator("lodestone.copy_decisions", icon="COPYDOWN")


def draw_levels(layout, context, item):
    """What is decided about, and the levels of, an object or a collection; the same in both
    places."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    if item.library is not None:
        layout.label(text=f"Linked from {item.library.name}", icon="LINKED")
        kind = "collection" if isinstance(item, bpy.types.Collection) else "object"
        decided = object_decisions.linked_role(context.scene, kind, item)
        text = f"Role Here: {decided.title() if decided else 'As in Library'}"
        layout.operator_menu_enum("lodestone.linked_role", "role", text=text)
    else:
        _draw_decisions(layout, context, item)
    store = addon_session().stores.open(store_path.store_folder(bpy.data.filepath))
    if store.problem:
        layout.label(text=f"Levels cannot be read: {store.problem}", icon="ERROR")
        return
    uids = object_decisions.levels_uids(item, datablock_ids.Roles(context.scene))
    uid = next((uid for uid in uids if store.levels(uid)), None)
    if uid is None:
        layout.label(text="No levels yet: Update Levels builds them")
        return
    render = addon_session().renders.get(context.scene.name)
    in_use = render.in_use.get(uid, {}) if render else {}
    box = layout.box().column(align=True)
    for level in store.levels(uid):
        row = box.row(align=True)
        icon = "RADIOBUT_ON" if level.lod in in_use else "RADIOBUT_OFF"
        row.label(text=f"LOD {level.lod}", icon=icon)
        row.label(text=level_word(level.lod, level.kind))
        row.label(text=progress_text.count(level.triangles))
        row.label(text=progress_text.length(level.error))
        times = in_use.get(level.lod, 0)
        row.label(text=f"\N{MULTIPLICATION SIGN} {times:,}" if times else "")


class LODESTONE_OBJECT_PT_levels(Panel):
    bl_label = "Levels of Detail"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        kinds = {"MESH", "CURVE", "SURFACE", "FONT", "META", "EMPTY"}
        return context.object is not None and context.object.type in kinds

    def draw(self, context):
        draw_levels(self.layout, context, context.object)


class LODESTONE_COLLECTION_PT_levels(Panel):
    bl_label = "Levels of Detail"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "collection"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.collection is not None and context.collection != context.scene.collection

    def draw(self, context):
        draw_levels(self.layout, context, context.collection)
        self.layout.operator("lodestone.auto_structure", icon="OUTLINER_COLLECTION")


_CLASSES = (LODESTONE_OBJECT_PT_levels, LODESTONE_COLLECTION_PT_levels)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


register = _register


def unregister():
    _unregister()
    addon_session().stores.forget()
