# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what is hidden: from everybody (table B: B8), or from some rays."""

import tempfile
import unittest

import bpy

import blender_scenes as scenes
from blender_case import Case


class Visibility(Case):
    """B8: what is hidden stays hidden, from the rays that Blender hides it from."""

    CAMERA, REFLECTION, SHADOW, RADIOSITY = 1, 2, 4, 8

    def hidden(self, extraction):
        """Ray classes by the name of data."""
        names = {leaf.object.key: leaf.data for leaf in extraction.leaves}
        model = extraction.model
        found = zip(model.occurrences(), model.occurrences_hidden())
        return {names[item.key]: mask for (item, _), mask in found}

    def layer(self, name):
        return self.bpy_layer().children[name]

    def bpy_layer(self):
        return bpy.context.view_layer.layer_collection

    def test_objects_of_other_scenes_are_not_shown(self):
        other = bpy.data.scenes.new("Other")
        scenes.cube("Elsewhere", collection=other.collection)
        scenes.cube("Here")
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Here": 1})

    def test_another_scene_is_read_when_it_is_asked_for(self):
        other = bpy.data.scenes.new("Other")
        scenes.cube("Elsewhere", collection=other.collection)
        scenes.cube("Here")
        from lodestone.engines import extract_engine

        request = extract_engine.Request(compare=True)
        extraction = extract_engine.extract_now(other, request)
        self.addCleanup(extraction.model.close)
        self.assertEqual(request.differences, [])
        self.assertEqual(self.named(extraction), {"Elsewhere": 1})

    def test_each_view_layer_shows_its_own(self):
        for name in ("Left", "Right"):
            scenes.cube(name, collection=scenes.collection(name, self.root))
        second = self.scene.view_layers.new("Second")
        second.layer_collection.children["Left"].exclude = True
        self.scene.view_layers[0].layer_collection.children["Right"].exclude = True
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Left": 1})
        self.scene.view_layers[0].use = False
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Right": 1})

    def test_the_material_of_a_view_layer_is_worn_by_everything(self):
        """Clay: material slots, empty ones and those of objects count no more."""
        bare = scenes.cube("Bare")
        cube = scenes.cube("Cube", (2, 0, 0))
        cube.data.materials.append(scenes.material("Paint"))
        self.scene.view_layers[0].material_override = clay = scenes.material("Clay")
        self.assertEqual(len(bare.material_slots), 0)
        clay.use_nodes = False
        clay.node_tree.nodes.clear()
        clay.use_nodes = True  # is named, though no slot holds it
        extraction, _ = self.extract()
        self.assertEqual([leaf.materials for leaf in extraction.leaves], [("Clay",)] * 2)
        self.assertIn(("Clay", "no_surface"), self.codes(extraction))
        bpy.ops.lodestone.check_scene()
        from lodestone.core.session.addon_session import addon_session

        found = addon_session().checks.get(self.scene.name).problems
        self.assertIn("no_surface", [problem.code for problem in found])

    def test_ray_visibility_becomes_flags_of_the_placement(self):
        scenes.cube("Plain")
        for name, switches in {
            "Camera": ["visible_camera", "visible_transmission"],
            "Mirror": ["visible_glossy"],
            "Shadow": ["visible_shadow"],
            "Bounce": ["visible_diffuse"],
            "Fog": ["visible_volume_scatter"],
        }.items():
            item = scenes.cube(name, (3, 0, 0))
            for switch in switches:
                setattr(item, switch, False)
        extraction, _ = self.extract()
        expected = {"Plain": 0, "Camera": 1, "Mirror": 2, "Shadow": 4, "Bounce": 8, "Fog": 0}
        self.assertEqual(self.hidden(extraction), expected)
        self.assertEqual(list(extraction.problems), [])

    def test_an_instancer_hides_what_it_shows(self):
        inner = scenes.collection("Inner")
        scenes.cube("Part", collection=inner).visible_shadow = False
        scenes.instance("Use", inner).visible_camera = False
        bpy.data.objects["Use"].visible_transmission = False
        extraction, _ = self.extract()
        self.assertEqual(self.hidden(extraction), {"Part": self.CAMERA | self.SHADOW})

    def test_what_an_emitter_shows_is_hidden_by_both(self):
        emitter = scenes.cube("Emitter")
        emitter.visible_glossy = False
        inner = scenes.collection("Inner")
        scenes.cube("Stone", collection=inner).visible_shadow = False
        modifier = emitter.modifiers.new("Scatter", "NODES")
        modifier.node_group = scenes.scatter_nodes(collection=inner, join=True)
        extraction, _ = self.extract()
        self.assertEqual(
            self.hidden(extraction),
            {"Emitter": self.REFLECTION, "Stone": self.REFLECTION | self.SHADOW},
        )

    def test_indirect_only_collections_are_hidden_from_the_camera(self):
        indirect = scenes.collection("Indirect", self.root)
        scenes.cube("Seen In Mirrors", collection=indirect)
        inner = scenes.collection("Inner")
        scenes.cube("Part", collection=inner)
        scenes.instance("Use", inner, parent=indirect)
        scenes.cube("Plain")
        self.layer("Indirect").indirect_only = True
        extraction, _ = self.extract()
        expected = {"Seen In Mirrors": self.CAMERA, "Part": self.CAMERA, "Plain": 0}
        self.assertEqual(self.hidden(extraction), expected)

    def test_holdouts_are_black_and_named(self):
        red = scenes.material("Red")
        holes = scenes.collection("Holes", self.root)
        for name, place in (("Hole", holes), ("Plain", self.root), ("Own", self.root)):
            scenes.cube(name, collection=place).data.materials.append(red)
        inner = scenes.collection("Inner")
        scenes.cube("Part", collection=inner).data.materials.append(red)
        scenes.instance("Cut", inner, parent=holes)
        scenes.instance("Kept", inner)
        bpy.data.objects["Own"].is_holdout = True
        self.layer("Holes").holdout = True
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 5)
        black = sorted(
            leaf.data
            for leaf in extraction.leaves
            if max(extraction.model.measure(leaf.object).color) == 0.0
        )
        self.assertEqual(black, ["Hole", "Own", "Part"])
        self.assertEqual(
            self.codes(extraction), [("Cut", "holdout"), ("Hole", "holdout"), ("Own", "holdout")]
        )

    def test_shadow_catchers_and_glass_that_differs_are_named(self):
        scenes.cube("Catcher").is_shadow_catcher = True
        scenes.cube("Glass").visible_transmission = False
        extraction, _ = self.extract()
        self.assertEqual(
            self.codes(extraction),
            [("Catcher", "shadow_catcher"), ("Glass", "visible_transmission")],
        )
        self.assertEqual(self.hidden(extraction), {"Catcher": 3, "Glass": 0})

    def test_a_group_with_something_hidden_is_drawn_by_its_children(self):
        inner = scenes.collection("Inner")
        scenes.cube("Part", collection=inner)
        scenes.cube("Ghost", (3, 0, 0), collection=inner).visible_shadow = False
        scenes.instance("Use", inner)
        extraction, _ = self.extract()
        model = extraction.model
        with tempfile.TemporaryDirectory() as folder:
            model.build(folder)
        for item in model.objects():
            summary = model.object_summary(item)
            self.assertEqual(summary.representation_count > 1, not summary.group, summary.name)


if __name__ == "__main__":
    unittest.main()
