# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards worlds: what is seen of them and how they light, against Cycles; what is named."""

import math
import tempfile
import unittest
import unittest.mock
from array import array
from pathlib import Path
from types import SimpleNamespace

import bpy

import blender_scenes as scenes

WIDTH, HEIGHT = 48, 32
LIMIT = 3 / 255  # of display values, Standard


class World(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.world = bpy.data.worlds.new("World")
        self.world.use_nodes = True
        self.tree = self.world.node_tree
        self.background = self.tree.nodes["Background"]
        self.scene.world = self.world
        scenes.cube()

    def extracted(self):
        """(world, codes of its problems)"""
        from lodestone.bridge.world import world_background
        from lodestone.core.native import lodestone_native as native
        from lodestone.core.problems import Problems

        problems = Problems()
        with native.Model() as model:
            found = world_background.extract(model, self.scene.world, problems)
            model.set_world(found.color, False, found.environment, found.turn, found.strength)
        return found, [problem.code for problem in problems]

    def environment(self, image=None, mapping=None):
        node = self.tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = image
        self.tree.links.new(node.outputs[0], self.background.inputs["Color"])
        if mapping is not None:
            place = self.tree.nodes.new("ShaderNodeTexCoord")
            turn = self.tree.nodes.new("ShaderNodeMapping")
            turn.inputs["Rotation"].default_value = mapping
            self.tree.links.new(place.outputs["Generated"], turn.inputs["Vector"])
            self.tree.links.new(turn.outputs["Vector"], node.inputs["Vector"])
        return node

    def sky(self):
        """A bright patch over a gradient, brighter than an 8-bit picture can be."""
        image = bpy.data.images.new("Sky", 64, 32, float_buffer=True)
        image.colorspace_settings.name = "Linear"
        pixels = array("f")
        for y in range(32):
            for x in range(64):
                patch = 6.0 if abs(x - 20) < 3 and abs(y - 22) < 3 else 0.0
                high = y / 32
                pixels.extend((0.1 + patch, 0.1 + 0.3 * high + patch, 0.5 * high + patch, 1.0))
        image.pixels.foreach_set(pixels)
        return image

    def test_one_color_is_exact_and_none_is_black(self):
        self.background.inputs["Color"].default_value = (0.45, 0.6, 0.85, 1.0)
        self.background.inputs["Strength"].default_value = 0.5
        found, codes = self.extracted()
        for value, expected in zip(found.color, (0.225, 0.3, 0.425)):
            self.assertAlmostEqual(value, expected, places=6)
        self.assertEqual((found.environment, codes), (None, []))
        self.scene.world = None
        self.assertEqual(self.extracted()[0].color, (0.0, 0.0, 0.0))

    def test_an_image_all_around_is_a_picture_turned_as_mapped(self):
        self.environment(self.sky(), (0.0, 0.0, math.radians(90)))
        self.background.inputs["Strength"].default_value = 2.0
        found, codes = self.extracted()
        self.assertEqual((found.environment, codes), (0, []))
        self.assertEqual(found.strength, (2.0, 2.0, 2.0))
        for value, expected in zip(found.turn, (0, -1, 0, 1, 0, 0, 0, 0, 1)):
            self.assertAlmostEqual(value, expected, places=6)

    def test_a_missing_image_is_named(self):
        node = self.environment()
        self.assertIn("world_image_missing", self.extracted()[1])
        node.image = bpy.data.images.new("Gone", 4, 4)
        node.image.source = "FILE"
        node.image.filepath = "/nowhere/sky.png"
        self.assertIn("world_image_missing", self.extracted()[1])

    def shaded(self, kind, *inputs):
        """A node of this kind in front of the output, fed by those."""
        node = self.tree.nodes.new(kind)
        for socket, source in zip((i for i in node.inputs if i.type == "SHADER"), inputs):
            self.tree.links.new(source.outputs[0], socket)
        self.tree.links.new(node.outputs[0], self.tree.nodes["World Output"].inputs["Surface"])
        return node

    def close(self, values, expected, share=1e-5):
        for value, other in zip(values, expected, strict=True):
            self.assertAlmostEqual(value, other, delta=share * max(1.0, abs(other)))

    def test_of_two_outputs_that_of_cycles_counts(self):
        self.tree.nodes["World Output"].target = "EEVEE"
        other = self.tree.nodes.new("ShaderNodeBackground")
        other.inputs["Color"].default_value = (0.1, 0.2, 0.6, 1.0)
        output = self.tree.nodes.new("ShaderNodeOutputWorld")
        output.target = "CYCLES"
        self.tree.links.new(other.outputs[0], output.inputs["Surface"])
        self.close(self.extracted()[0].color, (0.1, 0.2, 0.6))

    def test_an_emission_shader_is_a_background_too(self):
        node = self.shaded("ShaderNodeEmission")
        node.inputs["Color"].default_value = (0.2, 0.5, 0.3, 1.0)
        node.inputs["Strength"].default_value = 0.5
        found, codes = self.extracted()
        self.close(found.color, (0.1, 0.25, 0.15))
        self.assertEqual(codes, [])

    def test_mixed_and_added_backgrounds_are_exact(self):
        other = self.tree.nodes.new("ShaderNodeBackground")
        self.background.inputs["Color"].default_value = (1.0, 0.0, 0.0, 1.0)
        other.inputs["Color"].default_value = (0.0, 0.0, 0.5, 1.0)
        mix = self.shaded("ShaderNodeMixShader", self.background, other)
        mix.inputs["Fac"].default_value = 0.25
        found, codes = self.extracted()
        self.close(found.color, (0.75, 0.0, 0.125))
        self.shaded("ShaderNodeAddShader", self.background, mix)
        found, more = self.extracted()
        self.close(found.color, (1.75, 0.0, 0.125))
        self.assertEqual((codes, more), ([], []))

    def test_a_background_for_the_camera_alone_gives_no_light_and_is_named(self):
        other = self.tree.nodes.new("ShaderNodeBackground")
        self.background.inputs["Color"].default_value = (0.6, 0.2, 0.1, 1.0)
        mix = self.shaded("ShaderNodeMixShader", self.background, other)
        path = self.tree.nodes.new("ShaderNodeLightPath")
        self.tree.links.new(path.outputs["Is Camera Ray"], mix.inputs["Fac"])
        self.assertIn("world_camera_rays", self.extracted()[1])

    def sky_texture(self, kind="NISHITA", **values):
        node = self.tree.nodes.new("ShaderNodeTexSky")
        node.sky_type = kind
        for name, value in values.items():
            setattr(node, name, value)
        self.tree.links.new(node.outputs[0], self.background.inputs["Color"])
        return node

    def taken(self, store=""):
        """(World, lights, pictures, codes)"""
        from lodestone.bridge.world import world_background
        from lodestone.core.problems import Problems

        suns, pictures, problems = [], [], Problems()
        taker = SimpleNamespace(
            add_light=suns.append, add_picture=lambda *_, **given: pictures.append(given) or 0
        )
        found = world_background.extract(taker, self.world, problems, store=store)
        return found, suns, pictures, [problem.code for problem in problems]

    def test_a_sky_has_its_sun_as_a_light(self):
        sky = self.sky_texture(sun_elevation=math.radians(30), sun_rotation=0.5)
        self.background.inputs["Strength"].default_value = 0.1
        _, (sun,), _, codes = self.taken()
        self.close(sun.color, (13.999, 11.116, 7.899), 0.004)
        self.close(sun.direction, (-0.41519, -0.76001, -0.5))
        self.assertNotIn("world_sky", codes)
        sky.sun_size = math.radians(45)  # a disk that reaches lower, through more air
        _, (wide,), _, _ = self.taken()
        for larger, small in zip(wide.color, sun.color):
            self.assertTrue(0.5 * small < larger < small, (wide.color, sun.color))
        sky.sun_size = math.radians(0.545)
        sky.sun_elevation = math.radians(-3)  # it has set: no light shines up
        self.assertEqual(self.taken()[1], [])
        sky.sun_elevation, sky.sun_disc = math.radians(30), False
        self.assertEqual(self.taken()[1], [])

    def test_a_sky_is_drawn_as_blender_draws_it(self):
        from lodestone.bridge.world import drawn_sky, sky_texture

        node = self.sky_texture(sun_elevation=math.radians(30), sun_rotation=math.radians(90))
        sky = drawn_sky.drawn_sky(node, 128, 64, "")
        sums = [0.0, 0.0, 0.0]  # of level ground
        for row in range(32):
            high = math.pi * (row + 0.5) / 64
            weight = math.sin(high) * math.cos(high) * (math.pi / 64) ** 2 / math.pi
            for column in range(128):
                turn = 2.0 * math.pi * column / 128
                flat = math.cos(high)
                at = (flat * math.cos(turn), flat * math.sin(turn), math.sin(high))
                sums = [sum_ + weight * value for sum_, value in zip(sums, sky.color(*at))]
        mean = sky_texture.mean_of_sky(node)
        self.close([s / m for s, m in zip(sums, mean)], (1.0, 1.0, 1.0), 0.04)
        self.assertEqual(sky.color(0.0, 0.0, -1.0), (0.0, 0.0, 0.0))  # below the horizon
        beside = [sum(sky.color(x, y, 0.5)) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        self.assertEqual(max(beside), beside[0])  # toward the sun

    def test_skies_of_all_kinds_are_brightest_around_their_sun(self):
        from lodestone.bridge.world import drawn_sky

        for kind in ("PREETHAM", "HOSEK_WILKIE"):
            node = self.sky_texture(kind, sun_direction=(0.0, 0.8, 0.6))
            sky = drawn_sky.drawn_sky(node, 128, 64, "")
            beside = [sum(sky.color(x, y, 0.75)) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
            self.assertEqual(max(beside), beside[1], kind)

    def test_a_drawn_sky_is_kept_beside_the_levels(self):
        from lodestone.bridge.world import drawn_sky
        from lodestone.core.session.addon_session import end_session

        self.sky_texture(sun_elevation=0.3)
        with tempfile.TemporaryDirectory() as store:
            _, _, (first,), _ = self.taken(store)
            (kept,) = Path(store, drawn_sky.FOLDER).glob("*.exr")
            end_session()
            with unittest.mock.patch.object(drawn_sky, "_draw", side_effect=AssertionError):
                self.assertEqual(self.taken(store)[2], [first])
            for damaged in (b"", kept.read_bytes()[:1000]):
                end_session()
                kept.write_bytes(damaged)
                self.assertEqual(self.taken(store)[2], [first])
            self.sky_texture(sun_elevation=0.4)
            self.taken()  # before there is a folder
            with unittest.mock.patch.object(drawn_sky, "_draw", side_effect=AssertionError):
                self.taken(store)
            self.assertEqual(len(list(Path(store, drawn_sky.FOLDER).glob("*.exr"))), 2)
            for damaged in ("[1e999, 0, 0]", f"[{10**400}, 0, 0]", "[1, 2]", "{}"):
                end_session()
                for file in Path(store, drawn_sky.FOLDER).glob("*.json"):
                    file.write_text(damaged, "utf-8")
                self.assertEqual(len(self.taken(store)[1]), 1)

    def test_where_blender_cannot_draw_a_sky_it_is_one_color_and_named(self):
        from lodestone.bridge.world import drawn_sky
        from lodestone.core.session.addon_session import end_session

        self.sky_texture(sun_elevation=math.radians(45), air_density=1.5)
        for program in ("/nowhere/blender", "/bin/true", "/bin/false"):
            end_session()
            fake = SimpleNamespace(
                app=SimpleNamespace(binary_path=program, version_string=program), types=bpy.types
            )
            with unittest.mock.patch.object(drawn_sky, "bpy", fake):
                _, (sun,), pictures, codes = self.taken()
            self.assertIn("world_sky", codes, program)
            self.close(sun.color, (146.51, 119.84, 92.14), 1e-4)
            with unittest.mock.patch.object(drawn_sky, "bpy", fake):
                with unittest.mock.patch.object(drawn_sky, "_draw", side_effect=AssertionError):
                    self.taken()  # it is not tried again

    def test_unknown_nodes_are_one_named_color(self):
        noise = self.tree.nodes.new("ShaderNodeTexNoise")
        self.tree.links.new(noise.outputs["Color"], self.background.inputs["Color"])
        found, codes = self.extracted()
        self.assertIsNone(found.environment)
        self.assertIn("world_nodes", codes)

    def test_nodes_in_a_circle_of_groups_and_nonsense_end(self):
        power = self.tree.nodes.new("ShaderNodeMath")
        power.operation = "POWER"
        power.inputs[0].default_value, power.inputs[1].default_value = 1e30, 1e9
        self.tree.links.new(power.outputs[0], self.background.inputs["Color"])
        found, _ = self.extracted()
        self.assertTrue(all(math.isfinite(value) for value in found.color))

    # ---- Against Cycles ----

    def compare(self):
        """A matte ball in front of the world, in both engines."""
        bpy.data.objects.remove(bpy.data.objects["Cube"])
        bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=1.5)
        ball = bpy.context.object
        for polygon in ball.data.polygons:
            polygon.use_smooth = True
        ball.data.materials.append(scenes.matte("Matte", (0.8, 0.7, 0.5)))
        scene = self.scene
        scene.camera.location = (0.0, -6.0, 0.0)
        scene.camera.rotation_euler = (math.radians(90), 0.0, 0.0)
        scene.lodestone.pixel_error_render = 0.0
        render = scene.render
        render.resolution_x, render.resolution_y = WIDTH, HEIGHT
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        cycles = scene.cycles
        cycles.device, cycles.samples, cycles.pixel_filter_type = "CPU", 128, "BOX"
        render.filter_size = 0.01  # as "BOX"
        cycles.use_denoising = cycles.use_adaptive_sampling = False
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 0
        cycles.sample_clamp_direct = 0.0
        with tempfile.TemporaryDirectory() as folder:
            bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder) / "file.blend"))
            ours, theirs = (
                self.render(engine, folder) for engine in ("LODESTONE_POVRAY", "CYCLES")
            )
        differences = [abs(a - b) for a, b in zip(ours, theirs)]
        self.assertLess(sum(differences) / len(differences), LIMIT)
        worst = 0.0
        for x, y in ((24, 16), (20, 20), (28, 20), (20, 11), (28, 11), (24, 22), (4, 4), (44, 28)):
            for channel in range(3):
                mean = [
                    sum(
                        picture[3 * ((y + dy) * WIDTH + x + dx) + channel]
                        for dx in (-1, 0, 1)
                        for dy in (-1, 0, 1)
                    )
                    / 9
                    for picture in (ours, theirs)
                ]
                worst = max(worst, abs(mean[0] - mean[1]))
                with self.subTest((x, y, channel)):
                    self.assertLess(abs(mean[0] - mean[1]), LIMIT, mean)
        print(f"worst: {255 * worst:.2f} / 255")

    def render(self, engine, folder):
        self.scene.render.engine = engine
        self.scene.render.filepath = str(Path(folder) / f"{engine}.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(self.scene.render.filepath)
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        return [scenes.encoded(value) for i, value in enumerate(pixels) if i % 4 < 3]

    def test_an_image_is_seen_and_lights_as_in_cycles(self):
        self.environment(self.sky(), (0.2, 0.1, 1.0))
        self.compare()

    def test_a_gradient_of_nodes_is_seen_and_lights_as_in_cycles(self):
        place = self.tree.nodes.new("ShaderNodeTexCoord")
        split = self.tree.nodes.new("ShaderNodeSeparateXYZ")
        ramp = self.tree.nodes.new("ShaderNodeValToRGB")
        ramp.color_ramp.elements[0].color = (0.9, 0.6, 0.3, 1.0)
        ramp.color_ramp.elements[1].color = (0.1, 0.2, 0.6, 1.0)
        link = self.tree.links.new
        link(place.outputs["Generated"], split.inputs[0])
        link(split.outputs["Z"], ramp.inputs["Fac"])
        link(ramp.outputs["Color"], self.background.inputs["Color"])
        self.assertEqual(self.extracted()[1], ["world_drawn"])
        self.compare()


if __name__ == "__main__":
    unittest.main()
