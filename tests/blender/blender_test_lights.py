# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that every kind of light gives what Cycles gives it, with direct light alone."""

import math
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import bpy
from mathutils import Matrix, Vector

import blender_scenes as scenes
from lodestone.bridge.world import scene_lights
from lodestone.core.native import lodestone_native as native
from lodestone.core.problems import Problems

WIDTH, HEIGHT = 48, 32
LIMIT = 3 / 255  # of display values, Standard


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
        cycles.pixel_filter_type, scene.render.filter_size = "BOX", 0.01  # as POV-Ray

    def render(self, engine):
        """Display values, lowest row first: rows of RGB triples."""
        self.scene.render.engine = engine
        self.scene.render.filepath = str(self.folder / f"{engine}.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(self.scene.render.filepath)
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        values = [scenes.encoded(value) for value in pixels]
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

    def test_colors_and_strengths_of_a_lamps_nodes_were_left_out(self):
        shone = lamp("POINT", (0.3, -0.5, 1.6), energy=45.0, shadow_soft_size=0.5).data
        shone.use_nodes = True
        tree = shone.node_tree
        emission = tree.nodes["Emission"]
        emission.inputs["Strength"].default_value = 2.0
        warm = tree.nodes.new("ShaderNodeBlackbody")
        warm.inputs["Temperature"].default_value = 4500.0
        tree.links.new(warm.outputs[0], emission.inputs["Color"])
        self.same_as_cycles()

    def test_nodes_of_lamps_that_are_not_the_same_everywhere_are_named(self):
        found = {}
        for kind in (None, "ShaderNodeTexNoise", "ShaderNodeLightFalloff"):
            shone = lamp("POINT", (0.3, -0.5, 1.6), energy=45.0).data
            shone.use_nodes = True
            if kind is not None:
                given = shone.node_tree.nodes.new(kind).outputs[0]
                shone.node_tree.links.new(
                    given, shone.node_tree.nodes["Emission"].inputs["Strength"]
                )
            problems = Problems()
            scene_lights.add(native.Model(), shone, Matrix(), "Lamp", problems)
            found[kind] = [problem.code for problem in problems]
        named = ["light_nodes"]
        expected = {"ShaderNodeTexNoise": named, "ShaderNodeLightFalloff": named, None: []}
        self.assertEqual(found, expected)

    def test_a_lamp_whose_nodes_have_no_shader_shone_all_the_same(self):
        shone = lamp("POINT", (0.3, -0.5, 1.6), energy=90.0).data
        shone.use_nodes = True
        shone.node_tree.nodes.clear()
        self.assertEqual(
            max(max(pixel) for row in self.render("LODESTONE_POVRAY") for pixel in row), 0
        )

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
        from lodestone.core.problems import Problems

        area = lamp("AREA", (0.0, 0.0, 4.0), (0.5, 0.3, 0.0), energy=15.0)
        area.parent = scenes.link(bpy.data.objects.new("Parent", None))
        area.parent.scale = (2.0, 1.0, 0.5)
        bpy.context.view_layer.update()
        added, problems = [], Problems()
        taker = SimpleNamespace(add_light=added.append)
        scene_lights.add(taker, area.data, area.matrix_world, "Area", problems)
        self.assertEqual([problem.code for problem in problems], ["light_sheared"])
        direction = Vector(added[0].direction)
        self.assertAlmostEqual(direction.dot(Vector(added[0].edge_u)), 0.0, places=6)
        self.assertAlmostEqual(direction.dot(Vector(added[0].edge_v)), 0.0, places=6)
        self.assertLess(direction.z, 0.0)

    def glowing(self, made, strength, color=(1.0, 0.85, 0.6)):
        """The same, of a material that only emits."""
        material = bpy.data.materials.new("Glow")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        emission = tree.nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (*color, 1.0)
        emission.inputs["Strength"].default_value = strength
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(emission.outputs[0], output.inputs[0])
        made.data.materials.append(material)
        return made

    def shape(self, kind, location, turn=(0, 0, 0), scale=(1, 1, 1), **sizes):
        """Of Blender's primitives; the camera does not see it, what it lights is compared."""
        getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=location, rotation=turn, **sizes)
        made = bpy.context.object
        made.scale, made.visible_camera = scale, False
        return made

    def glows(self):
        from lodestone.core.session.addon_session import addon_session

        found = addon_session().checks.get(self.scene.name).problems
        return [problem.message for problem in found if problem.code == "glow"]

    def test_a_panel_that_glows_lights_both_of_its_sides(self):
        panel = self.shape("plane", (0.0, -0.4, 0.9), (0.3, -1.2, 0.5), (1.2, 0.6, 1.0), size=1.0)
        self.glowing(panel, 3.0)
        self.same_as_cycles()
        self.assertEqual(self.glows(), [])

    def test_a_disk_and_a_thin_box_that_glow(self):
        disk = self.shape("circle", (-1.4, -0.4, 1.0), (0.2, 0.1, 0), radius=0.4, fill_type="NGON")
        self.glowing(disk, 4.0)
        box = self.shape("cube", (1.2, -0.3, -0.4), (0, 0.2, 0.4), (0.9, 0.5, 0.05), size=1.0)
        self.glowing(box, 5.0)
        self.same_as_cycles()

    def test_bulbs_that_glow_in_an_instanced_collection(self):
        holder = scenes.collection("Lamps")
        bulb = self.shape("uv_sphere", (0.0, 0.0, 0.0), radius=0.12)
        for collection in bulb.users_collection:
            collection.objects.unlink(bulb)
        holder.objects.link(bulb)
        self.glowing(bulb, 40.0)
        for place in ((-1.5, -0.5, 1.0), (1.4, -0.6, -0.9)):
            lamp = scenes.link(bpy.data.objects.new("Lamp", None))
            lamp.instance_type, lamp.instance_collection = "COLLECTION", holder
            lamp.location = place
        self.scene.cycles.samples = 2048  # it takes many to hit so small a thing evenly
        self.same_as_cycles()

    def test_a_screen_glows_to_its_front_and_its_case_keeps_the_light_in(self):
        screen = self.shape("cube", (0.1, -0.4, 0.9), (0.5, 0.3, 0.2), (1.0, 0.7, 0.2), size=1.0)
        screen.data.materials.append(scenes.matte("Case", (0.1, 0.1, 0.1)))
        self.glowing(screen, 4.0)
        lowest = min(screen.data.polygons, key=lambda face: face.center.z)
        lowest.material_index = 1
        self.same_as_cycles()

    def test_what_glows_and_is_no_light_is_named(self):
        self.glowing(self.shape("cylinder", (0, 0, 2), radius=0.05, depth=3.0), 3.0)
        self.shape("torus", (0, 0, 3)).data.materials.append(bpy.data.materials["Glow"])
        lamp("SUN", (0, 0, 0), energy=2.0)
        self.render("LODESTONE_POVRAY")
        told = 'Material "Glow": it glows, but %s falls on nothing else; put a lamp in its place'
        self.assertEqual(self.glows(), [told % "its light"])
        self.shape("plane", (0, 0, 4)).data.materials.append(bpy.data.materials["Glow"])
        self.render("LODESTONE_POVRAY")
        self.assertEqual(self.glows(), [told % "the light of some of it"])

    def test_a_light_of_negative_power_takes_away(self):
        lamp("SUN", (0, 0, 0), energy=3.0, angle=0.0)
        lamp("POINT", (1.0, -0.5, 1.0), energy=-20.0, shadow_soft_size=0.0)
        self.same_as_cycles()


if __name__ == "__main__":
    unittest.main()
