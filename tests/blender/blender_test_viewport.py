# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what viewports are told of a scene: what has moved, is hidden, new, edited, pinned. No GPU
is needed for it; window_viewport.py has the drawing."""

import shutil
import tempfile
import time
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes


class Viewport(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.row = scenes.collection("Row", self.scene.collection)
        self.mesh = scenes.bumpy_mesh(subdivisions=3)
        self.ball = scenes.cube("Ball", (0, 0, 0), data=self.mesh, collection=self.row)
        self.other = scenes.cube("Other", (3, 0, 0), data=self.mesh, collection=self.row)
        library = scenes.collection("Tree")  # in no scene: only instanced
        self.trunk = scenes.cube("Trunk", (0, 0, 0), collection=library)
        self.oak = scenes.instance("Oak", library, (0, 8, 0), parent=self.row)
        bpy.context.view_layer.update()
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        self.scene = bpy.context.scene
        bpy.ops.lodestone.update_levels()
        from lodestone.bridge.live import preview_changes
        from lodestone.core.preview import preview_worker
        from lodestone.core.store import store_path

        self.preview_scene, self.preview_worker = preview_changes, preview_worker
        names = preview_changes.names_of(self.scene)
        store = store_path.store_folder(bpy.data.filepath)
        self.worker = preview_worker.Worker(store, names)
        self.addCleanup(self.worker.close)
        self.wait(lambda: self.worker.ready)
        self.assertEqual(self.worker.problem, "")
        self.preview = preview_changes.Scene(set())
        self.refresh()
        while not self.preview.learned:
            self.preview.learn(self.depsgraph(), 1.0)

    def wait(self, condition):
        end = time.monotonic() + 20
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.002)

    def depsgraph(self):
        return bpy.context.evaluated_depsgraph_get()

    def refresh(self):
        """As if the window was drawn until nothing is left to read."""
        bpy.context.view_layer.update()
        self.preview.stale = True
        while self.preview.stale:
            self.preview.refresh(self.depsgraph(), self.worker.tree)
        return self.preview.things

    def slot(self, name):
        return self.worker.tree.objects[name][0]

    def test_nothing_is_different_of_a_scene_as_it_was_built(self):
        self.assertEqual(set(self.worker.tree.objects), {"Ball", "Other", "Oak"})
        self.assertEqual(set(self.worker.tree.inner), {"Trunk"})
        things = self.preview.things
        self.assertEqual((things.changes, things.live, things.number), ({}, (), 0))
        self.assertEqual(self.worker.tree.lost, [])

    def test_what_is_moved_is_where_it_is_with_its_levels(self):
        self.ball.location.x = 20.0
        self.oak.rotation_euler.z = 1.0
        things = self.refresh()
        self.assertEqual(set(things.changes), {self.slot("Ball").key, self.slot("Oak").key})
        self.assertEqual(things.changes[self.slot("Ball").key].world[3], 20.0)
        self.assertEqual(things.number, 0)
        self.ball.location.x = 0.0
        self.oak.rotation_euler.z = 0.0
        self.assertEqual(self.refresh().changes, {})

    def test_what_is_hidden_or_deleted_is_gone(self):
        self.ball.hide_set(True)
        bpy.data.objects.remove(self.other)
        changes = self.refresh().changes
        self.assertTrue(changes[self.slot("Ball").key].hidden)
        self.assertTrue(changes[self.slot("Other").key].hidden)
        self.assertFalse(self.slot("Oak").key in changes)

    def test_new_things_are_drawn_as_they_are_but_not_what_renders_hide(self):
        scenes.cube("New")
        scenes.cube("Helper").hide_render = True
        scenes.cube("Wires").display_type = "WIRE"
        things = self.refresh()
        self.assertEqual((things.number, len(things.live)), (1, 1))
        self.assertEqual(things.live[0].model.totals().triangles_placed, 12)
        first = things.live[0]
        scenes.cube("Newer", (5, 5, 5))
        self.assertIs(self.refresh().live[0], first)  # what was read is not read again

    def test_only_what_has_another_shape_counts_as_edited(self):
        self.preview.touch(["Ball"])  # Blender says so of whatever is tagged or shown again
        self.assertEqual(self.refresh().number, 0)
        self.mesh.vertices[0].co.z += 1.0
        self.mesh.update()
        self.preview.touch(["Ball"])
        things = self.refresh()
        self.assertEqual(things.number, 1)
        self.assertTrue(things.changes[self.slot("Ball").key].hidden)
        self.mesh.vertices[0].co.z -= 1.0
        self.mesh.update()
        self.preview.touch(["Ball"])
        self.assertEqual(self.refresh().number, 0)

    def test_editing_what_is_instanced_shows_its_instances_as_they_are(self):
        self.trunk.data.vertices[0].co.z += 1.0
        self.trunk.data.update()
        self.preview.touch(["Trunk"])
        things = self.refresh()
        self.assertEqual(things.number, 1)
        self.assertTrue(things.changes[self.slot("Oak").key].hidden)
        self.assertEqual(things.live[0].model.totals().triangles_placed, 12)

    def test_pins_for_viewports_and_for_renders_are_apart(self):
        from lodestone.bridge import datablock_ids

        self.ball.lodestone.use_pin_viewport = True
        self.ball.lodestone.pin_viewport = 2
        self.other.lodestone.use_pin_render = True
        changes = self.refresh().changes
        self.assertEqual(set(changes), {self.slot("Ball").key})
        self.assertEqual(changes[self.slot("Ball").key].coarsest, 2)
        self.assertTrue(changes[self.slot("Ball").key].pinned)
        self.assertEqual(datablock_ids.decision_of(self.ball), datablock_ids.UNDECIDED)
        self.assertTrue(datablock_ids.decision_of(self.other).pinned)
        self.assertTrue(self.preview_scene.any_pin())

    def test_pins_of_inner_objects_and_of_collections_count(self):
        self.trunk.lodestone.use_pin_viewport = True
        self.row.lodestone.use_pin_viewport = True
        self.row.lodestone.pin_viewport = 1
        tree = self.worker.tree
        changes = self.refresh().changes
        self.assertTrue(changes[tree.inner["Trunk"][0].key].pinned)
        (row,) = [s for found in tree.collections.values() for s in found if s.key in changes]
        self.assertEqual(changes[row.key].coarsest, 1)
        self.assertEqual(self.preview_scene.decisions(tree), changes)

    def test_pins_are_kept_in_the_file_and_copied_to_the_selected(self):
        self.ball.lodestone.use_pin_viewport = True
        self.ball.lodestone.pin_viewport = 3
        for item in (self.ball, self.other):
            item.select_set(True)
        bpy.context.view_layer.objects.active = self.ball
        self.assertEqual(bpy.ops.lodestone.copy_decisions(), {"FINISHED"})
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        for name in ("Ball", "Other"):
            found = bpy.data.objects[name].lodestone
            self.assertEqual((found.use_pin_viewport, found.pin_viewport), (True, 3))
            self.assertFalse(found.use_pin_render)

    def test_statistics_of_the_viewport_follow_its_pins(self):
        from lodestone.bridge.live import live_view
        from lodestone.core.session.addon_session import addon_session
        from lodestone.core.store import store_path

        store = addon_session().stores.open(store_path.store_folder(bpy.data.filepath))
        live_view.forget()
        self.other.lodestone.use_pin_viewport = True
        pinned = addon_session().part(live_view.LiveStatistics).pinned
        pinned.follow(store, self.scene)
        first = pinned.decided()
        self.assertEqual(len(first), 1)
        from lodestone import lodestone_native as native

        camera = native.Camera("c", False, (0, 0, 5000), (0, 0, -1), (1, 0, 0), (0, 0.6, 0), 0.1)
        view = native.View(camera, 640, 384, 4.0)
        with native.Cut(pinned.model, view) as cut:
            self.assertEqual([c.world[3] for c in cut.choices() if c.lod == 0], [3.0])
        self.other.lodestone.use_pin_viewport = False
        self.assertEqual(pinned.decided(), ())
        with native.Cut(pinned.model, view) as cut:
            self.assertEqual([c for c in cut.choices() if c.lod == 0], [])
        live_view.forget()

    def test_a_local_view_shows_only_what_is_in_it(self):
        things = self.preview.within({"Ball"}, self.worker.tree)
        hidden = {key for key, change in things.changes.items() if change.hidden}
        self.assertEqual(hidden, {self.slot("Other").key, self.slot("Oak").key})
        self.assertEqual(self.preview.things.changes, {})

    def test_material_preview_stays_eevees(self):
        from lodestone.engines.render_engine import LODESTONE_RE_povray

        self.assertTrue(LODESTONE_RE_povray.bl_use_eevee_viewport)
