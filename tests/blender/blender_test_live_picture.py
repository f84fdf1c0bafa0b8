# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the picture that is seen while POV-Ray draws: its parts arrive in the render result, they
are those of the finished one, and stay when it is stopped."""

import shutil
import tempfile
import unittest
from array import array
from pathlib import Path
from unittest import mock

import bpy

import blender_scenes as scenes
import povray_state
from lodestone.bridge import render_result
from lodestone.core.native import lodestone_native as native
from lodestone.core.session.addon_session import addon_session
from lodestone.engines import render_engine


class LivePicture(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.render.film_transparent = True
        self.scene.render.filter_size = 0.01  # finished pictures are not blurred
        self.scene.render.filepath = str(self.folder / "picture.png")
        scenes.cube("Red", (1.0, 0.5, 0.0), 1.0)
        scenes.sun()
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        self.state = addon_session().part(render_engine.RenderState)
        self.addCleanup(setattr, self.state, "watched", self.state.watched)
        self.state.watched = True
        self.parts = []  # (layer, left, bottom, image) as shown
        real = render_result.show_part

        def show_part(engine, layer, part, depth):
            self.parts.append((layer, *part))
            real(engine, layer, part, depth)

        self.patch(render_result, "show_part", show_part)

    def patch(self, owner, name, value):
        patched = mock.patch.object(owner, name, value)
        patched.start()
        self.addCleanup(patched.stop)

    def povray(self, script):
        """A program that takes POV-Ray's place; it knows the picture's name without its ending as
        $stem."""
        program = self.folder / "povray"
        program.write_text("#!/bin/sh\nstem=${2#+O}\nstem=${stem%.*}\n" + script)
        program.chmod(0o755)
        patched = mock.patch.dict("os.environ", LODESTONE_POVRAY=str(program))
        patched.start()
        self.addCleanup(patched.stop)

    def slowly(self):
        """POV-Ray itself, which takes a moment for the picture and ends a second later."""
        self.scene.lodestone.antialias = "REFERENCE"
        self.scene.render.resolution_x, self.scene.render.resolution_y = 320, 180
        real = shutil.which("povray")
        if real is None:
            self.skipTest("no POV-Ray")
        self.povray(
            f'echo "$*" >>{self.folder}/arguments\n{real} "$@"\ncode=$?\nsleep 1\nexit $code\n'
        )

    def drawing(self, then):
        """A POV-Ray that has drawn a green rectangle, and does something then."""
        (self.folder / "state").write_bytes(povray_state.rectangle(0, 0, 31, 31, (0.0, 0.5, 0.0)))
        self.povray(
            f"cp {self.folder}/state $stem.pov-state\necho Rendered 1024 of 2304 pixels\n{then}"
        )

    def arguments(self):
        return (self.folder / "arguments").read_text().split()

    def pixels(self):
        """The render result's: rows from the lowest one, each of RGBA."""
        path = str(self.folder / "result.exr")
        settings = self.scene.render.image_settings
        settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
        bpy.data.images["Render Result"].save_render(path, scene=self.scene)
        image = native.image_read(path, bottom_up=True)
        row = 4 * image.width
        return [image.pixels[row * y : row * (y + 1)] for y in range(image.height)]

    def put_together(self, layer, width, height):
        """What was shown of a layer before its finished picture, which is returned too."""
        together = array("f", bytes(16 * width * height))
        shown = [part[1:] for part in self.parts if part[0] == layer]
        *parts, (left, bottom, finished) = shown
        self.assertEqual((left, bottom, finished.width, finished.height), (0, 0, width, height))
        for left, bottom, image in parts:
            for y in range(image.height):
                start = 4 * (width * (bottom + y) + left)
                row = image.pixels[4 * image.width * y : 4 * image.width * (y + 1)]
                together[start : start + len(row)] = row
        return together, finished.pixels

    def is_the_finished_one(self, layer, width, height):
        live, finished = self.put_together(layer, width, height)
        self.assertGreater(max(finished), 0.1)
        # An EXR's numbers have 11 bits
        wrong = [(a, b) for a, b in zip(live, finished) if abs(a - b) > max(1e-4, abs(b)) / 2000.0]
        self.assertEqual(wrong, [])

    def test_what_is_seen_meanwhile_is_the_finished_picture(self):
        self.slowly()
        lines = []
        real = render_engine._Run._show
        self.patch(
            render_engine._Run, "_show", lambda run, line: (lines.append(line), real(run, line))
        )
        bpy.ops.render.render()
        self.assertGreaterEqual(len(self.parts), 2)  # before it ends, and then
        self.is_the_finished_one(self.scene.view_layers[0].name, 320, 180)
        self.assertIn("+SP32", self.arguments())
        self.assertIn("| 12 triangles", lines[-1])
        self.assertIn("Trace 100 %", lines[-1])
        finished = self.parts[-1][3]
        rows = self.pixels()
        self.assertEqual(rows[90].tobytes(), finished.pixels[4 * 320 * 90 : 4 * 320 * 91].tobytes())

    def test_parts_of_a_border_and_of_each_layer_are_in_their_place(self):
        self.slowly()
        render = self.scene.render
        render.use_border = True
        render.border_min_x, render.border_max_x = 0.25, 0.8125
        render.border_min_y, render.border_max_y = 0.2, 0.9
        first = self.scene.view_layers[0].name
        self.scene.view_layers.new("Second").use_pass_z = True
        bpy.ops.render.render()
        for layer in (first, "Second"):
            self.is_the_finished_one(layer, 180, 126)

    def test_gathering_light_draws_its_own_mosaic(self):
        self.slowly()
        self.scene.lodestone.bounces = 1
        bpy.ops.render.render()
        self.assertNotIn("+SP32", self.arguments())
        self.assertGreater(len(self.parts), 1)

    def test_without_a_window_nobody_pays(self):
        self.state.watched = False
        self.slowly()
        bpy.ops.render.render()
        self.assertEqual(len(self.parts), 1)
        self.assertNotIn("+SP32", self.arguments())

    def test_what_was_drawn_stays_when_it_is_stopped(self):
        self.drawing("exec sleep 60\n")
        self.patch(render_engine._Run, "_stopped", lambda run: bool(self.parts))
        bpy.ops.render.render()
        self.assertEqual([part[:3] for part in self.parts], [("ViewLayer", 0, 4)])
        rows = self.pixels()
        self.assertEqual(list(rows[35][:4]), [0.0, 0.5, 0.0, 1.0])
        self.assertEqual(list(rows[4][4 * 31 : 4 * 32]), [0.0, 0.5, 0.0, 1.0])
        self.assertEqual(list(rows[4][4 * 32 : 4 * 33]), [0.0] * 4)
        self.assertEqual(list(rows[3][:4]), [0.0] * 4)
        left = sorted(path.name for path in (self.folder / "lodestone").iterdir())
        self.assertEqual(left, ["file"])

    def test_a_failure_after_the_first_pixels_never_replaces_a_picture(self):
        self.drawing("sleep 1\necho Fatal error: it is late\nexit 1\n")
        out = Path(self.scene.render.filepath)
        out.write_bytes(b"last night's picture")
        with self.assertRaisesRegex(RuntimeError, "it is late"):
            bpy.ops.render.render(write_still=True)
        self.assertEqual(len(self.parts), 1)
        self.assertEqual(out.read_bytes(), b"last night's picture")

    def test_a_picture_that_cannot_be_shown_meanwhile_is_finished_all_the_same(self):
        self.slowly()
        real, tried = render_result.show_part, []

        def failing(engine, layer, part, depth):
            tried.append(part)
            if len(tried) == 1:
                raise MemoryError("no room for a part")
            real(engine, layer, part, depth)

        self.patch(render_result, "show_part", failing)
        bpy.ops.render.render()
        self.assertEqual(len(tried), 2)  # then the finished picture
        self.assertGreater(max(tried[1].image.pixels), 0.1)

    def test_what_is_drawn_is_told_in_triangles(self):
        grid = scenes.mesh(
            "Grid",
            [(x / 40 - 0.5, y / 40 - 0.5, 0) for y in range(41) for x in range(41)],
            [
                (41 * y + x, 41 * y + x + 1, 41 * y + x + 42, 41 * y + x + 41)
                for y in range(40)
                for x in range(40)
            ],
        )
        scenes.link(bpy.data.objects.new("Grid", grid))
        self.drawing("sleep 1\nexit 1\n")
        lines = []
        self.patch(render_engine._Run, "_show", lambda run, line: lines.append(line))
        with self.assertRaises(RuntimeError):
            bpy.ops.render.render()
        self.assertRegex(lines[-1], r"Trace 44 % \| [\d,]+ of 3,212 triangles$")
