# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards hair: particle hair as it renders, hair curves, and points."""

import unittest

import bpy

import blender_scenes as scenes
from blender_case import Case


class Hair(Case):
    def furry(self, name="Furry", **settings):
        item = scenes.cube(name)
        system = scenes.particles(item, 20, type="HAIR", render_type="PATH")
        system.settings.hair_length = 0.5
        for key, value in settings.items():
            setattr(system.settings, key, value)
        return item

    def test_hair_is_drawn_on_its_emitter(self):
        self.furry().scale = (2, 2, 2)
        extraction, occurrences = self.extract()
        self.assertEqual(self.named(extraction), {"Furry": 1, "Furry hair": 1})
        self.assertEqual(occurrences[0][1], occurrences[1][1])
        # Straight to a tip: a pyramid with its floor each
        self.assertEqual(self.triangles(extraction, "Furry hair"), 20 * 4)

    def test_children_are_drawn_in_place_of_their_parents(self):
        self.furry(child_type="SIMPLE", rendered_child_count=10, child_nbr=2, use_close_tip=False)
        extraction, _ = self.extract()
        (hair,) = [leaf for leaf in extraction.leaves if leaf.data == "Furry hair"]
        self.assertEqual(hair.size, 200)

    def test_hair_follows_instances_of_its_emitter(self):
        box = scenes.collection("Box")
        item = self.furry()
        self.root.objects.unlink(item)
        box.objects.link(item)
        for i in range(3):
            scenes.instance(f"Use {i}", box, (5 * i, 0, 0), (1, 1, 1 + i))
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Furry": 3, "Furry hair": 3})

    def test_hair_without_its_emitter(self):
        self.furry().show_instancer_for_render = False
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Furry hair": 1})

    def test_hair_that_does_not_render_is_left_out(self):
        self.furry("Off").modifiers[0].show_render = False
        self.furry("None", render_type="NONE")
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Off": 1, "None": 1})

    def test_radii_run_from_root_to_tip_by_the_shape(self):
        self.furry(root_radius=2.0, tip_radius=1.0, radius_scale=0.1, use_close_tip=False)
        extraction, _ = self.extract()
        (hair,) = [leaf for leaf in extraction.leaves if leaf.data == "Furry hair"]
        self.assertEqual(self.triangles(extraction, "Furry hair"), 20 * 8)
        # Half of 0.1 x 2 and of 0.1 x 1, on 20 cones of 0.5 m: the mantles
        summary = extraction.model.measure(hair.object)
        self.assertAlmostEqual(summary.surface_area, 20 * 3.1416 * 0.15 * 0.5, delta=0.6)

    def test_hair_has_the_material_it_chose(self):
        item = self.furry(material=2)
        for name in ("Skin", "Fur"):
            item.data.materials.append(scenes.material(name))
        extraction, _ = self.extract()
        (hair,) = [leaf for leaf in extraction.leaves if leaf.data == "Furry hair"]
        self.assertEqual(hair.materials, ("Skin", "Fur"))

    def test_hair_of_a_textured_material_has_the_uvs_of_its_roots(self):
        from lodestone.bridge.scene import hair_strands

        item = self.furry(child_type="SIMPLE", rendered_child_count=3, child_nbr=1)
        layer = item.data.uv_layers.new(name="Root")
        for corner in layer.data:
            corner.uv = (0.25, 0.75)
        made = []
        strands_hair, hair_strands.hair = hair_strands.hair, lambda *a: made.append(
            strands_hair(*a)
        )
        try:
            material = scenes.material("Fur")
            nodes = material.node_tree
            image = nodes.nodes.new("ShaderNodeTexImage")
            image.image = bpy.data.images.new("Stripes", 4, 4)
            socket = nodes.nodes["Principled BSDF"].inputs["Base Color"]
            nodes.links.new(image.outputs["Color"], socket)
            item.data.materials.append(material)
            scenes.extract(compare=False)[0].model.close()
            item.data.materials[0] = scenes.material("Plain")
            scenes.extract(compare=False)[0].model.close()
        finally:
            hair_strands.hair = strands_hair
        self.assertEqual(len(made[0].counts), 60)
        self.assertEqual([round(v, 4) for v in made[0].uvs], [0.25, 0.75] * 60)
        self.assertIsNone(made[1].uvs)

    def test_hair_curves(self):
        bpy.ops.object.curves_random_add()
        data = bpy.context.object.data
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {data.name: 1})
        (leaf,) = extraction.leaves
        self.assertEqual(leaf.size, 500)
        self.assertGreater(self.triangles(extraction, data.name), 500 * 4)

    def test_hair_curves_that_nodes_make(self):
        data = bpy.data.hair_curves.new("Grown")
        item = scenes.link(bpy.data.objects.new("Grown", data))
        group, _, last = scenes.node_group("Grow")
        line = group.nodes.new("GeometryNodeCurvePrimitiveLine")
        group.links.new(line.outputs[0], last.inputs[0])
        item.modifiers.new("Grow", "NODES").node_group = group
        scenes.link(bpy.data.objects.new("Empty", bpy.data.hair_curves.new("Empty")))
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 1)
        self.assertEqual(list(extraction.problems), [])

    def test_points_are_balls_in_their_place(self):
        host = scenes.cube("Host", (1, 2, 3))
        host.scale = (1, 2, 1)
        group, first, last = scenes.node_group("Points")
        points = group.nodes.new("GeometryNodeMeshToPoints")
        points.inputs["Radius"].default_value = 0.25
        group.links.new(first.outputs[0], points.inputs[0])
        group.links.new(points.outputs[0], last.inputs[0])
        host.modifiers.new("Points", "NODES").node_group = group
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 8)
        self.assertAlmostEqual(occurrences[0][1][0], 0.25)
        self.assertAlmostEqual(occurrences[0][1][5], 0.5)


if __name__ == "__main__":
    unittest.main()
