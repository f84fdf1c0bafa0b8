# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto-Structure: groups what stands flat in a collection into new collections below it.

In the window: the scene is read by a render job, a thread measures what the groups are worth, a
dialog tells it, and only OK changes the file.
"""

import contextlib
import os
import shutil
import tempfile
from dataclasses import dataclass

import bpy

from ..bridge.scene import found_structure
from ..core import progress_text
from ..core.native import lodestone_native as native
from ..core.printable_text import sentence
from ..core.store import motion_file, store_path
from ..engines import extract_engine
from . import window_run
from .polled_operator import Polled

FEWEST = 8  # a collection of at most so many is not structured
GROUP_COST = 20.0  # fewer and larger groups than those nobody sees


class NothingToGroup(Exception):
    """The collection has no groups that could be made."""


class Gone(Exception):
    """The collection is no more."""


FAILURES = (*window_run.FAILURES, extract_engine.CameraMissing, NothingToGroup, Gone)


@dataclass
class Preview:
    """What grouping is worth: expected costs, and what POV-Ray would keep of the scene camera's cut
    (None: not measured)."""

    groups: int
    cost_before: float
    cost_after: float
    bytes_before: int | None = None
    bytes_after: int | None = None

    def lines(self):
        less = progress_text.percent(self.cost_after, self.cost_before)
        lines = [
            f"{self.groups:,} new collections",
            f"Expected Cost {self.cost_before:,.1f} \N{RIGHTWARDS ARROW} {self.cost_after:,.1f}"
            f"   {less}",
        ]
        if self.bytes_before is not None:
            before, after = map(progress_text.memory, (self.bytes_before, self.bytes_after))
            share = progress_text.percent(self.bytes_after, self.bytes_before)
            lines.append(f"POV-Ray Memory {before} \N{RIGHTWARDS ARROW} {after}   {share}")
        return lines


def group_in(extraction, collection):
    """The model's group of a collection. Raises NothingToGroup."""
    group = found_structure.group_of(extraction, collection)
    if group is None or extraction.model.object_summary(group).child_count <= FEWEST:
        raise NothingToGroup(f'"{collection.name}" shows at most {FEWEST} things to group')
    return group


def structure_model(model, group):
    """Groups what is in a group; returns (number of objects before, expected cost before and
    after)."""
    known = sum(1 for _ in model.objects())
    report = model.structure(
        [group], native.StructureOptions(fewest_children=FEWEST, group_cost=GROUP_COST)
    )
    return known, report.cost_before, report.cost_after


def groups_in(extraction, group, collection, known):
    """What was found, by Blender's names. Raises NothingToGroup."""
    found = found_structure.found_groups(extraction, group, collection, known)
    if not found.count():
        raise NothingToGroup(f'Nothing in "{collection.name}" belongs together')
    return found


def auto_structure(context, collection):
    """Reads the scene and groups what is directly in a collection, synchronously; returns (the new
    collections, a Preview without bytes). Raises what failed, then nothing has changed."""
    still = motion_file.read(store_path.store_folder(bpy.data.filepath))
    request = extract_engine.Request(still=still, structured=False)
    extraction = extract_engine.extract_now(context.scene, request)
    with extraction.model as model:
        group = group_in(extraction, collection)
        known, before, after = structure_model(model, group)
        found = groups_in(extraction, group, collection, known)
    return found_structure.make_collections(collection, found), Preview(
        found.count(), before, after
    )


def refusal(collection):
    """Why a collection cannot be structured; "" when it can."""
    if collection is None:
        return "No active collection"
    if collection.library is not None:
        return f"Linked from {collection.library.name}: its collections cannot be changed"
    if collection.override_library is not None:
        return "A library override: its collections cannot be changed"
    if len(collection.objects) + len(collection.children) <= FEWEST:
        return f"At most {FEWEST} things are directly in this collection"
    return ""


class _Run(window_run.WindowRun):
    """One run in the window."""

    def __init__(self, context):
        self.collection = context.collection.name
        self.found = self.preview = None
        self._store = store_path.store_folder(bpy.data.filepath)
        still = motion_file.read(self._store)
        cameras = [("", None)] if context.scene.camera is not None else []
        super().__init__(extract_engine.Request(cameras, still=still, structured=False))
        self._pixel_error = max(0.01, context.scene.lodestone.pixel_error_render)
        self._group = None

    def was_read(self):
        self._group = group_in(self.extraction, _collection(self.collection))
        self.start(self._measure)

    def _measure(self):
        """On the thread: the number of objects before grouping, and the Preview."""
        model, frames = self.extraction.model, self.request.frames

        def kept(store):
            if not frames:
                return None
            model.build(store, None, self.work.new_job("Levels"))
            camera, (width, height) = frames[0]
            with native.Cut(model, native.View(camera, width, height, self._pixel_error)) as cut:
                return cut.summary().bytes

        with _scratch_store(self._store) as store:
            before = kept(store)
            known, *costs = structure_model(model, self._group)
            return known, Preview(0, *costs, before, kept(store))

    def measured(self):
        """After the thread has ended: `found` and `preview` are there."""
        known, preview = self.worked()
        collection = _collection(self.collection)
        self.found = groups_in(self.extraction, self._group, collection, known)
        preview.groups = self.found.count()
        self.preview = preview


@contextlib.contextmanager
def _scratch_store(store):
    """A folder with the levels there are, to build into: the file's own store stays as it is."""
    beside = store.parent if store.is_dir() and os.access(store.parent, os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix=".structure", dir=beside) as folder:
        made = os.path.join(folder, "store")
        if store.is_dir():
            ignore = shutil.ignore_patterns("lock")
            shutil.copytree(store, made, ignore=ignore, copy_function=_link)
        else:
            os.mkdir(made)
        yield made


def _link(source, target):
    try:
        os.link(source, target)  # files of a store are replaced, never written into
    except OSError:
        shutil.copyfile(source, target)


class LODESTONE_OT_auto_structure(Polled, window_run.InWindow, bpy.types.Operator):
    bl_idname = "lodestone.auto_structure"
    bl_label = "Auto-Structure"
    bl_description = (
        "Find groups of what is near and alike directly in the active collection, tell what they "
        "are worth, and make them collections"
    )
    bl_options = {"REGISTER", "UNDO"}

    failures = FAILURES

    @classmethod
    def refused(cls, context):
        return window_run.refusal() or refusal(context.collection)

    def execute(self, context):
        try:
            made, preview = auto_structure(context, context.collection)
        except FAILURES as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        self.report({"INFO"}, "; ".join(preview.lines()))
        return {"FINISHED"}

    def invoke(self, context, event):
        return self.begin(context, _Run(context))

    def step(self, context, run):
        if run.reading():
            window_run.status(context, "Lodestone: reading the scene   [Esc] Cancel")
            return {"PASS_THROUGH"}
        if run.working():
            share = progress_text.percent(run.work.fraction, 1.0)
            window_run.status(context, f"Lodestone: measuring groups {share}   [Esc] Cancel")
            return {"PASS_THROUGH"}
        run.measured()
        window_run.status(context, None)
        self.remove_timer(context)
        bpy.ops.lodestone.make_groups("INVOKE_DEFAULT")
        return {"CANCELLED"}  # nothing has changed yet: there is nothing to undo


class LODESTONE_OT_make_groups(bpy.types.Operator):
    bl_idname = "lodestone.make_groups"
    bl_label = "Auto-Structure"
    bl_description = "Make the groups that were found collections"
    bl_options = {"INTERNAL", "UNDO"}

    @classmethod
    def poll(cls, context):
        run = window_run.current(_Run)
        return run is not None and run.preview is not None

    def invoke(self, context, event):
        return context.window_manager.invoke_props_dialog(self, width=320)

    def draw(self, context):
        run = window_run.current(_Run)
        column = self.layout.column(align=True)
        if run is not None and run.preview is not None:
            column.label(text=run.collection, icon="OUTLINER_COLLECTION")
            for line in run.preview.lines():
                column.label(text=line)

    def execute(self, context):
        run = window_run.current(_Run)
        try:
            collection = _collection(run.collection)
            if refusal(collection):
                self.report({"ERROR"}, "The collection has changed meanwhile")
                return {"CANCELLED"}
            made = found_structure.make_collections(collection, run.found)
        except Gone as error:
            self.report({"ERROR"}, sentence(error))
            return {"CANCELLED"}
        finally:
            window_run.stop_running()
        self.report({"INFO"}, f"Made {len(made):,} collections")
        return {"FINISHED"}

    def cancel(self, context):
        window_run.stop_running()


def _collection(name):
    """By name: Blender may have moved its memory. Raises Gone."""
    scene = bpy.context.scene
    if scene.collection.name == name:
        return scene.collection
    for item in bpy.data.collections:
        if item.name == name:
            return item
    raise Gone(f'Collection "{name}" is no more')


_CLASSES = (LODESTONE_OT_auto_structure, LODESTONE_OT_make_groups)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
