# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels: Levels of Detail in Properties > Render, Object and Collection."""

import bpy
from bpy.types import Panel

from .bridge import decisions
from .core import last_render, progress, store_levels, store_path
from .core.native import lodestone_native as native

ENGINE = "LODESTONE_POVRAY"
PRESETS = (("Draft", 8.0), ("Preview", 2.0), ("Final", 1.0), ("Exact", 0.0))
_KINDS = {
    native.Kind.MESH: "Simplified",
    native.Kind.BOX: "Box",
    native.Kind.ELLIPSOID: "Ellipsoid",
    native.Kind.ASSEMBLY: "Group",
}


class LODESTONE_OT_pixel_error(bpy.types.Operator):
    bl_idname = "lodestone.pixel_error"
    bl_label = "Pixel Error"
    bl_description = "Use this Pixel Error in renders"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    value: bpy.props.FloatProperty()

    def execute(self, context):
        context.scene.lodestone.pixel_error_render = self.value
        return {"FINISHED"}


class LODESTONE_RENDER_PT_levels(Panel):
    bl_label = "Levels of Detail"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.lodestone
        column = layout.column()
        column.prop(settings, "pixel_error_render", text="Pixel Error")
        row = column.row(align=True)
        for name, value in PRESETS:
            chosen = abs(settings.pixel_error_render - value) < 1e-6
            row.operator("lodestone.pixel_error", text=name, depress=chosen).value = value
        if context.engine == ENGINE:
            column.prop(settings, "antialias")
            column.prop(settings, "keep_scene_files")
        layout.prop(settings, "scope")
        row = layout.row(align=True)
        row.operator("lodestone.update_levels", icon="FILE_REFRESH")
        row.operator("lodestone.clear_levels", text="", icon="X")


class LODESTONE_RENDER_PT_levels_view(Panel):
    bl_label = "In This View"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE

    def draw(self, context):
        layout = self.layout
        render = last_render.get(context.scene.name)
        if render is None:
            layout.label(text="Render a picture to see what it uses")
            return
        split = layout.split(factor=0.4)
        names, values = split.column(align=True), split.column(align=True)
        names.label(text="Triangles")
        before, after = progress.count(render.triangles_placed), progress.count(render.triangles)
        share = progress.percent(render.triangles, render.triangles_placed)
        values.label(text=f"{before} \N{RIGHTWARDS ARROW} {after}   {share}")
        names.label(text="Meshes, Boxes, Ellipsoids")
        kinds = render.kinds
        values.label(text=f"{kinds['mesh']:,}, {kinds['box']:,}, {kinds['ellipsoid']:,}")
        names.label(text="Largest Error")
        if render.largest_error_name:
            text = f"{render.largest_error_px:.2f} px   {render.largest_error_name}"
            values.operator(
                "lodestone.select_object", text=text, emboss=False
            ).path = render.largest_error_name
        else:
            values.label(text=f"{render.largest_error_px:.2f} px")
        self._problems(layout, render)

    def _problems(self, layout, render):
        counted: dict[str, list] = {}
        for problem in render.problems:
            if problem.severity != "info":
                counted.setdefault(problem.code, []).append(problem)
        column = layout.column(align=True)
        for problems in counted.values():
            first = problems[0]
            icon = "CANCEL" if first.severity == "error" else "ERROR"
            more = f"   (and {len(problems) - 1} more)" if len(problems) > 1 else ""
            column.label(text=first.sentence + more, icon=icon)


def draw_levels(layout, context, item):
    """The role and the levels of an object or a collection; the same in both places."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    if item.library is not None:
        layout.label(text=f"Linked from {item.library.name}: its role is set there", icon="LINKED")
    column = layout.column()
    column.enabled = item.library is None
    column.prop(item.lodestone, "role")
    store = store_levels.open_store(store_path.store_folder(bpy.data.filepath))
    if store.problem:
        layout.label(text=f"Levels cannot be read: {store.problem}", icon="ERROR")
        return
    uids = decisions.levels_uids(item)
    uid = next((uid for uid in uids if store.levels(uid)), None)
    if uid is None:
        layout.label(text="No levels yet: Update Levels builds them")
        return
    render = last_render.get(context.scene.name)
    in_use = render.in_use.get(uid, {}) if render else {}
    box = layout.box().column(align=True)
    for level in store.levels(uid):
        row = box.row(align=True)
        icon = "RADIOBUT_ON" if level.lod in in_use else "RADIOBUT_OFF"
        kind = "Original" if level.lod == 0 else _KINDS.get(level.kind, "?")
        row.label(text=f"LOD {level.lod}", icon=icon)
        row.label(text=kind)
        row.label(text=progress.count(level.triangles))
        row.label(text=progress.length(level.error))
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


_CLASSES = (
    LODESTONE_OT_pixel_error,
    LODESTONE_RENDER_PT_levels,
    LODESTONE_RENDER_PT_levels_view,
    LODESTONE_OBJECT_PT_levels,
    LODESTONE_COLLECTION_PT_levels,
)
_register, _unregister = bpy.utils.register_classes_factory(_CLASSES)


def register():
    _register()


def unregister():
    _unregister()
    store_levels.forget()
