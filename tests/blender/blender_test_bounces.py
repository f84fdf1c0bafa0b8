# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards indirect light: rooms are as bright as Cycles makes them with as many diffuse bounces,
what glows is not counted twice, and nothing of it is there unless asked for."""

import tempfile
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes

WIDTH, HEIGHT = 32, 24
LIMIT = 5 / 255  # mean of display values
BOUNCES = 2


class Bounces(unittest.TestCase):
    def setUp(self):
        """A box of 2 m, open to the camera, its left wall red, a block in it."""
        self.scene = scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        white = scenes.matte("White", (0.7, 0.7, 0.7))
        red = scenes.matte("Red", (0.65, 0.05, 0.05))
        for name, place, paint in (
            ("floor", (0, 0, -2), white),
            ("ceiling", (0, 0, 2), white),
            ("back", (0, 2, 0), white),
            ("left", (-2, 0, 0), red),
            ("right", (2, 0, 0), white),
        ):
            scenes.cube(name, place, 2.0).data.materials.append(paint)
        scenes.cube("block", (0.35, 0.3, -0.7), 0.6).data.materials.append(white)
        scene.camera.location, scene.camera.rotation_euler = (0, -3.4, 0), (1.5707963, 0, 0)
        scene.camera.data.lens = 40
        scene.world = None
        render = scene.render
        render.resolution_x, render.resolution_y = WIDTH, HEIGHT
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        scene.lodestone.pixel_error_render = 1.0
        scene.lodestone.antialias = "FINAL"
        cycles = scene.cycles
        cycles.device, cycles.samples = "CPU", 128
        cycles.use_denoising = cycles.use_adaptive_sampling = False
        cycles.max_bounces = cycles.diffuse_bounces = BOUNCES
        cycles.glossy_bounces = cycles.transmission_bounces = 0
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
        cycles.pixel_filter_type, render.filter_size = "BOX", 0.01

    def render(self, engine, bounces=0):
        self.scene.render.engine = engine
        self.scene.lodestone.bounces = bounces
        self.scene.render.filepath = str(self.folder / f"{engine}.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(self.scene.render.filepath)
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        return [scenes.encoded(value) for i, value in enumerate(pixels) if i % 4 < 3]

    def differs(self, ours, theirs):
        return sum(abs(a - b) for a, b in zip(ours, theirs)) / len(theirs)

    def test_a_room_is_lit_as_in_cycles(self):
        data = bpy.data.lights.new("Lamp", "AREA")
        data.energy, data.size = 25, 0.6
        scenes.link(bpy.data.objects.new("Lamp", data)).location = (0, 0, 0.98)
        theirs = self.render("CYCLES")
        self.assertGreater(self.differs(self.render("LODESTONE_POVRAY"), theirs), 4 * LIMIT)
        ours = self.render("LODESTONE_POVRAY", BOUNCES)
        self.assertLess(self.differs(ours, theirs), LIMIT)
        self.assertLess(abs(sum(ours) - sum(theirs)), 0.03 * sum(theirs))

    def test_what_glows_shines_once(self):
        glowing = bpy.data.materials.new("Glowing")
        glowing.use_nodes = True
        tree = glowing.node_tree
        shader = tree.nodes.new("ShaderNodeEmission")
        shader.inputs["Strength"].default_value = 18.0
        tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        corners = [(-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)]
        panel = scenes.mesh("Panel", [(x, y, 0.4) for x, y in corners], [(0, 1, 2, 3)])
        panel.materials.append(glowing)
        scenes.link(bpy.data.objects.new("Panel", panel))
        theirs = self.render("CYCLES")
        ours = self.render("LODESTONE_POVRAY", BOUNCES)
        self.assertLess(self.differs(ours, theirs), LIMIT)
        self.assertLess(abs(sum(ours) - sum(theirs)), 0.03 * sum(theirs))

    def test_bounces_are_none_until_they_are_set_and_can_be_set_back(self):
        settings = self.scene.lodestone
        self.assertEqual(settings.bounces, 0)
        settings.bounces = 3
        self.assertEqual(settings.bounces, 3)
        bpy.ops.lodestone.inherit_control(key="bounces")
        self.assertEqual(settings.bounces, 0)
