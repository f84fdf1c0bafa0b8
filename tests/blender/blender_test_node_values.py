# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards node functions: what they make of an image is what Cycles shows, node by node."""

import unittest

import bpy

import blender_scenes as scenes

BLENDS = (
    "MIX DARKEN MULTIPLY LIGHTEN SCREEN ADD OVERLAY SOFT_LIGHT LINEAR_LIGHT DIFFERENCE SUBTRACT "
    "DIVIDE"
).split()
MATHS = (
    "ADD SUBTRACT MULTIPLY DIVIDE MULTIPLY_ADD POWER SQRT ABSOLUTE EXPONENT MINIMUM "
    "MAXIMUM LESS_THAN GREATER_THAN SIGN COMPARE ROUND FLOOR CEIL TRUNC FRACT MODULO WRAP SNAP "
    "RADIANS DEGREES"
).split()


class NodeValues(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.images = {}
        self.materials = []

    def image(self, alpha_mode="STRAIGHT", space="sRGB", alpha=1.0):
        key = (alpha_mode, space, alpha)
        if key not in self.images:
            made = bpy.data.images.new("Picture", 2, 2, alpha=True)
            made.colorspace_settings.name = space
            made.alpha_mode = alpha_mode
            made.pixels = [0.6, 0.3, 0.8, alpha] * 4
            self.images[key] = made
        return self.images[key]

    def graph(self, name, kind=None, source="Color", target=0, out=0, set_up=None, **image):
        """An emission of what a node makes of an image."""
        made = bpy.data.materials.new(name)
        made.use_nodes = True
        tree = made.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        emission = tree.nodes.new("ShaderNodeEmission")
        tree.links.new(emission.outputs[0], output.inputs["Surface"])
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = self.image(**image)
        result = texture.outputs[source]
        if kind is not None:
            node = tree.nodes.new(kind)
            if set_up is not None:
                set_up(node)
            tree.links.new(result, node.inputs[target])
            result = node.outputs[out]
        tree.links.new(result, emission.inputs["Color"])
        self.materials.append(made)
        return tree, texture

    def shown(self):
        """What Cycles shows of every material: a pixel each."""
        count = len(self.materials)
        for number, material in enumerate(self.materials):
            x, y = number % 8, number // 8
            corners = [(x, y, 0), (x + 1, y, 0), (x + 1, y + 1, 0), (x, y + 1, 0)]
            data = scenes.mesh(material.name, corners, [(0, 1, 2, 3)])
            data.uv_layers.new()
            data.materials.append(material)
            scenes.link(bpy.data.objects.new(material.name, data))
        scene, rows = self.scene, (count + 7) // 8
        camera = scene.camera
        camera.data.type, camera.data.ortho_scale = "ORTHO", max(8, rows)
        camera.location = (4, rows / 2, 10)
        scene.render.engine = "CYCLES"
        scene.cycles.samples = 1
        scene.cycles.use_denoising = False
        scene.cycles.filter_width = 0.01
        scene.render.resolution_x, scene.render.resolution_y = 8, rows
        scene.render.resolution_percentage = 100
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = bpy.app.tempdir + "node_values.exr"
        bpy.ops.render.render(write_still=True)
        picture = bpy.data.images.load(scene.render.filepath, check_existing=False)
        pixels = list(picture.pixels)
        return [pixels[4 * number : 4 * number + 3] for number in range(count)]

    def translated(self):
        """What our material shows, and the materials something was said about."""
        from lodestone.bridge.nodes.materials import Materials
        from lodestone.core.native import lodestone_native as native
        from lodestone.core.problems import Problems

        given = []

        class Recorder(native.Model):
            def add_material(self, name, **fields):
                given.append(fields["emission"])
                return super().add_material(name, **fields)

        model, problems = Recorder(), Problems()
        self.addCleanup(model.close)
        materials = Materials(model, problems)
        for material in self.materials:
            materials.index(material)
        said = [p for p in problems if p.severity != "info" and p.code != "glow"]
        return given, {p.object: p.message for p in said}

    def test_what_nodes_make_of_an_image_is_what_cycles_shows(self):
        for blend in BLENDS:
            for share in (1.0, 0.4):

                def set_up(node, blend=blend, share=share):
                    node.blend_type = blend
                    node.inputs[0].default_value = share
                    node.inputs[2].default_value = (0.5, 0.2, 0.7, 1.0)

                self.graph(f"mix {blend} {share}", "ShaderNodeMixRGB", target=1, set_up=set_up)
        for operation in MATHS:

            def set_up(node, operation=operation):
                node.operation = operation
                node.inputs[1].default_value, node.inputs[2].default_value = 0.15, 0.05

            self.graph(f"math {operation}", "ShaderNodeMath", set_up=set_up)

        def hue(node):
            node.inputs["Hue"].default_value = 0.8
            node.inputs["Saturation"].default_value = 1.2
            node.inputs["Value"].default_value = 0.9

        def contrast(node):
            node.inputs["Bright"].default_value, node.inputs["Contrast"].default_value = 0.1, 0.5

        def gamma(node):
            node.inputs["Gamma"].default_value = 2.2

        def ramp(node):
            node.color_ramp.elements[0].color = (1.0, 0.2, 0.0, 1.0)
            node.color_ramp.elements[1].color = (0.0, 0.5, 1.0, 1.0)
            node.color_ramp.elements[0].position = 0.1

        def curve(node):
            node.mapping.curves[3].points.new(0.4, 0.7)
            node.mapping.curves[0].points.new(0.5, 0.3)

        def steps(kind):
            def set_up(node):
                node.interpolation_type = kind
                for number, value in enumerate((0.05, 0.5, 0.2, 0.9), 1):
                    node.inputs[number].default_value = value

            return set_up

        self.graph("hue", "ShaderNodeHueSaturation", target="Color", set_up=hue)
        self.graph("contrast", "ShaderNodeBrightContrast", set_up=contrast)
        self.graph("gamma", "ShaderNodeGamma", set_up=gamma)
        self.graph("ramp", "ShaderNodeValToRGB", set_up=ramp)
        self.graph("curve", "ShaderNodeRGBCurve", target="Color", set_up=curve)
        self.graph("invert", "ShaderNodeInvert", target="Color")
        self.graph("gray", "ShaderNodeRGBToBW")
        for kind in ("LINEAR", "SMOOTHSTEP", "SMOOTHERSTEP"):
            self.graph(f"range {kind}", "ShaderNodeMapRange", set_up=steps(kind))
        for out in range(3):
            self.graph(f"channel {out}", "ShaderNodeSeparateColor", out=out)
            self.graph(f"hsv {out}", "ShaderNodeSeparateHSV", out=out)
            self.graph(f"xyz {out}", "ShaderNodeSeparateXYZ", out=out)
        self.compare()

    def test_alpha_counts_in_colors_as_in_cycles(self):
        for mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"):
            for space in ("sRGB", "Non-Color"):
                how = {"alpha_mode": mode, "space": space, "alpha": 0.8}
                self.graph(f"{mode} {space}", **how)
                self.graph(f"{mode} {space} alpha", source="Alpha", **how)
                tree, texture = self.graph(f"{mode} {space} both", **how)
                math = tree.nodes.new("ShaderNodeMath")  # somebody asks for the alpha
                tree.links.new(texture.outputs["Alpha"], math.inputs[0])
                math.operation = "MULTIPLY"
                math.inputs[1].default_value = 1e-9
                add = tree.nodes.new("ShaderNodeMixRGB")
                add.blend_type = "ADD"
                add.inputs[0].default_value = 1.0
                emission = next(n for n in tree.nodes if n.type == "EMISSION")
                tree.links.new(texture.outputs["Color"], add.inputs[1])
                tree.links.new(math.outputs[0], add.inputs[2])
                tree.links.new(add.outputs[0], emission.inputs["Color"])
        self.compare()

    def test_random_is_that_of_cycles(self):
        from lodestone.core.object_random import random_of

        names = [f"Tree.{i:03}" for i in range(29)]
        for name in ("a", "木.001", "x" * 63, *names):
            tree, _ = self.graph(name)
            info = tree.nodes.new("ShaderNodeObjectInfo")
            emission = next(n for n in tree.nodes if n.type == "EMISSION")
            tree.links.new(info.outputs["Random"], emission.inputs["Color"])
        for material, cycles in zip(self.materials, self.shown(), strict=True):
            self.assertAlmostEqual(random_of(material.name), cycles[0], delta=1e-4)

    def compare(self):
        given, named = self.translated()
        for material, ours, cycles in zip(self.materials, given, self.shown(), strict=True):
            with self.subTest(material.name):
                self.assertNotIn(material.name, named)
                for a, b in zip(ours, cycles):
                    # Emission cannot be negative for us; a baked texel has 8 bits
                    self.assertAlmostEqual(a, max(0.0, b), delta=0.006 + 0.006 * abs(b))


if __name__ == "__main__":
    unittest.main()
