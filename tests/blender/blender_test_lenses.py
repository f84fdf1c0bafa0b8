# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards lenses: how they are added, what of them reaches the cut, and what nonsense becomes."""

import math
import os
import shutil
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import bmesh
import bpy

import blender_scenes as scenes
from lodestone.bridge.live import live_view
from lodestone.bridge.scene import quality_lenses
from lodestone.bridge.scene_settings import SceneSettings
from lodestone.core.native import lodestone_native as native
from lodestone.core.problems import Problems
from lodestone.core.session.addon_session import addon_session
from lodestone.operators import screen_lenses

HAVE_POVRAY = shutil.which(os.environ.get("LODESTONE_POVRAY", "povray")) is not None


def ball(name, location, collection=None, subdivisions=3, data=None):
    if data is None:
        data = bpy.data.meshes.new(name)
        made = bmesh.new()
        bmesh.ops.create_icosphere(made, subdivisions=subdivisions, radius=1.0)
        made.to_mesh(data)
        made.free()
    return scenes.cube(name, location, data=data, collection=collection)


def add_lens(location=(0, 0, 0), **values):
    bpy.ops.lodestone.detail_lens_add(location=location, **values)
    bpy.context.view_layer.update()
    return bpy.context.object


def read(parts_of=lambda collection: ()):
    problems = Problems()
    found = quality_lenses.detail(bpy.context.scene.objects, parts_of, problems)
    return found, [problem.code for problem in problems]


class Adding(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()

    def test_a_new_lens_is_an_empty_at_the_cursor_and_one_undo_takes_it_back(self):
        self.scene.cursor.location = (1, 2, 3)
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.lodestone.detail_lens_add(location=self.scene.cursor.location, radius=2.5)
        made = bpy.context.object
        self.assertEqual((made.type, made.empty_display_type), ("EMPTY", "SPHERE"))
        self.assertEqual(tuple(made.location), (1, 2, 3))
        self.assertTrue(made.select_get() and quality_lenses.is_lens(made))
        self.assertEqual([item.name for item in bpy.context.selected_objects], [made.name])
        bpy.ops.ed.undo_push(message="Detail Lens")
        bpy.ops.ed.undo()
        self.assertNotIn("Detail Lens", bpy.data.objects)

    def test_its_size_and_scale_are_the_lens_s(self):
        made = add_lens((1, 0, 0), shape="CUBE", radius=2.0, strength=8.0)
        made.scale = (1, 1, 3)
        made.lodestone.lens.falloff = 0.0
        bpy.context.view_layer.update()
        (found,), codes = read()
        self.assertEqual((found.shape, found.radius, found.strength, found.falloff), (1, 2, 8, 0))
        self.assertEqual(tuple(found.transform), (1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 3, 0))
        self.assertEqual(codes, [])

    def test_an_empty_becomes_a_lens_and_an_ordinary_one_is_none(self):
        made = scenes.link(bpy.data.objects.new("Arrow", None))
        self.assertEqual(read(), ((), []))
        self.assertNotIn("lodestone", made)
        bpy.context.view_layer.objects.active = made
        made.select_set(True)
        bpy.ops.lodestone.detail_lens_enable()
        self.assertEqual(made.empty_display_type, "SPHERE")
        self.assertEqual(len(read()[0]), 1)
        with self.assertRaisesRegex(RuntimeError, "no lenses yet"):
            bpy.ops.lodestone.detail_lens_enable()

    def test_what_renders_do_not_see_has_no_effect(self):
        add_lens().hide_render = True
        self.assertEqual(read(), ((), []))

    def test_a_lens_without_its_collection_is_named(self):
        made = add_lens()
        made.lodestone.lens.filter = "SHOW"
        self.assertEqual(read(), ((), ["lens_without_collection"]))

    def test_a_filter_hands_over_what_its_collection_became(self):
        made = add_lens()
        made.lodestone.lens.filter = "REFINE"
        made.lodestone.lens.collection = scenes.collection("Stage", self.scene.collection)
        parts = {"Stage": [native.Object(3, 1)]}
        (found,), _ = read(lambda collection: parts[collection.name])
        self.assertEqual(found.filter, native.LensFilter.REFINE)
        self.assertEqual([part.key for part in found.objects], [(3, 1)])

    def test_ten_thousand_lenses_are_cut_off_and_named(self):
        for number in range(10_000):
            made = bpy.data.objects.new(f"Lens {number}", None)
            made.lodestone.lens.enabled = True
            self.scene.collection.objects.link(made)
        found, codes = read()
        self.assertEqual((len(found), codes), (quality_lenses.MOST, ["lenses_too_many"]))

    def test_copied_to_the_selected(self):
        source = add_lens(strength=9.0)
        target = scenes.link(bpy.data.objects.new("Empty", None))
        target.select_set(True)
        bpy.context.view_layer.objects.active = source
        source.select_set(True)
        bpy.ops.lodestone.copy_decisions()
        self.assertTrue(quality_lenses.is_lens(target))
        self.assertEqual(target.lodestone.lens.strength, 9.0)


@unittest.skipUnless(HAVE_POVRAY, "POV-Ray is not installed")
class Animations(unittest.TestCase):
    def test_keys_of_strength_and_of_a_screen_lens_stayed_as_in_the_frame_that_was_open(self):
        scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        scene.render.engine = "LODESTONE_POVRAY"
        scene.render.resolution_x, scene.render.resolution_y = 16, 9
        scene.render.filepath = os.path.join(folder.name, "frame_")
        ball("Ball", (0, 0, 0), subdivisions=1)
        lens = add_lens().lodestone.lens
        bpy.ops.lodestone.screen_lens_add()
        disc = scene.camera.data.lodestone.screen_lenses[0]
        for frame, strength, x in ((1, 2.0, 0.25), (2, 8.0, 0.75)):
            lens.strength, disc.x = strength, x
            lens.keyframe_insert("strength", frame=frame)
            disc.keyframe_insert("x", frame=frame)
        scene.frame_set(1)
        scene.frame_start, scene.frame_end = 1, 2
        seen, real = [], quality_lenses.modifiers

        def modifiers(*arguments):
            made = real(*arguments)
            seen.append((made.lenses[0].strength, made.screen_lenses[0].center[0]))
            return made

        with mock.patch.object(quality_lenses, "modifiers", modifiers):
            bpy.ops.render.render(animation=True)
        self.assertEqual(seen, [(2.0, 0.25), (8.0, 0.75)])


class OnTheScreen(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()

    def test_added_and_removed(self):
        bpy.ops.lodestone.screen_lens_add()
        bpy.ops.lodestone.screen_lens_add()
        settings = self.scene.camera.data.lodestone
        self.assertEqual([lens.name for lens in settings.screen_lenses], ["Lens 1", "Lens 2"])
        bpy.ops.lodestone.screen_lens_remove()
        bpy.ops.lodestone.screen_lens_remove()
        self.assertEqual(len(settings.screen_lenses), 0)
        self.assertIsNone(screen_lenses.active_lens(self.scene.camera.data))
        with self.assertRaisesRegex(RuntimeError, "There is no screen lens"):
            bpy.ops.lodestone.screen_lens_remove()

    def test_shares_of_the_image_count_from_the_top(self):
        self.assertEqual(quality_lenses.screen(self.scene.camera), ())
        bpy.ops.lodestone.screen_lens_add()
        lens = self.scene.camera.data.lodestone.screen_lenses[0]
        lens.x, lens.y, lens.radius = 0.25, 0.75, 0.5
        (found,) = quality_lenses.screen(self.scene.camera)
        self.assertEqual((found.center, found.radius, found.in_pixels), ((0.25, 0.25), 0.5, False))
        lens.enabled = False
        self.assertEqual(quality_lenses.screen(self.scene.camera), ())

    def test_looking_stores_nothing(self):
        camera = self.scene.camera.data
        self.assertEqual(screen_lenses.lens_count(camera), 0)
        self.assertIsNone(screen_lenses.active_lens(camera))
        self.assertTrue(bpy.ops.lodestone.screen_lens_add.poll())
        self.assertNotIn("lodestone", camera.keys())

    def test_no_camera_is_said(self):
        self.scene.camera = None
        with self.assertRaisesRegex(RuntimeError, "Set a scene camera"):
            bpy.ops.lodestone.screen_lens_add()

    def test_dragging_needs_a_view_through_the_camera(self):
        bpy.ops.lodestone.screen_lens_add()
        with self.assertRaisesRegex(RuntimeError, "Look through the scene's camera"):
            bpy.ops.lodestone.screen_lens_drag("INVOKE_DEFAULT")


class Drawn(unittest.TestCase):
    """What the levels in use are, of a row of groups of balls; the store is built once."""

    @classmethod
    def setUpClass(cls):
        cls.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        data = ball("Ball", (0, 0, -99)).data
        bpy.data.objects.remove(bpy.data.objects["Ball"])
        for group in range(3):
            made = scenes.collection(f"Group {group}", cls.scene.collection)
            for number in range(8):
                place = (40 * group + 3 * (number % 4), 3 * (number // 4), 0)
                ball(f"Ball {group} {number}", place, made, data=data)
        camera = cls.scene.camera
        camera.location = (40, 0, 400)
        camera.data.clip_end = 1e4
        # A pixel of the middle group is .22 m
        cls.scene.render.resolution_x, cls.scene.render.resolution_y = 1280, 720
        cls.scene.lodestone.pixel_error_render = 1.0
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(Path(folder.name) / "balls.blend"))
        bpy.context.view_layer.update()
        bpy.ops.lodestone.update_levels()

    def tearDown(self):
        for item in [item for item in self.scene.objects if item.type == "EMPTY"]:
            bpy.data.objects.remove(item)
        self.scene.camera.data.lodestone.screen_lenses.clear()
        settings = self.scene.lodestone
        for name in ("budget_render", "use_levels", "coarser_moving_dark", "off_screen"):
            settings.property_unset(name)
        settings.pixel_error_render = 1.0

    def chosen(self):
        """{group's name: triangles drawn of it}."""
        from lodestone.core.store import store_path

        bpy.context.view_layer.update()
        store = addon_session().stores.open(store_path.store_folder(bpy.data.filepath))
        settings = live_view.settings_of(self.scene, quality_lenses.parts_stored(store.model))
        frame = lenses_frame(self.scene)
        found = {}
        with settings.cut(store.model, frame[0], frame[1]) as cut:
            for number, choice in enumerate(cut.choices()):
                level = store.model.representation(choice.object, choice.lod)
                group = cut.choice_path(number).split("/")[0]
                found[group] = found.get(group, 0) + level.triangles
        return found

    def test_a_lens_on_a_corner_opens_its_group_and_leaves_the_far_children(self):
        plain = self.chosen()
        # Around the first ball of the middle group only
        add_lens((40, 0, 0), radius=2.0, strength=64.0)
        found = self.chosen()
        self.assertEqual(found["Group 0"], plain["Group 0"])
        self.assertEqual(found["Group 2"], plain["Group 2"])
        self.assertGreater(found["Group 1"], plain["Group 1"])
        everything = 8 * len(bpy.data.objects["Ball 1 0"].data.polygons)
        self.assertLess(found["Group 1"], everything / 2)

    def test_a_lens_that_is_moved_takes_its_detail_along(self):
        made = add_lens((40, 0, 0), radius=2.0, strength=64.0)
        before = self.chosen()
        made.location = (80, 0, 0)
        after = self.chosen()
        self.assertGreater(before["Group 1"], after["Group 1"])
        self.assertGreater(after["Group 2"], before["Group 2"])

    def test_an_animated_lens_is_read_at_each_frame(self):
        made = add_lens((40, 0, 0), radius=2.0, strength=64.0)
        made.keyframe_insert("location", frame=1)
        made.location = (80, 0, 0)
        made.keyframe_insert("location", frame=2)
        found = []
        for frame in (2, 1, 2):
            self.scene.frame_set(frame)
            found.append(self.chosen())
        self.assertEqual(found[0], found[2])
        self.assertNotEqual(found[0], found[1])
        self.scene.frame_set(1)

    def test_nonsense_has_no_effect(self):
        plain = self.chosen()
        for scale in ((0, 0, 0), (1, 0, 1)):
            made = add_lens((40, 0, 0), radius=2.0, strength=64.0)
            made.scale = scale
            self.assertEqual(self.chosen(), plain, scale)
            bpy.data.objects.remove(made)
        made = add_lens((40, 0, 0), strength=64.0)
        made.location = (math.inf, 0, 0)
        self.assertEqual(self.chosen(), plain)

    def test_a_screen_lens_refines_what_is_below_it(self):
        plain = self.chosen()
        bpy.ops.lodestone.screen_lens_add()
        lens = self.scene.camera.data.lodestone.screen_lenses[0]
        lens.radius, lens.strength = 0.02, 64.0
        found = self.chosen()
        self.assertGreater(found["Group 1"], plain["Group 1"])
        self.assertEqual(found["Group 0"], plain["Group 0"])

    def test_depth_exaggeration_is_coarser_beyond_the_focus_and_finer_before_it(self):
        camera = self.scene.camera
        plain = self.chosen()
        self.scene.lodestone.off_screen = "FULL"
        self.assertIsNone(quality_lenses.modifiers(SceneSettings(self.scene), (), camera))
        settings, dof = camera.data.lodestone, camera.data.dof
        before = dof.focus_distance
        try:
            settings.depth_exaggeration = 3.0
            dof.focus_distance = 40.0  # the balls are 400 m away: 100 times as coarse, 64 at most
            made = quality_lenses.modifiers(SceneSettings(self.scene), (), camera)
            self.assertEqual((made.depth, made.depth_focus), (3.0, 40.0))
            far = self.chosen()
            dof.focus_distance = 4000.0
            near = self.chosen()
            numbers = self.statistics()
            dof.focus_distance = 400.0
            self.assertNotEqual(self.statistics().bytes, numbers.bytes)
        finally:
            settings.property_unset("depth_exaggeration")
            self.scene.lodestone.property_unset("off_screen")
            dof.focus_distance = before
        self.assertLess(sum(far.values()), sum(near.values()))
        self.assertLessEqual(sum(far.values()), sum(plain.values()))
        self.assertGreater(sum(near.values()), sum(plain.values()))

    def test_the_button_exaggerates_the_depth_of_the_camera(self):
        settings = self.scene.camera.data.lodestone
        self.addCleanup(settings.property_unset, "depth_exaggeration")
        self.assertEqual(bpy.ops.lodestone.depth_exaggerate(), {"FINISHED"})
        self.assertEqual(settings.depth_exaggeration, 2.0)

    def test_depth_exaggeration_is_about_what_is_in_focus(self):
        camera = self.scene.camera
        settings, dof = camera.data.lodestone, camera.data.dof
        settings.depth_exaggeration = 2.0
        target = scenes.link(bpy.data.objects.new("Focus", None))
        target.location = (0, 0, 150)
        dof.focus_object = target
        bpy.context.view_layer.update()
        try:
            made = quality_lenses.modifiers(SceneSettings(self.scene), (), camera)
            self.assertAlmostEqual(made.depth_focus, 250.0, 3)
        finally:
            dof.focus_object = None
            settings.property_unset("depth_exaggeration")

    def test_what_is_off_screen_may_be_coarser(self):
        camera = self.scene.camera
        before = camera.location.copy()
        try:
            camera.location = (4.5, 1.5, 40)  # sees the first group
            self.scene.lodestone.pixel_error_render = 0.1
            found = self.chosen()
            self.scene.lodestone.off_screen = "FULL"
            full = self.chosen()
        finally:
            self.scene.lodestone.property_unset("off_screen")
            camera.location = before
        self.assertEqual(found["Group 0"], full["Group 0"])
        self.assertLess(found.get("Group 2", 0), full["Group 2"])

    def statistics(self):
        found = live_view.statistics(bpy.context)
        self.assertNotIsInstance(found, str, found)
        return found

    def test_the_panel_s_numbers_follow_pixel_error_and_lenses(self):
        settings = self.scene.lodestone
        numbers, sizes = [], []
        for error in (0.0, 1.0, 64.0):
            settings.pixel_error_render = error
            found = self.statistics()
            numbers.append(found.triangles)
            sizes.append(found.bytes)
            self.assertLessEqual(found.largest_error_px, error)
        self.assertEqual(numbers[0], found.triangles_before)
        self.assertGreater(numbers[0], numbers[1])
        self.assertGreater(sizes[0], sizes[1])
        self.assertGreater(sizes[1], sizes[2])
        add_lens((40, 0, 0), radius=20.0, strength=64.0)
        bpy.context.view_layer.update()
        self.assertGreater(self.statistics().bytes, sizes[2])
        settings.use_levels = False
        self.assertEqual(self.statistics().triangles, numbers[0])

    def test_the_panel_counted_what_is_pinned_as_its_original(self):
        whole = self.statistics().triangles_before
        pinned = bpy.data.objects["Ball 0 0"].lodestone
        pinned.use_pin_render, pinned.pin_render = True, 3
        bpy.ops.lodestone.update_levels()
        try:
            self.assertEqual(self.statistics().triangles_before, whole)
        finally:
            pinned.property_unset("use_pin_render")
            pinned.property_unset("pin_render")
            bpy.ops.lodestone.update_levels()

    def test_lenses_in_hidden_collections_counted_in_the_panel_s_numbers_alone(self):
        plain = self.statistics().triangles
        kept = scenes.collection("Lenses", self.scene.collection)
        self.addCleanup(bpy.data.collections.remove, kept)
        made = add_lens((40, 0, 0), radius=20.0, strength=64.0)
        self.scene.collection.objects.unlink(made)
        kept.objects.link(made)
        bpy.context.view_layer.update()
        refined = self.statistics().triangles
        self.assertGreater(refined, plain)
        kept.hide_render = True
        self.assertEqual(self.statistics().triangles, plain)
        kept.hide_render = False
        self.assertEqual(self.statistics().triangles, refined)
        layer = bpy.context.view_layer.layer_collection.children["Lenses"]
        layer.exclude = True
        self.assertEqual(self.statistics().triangles, plain)

    def test_equal_views_are_chosen_once(self):
        add_lens((40, 0, 0))
        bpy.context.view_layer.update()
        self.assertIs(self.statistics(), self.statistics())

    def test_a_budget_is_kept_and_an_impossible_one_said(self):
        settings = self.scene.lodestone
        settings.pixel_error_render = 0.0
        whole = self.statistics()
        settings.budget_render = 1
        found = self.statistics()
        if whole.bytes > 1_000_000:
            self.assertGreater(found.pixel_error, 0.0)
        self.assertTrue(found.fits)
        self.assertLessEqual(found.bytes, 1_000_000)

    def test_without_a_camera_the_reason_is_told(self):
        camera, self.scene.camera = self.scene.camera, None
        try:
            self.assertEqual(live_view.statistics(bpy.context), "Set a scene camera")
        finally:
            self.scene.camera = camera


def lenses_frame(scene):
    from lodestone.bridge.scene import scene_camera

    frame = scene_camera.Frame.of(scene.render)
    return scene_camera.extract(scene.camera, frame, Problems()), (frame.width, frame.height)


if __name__ == "__main__":
    unittest.main()
