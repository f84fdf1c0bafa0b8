# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the tree of quality in Blender: presets, overrides that reach the scene file, and pins."""

import os
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import bmesh
import bpy

import blender_scenes as scenes
from blender_test_labels import Layout
from lodestone.bridge import quality_settings
from lodestone.bridge.live import viewport_camera
from lodestone.bridge.scene import quality_lenses
from lodestone.core.native import lodestone_native as native
from lodestone.core.picture import quality_tree
from lodestone.core.picture.slow_causes import Remedy
from lodestone.core.problems import INFO, Problem
from lodestone.core.session.addon_session import addon_session
from lodestone.core.session.last_check import Check
from lodestone.core.session.last_render import LastRender

NUMBERS = [control for control in quality_tree.CONTROLS if control.least is not None]


class Controls(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.settings = self.scene.lodestone

    def values(self):
        return {control.key: getattr(self.settings, control.key) for control in NUMBERS}

    def test_untouched_they_show_what_they_inherit(self):
        for error in (0.0, 1.0, 2.0, 8.0):
            self.settings.pixel_error_render = error
            found = quality_tree.quality(error)
            for key, value in self.values().items():
                self.assertEqual(value, getattr(found, key), (key, error))
        self.assertEqual(quality_settings.overrides(self.settings), {})

    def test_one_that_is_set_stays_and_is_set_back_with_one_click(self):
        self.settings.pixel_error_render = 2.0
        self.settings.area_samples = 33
        self.settings.shadows = 0.5
        self.settings.antialias = "REFERENCE"
        self.settings.pixel_error_render = 8.0
        self.assertEqual((self.settings.area_samples, self.settings.shadows), (33, 0.5))
        for key in ("area_samples", "shadows", "antialias"):
            bpy.ops.lodestone.inherit_control(key=key)
        self.assertEqual((self.settings.area_samples, self.settings.shadows), (1, 8.0))
        self.assertEqual(quality_settings.overrides(self.settings), {})
        with self.assertRaisesRegex(RuntimeError, "Everything inherits already"):
            bpy.ops.lodestone.inherit_control(key="shadows")

    def test_all_are_set_back_at_once(self):
        for control in NUMBERS:
            setattr(self.settings, control.key, control.most)
        bpy.ops.lodestone.inherit_control(key="")
        self.assertEqual(quality_settings.overrides(self.settings), {})

    def test_a_control_that_is_none_is_refused(self):
        self.settings.shadows = 1.0
        with self.assertRaisesRegex(RuntimeError, "no control called"):
            bpy.ops.lodestone.inherit_control(key="__class__")

    def test_a_child_s_preset_s_word_follows_its_parent(self):
        self.settings.reflections = 8.0
        self.assertEqual(self.settings.trace_depth, 2)
        self.assertEqual(quality_settings.inherited_word(self.settings, "reflections"), "1.00 px")
        self.assertEqual(quality_settings.inherited_word(self.settings, "antialias"), "Final")

    def test_presets_set_the_one_number_and_every_override_back(self):
        for key, expected in (("DRAFT", 8.0), ("PREVIEW", 2.0), ("FINAL", 1.0), ("EXACT", 0.0)):
            self.settings.area_samples = 5
            self.settings.antialias = "OFF"
            self.settings.use_levels = False
            bpy.ops.lodestone.levels_preset(preset=key)
            self.assertEqual(
                quality_settings.of_scene(self.settings), quality_tree.quality(expected)
            )

    def test_a_user_s_own_preset_is_added_used_and_removed(self):
        settings = self.settings
        settings.pixel_error_render, settings.shadows, settings.budget_render = 3.0, 5.0, 700
        folder = bpy.utils.user_resource("SCRIPTS", path="presets/lodestone/levels", create=True)
        path = Path(folder) / "Test_of_Lodestone.py"
        self.addCleanup(path.unlink, missing_ok=True)
        bpy.ops.lodestone.levels_preset_add(name="Test of Lodestone")
        self.assertTrue(path.is_file(), folder)
        bpy.ops.lodestone.levels_preset(preset="DRAFT")
        settings.budget_render = 0
        exec(compile(path.read_text(), str(path), "exec"), {})
        self.assertEqual((settings.pixel_error_render, settings.shadows), (3.0, 5.0))
        self.assertEqual(settings.budget_render, 700)
        self.assertEqual(quality_settings.overrides(settings), {"shadows": 5.0})
        bpy.ops.lodestone.levels_preset_add(name="Test of Lodestone", remove_name=True)
        self.assertFalse(path.exists())

    def test_each_setting_of_a_scene_is_in_presets_or_none_of_quality(self):
        from lodestone.panels import presets

        not_of_quality = {"scope", "deforming", "build_on_render", "structure", "keep_scene_files"}
        not_of_quality |= {"ignored", "linked"}
        drawn = {control.key for control in NUMBERS}  # what is stored has a name of its own
        settings = set(self.settings.bl_rna.properties.keys()) - {"rna_type", "name"}
        self.assertEqual(settings - not_of_quality - drawn, set(presets._KEPT))

    def test_nonsense_stops_at_the_limits(self):
        for control in NUMBERS:
            for value in (-(2**30), 2**30):
                setattr(self.settings, control.key, value)
                found = getattr(quality_settings.of_scene(self.settings), control.key)
                self.assertTrue(control.least <= found <= control.most, (control.key, value))
        self.settings.pixel_error_render = float("nan")
        self.assertTrue(0.0 <= quality_settings.of_scene(self.settings).pixel_error <= 1024.0)


class SlowPictures(unittest.TestCase):
    """What a slow picture's row in Problems offers."""

    def setUp(self):
        self.scene = scenes.fresh()
        self.settings = self.scene.lodestone
        session = addon_session()
        lamps = Problem("", INFO, "slow_lamps", "25 lamps: about 90 % of the time")
        other = Problem("", INFO, "slow_weather", "Nothing helps against it")
        session.checks[self.scene.name] = Check((lamps, other), {})
        remedies = {"slow_lamps": Remedy("lights", 1.0, 16.0)}
        session.renders[self.scene.name] = LastRender(0, 0, {}, 0.0, "", remedies=remedies)
        self.addCleanup(session.renders.pop, self.scene.name, None)

    def buttons(self):
        layout = Layout([])
        panel = bpy.types.LODESTONE_RENDER_PT_problems
        panel.draw(SimpleNamespace(layout=layout), bpy.context)
        return layout.operators

    def test_faster_sets_the_control_once_a_picture(self):
        self.assertIn("lodestone.draw_faster", self.buttons())
        self.assertEqual(bpy.ops.lodestone.draw_faster(code="slow_lamps"), {"FINISHED"})
        self.assertEqual(quality_settings.overrides(self.settings), {"lights": 16.0})
        self.assertNotIn("lodestone.draw_faster", self.buttons())
        self.assertEqual(bpy.ops.lodestone.draw_faster(code="slow_lamps"), {"CANCELLED"})
        bpy.ops.lodestone.inherit_control(key="lights")
        self.assertIn("lodestone.draw_faster", self.buttons())

    def test_without_a_control_that_helps_there_is_no_button(self):
        self.assertEqual(bpy.ops.lodestone.draw_faster(code="slow_weather"), {"CANCELLED"})
        addon_session().renders.pop(self.scene.name)
        self.assertEqual(bpy.ops.lodestone.draw_faster(code="slow_lamps"), {"CANCELLED"})
        self.assertNotIn("lodestone.draw_faster", self.buttons())
        self.assertEqual(quality_settings.overrides(self.settings), {})


class Files(unittest.TestCase):
    """What F12 writes for POV-Ray; nothing is built and POV-Ray draws a tiny picture."""

    def setUp(self):
        self.scene = scenes.fresh()
        self.settings = self.scene.lodestone
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.render.resolution_x, self.scene.render.resolution_y = 16, 16
        self.settings.build_on_render = "NONE"
        self.settings.keep_scene_files = "ALWAYS"
        mirror = bpy.data.materials.new("Mirror")
        mirror.use_nodes = True
        surface = mirror.node_tree.nodes["Principled BSDF"].inputs
        surface["Metallic"].default_value, surface["Roughness"].default_value = 1.0, 0.0
        scenes.cube().data.materials.append(mirror)
        lamp = bpy.data.lights.new("Lamp", "AREA")
        lamp.size = 2.0
        scenes.link(bpy.data.objects.new("Lamp", lamp)).location = (0, 0, 4)
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(self.folder / "quality.blend"))

    def written(self):
        bpy.ops.render.render()
        (scene,) = self.folder.glob("lodestone/**/scene.pov")
        return scene.read_text(), scene.with_name("scene.ini").read_text()

    def test_overrides_reach_the_scene_file(self):
        self.settings.lights = 1.0
        scene, ini = self.written()
        self.assertIn("max_trace_level 5 ", scene)
        self.assertIn(",9,9 adaptive", scene)
        self.assertNotIn("adc_bailout", scene)
        self.assertIn("Antialias_Threshold=0.3\nAntialias_Depth=2", ini)
        self.settings.trace_depth = 7
        self.settings.area_samples = 9
        self.settings.reflections = 51.0
        self.settings.antialias = "OFF"
        scene, ini = self.written()
        self.assertIn("max_trace_level 7 ", scene)
        self.assertIn(",5,5 adaptive", scene)
        self.assertIn("adc_bailout 0.2\n", scene.replace(" ambient", "\n"))
        self.assertIn("Antialias=Off", ini)

    def test_a_rough_model_is_shaded_roughly(self):
        self.settings.pixel_error_render = 8.0
        scene, ini = self.written()
        self.assertIn("max_trace_level 2 ", scene)
        self.assertNotIn("area_light", scene)
        self.assertIn("Antialias=Off", ini)

    def test_switched_off_everything_is_drawn_and_shaded_as_exact(self):
        self.settings.pixel_error_render = 8.0
        self.settings.use_levels = False
        scene, ini = self.written()
        self.assertIn("a fixed cut at Pixel Error 0\n", scene)
        self.assertIn("Antialias_Threshold=0.1", ini)


class Pins(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.lodestone.build_on_render = "ALL"
        self.scene.lodestone.antialias = "OFF"
        data = bpy.data.meshes.new("Ball")
        made = bmesh.new()
        bmesh.ops.create_icosphere(made, subdivisions=4, radius=1.0)
        made.to_mesh(data)
        made.free()
        self.balls = [scenes.cube(f"Ball {n}", (3 * n, 0, 0), data=data) for n in range(2)]
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(Path(folder.name) / "balls.blend"))

    def in_use(self):
        from lodestone.core.session.addon_session import addon_session

        bpy.ops.render.render()
        return [
            lod for found in addon_session().renders.get("Scene").in_use.values() for lod in found
        ]

    def test_a_pinned_level_is_drawn_near_and_far(self):
        for item, level in zip(self.balls, (0, 1)):
            item.lodestone.use_pin_render = True
            item.lodestone.pin_render = level
        for error in (0.01, 500.0):
            self.scene.lodestone.pixel_error_render = error
            self.assertEqual(sorted(self.in_use()), [0, 1], error)
        for item in self.balls:
            item.lodestone.use_pin_render = False
        self.scene.lodestone.pixel_error_render = 0.0
        self.assertEqual(set(self.in_use()), {0})

    def test_copied_to_the_selected(self):
        from lodestone.bridge import datablock_ids

        self.balls[0].lodestone.use_pin_render = True
        self.balls[0].lodestone.pin_render = 3
        for item in self.balls:
            item.select_set(True)
        bpy.context.view_layer.objects.active = self.balls[0]
        bpy.ops.lodestone.copy_decisions()
        found = datablock_ids.decision_of(self.balls[1])
        self.assertEqual((found.pinned, found.coarsest), (True, 3))


class Viewports(unittest.TestCase):
    def test_a_view_s_matrices_become_the_camera_they_came_from(self):
        scene = scenes.fresh()
        camera = scene.camera
        camera.location, camera.rotation_euler = (3, 2, 1), (1.0, 0.2, 0.7)
        from lodestone.bridge.scene import scene_camera as cameras
        from lodestone.core.problems import Problems

        for kind in ("PERSP", "ORTHO"):
            camera.data.type = kind
            camera.data.shift_x, camera.data.shift_y = 0.25, -0.125
            bpy.context.view_layer.update()
            window = camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=64, y=36)
            view = camera.matrix_world.inverted()
            made = viewport_camera.camera_of(view, window, camera.data.clip_start)
            frame = cameras.Frame(64, 36)
            real = cameras.extract(camera, frame, Problems())
            self.assertEqual(made.orthographic, real.orthographic)
            for name in ("position", "direction", "right", "up"):
                for a, b in zip(getattr(made, name), getattr(real, name)):
                    self.assertAlmostEqual(a, b, 4, (kind, name))

    def test_a_view_of_no_volume_is_none(self):
        from mathutils import Matrix

        self.assertIsNone(viewport_camera.camera_of(Matrix(), Matrix.Scale(0.0, 4), 0.1))
        self.assertIsNone(viewport_camera.camera_of(Matrix.Scale(0.0, 4), Matrix(), 0.1))
        self.assertIsNone(viewport_camera.of_screen(None))


class WithoutAWindow(unittest.TestCase):
    def test_the_overlay_touches_no_gpu(self):
        from lodestone.viewport import lens_overlay

        scenes.fresh()
        self.assertEqual(lens_overlay._handles, [])
        bpy.ops.lodestone.detail_lens_add(location=(0, 0, 0))
        bpy.context.view_layer.update()
        self.assertTrue(quality_lenses.is_lens(bpy.context.object))
        self.assertEqual(native.Lens("x", (1.0,) * 12).falloff, 1.0)


if __name__ == "__main__":
    unittest.main()
