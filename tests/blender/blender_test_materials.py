# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards looks: what of a material is exact, and that the rest is named, never silently grey."""

import unittest

import bpy

import blender_scenes as scenes


class _Recorder:
    """Stands where a model is filled: keeps what it is given."""

    def __init__(self):
        self.materials = []

    def add_material(self, *values):
        self.materials.append(values)
        return len(self.materials) - 1


class Materials(unittest.TestCase):
    def setUp(self):
        scenes.fresh()
        self.material = scenes.material("Bark", (0.2, 0.4, 0.6))
        self.tree = self.material.node_tree
        self.principled = self.tree.nodes["Principled BSDF"]

    def translate(self, material=None):
        from lodestone.bridge.materials import Materials
        from lodestone.core.problems import Problems

        problems = Problems()
        surface = Materials(_Recorder(), problems).translate(material or self.material)
        for problem in problems:
            self.assertIn(problem.object, problem.message)
            self.assertEqual(problem.severity, "warning")
        return surface, {problem.code for problem in problems}

    def node(self, kind, *links):
        """A new node; links are (its output, input socket it feeds)."""
        made = self.tree.nodes.new(kind)
        for output, target in links:
            self.tree.links.new(made.outputs[output], target)
        return made

    def close(self, actual, expected, places=5):
        for a, e in zip(actual, expected, strict=True):
            self.assertAlmostEqual(a, e, places=places)

    def test_an_empty_slot_is_blenders_default(self):
        from lodestone.bridge.materials import Materials
        from lodestone.core.problems import Problems

        model, problems = _Recorder(), Problems()
        materials = Materials(model, problems)
        self.assertEqual([materials.index(None), materials.index(None)], [0, 0])
        self.close(model.materials[0][1], (0.8, 0.8, 0.8))
        self.assertEqual(len(problems), 0)

    def test_a_plain_principled_is_exact(self):
        inputs = self.principled.inputs
        inputs["Roughness"].default_value = 0.3
        inputs["Metallic"].default_value = 0.7
        inputs["Specular"].default_value = 0.2
        inputs["Emission"].default_value = (1.0, 0.5, 0.0, 1.0)
        inputs["Emission Strength"].default_value = 4.0
        surface, codes = self.translate()
        self.assertEqual(codes, set())
        self.close(surface.base_color, (0.2, 0.4, 0.6))
        self.close((surface.roughness, surface.metallic, surface.specular), (0.3, 0.7, 0.2))
        self.close(surface.emission, (4.0, 2.0, 0.0))

    def test_without_nodes_the_viewport_color_is_exact(self):
        self.material.use_nodes = False
        self.material.diffuse_color = (0.1, 0.2, 0.3, 1.0)
        surface, codes = self.translate()
        self.close(surface.base_color, (0.1, 0.2, 0.3))
        self.assertEqual(codes, set())

    def test_a_texture_is_its_mean_weighted_by_alpha(self):
        image = bpy.data.images.new("Half", 4, 2, alpha=True, float_buffer=True)
        image.colorspace_settings.name = "Linear"
        image.pixels = (
            [1.0, 0.0, 0.0, 1.0] * 4 + [0.0, 0.0, 1.0, 0.5] * 2 + [9.0, 9.0, 9.0, 0.0] * 2
        )
        node = self.node("ShaderNodeTexImage", ("Color", self.principled.inputs["Base Color"]))
        node.image = image
        surface, codes = self.translate()
        self.close(surface.base_color, (0.8, 0.0, 0.2))
        self.assertEqual(codes, {"texture_mean"})

    def test_an_encoded_texture_is_averaged_in_linear_light(self):
        image = bpy.data.images.new("Checker", 2, 1)
        image.pixels = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0]
        node = self.node("ShaderNodeTexImage", ("Color", self.principled.inputs["Base Color"]))
        node.image = image
        surface, _ = self.translate()
        self.close(surface.base_color, (0.5, 0.5, 0.5))

    def test_a_large_texture_is_sampled(self):
        image = bpy.data.images.new("Large", 1024, 1024, float_buffer=True)
        image.colorspace_settings.name = "Linear"
        image.pixels.foreach_set([0.25, 0.5, 1.0, 1.0, 0.75, 0.5, 0.0, 1.0] * (512 * 1024))
        node = self.node("ShaderNodeTexImage", ("Color", self.principled.inputs["Base Color"]))
        node.image = image
        surface, _ = self.translate()
        self.close(surface.base_color, (0.5, 0.5, 0.5), places=1)

    def test_a_missing_texture_is_named(self):
        self.node("ShaderNodeTexImage", ("Color", self.principled.inputs["Base Color"]))
        surface, codes = self.translate()
        self.assertIn("image_missing", codes)
        self.close(surface.base_color, (0.2, 0.4, 0.6))

    def test_procedural_colors_are_means_and_named(self):
        ramp = self.node("ShaderNodeValToRGB", ("Color", self.principled.inputs["Base Color"]))
        self.node("ShaderNodeTexNoise", ("Fac", ramp.inputs["Fac"]))
        surface, codes = self.translate()
        self.close(surface.base_color, (0.5, 0.5, 0.5))
        self.assertEqual(codes, {"node_color"})

    def test_a_mix_of_constants_is_exact(self):
        mix = self.node("ShaderNodeMixRGB", ("Color", self.principled.inputs["Base Color"]))
        mix.inputs["Fac"].default_value = 0.25
        mix.inputs["Color1"].default_value = (1, 0, 0, 1)
        mix.inputs["Color2"].default_value = (0, 0, 1, 1)
        surface, codes = self.translate()
        self.close(surface.base_color, (0.75, 0.0, 0.25))
        self.assertEqual(codes, set())

    def test_inside_a_group_the_outside_values_count(self):
        group = bpy.data.node_groups.new("Paint", "ShaderNodeTree")
        group.inputs.new("NodeSocketColor", "Tint")
        group.outputs.new("NodeSocketShader", "Shader")
        first, last = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        inner = group.nodes.new("ShaderNodeBsdfPrincipled")
        group.links.new(first.outputs[0], inner.inputs["Base Color"])
        group.links.new(inner.outputs[0], last.inputs[0])
        output = self.tree.nodes["Material Output"]
        node = self.node("ShaderNodeGroup")
        node.node_tree = group
        self.tree.links.new(node.outputs[0], output.inputs["Surface"])
        node.inputs["Tint"].default_value = (0.9, 0.8, 0.7, 1.0)
        surface, codes = self.translate()
        self.close(surface.base_color, (0.9, 0.8, 0.7))
        self.assertEqual(codes, set())

    def test_a_leaf_mixed_with_transparency_keeps_its_color_and_is_named(self):
        output = self.tree.nodes["Material Output"]
        mix = self.node("ShaderNodeMixShader", (0, output.inputs["Surface"]))
        clear = self.node("ShaderNodeBsdfTransparent", (0, mix.inputs[1]))
        self.assertIsNotNone(clear)
        self.tree.links.new(self.principled.outputs[0], mix.inputs[2])
        surface, codes = self.translate()
        self.close(surface.base_color, (0.2, 0.4, 0.6))
        self.assertEqual(codes, {"transparency"})

    def test_what_is_left_out_is_named_once_each(self):
        self.principled.inputs["Alpha"].default_value = 0.5
        self.principled.inputs["Transmission"].default_value = 0.5
        self.principled.inputs["Clearcoat"].default_value = 0.5
        self.node("ShaderNodeNormalMap", ("Normal", self.principled.inputs["Normal"]))
        surface, codes = self.translate()
        self.assertEqual(codes, {"transparency", "transmission", "clearcoat", "normal_map"})

    def test_other_shaders_have_their_nearest_surface(self):
        output = self.tree.nodes["Material Output"]
        for kind, field, expected in (
            ("ShaderNodeBsdfDiffuse", "base_color", (0.1, 0.2, 0.3)),
            ("ShaderNodeBsdfGlossy", "base_color", (0.1, 0.2, 0.3)),
            ("ShaderNodeEmission", "emission", (0.1, 0.2, 0.3)),
        ):
            node = self.node(kind, (0, output.inputs["Surface"]))
            node.inputs["Color"].default_value = (0.1, 0.2, 0.3, 1.0)
            surface, _ = self.translate()
            self.close(getattr(surface, field), expected)

    def test_no_output_is_named(self):
        self.tree.nodes.clear()
        surface, codes = self.translate()
        self.assertEqual(codes, {"no_surface"})

    def test_numbers_outside_their_range_are_brought_in(self):
        strength = self.node("ShaderNodeValue", (0, self.principled.inputs["Roughness"]))
        strength.outputs[0].default_value = 1e30
        surface, _ = self.translate()
        self.assertEqual(surface.roughness, 1.0)


if __name__ == "__main__":
    unittest.main()
