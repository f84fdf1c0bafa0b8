# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what is seen and explained: comparisons, false colors, reasons, costs. Nothing of it may
leave a trace in the file."""

import json
import os
import shutil
import tempfile
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes

HAVE_POVRAY = shutil.which(os.environ.get("LODESTONE_POVRAY", "povray")) is not None


class Seeing(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.addCleanup(setattr, tempfile, "tempdir", tempfile.tempdir)
        tempfile.tempdir = str(self.folder)  # others may compare on this machine, too
        self.scene.render.engine = "LODESTONE_POVRAY"
        scenes.sun()
        self.near = scenes.cube("Near", (0, 0, 0), data=scenes.bumpy_mesh())
        self.far = scenes.cube("Far", (2.5, 1.0, -30), data=scenes.bumpy_mesh())
        bpy.context.view_layer.update()
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        self.scene = bpy.context.scene
        from lodestone.core.session.addon_session import addon_session

        session = addon_session()
        self.comparisons, self.renders = session.comparisons, session.renders
        self.kept = session.kept_models
        self.addCleanup(self.kept.clear)

    def compares(self):
        from lodestone.engines import render_engine

        return render_engine.is_comparing()

    def everything(self):
        """What a comparison may not change."""
        render = self.scene.render
        slots = bpy.data.images["Render Result"].render_slots
        return (
            self.scene.lodestone.pixel_error_render,
            render.use_compositing,
            render.use_sequencer,
            render.engine,
            render.filepath,
            len(bpy.data.images),
            slots.active_index if self.comparisons.get(self.scene.name) is None else 0,
            self.left_over(),
        )

    def left_over(self):
        return [n for n in os.listdir(tempfile.gettempdir()) if n.startswith("lodestone-compare-")]

    def compare(self):
        self.scene.lodestone.pixel_error_render = 16.0
        return bpy.ops.lodestone.compare()

    @unittest.skipUnless(HAVE_POVRAY, "POV-Ray is not installed")
    def test_compare_fills_three_slots_and_names_what_differs(self):
        self.assertEqual(self.compare(), {"FINISHED"})
        found = self.comparisons.get(self.scene.name)
        self.assertEqual(found.pixel_error, 16.0)
        self.assertGreater(found.pixels, 100)
        self.assertGreater(found.max, 0.0)
        self.assertLess(found.ssim, 1.0)
        self.assertEqual(found.worst[0][0].rsplit("/", 1)[-1], "Near")
        self.assertGreater(found.worst[0][1], 0.5)
        self.assertEqual(bpy.ops.lodestone.select_object(path=found.worst[0][0]), {"FINISHED"})
        self.assertEqual(bpy.context.object, self.near)
        # The slots hold three different pictures, the third black where nothing differs
        result = bpy.data.images["Render Result"]
        pictures = []
        for slot in range(3):
            result.render_slots.active_index = slot
            path = str(self.folder / f"slot{slot}.png")
            result.save_render(path, scene=self.scene)
            from lodestone import lodestone_native as native

            pictures.append(native.image_read(path).pixels)
        self.assertNotEqual(pictures[0], pictures[1])
        self.assertLess(max(pictures[2][0:3]), 0.01)
        self.assertGreater(max(pictures[2][0::4]) + max(pictures[2][2::4]), 0.1)
        self.assertEqual(self.left_over(), [])
        self.assertFalse(self.compares())

    @unittest.skipUnless(HAVE_POVRAY, "POV-Ray is not installed")
    def test_compare_of_a_border_counts_the_border_alone(self):
        render = self.scene.render
        render.use_border = True
        render.border_min_x, render.border_max_x = 0.5, 0.75
        render.border_min_y, render.border_max_y = 0.0, 1.0
        self.assertEqual(self.compare(), {"FINISHED"})
        self.assertLessEqual(self.comparisons.get(self.scene.name).pixels, 16 * 36)

    @unittest.skipUnless(HAVE_POVRAY, "POV-Ray is not installed")
    def test_a_failing_comparison_leaves_everything_as_it_was(self):
        bpy.ops.render.render()
        slots = bpy.data.images["Render Result"].render_slots
        slots.active_index = 4
        self.scene.render.use_compositing = True
        program = self.folder / "povray"
        program.write_text("#!/bin/sh\nexit 1\n")
        program.chmod(0o755)
        self.scene.lodestone.pixel_error_render = 16.0
        before = self.everything()
        old = os.environ.get("LODESTONE_POVRAY")
        os.environ["LODESTONE_POVRAY"] = str(program)
        try:
            with self.assertRaises(RuntimeError):
                bpy.ops.lodestone.compare()
        finally:
            if old is None:
                del os.environ["LODESTONE_POVRAY"]
            else:
                os.environ["LODESTONE_POVRAY"] = old
        self.assertEqual(self.everything(), before)
        self.assertEqual(slots.active_index, 4)
        self.assertFalse(self.compares())

    def test_what_cannot_be_compared_is_refused_with_a_reason(self):
        from lodestone.operators import compare

        self.scene.lodestone.pixel_error_render = 0.0
        self.assertIn("Pixel Error 0", compare.refusal(bpy.context))
        self.scene.lodestone.budget_render = 1  # which draws levels all the same
        self.assertEqual(compare.refusal(bpy.context), "")
        self.scene.lodestone.pixel_error_render = 1.0
        self.assertEqual(compare.refusal(bpy.context), "")
        self.scene.camera = None
        self.assertIn("camera", compare.refusal(bpy.context))
        self.scene.render.engine = "CYCLES"
        self.assertIn("engine", compare.refusal(bpy.context))

    def test_originals_are_not_compared_with_themselves_where_levels_are_off(self):
        from lodestone.operators import compare

        self.scene.lodestone.use_levels = False
        self.assertIn("off", compare.refusal(bpy.context))

    def test_why_this_level_tells_of_originals_where_levels_are_off(self):
        from lodestone.bridge.live import kept_model_view

        bpy.ops.lodestone.update_levels()
        bpy.ops.lodestone.read_levels()

        def title():
            depsgraph = bpy.context.evaluated_depsgraph_get()
            return kept_model_view.explained(self.scene, depsgraph, self.far).title

        self.scene.lodestone.pixel_error_render = 16.0
        self.assertNotIn("Original", title())
        self.scene.lodestone.use_levels = False
        self.assertIn("Original", title())

    def test_why_this_level_missed_instances_of_a_collection_with_an_offset(self):
        from lodestone.bridge.live import kept_model_view

        inner = scenes.collection("Inner")
        inner.instance_offset = (1, 2, 3)
        scenes.cube("Member", (1, 2, 3), collection=inner)
        copy = scenes.instance("Copy", inner, (0, 5, 0), (2, 1, 1), (0, 0, 1))
        bpy.context.view_layer.update()
        bpy.ops.lodestone.read_levels()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        found = kept_model_view.explained(self.scene, depsgraph, copy)
        self.assertNotEqual(found.title, "Not in the last picture")

    def explained(self, item):
        from lodestone.bridge.live import kept_model_view

        bpy.context.view_layer.update()
        return kept_model_view.explained(self.scene, bpy.context.evaluated_depsgraph_get(), item)

    def test_a_lens_was_missing_from_why_this_level_after_read_scene(self):
        self.scene.lodestone.pixel_error_render = 8.0
        bpy.ops.lodestone.update_levels()
        bpy.ops.lodestone.detail_lens_add(location=self.far.location, radius=4.0, strength=64.0)
        made = bpy.context.object
        made.lodestone.lens.falloff = 0.0
        bpy.ops.lodestone.read_levels()
        with_lens = self.explained(self.far)
        self.assertIn("Detail lenses \N{MULTIPLICATION SIGN} 64 finer", with_lens.lines)
        made.location.z += 1000.0
        without = self.explained(self.far)
        self.assertNotIn("Detail lenses", " ".join(without.lines))
        self.assertNotEqual(with_lens.title, without.title)
        self.assertFalse(self.kept.get(self.scene.name).outdated, "lenses are followed")

    def test_of_a_budget_why_this_level_and_colors_told_as_of_a_picture_without(self):
        from lodestone.viewport import false_color_overlay

        self.near.data = scenes.bumpy_mesh(subdivisions=6)
        self.scene.lodestone.pixel_error_render = 0.0
        bpy.context.view_layer.update()
        bpy.ops.lodestone.update_levels()
        bpy.ops.lodestone.read_levels()
        self.assertEqual(self.explained(self.near).title, "LOD 0  Original")
        self.scene.lodestone.budget_render = 1
        found = self.explained(self.near)
        self.assertNotEqual(found.title, "LOD 0  Original")
        self.assertNotIn("0 px: nothing finer can be drawn", found.lines[0])
        self.assertTrue(false_color_overlay.refresh(bpy.context, self.scene, "ERROR"))
        self.addCleanup(false_color_overlay.forget)
        self.assertNotIn("Pixel Error 0:", false_color_overlay.drawn().shown.lines[0])
        self.assertNotEqual(false_color_overlay.drawn().shown.legend[-1][0], "above 0 px")

    @unittest.skipUnless(HAVE_POVRAY, "POV-Ray is not installed")
    def test_a_picture_tells_why_and_what_it_took(self):
        from lodestone.bridge.live import kept_model_view

        self.scene.lodestone.pixel_error_render = 1.0
        self.scene.lodestone.build_on_render = "ALL"
        bpy.ops.render.render()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        near = kept_model_view.explained(self.scene, depsgraph, self.near)
        far = kept_model_view.explained(self.scene, depsgraph, self.far)
        self.assertNotEqual(near.title, far.title)
        self.assertRegex(far.lines[0], r"^\d+ m . .*m = .* px . 1 px$")
        self.assertIn("would be", " ".join(near.lines))
        empty = scenes.link(bpy.data.objects.new("Later", None))
        bpy.context.view_layer.update()
        found = kept_model_view.explained(self.scene, bpy.context.evaluated_depsgraph_get(), empty)
        self.assertEqual(found.title, "Not in the last picture")
        render = self.renders.get(self.scene.name)
        self.assertGreater(render.actual_s, 0.0)
        self.assertGreater(render.predicted_s, 0.0)
        self.assertGreater(render.actual_bytes, 1e6)
        self.assertLess(abs(render.predicted_bytes / render.actual_bytes - 1.0), 0.5)
        cost = json.loads((self.folder / "lodestone/file/cost.json").read_text())
        ratios = {"parse", "trace", "memory", "trace_exact"}
        self.assertEqual(set(cost), {"model", "cameras", *ratios})
        self.assertEqual([set(one) for one in cost["cameras"].values()], [ratios])
        self.assertFalse(any("lodestone" in item.keys() for item in bpy.data.objects))

    def test_reading_keeps_the_scene_until_it_changes(self):
        self.assertEqual(bpy.ops.lodestone.read_levels(), {"FINISHED"})
        kept = self.kept.get(self.scene.name)
        self.assertFalse(kept.outdated)
        self.scene.camera.location.z = 20.0
        bpy.context.view_layer.update()
        self.assertFalse(kept.outdated)
        self.near.location.x = 0.5
        bpy.context.view_layer.update()
        self.assertTrue(kept.outdated)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        self.assertTrue(kept.closed)
        self.assertIsNone(self.kept.get("Scene"))

    def test_a_moved_light_left_why_this_level_as_if_nothing_had_changed(self):
        lamp = next(item for item in self.scene.objects if item.type == "LIGHT")

        def changes():
            yield lambda: setattr(lamp.location, "x", lamp.location.x + 1.0)
            yield lambda: setattr(lamp.data, "energy", lamp.data.energy * 0.5)
            yield lambda: setattr(self.scene.world, "color", (0.1, 0.2, 0.3))

        self.scene.world = bpy.data.worlds.new("World")
        for coarser in (False, True):
            self.scene.lodestone.coarser_moving_dark = coarser
            for change in changes():
                bpy.ops.lodestone.read_levels()
                bpy.context.view_layer.update()
                self.assertFalse(self.kept.get(self.scene.name).outdated)
                change()
                bpy.context.view_layer.update()
                self.assertEqual(self.kept.get(self.scene.name).outdated, coarser)

    def test_motion_of_the_camera_was_missing_from_why_this_level_after_read_scene(self):
        from lodestone.bridge.live import kept_model_view

        camera = self.scene.camera
        camera.keyframe_insert("location", frame=1)
        camera.location.x += 1.0
        camera.keyframe_insert("location", frame=2)
        self.scene.frame_set(1)
        bpy.ops.lodestone.update_levels()
        bpy.ops.lodestone.read_levels()
        self.scene.lodestone.coarser_moving_dark = True
        self.assertTrue(kept_model_view.old(self.kept.get(self.scene.name), self.scene))
        bpy.ops.lodestone.read_levels()
        self.assertFalse(kept_model_view.old(self.kept.get(self.scene.name), self.scene))
        self.assertIn("Motion", " ".join(self.explained(self.near).lines))
        self.scene.lodestone.coarser_moving_dark = False
        self.assertNotIn("Motion", " ".join(self.explained(self.near).lines))

    @unittest.skipUnless(HAVE_POVRAY, "POV-Ray is not installed")
    def test_false_colors_are_the_levels_of_the_scene_camera_from_anywhere(self):
        from lodestone import lodestone_native as native
        from lodestone.core.picture import false_colors

        self.scene.lodestone.pixel_error_render = 2.0
        self.scene.render.resolution_x, self.scene.render.resolution_y = 320, 180
        bpy.ops.lodestone.read_levels()
        shown = {}
        for seen_from in ("CAMERA", "OVERVIEW"):
            done = bpy.ops.lodestone.false_color_picture(seen_from=seen_from, mode="LEVEL")
            self.assertEqual(done, {"FINISHED"})
            image = bpy.data.images["Lodestone False Colors"]
            self.assertEqual(image.size[0], 320)
            self.assertGreater(image.size[1], 180)
            pixels = list(image.pixels)[4 * 320 * (image.size[1] - 180) :]
            shown[seen_from] = pixels
        self.assertNotEqual(shown["CAMERA"], shown["OVERVIEW"])
        color = false_colors.of_level(native.Kind.MESH, 0)  # nothing is built: all originals
        for pixels in shown.values():
            reds = [p for p in pixels[0::4] if abs(p - color[0]) < 0.01]
            self.assertGreater(len(reds), 5, sorted(set(round(p, 2) for p in pixels[0::4])))
        self.assertEqual(len([i for i in bpy.data.images if "False" in i.name]), 1)

    def test_the_overlay_makes_what_it_draws_without_a_gpu(self):
        from lodestone.viewport import false_color_overlay

        bpy.ops.lodestone.read_levels()
        self.assertTrue(false_color_overlay.refresh(bpy.context, self.scene, "LEVEL"))
        shown = false_color_overlay.drawn().shown
        self.assertGreater(shown.triangles, 2000)
        self.assertEqual(len(shown._arrays[0]), 9 * shown.triangles)
        self.assertEqual(len(shown._arrays[1]), 12 * shown.triangles)
        kept = self.kept.get(self.scene.name)
        self.assertEqual(
            false_color_overlay.wanted_key(bpy.context, self.scene, kept, "LEVEL"), shown.key
        )
        self.scene.camera.location.z = 500.0
        bpy.context.view_layer.update()
        self.assertNotEqual(
            false_color_overlay.wanted_key(bpy.context, self.scene, kept, "LEVEL"), shown.key
        )
        self.assertIsNone(false_color_overlay._handle)  # without a window nothing is drawn
        false_color_overlay.forget()

    def test_files_are_opened_as_they_are_whatever_was_shown(self):
        bpy.context.window_manager.lodestone_overlay.mode = "COST"
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "shown.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "shown.blend"))
        self.assertEqual(bpy.context.window_manager.lodestone_overlay.mode, "NONE")
