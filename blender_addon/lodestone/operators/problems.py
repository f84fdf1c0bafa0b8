# SPDX-License-Identifier: GPL-3.0-or-later
"""What the rows of the Problems panel do: select, copy, ignore, restore."""

import bpy
from bpy.props import StringProperty

from ..bridge import datablock_ids, ignored_problems, quality_settings
from ..core import problem_causes
from ..core.session.addon_session import addon_session
from .polled_operator import InObjectMode, Polled


def split(context):
    """The last check of the scene by cause; None before the first."""
    check = addon_session().checks.get(context.scene.name)
    return check.split(ignored_problems.keys(context.scene)) if check else None


def find(context, key):
    """The shown cause with this key, or None."""
    found = split(context)
    return next((cause for cause in found.shown if cause.key == key), None) if found else None


def select_subjects(context, subjects):
    """Selects just these, and for what only collection instances show, its instancers. Returns how
    many could be selected and how many were not to be seen."""
    layer = context.view_layer.objects
    own = {item.as_pointer(): item for item in layer if item.visible_get()}
    chosen, missing, inside = {}, 0, None
    for kind, library, name in subjects:
        if kind == "library":
            items = [item for item in own.values() if _from_library(item, name)]
        else:
            wanted = bpy.data.objects.get((name, library or None))
            items = [own[wanted.as_pointer()]] if wanted and wanted.as_pointer() in own else []
            if wanted and not items:
                inside = inside or _instancers(own.values())
                items = inside.get(wanted.as_pointer(), ())
        missing += not items
        chosen.update((item.as_pointer(), item) for item in items)
    if not chosen:
        return 0, missing
    for other in context.selected_objects:
        other.select_set(False)
    for item in chosen.values():
        item.select_set(True)
    layer.active = next(iter(chosen.values()))
    return len(chosen), missing


def _instancers(items):
    """Those of the items that show an object as part of a collection, by the object's pointer."""
    found = {}
    for item in items:
        if item.instance_collection is not None:
            for pointer in _held(item.instance_collection, set()):
                found.setdefault(pointer, []).append(item)
    return found


def _held(collection, seen):
    """Pointers of all that a collection holds or instances."""
    found = set()
    if collection.as_pointer() not in seen:
        seen.add(collection.as_pointer())
        for item in collection.all_objects:
            found.add(item.as_pointer())
            if item.instance_collection is not None:
                found |= _held(item.instance_collection, seen)
    return found


def _from_library(item, name):
    for block in (item, item.data, item.instance_collection):
        if block is not None and block.library is not None and block.library.name == name:
            return True
    return False


class _OfCause:
    """What the buttons of one row share; no operator itself."""

    @classmethod
    def description(cls, context, properties):
        cause = find(context, properties.key)
        return f"{cls.bl_description}: {cause.sentence}" if cause else cls.bl_description


class LODESTONE_OT_select_problem(_OfCause, InObjectMode, bpy.types.Operator):
    bl_idname = "lodestone.select_problem"
    bl_label = "Select"
    bl_description = "Select the objects that have this problem"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    key: StringProperty(options={"HIDDEN"})

    def execute(self, context):
        cause = find(context, self.key)
        if cause is None:
            self.report({"WARNING"}, "This problem is gone: check the scene again")
            return {"CANCELLED"}
        selected, missing = select_subjects(context, cause.objects)
        if not selected:
            self.report({"WARNING"}, "Nothing to select: hidden, or not in this view layer")
            return {"CANCELLED"}
        more = f"; {missing:,} more hidden or not in this view layer" if missing else ""
        self.report({"INFO"}, f"Selected {selected:,} object{'s' if selected > 1 else ''}{more}")
        return {"FINISHED"}


class LODESTONE_OT_copy_problems(_OfCause, Polled, bpy.types.Operator):
    bl_idname = "lodestone.copy_problems"
    bl_label = "Copy"
    bl_description = "Copy as text, with the names of everything that has the problem"
    bl_options = {"INTERNAL"}

    key: StringProperty(description="Empty for all rows", options={"HIDDEN"})

    @classmethod
    def refused(cls, context):
        found = split(context)
        if found is None or not (found.shown or found.ignored):
            return "No problems to copy"
        return ""

    def execute(self, context):
        context.window_manager.clipboard = text_of(context, self.key)
        self.report({"INFO"}, "Copied to the clipboard")
        return {"FINISHED"}


def text_of(context, key=""):
    """One row as text, or all of them, ignored ones last."""
    found = split(context)
    if found is None:
        return ""
    if key:
        return "".join(cause.report + "\n" for cause in found.shown if cause.key == key)
    lines = [cause.report for cause in found.shown]
    lines += [f"ignored {cause.report}" for cause in found.ignored]
    exact = problem_causes.exact_line(
        *addon_session().checks.get(context.scene.name).exact_materials
    )
    return "\n".join([*lines, *([exact] if exact else [])]) + "\n"


def remedy(context, code):
    """The control that makes the next picture of the scene faster than the last one, which had a
    problem with this code; None where there is none, or where it is set already."""
    render = addon_session().renders.get(context.scene.name)
    found = render.remedies.get(code) if render else None
    if found is None:
        return None
    now = getattr(quality_settings.of_scene(context.scene.lodestone), found.key)
    return found if now != found.after else None


class _Deciding(Polled):
    @classmethod
    def refused(cls, context):
        if datablock_ids.library_of(context.scene):
            return "The scene is linked: its decisions are made in its own file"
        return ""


class LODESTONE_OT_draw_faster(_Deciding, bpy.types.Operator):
    bl_idname = "lodestone.draw_faster"
    bl_label = "Faster"
    bl_description = "Change the control that makes the next picture faster"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    code: StringProperty(options={"HIDDEN"})

    @classmethod
    def description(cls, context, properties):
        faster = remedy(context, properties.code)
        return f"Draw the next picture with {faster.words}" if faster else cls.bl_description

    def execute(self, context):
        faster = remedy(context, self.code)
        if faster is None:
            self.report({"WARNING"}, "No control makes it faster: render again")
            return {"CANCELLED"}
        quality_settings.override(context.scene.lodestone, faster.key, faster.after)
        self.report({"INFO"}, f"The next picture is drawn with {faster.words}")
        return {"FINISHED"}


class LODESTONE_OT_ignore_problem(_OfCause, _Deciding, bpy.types.Operator):
    bl_idname = "lodestone.ignore_problem"
    bl_label = "Ignore"
    bl_description = "Do not show again until it changes; batch jobs still report it"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    key: StringProperty(options={"HIDDEN"})

    def execute(self, context):
        cause = find(context, self.key)
        if cause is None or cause.about_setup:
            self.report({"WARNING"}, "This problem is gone: check the scene again")
            return {"CANCELLED"}
        ignored_problems.add(context.scene, cause.problems)
        return {"FINISHED"}


class LODESTONE_OT_restore_problems(_Deciding, bpy.types.Operator):
    bl_idname = "lodestone.restore_problems"
    bl_label = "Restore"
    bl_description = "Show the ignored problems again"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    @classmethod
    def refused(cls, context):
        none = "" if ignored_problems.keys(context.scene) else "No problem is ignored"
        return super().refused(context) or none

    def execute(self, context):
        ignored_problems.clear(context.scene)
        return {"FINISHED"}


_CLASSES = (
    LODESTONE_OT_select_problem,
    LODESTONE_OT_copy_problems,
    LODESTONE_OT_draw_faster,
    LODESTONE_OT_ignore_problem,
    LODESTONE_OT_restore_problems,
)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
