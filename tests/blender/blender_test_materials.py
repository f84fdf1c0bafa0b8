# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards looks: what of a material is exact, and that the rest is named, never silently gray."""

import time
import unittest

import bpy

import blender_scenes as scenes


class MaterialCase(unittest.TestCase):
    """A principled material "Bark" of a plain color, and ways to change and to read it."""

    def setUp(self):
        scenes.fresh()
        self.material = scenes.material("Bark", (0.2, 0.4, 0.6))
        self.tree = self.material.node_tree
        self.principled = self.tree.nodes["Principled BSDF"]
        self.base = self.principled.inputs["Base Color"]
        self.output = self.tree.nodes["Material Output"]

    def translate(self, material=None, color=None, severities=("info", "warning", "error")):
        """(look, codes of its problems of these severities); fields go to self.added."""
        from lodestone.bridge.nodes.materials import Materials
        from lodestone.core.native import lodestone_native as native
        from lodestone.core.problems import Problems

        added = self.added = []

        class Recorder(native.Model):
            def add_material(self, name, **fields):
                added.append(fields)
                return super().add_material(name, **fields)

        problems = Problems()
        self.model = Recorder()
        self.addCleanup(self.model.close)
        materials = Materials(self.model, problems)
        look = materials.look(material or self.material, color)
        materials.index(material or self.material, color)
        for problem in problems:
            self.assertIn(problem.object, problem.message)
        self.severity = {problem.code: problem.severity for problem in problems}
        return look, {p.code for p in problems if p.severity in severities}

    def node(self, kind, *links, **values):
        """A new node; links are (its output, input socket it feeds), values those of its inputs."""
        made = self.tree.nodes.new(kind)
        for output, target in links:
            self.tree.links.new(made.outputs[output], target)
        for name, value in values.items():
            made.inputs[name.replace("_", " ")].default_value = value
        return made

    def image(self, pixels, width=2, name="Picture", data=False, float_buffer=False):
        """An image whose numbers are these (RGBA, lowest row first); data: no color."""
        height = len(pixels) // width
        made = bpy.data.images.new(name, width, height, alpha=True, float_buffer=float_buffer)
        made.colorspace_settings.name = "Non-Color" if data else "sRGB"
        made.pixels = [part for pixel in pixels for part in pixel]
        return made

    def picture(self, target, pixels=((0, 0, 0, 1), (1, 1, 1, 1)), output="Color", **how):
        """An image texture node that feeds a socket."""
        made = self.node("ShaderNodeTexImage", (output, target))
        made.image = self.image(pixels, **how)
        return made

    def close(self, actual, expected, places=5):
        for a, x in zip(actual, expected, strict=True):
            self.assertAlmostEqual(a, x, places=places, msg=f"{actual} is not {expected}")


class Materials(MaterialCase):
    # ---- Constants ----

    def test_an_empty_slot_is_blenders_default(self):
        from lodestone.bridge.nodes.materials import Materials
        from lodestone.core.problems import Problems

        problems = Problems()
        materials = Materials(None, problems)
        self.assertEqual([materials.index(None), materials.index(None)], [0, 0])
        self.close(materials.look(None).base_color.color, (0.8, 0.8, 0.8))
        self.assertEqual(len(problems), 0)

    def test_a_plain_principled_is_exact(self):
        for name, value in (
            ("Roughness", 0.08),
            ("Metallic", 0.7),
            ("Specular", 0.2),
            ("Emission", (1.0, 0.5, 0.0, 1.0)),
            ("Emission Strength", 0.9),
            ("Alpha", 0.6),
            ("Transmission", 0.9),
            ("IOR", 1.33),
            ("Clearcoat", 0.8),
            ("Clearcoat Roughness", 0.1),
        ):
            self.principled.inputs[name].default_value = value
        look, codes = self.translate()
        self.assertEqual(codes, set())
        fields = self.added[0]
        self.close(fields["base_color"], (0.2, 0.4, 0.6))
        self.close(fields["emission"], (0.9, 0.45, 0.0))
        names = ("roughness", "metallic", "specular", "alpha", "transmission", "ior")
        self.close([fields[n] for n in names], (0.08, 0.7, 0.2, 0.6, 0.9, 1.33))
        self.close([fields["clearcoat"], fields["clearcoat_roughness"]], (0.8, 0.1))
        self.assertEqual((look.alpha_mode, look.coordinates, look.other), (1, None, None))

    def test_without_nodes_the_viewport_color_is_exact(self):
        self.material.use_nodes = False
        self.material.diffuse_color = (0.1, 0.2, 0.3, 1.0)
        look, codes = self.translate()
        self.close(look.base_color.color, (0.1, 0.2, 0.3))
        self.assertEqual(codes, set())

    def test_a_mix_of_constants_is_exact(self):
        mix = self.node("ShaderNodeMixRGB", ("Color", self.base), Fac=0.25)
        mix.inputs["Color1"].default_value = (1, 0, 0, 1)
        mix.inputs["Color2"].default_value = (0, 0, 1, 1)
        look, codes = self.translate()
        self.close(look.base_color.color, (0.75, 0.0, 0.25))
        self.assertEqual(codes, set())

    def test_inside_a_group_the_outside_values_count(self):
        group = bpy.data.node_groups.new("Paint", "ShaderNodeTree")
        group.inputs.new("NodeSocketColor", "Tint")
        group.outputs.new("NodeSocketShader", "Shader")
        first, last = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        inner = group.nodes.new("ShaderNodeBsdfPrincipled")
        group.links.new(first.outputs[0], inner.inputs["Base Color"])
        group.links.new(inner.outputs[0], last.inputs[0])
        node = self.node("ShaderNodeGroup")
        node.node_tree = group
        self.tree.links.new(node.outputs[0], self.output.inputs["Surface"])
        node.inputs["Tint"].default_value = (0.9, 0.8, 0.7, 1.0)
        look, codes = self.translate()
        self.close(look.base_color.color, (0.9, 0.8, 0.7))
        self.assertEqual(codes, set())

    def test_a_muted_node_is_passed_through(self):
        node = self.node("ShaderNodeInvert", ("Color", self.base), Color=(0.1, 0.2, 0.3, 1.0))
        node.mute = True
        self.close(self.translate()[0].base_color.color, (0.1, 0.2, 0.3))

    def test_object_color_is_that_of_the_object(self):
        self.node("ShaderNodeObjectInfo", ("Color", self.base))
        look, codes = self.translate(color=(0.1, 0.2, 0.3, 1.0))
        self.close(look.base_color.color, (0.1, 0.2, 0.3))
        self.assertEqual(codes, set())

    def test_numbers_outside_their_range_are_brought_in(self):
        strength = self.node("ShaderNodeValue", (0, self.principled.inputs["Roughness"]))
        strength.outputs[0].default_value = 1e30
        self.translate()
        self.assertEqual(self.added[0]["roughness"], 1.0)

    # ---- What is an offset and a scale of one image ----

    def test_a_texture_keeps_its_picture_and_its_mean(self):
        self.picture(self.base)
        look, codes = self.translate()
        self.assertEqual(codes, set())
        self.close(self.added[0]["base_color"], (0.5, 0.5, 0.5))
        self.assertEqual(look.coordinates.kind, "UV")
        texture = look.base_color.texture
        self.assertEqual((texture.channel, texture.scale), (0, (1.0, 1.0, 1.0)))

    def test_a_color_feeding_a_number_is_its_luma(self):
        self.picture(self.principled.inputs["Roughness"], ((0, 1, 0, 1), (0, 1, 0, 1)), data=True)
        look, codes = self.translate()
        self.assertEqual((codes, look.roughness.texture.channel), (set(), 5))
        self.assertAlmostEqual(self.added[0]["roughness"], 0.7152, places=5)

    def test_channels_math_inversion_and_ranges_become_scale_and_offset(self):
        rough = self.principled.inputs["Roughness"]
        range_ = self.node("ShaderNodeMapRange", (0, rough), To_Min=0.2, To_Max=0.6)
        math = self.node("ShaderNodeMath", (0, range_.inputs["Value"]))
        math.operation = "SUBTRACT"
        math.inputs[0].default_value = 1.0
        split = self.node("ShaderNodeSeparateColor", ("Green", math.inputs[1]))
        self.picture(split.inputs[0], data=True)
        look, codes = self.translate()
        texture = look.roughness.texture
        self.assertEqual((codes, texture.channel), (set(), 2))
        self.assertAlmostEqual(texture.scale[0], -0.4, places=6)
        self.assertAlmostEqual(texture.offset[0], 0.6, places=6)

    def test_multiplied_added_and_mixed_with_constants_it_stays_one_texture(self):
        for blend, scale, offset in (
            ("MULTIPLY", (0.75, 0.625, 0.5), (0.0, 0.0, 0.0)),
            ("ADD", (1.0, 1.0, 1.0), (0.25, 0.125, 0.0)),
            ("MIX", (0.5, 0.5, 0.5), (0.25, 0.125, 0.0)),
        ):
            mix = self.node("ShaderNodeMixRGB", ("Color", self.base), Fac=0.5)
            mix.blend_type = blend
            mix.inputs["Color2"].default_value = (0.5, 0.25, 0.0, 1.0)
            self.picture(mix.inputs["Color1"])
            look, codes = self.translate()
            self.assertEqual(codes, set())
            self.close(look.base_color.texture.scale, scale)
            self.close(look.base_color.texture.offset, offset)

    def test_two_colors_mixed_by_an_image_are_one_texture(self):
        mix = self.node("ShaderNodeMixRGB", ("Color", self.base))
        mix.inputs["Color1"].default_value = (1, 0, 0, 1)
        mix.inputs["Color2"].default_value = (0, 0, 1, 1)
        self.picture(mix.inputs["Fac"], data=True)
        look, codes = self.translate()
        self.assertEqual((codes, look.base_color.texture.channel), (set(), 5))
        self.close(look.base_color.texture.scale, (-1.0, 0.0, 1.0))

    def test_alpha_of_the_image_is_the_surfaces(self):
        node = self.picture(self.base, ((1, 0, 0, 1), (1, 0, 0, 0.5)))
        self.tree.links.new(node.outputs["Alpha"], self.principled.inputs["Alpha"])
        look, codes = self.translate()
        self.assertEqual((codes, look.alpha_mode, look.alpha.texture.channel), (set(), 1, 4))
        self.assertAlmostEqual(self.added[0]["alpha"], 0.75, places=2)
        self.close(self.added[0]["base_color"], (1.0, 0.0, 0.0))

    def test_alpha_compared_with_a_constant_is_clipped_there(self):
        for operation, limit, cutoff, scale in (
            ("GREATER_THAN", 0.3, 0.3, 1.0),
            ("LESS_THAN", 0.3, 0.7, -1.0),
        ):
            math = self.node("ShaderNodeMath", (0, self.principled.inputs["Alpha"]))
            math.operation = operation
            math.inputs[1].default_value = limit
            self.picture(math.inputs[0], ((1, 1, 1, 1), (1, 1, 1, 0)), output="Alpha")
            look, codes = self.translate()
            self.assertEqual((codes, look.alpha_mode), (set(), 2))
            self.assertAlmostEqual(look.alpha_cutoff, cutoff, places=6)
            self.assertEqual(look.alpha.texture.scale[0], scale)

    # ---- What is computed texel by texel ----

    def test_functions_of_an_image_are_baked(self):
        white, black = (1, 1, 1, 1), (0, 0, 0, 1)
        ramp = self.node("ShaderNodeValToRGB", ("Color", self.base))
        ramp.color_ramp.elements[0].color = (1, 0, 0, 1)
        ramp.color_ramp.elements[1].color = (0, 1, 0, 1)
        self.picture(ramp.inputs["Fac"], (black, white, white, white))
        self.assertEqual(self.translate()[1], set())
        self.close(self.added[0]["base_color"], (0.25, 0.75, 0.0))
        gamma = self.node("ShaderNodeGamma", ("Color", self.base), Gamma=2.0)
        half = (0.7353569831, 0.7353569831, 0.7353569831, 1)  # 0.5 in linear light
        self.picture(gamma.inputs["Color"], (half, half))
        self.assertEqual(self.translate()[1], set())
        self.close(self.added[0]["base_color"], (0.25, 0.25, 0.25), places=2)
        hue = self.node("ShaderNodeHueSaturation", ("Color", self.base), Hue=0.5 + 1 / 3)
        self.picture(hue.inputs["Color"], ((1, 0, 0, 1), (0, 1, 0, 1)))
        self.assertEqual(self.translate()[1], set())
        self.close(self.added[0]["base_color"], (0.0, 0.5, 0.5), places=2)

    def test_two_images_of_one_mapping_are_baked_into_one(self):
        mix = self.node("ShaderNodeMixRGB", ("Color", self.base), Fac=1.0)
        mix.blend_type = "MULTIPLY"
        self.picture(mix.inputs["Color1"], ((1, 0, 0, 1), (0, 1, 0, 1)))
        self.picture(mix.inputs["Color2"], ((1, 1, 1, 1), (0, 0, 0, 1)))
        look, codes = self.translate()
        self.assertEqual(codes, set())
        self.close(self.added[0]["base_color"], (0.5, 0.0, 0.0))

    def test_light_multiplied_above_one_keeps_its_strength(self):
        self.principled.inputs["Emission Strength"].default_value = 20.0
        gamma = self.node("ShaderNodeGamma", ("Color", self.principled.inputs["Emission"]))
        gamma.inputs["Gamma"].default_value = 2.0
        self.picture(gamma.inputs["Color"])
        look, _ = self.translate()
        self.close(look.emission.texture.scale, (20.0, 20.0, 20.0))
        self.close(self.added[0]["emission"], (10.0, 10.0, 10.0), places=3)

    def test_an_image_whose_alpha_nobody_uses_is_times_alpha_as_in_cycles(self):
        self.picture(self.base, ((1, 1, 1, 1), (1, 1, 1, 0)))
        look, codes = self.translate()
        self.assertEqual((codes, look.alpha_mode), (set(), 0))
        self.close(self.added[0]["base_color"], (0.5, 0.5, 0.5))

    def test_packed_channels_and_data_are_not_times_alpha(self):
        node = self.picture(self.base, ((1, 1, 1, 1), (1, 1, 1, 0)))
        node.image.alpha_mode = "CHANNEL_PACKED"
        texture = self.translate()[0].base_color.texture
        self.assertEqual(texture.picture.image, node.image)

    # ---- Procedures and what cannot be followed ----

    def test_procedural_colors_are_means_and_named(self):
        ramp = self.node("ShaderNodeValToRGB", ("Color", self.base))
        self.node("ShaderNodeTexNoise", ("Fac", ramp.inputs["Fac"]))
        look, codes = self.translate()
        self.close(look.base_color.color, (0.5, 0.5, 0.5))
        self.assertEqual((codes, self.severity["node_color"]), ({"node_color"}, "warning"))

    def test_a_checker_is_the_mean_of_its_colors(self):
        checker = self.node("ShaderNodeTexChecker", ("Color", self.base))
        checker.inputs["Color1"].default_value = (1, 0, 0, 1)
        checker.inputs["Color2"].default_value = (0, 0, 1, 1)
        look, codes = self.translate()
        self.close(look.base_color.color, (0.5, 0.0, 0.5))
        self.assertEqual(codes, {"node_color"})

    def test_a_loop_of_nodes_ends_and_is_named(self):
        first = self.node("ShaderNodeInvert", ("Color", self.base))
        second = self.node("ShaderNodeInvert", ("Color", first.inputs["Color"]))
        self.tree.links.new(first.outputs[0], second.inputs["Color"], verify_limits=False)
        self.assertIsNone(self.translate()[0].base_color.texture)

    def test_hundreds_of_nodes_in_a_row_end_and_are_named(self):
        target = self.base
        for _ in range(200):
            target = self.node("ShaderNodeInvert", ("Color", target)).inputs["Color"]
        self.assertIn("node_depth", self.translate()[1])

    # ---- Mixtures ----

    def mix(self, first, second, share=0.5, target=None):
        node = self.node("ShaderNodeMixShader", (0, target or self.output.inputs["Surface"]))
        node.inputs[0].default_value = share
        for place, shader in ((1, first), (2, second)):
            if shader is not None:
                self.tree.links.new(shader.outputs[0], node.inputs[place])
        return node

    def test_transparency_mixed_in_is_alpha(self):
        clear = self.node("ShaderNodeBsdfTransparent")
        self.mix(clear, self.principled, 0.7)
        look, codes = self.translate()
        self.assertEqual((codes, look.other), (set(), None))
        self.close(look.base_color.color, (0.2, 0.4, 0.6))
        self.assertAlmostEqual(look.alpha.number, 0.7)
        node = self.mix(self.principled, clear)
        self.picture(node.inputs[0], output="Alpha")
        self.translate()
        node = self.mix(self.principled, clear)
        self.picture(node.inputs[0], data=True)
        look, codes = self.translate()
        self.assertEqual((codes, look.alpha.texture.scale[0]), (set(), -1.0))
        self.assertEqual(look.alpha.texture.offset[0], 1.0)

    def test_two_principled_mixed_by_an_image_are_both_kept(self):
        moss = self.node("ShaderNodeBsdfPrincipled")
        moss.inputs["Base Color"].default_value = (0, 1, 0, 1)
        node = self.mix(self.principled, moss)
        self.picture(node.inputs[0], data=True)
        look, codes = self.translate()
        self.assertEqual(codes, set())
        self.close(look.other.base_color.color, (0.0, 1.0, 0.0))
        self.assertEqual(look.mix.texture.channel, 5)
        self.assertEqual((self.added[1]["other"], len(self.added)), (1, 2))

    def test_nested_mixtures_keep_their_shares(self):
        colors = ((1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1))
        nodes = [self.node("ShaderNodeBsdfDiffuse", Color=color) for color in colors]
        inner = self.mix(nodes[0], nodes[1], 0.25)
        outer = self.mix(inner, nodes[2], 0.4)
        self.tree.links.new(outer.outputs[0], self.output.inputs["Surface"])
        look, codes = self.translate()
        self.assertEqual(codes, set())
        weights, left = {}, 1.0
        while look is not None:
            rest = left * look.mix.number if look.other else 0.0
            weights[look.base_color.color] = left - rest
            look, left = look.other, rest
        self.close([weights[c[:3]] for c in colors], (0.45, 0.15, 0.4))

    def test_mixtures_that_each_show_the_one_before_twice_end_and_are_named(self):
        diffuse = self.node("ShaderNodeBsdfDiffuse")
        last = self.mix(self.principled, diffuse)
        for _ in range(32):  # 2^32 ways down to a surface
            last = self.mix(last, last)
        look, codes = self.translate()
        self.assertEqual(codes, {"mixed_shaders"})
        count = 1
        while look.other is not None:
            look, count = look.other, count + 1
        self.assertEqual(count, 4)

    def test_light_added_is_emission(self):
        add = self.node("ShaderNodeAddShader", (0, self.output.inputs["Surface"]))
        glow = self.node("ShaderNodeEmission", (0, add.inputs[0]), Color=(1, 0.5, 0, 1))
        glow.inputs["Strength"].default_value = 3.0
        self.tree.links.new(self.principled.outputs[0], add.inputs[1])
        look, codes = self.translate()
        self.assertEqual(codes, set())
        self.close(look.emission.color, (3.0, 1.5, 0.0))
        self.close(look.radiance, (3.0, 1.5, 0.0))
        self.close(look.base_color.color, (0.2, 0.4, 0.6))

    def test_what_it_radiates_is_the_mean_of_what_glows_through_its_holes_and_mixtures(self):
        emission = self.principled.inputs["Emission"]
        emission.default_value = (1.0, 0.8, 0.5, 1.0)
        self.principled.inputs["Emission Strength"].default_value = 4.0
        self.close(self.translate()[0].radiance, (4.0, 3.2, 2.0))
        self.principled.inputs["Alpha"].default_value = 0.5
        self.close(self.translate()[0].radiance, (2.0, 1.6, 1.0))
        node = self.mix(self.principled, self.node("ShaderNodeBsdfDiffuse"))
        node.inputs[0].default_value = 0.75
        self.close(self.translate()[0].radiance, (0.5, 0.4, 0.25))

    def test_a_fresnel_factor_is_its_mean_and_named(self):
        gloss = self.node("ShaderNodeBsdfGlossy")
        node = self.mix(self.principled, gloss)
        self.node("ShaderNodeFresnel", (0, node.inputs[0]))
        look, codes = self.translate()
        self.assertEqual(codes, {"fresnel"})
        self.assertTrue(0.0 < look.mix.number < 0.2)

    def test_camera_rays_choose_what_is_drawn(self):
        self.mix(self.node("ShaderNodeBsdfDiffuse"), self.principled)
        node = self.output.inputs["Surface"].links[0].from_node
        self.node("ShaderNodeLightPath", ("Is Camera Ray", node.inputs[0]))
        look, codes = self.translate()
        self.close(look.base_color.color, (0.2, 0.4, 0.6))
        self.assertEqual((codes, self.severity["light_path"]), ({"light_path"}, "info"))

    def test_other_shaders_have_their_nearest_surface(self):
        for kind, field, expected in (
            ("ShaderNodeBsdfDiffuse", "base_color", set()),
            ("ShaderNodeBsdfGlossy", "base_color", set()),
            ("ShaderNodeEmission", "emission", set()),
            ("ShaderNodeBsdfGlass", "base_color", set()),
            ("ShaderNodeBsdfRefraction", "base_color", {"shader"}),
            ("ShaderNodeBsdfTranslucent", "base_color", {"shader"}),
            ("ShaderNodeSubsurfaceScattering", "base_color", {"shader"}),
            ("ShaderNodeBsdfVelvet", "base_color", {"shader"}),
            ("ShaderNodeBsdfToon", "base_color", {"shader"}),
            ("ShaderNodeBsdfHair", "base_color", {"shader"}),
        ):
            node = self.node(kind, (0, self.output.inputs["Surface"]))
            node.inputs["Color"].default_value = (0.1, 0.2, 0.3, 1.0)
            look, codes = self.translate()
            self.close(getattr(look, field).color, (0.1, 0.2, 0.3))
            self.assertEqual(codes, expected, kind)
            self.assertEqual(look.transmission, float(kind[14:] in {"Glass", "Refraction"}))

    def test_rough_glass_was_drawn_clear_without_a_word(self):
        self.principled.inputs["Transmission"].default_value = 1.0
        for roughness, metallic, named in ((0.09, 0, False), (0.5, 1, False), (0.5, 0, True)):
            self.principled.inputs["Roughness"].default_value = roughness
            self.principled.inputs["Metallic"].default_value = metallic
            self.assertEqual("rough_glass" in self.translate()[1], named, (roughness, metallic))
        self.picture(self.principled.inputs["Roughness"])
        self.assertEqual(self.translate()[1], {"rough_glass"})

    def test_no_output_is_named(self):
        self.tree.nodes.clear()
        self.assertEqual(self.translate()[1], {"no_surface"})

    def test_what_is_left_out_is_named(self):
        for name in ("Subsurface", "Sheen", "Anisotropic"):
            self.principled.inputs[name].default_value = 0.5
        self.node("ShaderNodeVolumeScatter", (0, self.output.inputs["Volume"]))
        self.node("ShaderNodeBevel", (0, self.principled.inputs["Normal"]))
        _, codes = self.translate()
        self.assertEqual(codes, {"subsurface", "sheen", "anisotropic", "volume", "normal"})

    # ---- Relief ----

    def test_normal_map_and_bump_are_kept_together(self):
        bump = self.node("ShaderNodeBump", (0, self.principled.inputs["Normal"]))
        bump.inputs["Strength"].default_value = 0.5
        bump.inputs["Distance"].default_value = 0.2
        bump.invert = True
        self.picture(bump.inputs["Height"], data=True)
        normal = self.node("ShaderNodeNormalMap", (0, bump.inputs["Normal"]), Strength=0.8)
        self.picture(normal.inputs["Color"], ((0.5, 0.5, 1, 1),) * 2, data=True, name="Normals")
        look, codes = self.translate()
        self.assertEqual(codes, set())
        self.assertAlmostEqual(look.bump_distance, -0.1, places=6)
        self.assertAlmostEqual(look.normal_strength, 0.8, places=6)
        self.assertEqual((look.normal.picture.name, look.bump.channel), ("Normals", 5))

    def test_displacement_is_a_bump(self):
        node = self.node("ShaderNodeDisplacement", (0, self.output.inputs["Displacement"]))
        node.inputs["Scale"].default_value = 0.3
        self.picture(node.inputs["Height"], data=True)
        look, codes = self.translate()
        self.assertEqual(codes, set())
        self.assertAlmostEqual(look.bump_distance, 0.3, places=6)

    # ---- Many ----

    def test_a_thousand_materials_take_less_than_a_second(self):
        from lodestone.bridge.nodes.materials import Materials
        from lodestone.core.problems import Problems

        node = self.picture(self.base)
        self.node("ShaderNodeUVMap", (0, node.inputs["Vector"])).uv_map = "UVMap"
        copies = [self.material.copy() for _ in range(1000)]
        materials = Materials(None, Problems())
        start = time.process_time()
        for material in copies:
            materials.index(material)
        self.assertLess(time.process_time() - start, 1.0)


if __name__ == "__main__":
    unittest.main()
