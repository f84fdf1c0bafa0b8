# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards F12: the cube is where it should be, and a failure is never a picture."""

import contextlib
import io
import math
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import bpy

import blender_scenes as scenes
from lodestone.core import egl_library
from lodestone.core.session.addon_session import addon_session


class Engine(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.out = self.folder / "picture.png"
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.render.filepath = str(self.out)
        self.scene.render.film_transparent = True
        self.scene.render.image_settings.color_mode = "RGBA"
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))

    def render(self):
        bpy.ops.render.render(write_still=True)
        return self.pixels()

    def pixels(self):
        image = bpy.data.images.load(str(self.out))
        self.addCleanup(lambda: None)
        width, height = image.size
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        return [
            [pixels[4 * (y * width + x) : 4 * (y * width + x) + 4] for x in range(width)]
            for y in range(height)
        ]

    def pencil(self, name="Ink"):
        turn = (math.pi / 2, 0, 0)
        bpy.ops.object.gpencil_add(type="STROKE", location=(0, 0, 2), rotation=turn)
        bpy.context.object.name = name
        return bpy.context.object

    def problems(self, code):
        found = addon_session().checks.get(self.scene.name).problems
        return [problem for problem in found if problem.code == code]

    def refused(self, text):
        self.out.write_bytes(b"last night's picture")
        with self.assertRaisesRegex(RuntimeError, text):
            bpy.ops.render.render(write_still=True)
        self.assertEqual(self.out.read_bytes(), b"last night's picture")

    def with_environment(self, **changes):
        before = {name: os.environ.get(name) for name in changes}

        def put_back():
            for name, value in before.items():
                os.environ.pop(name, None)
                if value is not None:
                    os.environ[name] = value

        self.addCleanup(put_back)
        os.environ.update(changes)

    def povray(self, script):
        """A program that takes POV-Ray's place."""
        program = self.folder / "povray"
        program.write_text("#!/bin/sh\n" + script)
        program.chmod(0o755)
        self.with_environment(LODESTONE_POVRAY=str(program))

    def test_what_two_view_layers_have_in_common_is_told_once(self):
        scenes.cube()
        bpy.context.scene.collection.objects.link(
            bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke"))
        )
        self.scene.view_layers.new("Second")
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            bpy.ops.render.render()
        self.assertEqual(said.getvalue().count("Lodestone: error"), 1, said.getvalue())
        self.with_environment(LODESTONE_POVRAY=str(self.folder / "none"))
        with self.assertRaises(RuntimeError) as raised:
            bpy.ops.render.render()
        self.assertEqual(str(raised.exception).count("Error:"), 1, raised.exception)

    def test_the_cube_is_where_it_should_be(self):
        cube = scenes.cube("Red", (1.0, 0.5, 0.0), 1.0)
        cube.data.materials.append(scenes.material("Red", (0.8, 0.05, 0.05)))
        scenes.sun()
        rows = self.render()
        # The camera is 10 m above; a pixel at the cube's top (z = 0.5) is 9.5 * 36/50 / 64 m
        pixel = 9.5 * 0.72 / 64
        covered = [(x, y) for y, row in enumerate(rows) for x, p in enumerate(row) if p[3] > 0.5]
        left, right = min(x for x, _ in covered), max(x for x, _ in covered) + 1
        bottom, top = min(y for _, y in covered), max(y for _, y in covered) + 1
        self.assertAlmostEqual((left + right) / 2, 32 + 1.0 / pixel, delta=1.0)
        self.assertAlmostEqual((bottom + top) / 2, 18 + 0.5 / pixel, delta=1.0)
        self.assertAlmostEqual(right - left, 1.0 / pixel, delta=1.1)
        red, green, blue, _ = rows[(bottom + top) // 2][(left + right) // 2]
        self.assertGreater(red, 0.5)
        self.assertGreater(red, 2 * green)

    def test_light_is_blenders(self):
        # A white plane under a sun of strength pi from above: radiance albedo
        plane = scenes.mesh(
            "Plane", [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [(0, 1, 2, 3)]
        )
        material = scenes.material("Grey", (0.5, 0.5, 0.5))
        material.use_nodes = False
        material.diffuse_color = (0.5, 0.5, 0.5, 1.0)
        material.roughness, material.specular_intensity = 1.0, 0.0
        plane.materials.append(material)
        scenes.link(bpy.data.objects.new("Plane", plane))
        scenes.sun(energy=3.14159265)
        rows = self.render()
        self.assertAlmostEqual(rows[18][32][0], 0.7354, delta=0.02)  # 0.5 display-encoded

    def test_nothing_is_written_into_the_file(self):
        scenes.cube()
        self.render()
        self.assertFalse(any("lodestone" in item.keys() for item in bpy.data.objects))
        self.assertTrue((self.folder / "lodestone" / "file" / "tileset.json").is_file())
        self.assertEqual(os.listdir(self.folder / "lodestone"), ["file"])

    def test_scene_files_are_kept_when_asked(self):
        scenes.cube()
        self.scene.lodestone.keep_scene_files = "ALWAYS"
        self.render()
        self.assertTrue((self.folder / "lodestone" / "file.scene" / "scene.pov").is_file())

    def test_every_frame_of_an_animation_is_its_own(self):
        cube = scenes.cube()
        for frame, x in ((1, -2.0), (2, 2.0)):
            cube.location.x = x
            cube.keyframe_insert("location", frame=frame)
        centers = []
        for frame in (1, 2):
            self.scene.frame_set(frame)
            rows = self.render()
            covered = [x for row in rows for x, p in enumerate(row) if p[3] > 0.5]
            centers.append(sum(covered) / len(covered))
        self.assertLess(centers[0], 28)
        self.assertGreater(centers[1], 36)

    def test_what_rests_is_written_once_in_an_animation(self):
        cube = scenes.cube()
        scenes.cube("Resting", (1, 1, 1), size=0.5)
        for frame, x in ((1, -2.0), (2, 2.0)):
            cube.location.x = x
            cube.keyframe_insert("location", frame=frame)
        kept = self.folder / "scenes"
        self.povray(  # keeps what it is given: the inodes tell what was written again
            f"""n=$(ls {kept} | wc -l); mkdir {kept}/$n; ln r/* {kept}/$n/
            exec /usr/bin/povray "$@" """
        )
        kept.mkdir()
        self.scene.frame_start, self.scene.frame_end = 1, 3
        self.scene.render.filepath = str(self.folder / "frame_")
        self.scene.lodestone.pixel_error_render = 0.0
        bpy.ops.render.render(animation=True)
        written = [
            {(path.name, path.stat().st_ino) for path in (kept / str(frame)).iterdir()}
            for frame in range(3)
        ]
        self.assertEqual(len(written[0]), 2)
        self.assertEqual(written[1:], [written[0]] * 2)
        self.assertEqual(list(self.folder.glob("lodestone/*/r")), [])  # nothing is left

    def drawn(self, **render):
        bpy.ops.render.render(**render)
        return addon_session().renders.get(self.scene.name)

    def test_before_a_still_only_what_helps_it_is_built(self):
        scenes.sun()
        for name, subdivisions in (("Light", 4), ("Heavy", 8)):
            bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions)
            bpy.context.object.name = name
        self.scene.camera.location.z = 500.0  # a ball is a few pixels
        originals = 1280 + 327680
        first = self.drawn()
        self.assertLess(first.triangles, originals)
        self.assertGreater(first.triangles, 300000)  # the heavy one would keep us waiting
        self.assertGreater(first.without_levels, 0)
        self.scene.lodestone.build_on_render = "ALL"
        whole = self.drawn()
        self.assertLess(whole.triangles, originals / 100)
        self.assertEqual(whole.without_levels, 0)

    def test_an_animation_builds_everything_first_and_nothing_is_built_when_told_so(self):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=7)
        self.scene.camera.location.z = 500.0
        self.scene.lodestone.build_on_render = "NONE"
        self.assertEqual(self.drawn().triangles, 81920)
        self.scene.lodestone.build_on_render = "HELPFUL"
        self.scene.frame_end = 1
        self.assertLess(self.drawn(animation=True).triangles, 8192)
        self.scene.lodestone.build_on_render = "NONE"
        self.assertLess(self.drawn().triangles, 8192)

    def test_without_a_camera_nothing_is_written(self):
        scenes.cube()
        bpy.data.objects.remove(self.scene.camera)
        self.refused("(?i)camera")

    def test_without_objects_nothing_is_written(self):
        self.refused("Nothing to render")

    def test_an_animation_stopped_at_a_frame_that_shows_no_object(self):
        cube = scenes.cube()
        for frame, hidden in ((1, True), (2, False)):
            cube.hide_render = hidden
            cube.keyframe_insert("hide_render", frame=frame)
        self.scene.frame_end = 2
        self.scene.render.filepath = str(self.folder / "frame_")
        bpy.ops.render.render(animation=True)
        alphas = []
        for number in (1, 2):
            image = bpy.data.images.load(str(self.folder / f"frame_{number:04}.png"))
            alphas.append(max(list(image.pixels)[3::4]))
            bpy.data.images.remove(image)
        self.assertEqual(alphas, [0.0, 1.0])

    def test_a_view_layer_that_shows_no_object_kept_the_others_from_their_picture(self):
        held = scenes.collection("Held", self.scene.collection)
        scenes.cube(collection=held)
        second = self.scene.view_layers.new("Second")
        second.layer_collection.children["Held"].exclude = True
        self.assertEqual(max(pixel[3] for row in self.render() for pixel in row), 1.0)
        codes = [problem.code for problem in addon_session().checks.get(self.scene.name).problems]
        self.assertIn("nothing_shown", codes)

    def test_grease_pencil_in_a_layer_with_depth_crashed_blender(self):
        scenes.cube()
        self.pencil()
        without = self.render()
        bpy.context.view_layer.use_pass_z = True
        found = self.render()
        self.assertEqual(found, without)  # Blender has drawn it over the picture
        bpy.context.object.hide_render = True
        self.assertNotEqual(found, self.render())
        severities = {
            problem.severity for problem in addon_session().checks.get(self.scene.name).problems
        }
        self.assertNotIn("error", severities)

    def test_grease_pencil_ended_blender_where_libegl_is_missing(self):
        scenes.cube()
        ink = self.pencil()
        drawn = self.render()
        with mock.patch.object(egl_library, "LIBRARY", "libEGL_of_no_machine.so"):
            without = self.render()
        problems = self.problems("egl_missing")
        self.assertEqual([(item.object, item.severity) for item in problems], [("Ink", "error")])
        self.assertIn("install libegl1", problems[0].message)
        self.assertFalse(ink.hide_render)
        self.assertEqual(self.render(), drawn)
        self.assertEqual(self.problems("egl_missing"), [])
        ink.hide_render = True
        self.assertEqual(self.render(), without)
        self.assertNotEqual(drawn, without)

    def test_where_libegl_is_missing_grease_pencil_is_left_out_however_it_is_shown(self):
        scenes.cube()
        first = self.pencil()
        first.hide_render = True
        without = self.render()
        first.keyframe_insert("hide_render", frame=self.scene.frame_current - 1)
        first.hide_render = False
        first.keyframe_insert("hide_render", frame=self.scene.frame_current)
        second = self.pencil("Member")
        driver = second.driver_add("hide_render").driver
        driver.expression = "0"
        held = scenes.collection("Held")
        held.objects.link(second)
        self.scene.collection.objects.unlink(second)
        scenes.instance("Host", held)
        self.scene.view_layers.new("Second")
        self.scene.render.filepath = str(self.folder / "frame_")
        self.scene.frame_start, self.scene.frame_end = self.scene.frame_current - 1, 2
        with mock.patch.object(egl_library, "LIBRARY", "libEGL_of_no_machine.so"):
            bpy.ops.render.render(animation=True)
        for number in range(3):
            self.out = self.folder / f"frame_{number:04}.png"
            self.assertEqual(self.pixels(), without)
        named = [problem.object for problem in self.problems("egl_missing")]
        self.assertEqual(named, ["Ink", "Member"])
        curves = [*first.animation_data.action.fcurves, *second.animation_data.drivers]
        self.assertEqual([curve.mute for curve in curves], [False, False])
        self.assertEqual((first.hide_render, second.hide_render), (False, False))

    def test_settings_of_a_newer_version_are_their_defaults_here(self):
        scenes.cube()
        words = ("off_screen", "deforming", "build_on_render", "structure", "antialias")
        self.scene["lodestone"] = {word: 99 for word in words}
        self.render()

    def test_a_killed_povray_is_a_sentence(self):
        scenes.cube()
        self.povray("kill -KILL $$\n")
        self.refused("(?i)kill|signal")

    def test_a_povray_that_writes_no_picture_is_a_sentence(self):
        scenes.cube()
        self.povray("exit 0\n")
        self.refused(".")

    def test_an_unwritable_store_is_a_sentence(self):
        scenes.cube()
        (self.folder / "lodestone").mkdir()
        (self.folder / "lodestone" / "file").write_text("in the way")
        self.with_environment(LODESTONE_CACHE=str(self.folder / "file.blend"))
        self.refused(".")


if __name__ == "__main__":
    unittest.main()
