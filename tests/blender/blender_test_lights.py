# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that every kind of light gives what Cycles gives it, with direct light alone."""

import math
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import bpy
from mathutils import Vector

import blender_scenes as scenes

WIDTH, HEIGHT = 48, 32
LIMIT = 3 / 255  # of display values, Standard


def encoded(value):
    value = min(1.0, max(0.0, value))
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def lamp(kind, location, turn=(0, 0, 0), scale=(1, 1, 1), **values):
    data = bpy.data.lights.new("Lamp", kind)
    for name, value in values.items():
        setattr(data, name, value)
    made = scenes.link(bpy.data.objects.new("Lamp", data))
    made.location, made.rotation_euler, made.scale = location, turn, scale
    return made


class Lights(unittest.TestCase):
    def setUp(self):
        """Two floors, the right one 2 m lower, and a ball above each, from straight above."""
        self.scene = scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        grey = scenes.matte("Matte", (0.8, 0.7, 0.5))
        for name, left, height in (("Near", -3.0, 0.0), ("Far", 0.0, -2.0)):
            corners = [(left, -2), (left + 3, -2), (left + 3, 2), (left, 2)]
            floor = scenes.mesh(name, [(x, y, height) for x, y in corners], [(0, 1, 2, 3)])
            floor.materials.append(grey)
            scenes.link(bpy.data.objects.new(name, floor))
            block = scenes.cube(f"{name} block", (left + 1.5, 1.2, height + 0.6), 0.4)
            block.data.materials.append(grey)
        scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 6.0
        scene.camera.location = (0.0, 0.0, 20.0)
        render = scene.render
        render.resolution_x, render.resolution_y = WIDTH, HEIGHT
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        scene.lodestone.pixel_error_render = 0.0
        scene.world = None
        cycles = scene.cycles
        cycles.device, cycles.samples = "CPU", 64
        cycles.use_denoising = cycles.use_adaptive_sampling = False
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 0
        cycles.sample_clamp_direct = 0.0
        cycles.pixel_filter_type = "BOX"  # as POV-Ray

    def render(self, engine):
        """Display values, lowest row first: rows of RGB triples."""
        self.scene.render.engine = engine
        self.scene.render.filepath = str(self.folder / f"{engine}.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(self.scene.render.filepath)
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        values = [encoded(value) for value in pixels]
        return [
            [values[4 * (y * WIDTH + x) : 4 * (y * WIDTH + x) + 3] for x in range(WIDTH)]
            for y in range(HEIGHT)
        ]

    def same_as_cycles(self, brightest=0.98):
        """Over the whole picture, and on spots of both floors that no edge is near."""
        ours, theirs = self.render("LODESTONE_POVRAY"), self.render("CYCLES")
        peak = max(max(pixel) for row in theirs for pixel in row)
        self.assertGreater(peak, 0.2, "the test's own light is too dim to tell anything")
        self.assertLess(peak, brightest, "the test's own light is too bright to tell anything")
        differences = [
            abs(a - b)
            for our_row, their_row in zip(ours, theirs)
            for our, their in zip(our_row, their_row)
            for a, b in zip(our, their)
        ]
        self.assertLess(sum(differences) / len(differences), LIMIT)
        for x in (4, 12, 20, 34, 39, 44):
            for y in (3, 7, 11):
                for channel in range(3):
                    our, their = (
                        sum(rows[y + dy][x + dx][channel] for dx in (-1, 0, 1) for dy in (-1, 0, 1))
                        / 9
                        for rows in (ours, theirs)
                    )
                    self.assertLess(abs(our - their), LIMIT, (x, y, channel, our, their))

    def test_a_sun(self):
        lamp("SUN", (0, 0, 0), (0.5, 0.4, 0), energy=2.5, angle=math.radians(0.5))
        self.same_as_cycles()

    def test_a_sun_as_wide_as_a_lamp(self):
        lamp("SUN", (0, 0, 0), (0.9, 0.2, 0), energy=4.0, angle=math.radians(50))
        self.same_as_cycles()

    def test_a_soft_point(self):
        lamp("POINT", (0.3, -0.5, 1.6), energy=90.0, shadow_soft_size=0.5, color=(1, 0.8, 0.6))
        self.same_as_cycles()

    def test_a_soft_spot(self):
        lamp(
            "SPOT",
            (0.2, -0.6, 2.5),
            (0.1, 0.15, 0),
            (3.0, 1.0, 2.0),  # Cycles ignores it
            energy=160.0,
            shadow_soft_size=0.15,
            spot_size=math.radians(75),
            spot_blend=0.6,
        )
        self.same_as_cycles()

    def test_a_square_area(self):
        lamp("AREA", (0.2, -0.6, 1.2), (0.2, -0.3, 0.4), energy=15.0, size=0.8)
        self.same_as_cycles()

    def test_a_scaled_ellipse(self):
        lamp(
            "AREA",
            (0.4, -0.4, 1.0),
            (-0.3, 0.2, 0.7),
            (2.0, 1.0, 1.0),
            energy=25.0,
            shape="ELLIPSE",
            size=0.8,
            size_y=0.5,
        )
        self.same_as_cycles()

    def test_a_mirrored_area_under_a_mirrored_parent(self):
        area = lamp("AREA", (0.2, -0.6, 1.2), (0.2, -0.3, 0.4), (-1, 1, 1), energy=15.0, size=0.8)
        area.parent = scenes.link(bpy.data.objects.new("Parent", None))
        area.parent.scale = (-1.0, 1.0, 1.0)
        self.same_as_cycles()

    def test_an_area_that_its_parent_shears_is_named_and_shines_square_to_its_edges(self):
        from lodestone.bridge import lights
        from lodestone.core.problems import Problems

        area = lamp("AREA", (0.0, 0.0, 4.0), (0.5, 0.3, 0.0), energy=15.0)
        area.parent = scenes.link(bpy.data.objects.new("Parent", None))
        area.parent.scale = (2.0, 1.0, 0.5)
        bpy.context.view_layer.update()
        added, problems = [], Problems()
        taker = SimpleNamespace(add_light=added.append)
        lights.add(taker, area.data, area.matrix_world, "Area", problems)
        self.assertEqual([problem.code for problem in problems], ["light_sheared"])
        direction = Vector(added[0].direction)
        self.assertAlmostEqual(direction.dot(Vector(added[0].edge_u)), 0.0, places=6)
        self.assertAlmostEqual(direction.dot(Vector(added[0].edge_v)), 0.0, places=6)
        self.assertLess(direction.z, 0.0)

    def test_a_light_of_negative_power_takes_away(self):
        lamp("SUN", (0, 0, 0), energy=3.0, angle=0.0)
        lamp("POINT", (1.0, -0.5, 1.0), energy=-20.0, shadow_soft_size=0.0)
        self.same_as_cycles()


if __name__ == "__main__":
    unittest.main()
