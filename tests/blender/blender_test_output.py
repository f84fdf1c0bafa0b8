# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what ends up in the file: the border's pixels, Blender's colors, how it was made."""

import struct
import tempfile
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes
from lodestone.core.session.addon_session import addon_session


def png_text(path):
    """The tEXt lines of a PNG."""
    data, at, found = Path(path).read_bytes(), 8, {}
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"tEXt":
            keyword, text = data[at + 8 : at + 8 + size].split(b"\0", 1)
            found[keyword.decode("latin-1")] = text.decode("latin-1")
        at += 12 + size
    return found


class Output(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.lodestone.pixel_error_render = 0.0
        self.scene.render.dither_intensity = 0.0
        cube = scenes.cube(size=3.0)
        cube.data.materials.append(scenes.material("Paint", (0.3, 0.6, 0.1)))
        cube.rotation_euler = (0.3, 0.4, 0.5)
        scenes.sun()

    def render(self, name="picture.png"):
        self.scene.render.filepath = str(self.folder / name)
        bpy.ops.render.render(write_still=True)
        return self.read(self.scene.render.filepath)

    def read(self, path):
        image = bpy.data.images.load(str(path))
        (width, height), pixels = image.size, list(image.pixels)
        bpy.data.images.remove(image)
        return width, height, pixels

    def test_a_border_has_the_pixels_of_the_whole_picture_and_is_traced_alone(self):
        width, height, whole = self.render()
        render = self.scene.render
        render.use_border = True
        render.border_min_x, render.border_max_x = 0.25, 0.75
        render.border_min_y, render.border_max_y = 0.25, 0.5
        self.scene.lodestone.keep_scene_files = "ALWAYS"
        part_width, part_height, part = self.render()
        (ini,) = self.folder.rglob("scene.ini")
        rows = {"Start_Column=16", "End_Column=49", "Start_Row=18", "End_Row=28"}
        # The rest is not traced, but for a pixel around it, which the filter looks at.
        self.assertLessEqual(rows, set(ini.read_text().splitlines()))
        self.assertEqual((part_width, part_height), (width, height))
        render.use_crop_to_border = True
        crop_width, crop_height, crop = self.render()
        self.assertEqual((crop_width, crop_height), (32, 9))
        for y in range(height):
            for x in range(width):
                at = 4 * (y * width + x)
                inside = 16 <= x < 48 and 9 <= y < 18
                expected = whole[at : at + 3] if inside else [0.0, 0.0, 0.0]
                self.assertEqual(part[at : at + 3], expected, (x, y))
                if inside:
                    there = 4 * ((y - 9) * crop_width + x - 16)
                    self.assertEqual(crop[there : there + 3], expected, (x, y))

    def test_pictures_are_as_soft_as_the_filter_size_says(self):
        contrasts, means = [], []
        for size in (0.01, 1.5, 4.0):
            self.scene.render.filter_size = size
            width, height, pixels = self.render()
            values = [pixels[4 * i] for i in range(width * height)]
            steps = (abs(a - b) for a, b in zip(values, values[1:]))
            contrasts.append(max(steps))
            means.append(sum(values) / len(values))
        self.assertGreater(contrasts[0], 1.05 * contrasts[1])
        self.assertGreater(contrasts[1], 1.5 * contrasts[2])
        for mean in means[1:]:
            self.assertAlmostEqual(mean, means[0], delta=0.02)

    def test_resolution_percentage_scales_the_picture(self):
        self.scene.render.resolution_percentage = 50
        width, height, _ = self.render()
        self.assertEqual((width, height), (32, 18))

    def test_29_percent_of_100_pixels_are_29_and_no_row_stays_empty(self):
        render = self.scene.render
        render.film_transparent = False
        render.image_settings.color_mode = "RGBA"
        render.resolution_x, render.resolution_y, render.resolution_percentage = 100, 100, 29
        width, height, pixels = self.render()
        self.assertEqual((width, height), (29, 29))
        self.assertEqual(min(pixels[3::4]), 1.0)

    def test_a_border_ends_where_blender_rounds_it_to(self):
        """.7 of 100 are 70, though the number in the file is a little less than .7."""
        from lodestone.bridge import render_result

        render = self.scene.render
        render.image_settings.color_mode = "RGBA"
        render.resolution_x, render.resolution_y = 100, 40
        render.use_border = render.use_crop_to_border = True
        render.border_min_x, render.border_max_x = 0.1, 0.7
        render.border_min_y, render.border_max_y = 0.35, 0.95
        self.assertEqual(render_result.border(render, 100, 40), (10, 14, 60, 24))
        width, height, pixels = self.render()
        self.assertEqual((width, height), (60, 24))
        self.assertEqual(min(pixels[3::4]), 1.0)

    def test_colors_are_blenders_in_every_view_transform(self):
        settings, view = self.scene.render.image_settings, self.scene.view_settings
        settings.file_format, settings.color_depth = "OPEN_EXR", "32"
        _, _, linear = self.render("linear.exr")
        self.assertGreater(max(linear[:3] + linear[1::4]), 0.1)
        settings.file_format, settings.color_depth = "PNG", "8"
        for transform, look, exposure, gamma in (
            ("Standard", "None", 0.0, 1.0),
            ("Filmic", "High Contrast", 0.5, 1.2),
        ):
            view.view_transform, view.look = transform, look
            view.exposure, view.gamma = exposure, gamma
            _, _, ours = self.render()
            image = bpy.data.images.load(str(self.folder / "linear.exr"))
            image.save_render(str(self.folder / "blenders.png"), scene=self.scene)
            bpy.data.images.remove(image)
            _, _, blenders = self.read(self.folder / "blenders.png")
            worst = max(abs(a - b) for a, b in zip(ours, blenders))
            self.assertLessEqual(worst, 1.01 / 255, transform)
            if transform == "Standard":
                green = [scenes.encoded(value) for value in linear[1::4]]
                worst = max(abs(a - b) for a, b in zip(ours[1::4], green))
                self.assertLess(worst, 1.01 / 255)

    def test_a_compositor_that_reads_another_pass_got_black_without_a_word(self):
        self.scene.use_nodes = True
        tree = self.scene.node_tree
        bpy.context.view_layer.use_pass_z = True
        layer, composite = tree.nodes["Render Layers"], tree.nodes["Composite"]
        self.render()
        codes = [problem.code for problem in addon_session().checks.get(self.scene.name).problems]
        self.assertNotIn("empty_pass", codes)
        tree.links.new(layer.outputs["Depth"], composite.inputs["Image"])
        self.render()
        found = [
            p
            for p in addon_session().checks.get(self.scene.name).problems
            if p.code == "empty_pass"
        ]
        self.assertRegex(found[0].message, '"Depth"')
        bpy.ops.lodestone.check_scene()
        codes = [problem.code for problem in addon_session().checks.get(self.scene.name).problems]
        self.assertIn("empty_pass", codes)

    def test_the_file_says_how_it_was_made(self):
        self.scene.lodestone.pixel_error_render = 2.5
        self.render()
        text = png_text(self.folder / "picture.png")
        self.assertRegex(text["Lodestone"], r"^\d+\.\d+\.\d+$")
        self.assertEqual(text["Lodestone Pixel Error"], "2.5")
        first = text["Lodestone Settings"]
        self.assertRegex(first, "^[0-9a-f]{16}$")
        self.scene.lodestone.antialias = "OFF"
        self.render()
        second = png_text(self.folder / "picture.png")["Lodestone Settings"]
        self.scene.lodestone.off_screen = "SHADOWS"
        self.render()
        third = png_text(self.folder / "picture.png")["Lodestone Settings"]
        self.assertEqual(len({first, second, third}), 3)


if __name__ == "__main__":
    unittest.main()
