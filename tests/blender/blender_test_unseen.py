# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards Not Seen Directly: what is switched on reaches the cut, the numbers beside it are
the cut's, and nothing is chosen for it where it is off."""

import os
import tempfile
import time
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes
from lodestone.bridge import quality_settings
from lodestone.bridge.live import live_view
from lodestone.bridge.scene_settings import SceneSettings
from lodestone.core.native import lodestone_native as native
from lodestone.core.picture import unseen_detail
from lodestone.core.session.addon_session import addon_session
from lodestone.panels import unseen as panel

BOTH = int(native.Rays.SHADOW | native.Rays.REFLECTION)
KEYS = [one.key for one in unseen_detail.CLASSES]


class Settings(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.settings = self.scene.lodestone

    def test_every_class_is_off_at_first_and_stores_nothing(self):
        self.assertEqual([getattr(self.settings, key) for key in KEYS], [False] * len(KEYS))
        self.assertEqual(quality_settings.ray_classes(SceneSettings(self.scene)), 0)

    def test_each_class_is_its_own_bit(self):
        for one in unseen_detail.CLASSES:
            setattr(self.settings, one.key, True)
            self.assertEqual(quality_settings.ray_classes(self.settings), one.rays)
            setattr(self.settings, one.key, False)
        self.settings.shadow_levels = self.settings.reflection_levels = True
        self.assertEqual(quality_settings.ray_classes(self.settings), BOTH)

    def test_without_levels_of_detail_there_are_none(self):
        self.settings.shadow_levels = True
        self.settings.use_levels = False
        self.assertEqual(quality_settings.ray_classes(self.settings), 0)

    def test_a_user_s_preset_keeps_them(self):
        self.settings.shadow_levels = True
        self.settings.off_screen = "SHADOWS"
        bpy.ops.lodestone.levels_preset_add(name="Unseen of Lodestone")
        folder = bpy.utils.user_resource("SCRIPTS", path="presets/lodestone/levels")
        path = os.path.join(folder, "Unseen_of_Lodestone.py")
        self.addCleanup(lambda: os.path.exists(path) and os.remove(path))
        self.settings.shadow_levels = False
        self.settings.off_screen = "FULL"
        bpy.ops.script.execute_preset(filepath=path, menu_idname="LODESTONE_PT_levels_presets")
        self.assertTrue(self.settings.shadow_levels)
        self.assertEqual(self.settings.off_screen, "SHADOWS")


class Words(unittest.TestCase):
    def numbers(self, **values):
        usual = dict(own=5, triangles=1_200_000, largest_error_px=0.93, needed=0, shaped=0)
        usual |= dict(touching=0, ray_class=unseen_detail.CLASSES[0])
        return unseen_detail.RayNumbers(**(usual | values))

    def test_what_is_saved_and_its_bound(self):
        lines = panel.lines_of(self.numbers(), 2_700_000)
        self.assertEqual(lines, ["1.2 M of 2.7 M triangles   44 %", "Off by at most 1.0 px"])

    def test_bounds_are_rounded_up(self):
        found = [panel.bound(value) for value in (0.0, 0.01, 0.1, 0.11, 0.999, 1.0)]
        self.assertEqual(found, ["0.0 px", "0.1 px", "0.1 px", "0.2 px", "1.0 px", "1.0 px"])

    def test_nothing_saved_says_why(self):
        lines = panel.lines_of(self.numbers(own=0, touching=1200, shaped=3), 5)
        self.assertEqual(lines[0], "Nothing coarser may be used")
        self.assertEqual(lines[1], "1,200 as seen: too near to others")
        self.assertEqual(lines[2], "3 as seen: cover themselves")


class Drawn(unittest.TestCase):
    """Balls that hang over a floor, under a sun; the store is built once."""

    @classmethod
    def setUpClass(cls):
        cls.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        scenes.cube("Floor", (0, 0, -40), 1.0).scale = (400, 400, 1)
        data = scenes.bumpy_mesh()
        for number in range(16):
            place = (8 * (number % 4) - 12, 8 * (number // 4) - 12, 0)
            scenes.cube(f"Ball {number}", place, data=data)
        sun = bpy.data.lights.new("Sun", "SUN")
        scenes.link(bpy.data.objects.new("Sun", sun))
        cls.scene.camera.location = (0, 0, 60)
        cls.scene.render.engine = "LODESTONE_POVRAY"
        cls.scene.render.resolution_x, cls.scene.render.resolution_y = 480, 270
        cls.blend = Path(folder.name) / "balls.blend"
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(cls.blend))
        bpy.context.view_layer.update()
        bpy.ops.lodestone.update_levels()

    def tearDown(self):
        settings = self.scene.lodestone
        for name in (*KEYS, "off_screen", "use_levels", "pixel_error_render"):
            settings.property_unset(name)

    def statistics(self):
        found = live_view.statistics(bpy.context)
        self.assertNotIsInstance(found, str, found)
        return found

    def test_off_there_are_no_numbers_of_them(self):
        self.assertIsNone(self.statistics().met)

    def test_each_class_that_is_on_has_its_numbers(self):
        plain = self.statistics()
        for keys in (["shadow_levels"], ["reflection_levels"], KEYS):
            for key in KEYS:
                setattr(self.scene.lodestone, key, key in keys)
            found = self.statistics()
            self.assertEqual([one.ray_class.key for one in found.met.classes], keys)
            # What the camera sees is as it was; more has to be kept, never less
            self.assertEqual(found.triangles, plain.triangles)
            self.assertGreaterEqual(found.bytes, plain.bytes)
            self.assertGreaterEqual(found.met.triangles, plain.triangles)
            for one in found.met.classes:
                self.assertLessEqual(one.triangles, plain.triangles)
                self.assertLessEqual(one.largest_error_px, 1.0)
                self.assertEqual(one.own > 0, one.triangles < plain.triangles, one)

    def test_numbers_follow_the_settings_within_a_fifth_of_a_second(self):
        self.scene.lodestone.shadow_levels = True
        self.statistics()  # what depends on the store alone is read once
        for error in (0.5, 2.0):
            self.scene.lodestone.pixel_error_render = error
            start = time.process_time()
            found = self.statistics()
            self.assertLess(time.process_time() - start, 0.2)
            self.assertLessEqual(found.met.classes[0].largest_error_px, error)

    def test_the_originals_are_drawn_as_they_are(self):
        self.scene.lodestone.shadow_levels = True
        self.scene.lodestone.pixel_error_render = 0.0
        found = self.statistics()
        self.assertEqual([one.own for one in found.met.classes], [0])
        self.assertEqual(found.triangles, found.triangles_before)

    def test_a_picture_is_made_with_them(self):
        self.scene.lodestone.shadow_levels = True
        wanted = self.statistics().met.classes[0].own
        self.scene.lodestone.keep_scene_files = "ALWAYS"
        self.addCleanup(self.scene.lodestone.property_unset, "keep_scene_files")
        bpy.ops.render.render()
        (text,) = [path.read_text() for path in self.blend.parent.rglob("scene.pov")]
        self.assertEqual("no_shadow" in text, wanted > 0)


class Originals(unittest.TestCase):
    def test_the_panel_counted_levels_of_what_is_scaled_to_nothing_as_originals(self):
        scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        scene.render.engine = "LODESTONE_POVRAY"
        data = scenes.bumpy_mesh()
        for number in range(3):
            scenes.cube(f"Ball {number}", (3 * number, 0, 0), data=data)
        bpy.data.objects["Ball 2"].scale = (0, 0, 0)
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(Path(folder.name) / "cubes.blend"))
        bpy.ops.lodestone.update_levels()
        for error in (1.0, 0.0):
            scene.lodestone.pixel_error_render = error
            bpy.ops.render.render()
            drawn, found = addon_session().renders.get(scene.name), live_view.statistics(
                bpy.context
            )
            self.assertEqual(found.pixel_error, error)
            self.assertEqual(found.kinds, drawn.kinds)
            self.assertEqual(found.triangles, drawn.triangles)
            self.assertEqual(found.triangles_before, drawn.triangles_placed)
