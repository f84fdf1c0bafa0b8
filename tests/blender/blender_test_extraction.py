# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards truth: the model's occurrences are the render depsgraph's instances, one to one."""

import math
import unittest

import bpy
from mathutils import Matrix

import blender_scenes as scenes
from blender_case import Case


class Extraction(Case):
    def leaves(self, extraction):
        return sorted(leaf.data for leaf in extraction.leaves)

    # ---- Empty, smallest ----

    def test_an_empty_scene_gives_an_empty_model(self):
        extraction, occurrences = self.extract()
        self.assertEqual(occurrences, [])

    def test_one_cube_is_one_occurrence_where_it_stands(self):
        scenes.cube(location=(1, 2, 3))
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 1)
        self.assertEqual(occurrences[0][1][3::4], (1.0, 2.0, 3.0))
        self.assertEqual(extraction.model.totals().triangles_unique, 12)

    def test_what_has_no_faces_is_left_out_silently(self):
        scenes.link(bpy.data.objects.new("Plain Empty", None))
        scenes.link(bpy.data.objects.new("Nothing", scenes.mesh("Nothing", [], [])))
        scenes.link(bpy.data.objects.new("Point", scenes.mesh("Point", [(0, 0, 0)], [])))
        extraction, occurrences = self.extract()
        self.assertEqual((occurrences, list(extraction.problems)), ([], []))

    # ---- Hierarchy ----

    def test_collections_are_groups_and_empties_their_placements(self):
        house = scenes.collection("House")
        scenes.cube("Wall", collection=house)
        furniture = scenes.collection("Furniture", house)
        scenes.cube("Chair", (1, 0, 0), collection=furniture)
        street = scenes.collection("Street", self.root)
        scenes.instance("House.A", house, (10, 0, 0), parent=street)
        scenes.instance("House.B", house, (20, 0, 0), parent=street)
        extraction, occurrences = self.extract()
        model = extraction.model
        self.assertEqual(len(occurrences), 4)
        named = {model.object_summary(o).name: model.object_summary(o) for o in model.objects()}
        self.assertEqual(
            {name: (s.group, s.child_count) for name, s in named.items() if s.group},
            {"Scene": (1, 1), "Street": (1, 2), "House": (1, 2), "Furniture": (1, 1)},
        )
        self.assertEqual(self.leaves(extraction), ["Chair", "Wall"])

    def test_instances_keep_offset_mirror_stretch_and_nesting(self):
        inner = scenes.collection("Inner")
        inner.instance_offset = (1, 2, 3)
        scenes.cube("A", (4, 0, 0), collection=inner)
        outer = scenes.collection("Outer")
        outer.instance_offset = (0, 0, 7)
        scenes.instance("In.1", inner, (5, 5, 5), (1, 1, 1), (0.3, 0.2, 0.1), outer)
        scenes.instance("In.2", inner, (-5, 0, 0), (-1, 2, 0.5), parent=outer)
        scenes.instance("Out.1", outer, (100, 0, 0), (-1, 1, 1))
        scenes.instance("Out.2", outer, (0, 100, 0), (1, 3, 0.2), (0.5, 0.6, 0.7))
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 4)
        self.assertEqual(len(extraction.leaves), 1)
        mirrored = sum(_determinant(world) < 0 for _, world in occurrences)
        self.assertEqual(mirrored, 2)

    def test_eight_levels_of_instances(self):
        below = scenes.collection("C0")
        scenes.cube(collection=below)
        for level in range(1, 7):
            above = scenes.collection(f"C{level}")
            for side in (-1, 1):
                scenes.instance(f"E{level}{side}", below, (side * 2**level, 0, 0), parent=above)
            below = above
        scenes.instance("Top", below)
        _, occurrences = self.extract()
        self.assertEqual(len(occurrences), 64)

    def test_a_thing_linked_twice_is_drawn_once_under_its_first_parent(self):
        first = scenes.collection("First", self.root)
        second = scenes.collection("Second", self.root)
        cube = scenes.cube("Shared", collection=first)
        second.objects.link(cube)
        shared = scenes.collection("Below", first)
        second.children.link(shared)
        scenes.cube("Inside", collection=shared)
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 2)
        names = [extraction.model.object_summary(o).name for o in extraction.model.objects()]
        self.assertIn("First", names)
        self.assertNotIn("Second", names)

    def test_a_collection_shown_and_instanced_is_one_group(self):
        tree = scenes.collection("Tree", self.root)
        scenes.cube("Trunk", collection=tree)
        scenes.instance("Tree.001", tree, (5, 0, 0))
        extraction, occurrences = self.extract()
        groups = [s for s in self.summaries(extraction) if s.group]
        self.assertEqual(sorted(s.name for s in groups), ["Scene", "Tree"])
        self.assertEqual(len(occurrences), 2)

    def summaries(self, extraction):
        return [extraction.model.object_summary(o) for o in extraction.model.objects()]

    # ---- Visibility ----

    def test_hidden_and_excluded_things_are_left_out(self):
        scenes.cube("Shown")
        scenes.cube("Hidden").hide_render = True
        hidden = scenes.collection("Hidden", self.root)
        scenes.cube("In Hidden", collection=hidden)
        scenes.cube("Below Hidden", collection=scenes.collection("Sub", hidden))
        hidden.hide_render = True
        excluded = scenes.collection("Excluded", self.root)
        scenes.cube("In Excluded", collection=excluded)
        layer = bpy.context.view_layer.layer_collection
        layer.children["Excluded"].exclude = True
        scenes.cube("Screen Only").hide_viewport = True  # hidden in the viewport, rendered
        extraction, occurrences = self.extract()
        self.assertEqual(self.leaves(extraction), ["Screen Only", "Shown"])

    def test_an_excluded_collection_still_shows_through_its_instances(self):
        library = scenes.collection("Library", self.root)
        scenes.cube("Part", collection=library)
        bpy.context.view_layer.layer_collection.children["Library"].exclude = True
        scenes.instance("Use", library, (1, 0, 0))
        _, occurrences = self.extract()
        self.assertEqual(len(occurrences), 1)

    def test_a_thing_in_an_excluded_and_an_included_collection_is_shown(self):
        off = scenes.collection("Off", self.root)
        on = scenes.collection("On", self.root)
        on.objects.link(scenes.cube("Both", collection=off))
        bpy.context.view_layer.layer_collection.children["Off"].exclude = True
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 1)
        self.assertIn("On", [s.name for s in self.summaries(extraction)])

    def test_a_collection_partly_excluded_is_whole_in_its_instances(self):
        outer = scenes.collection("Outer", self.root)
        scenes.cube("A", collection=outer)
        scenes.cube("B", collection=scenes.collection("Inner", outer))
        layer = bpy.context.view_layer.layer_collection.children["Outer"]
        layer.children["Inner"].exclude = True
        scenes.instance("Use", outer, (9, 0, 0))
        _, occurrences = self.extract()
        self.assertEqual(len(occurrences), 3)

    # ---- Sharing and materials ----

    def test_linked_duplicates_are_one_object_and_modified_ones_are_not(self):
        data = scenes.cube_mesh("Shared")
        for i in range(3):
            scenes.cube(f"Copy.{i}", (i, 0, 0), data=data)
        scenes.cube("Round", data=data).modifiers.new("Subdivision", "SUBSURF")
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 4)
        self.assertEqual(len(extraction.leaves), 2)

    def test_materials_of_the_object_split_a_shared_mesh(self):
        data = scenes.cube_mesh("Shared")
        data.materials.append(scenes.material("Red"))
        scenes.cube("Plain", data=data)
        own = scenes.cube("Own", (3, 0, 0), data=data)
        own.material_slots[0].link = "OBJECT"
        own.material_slots[0].material = scenes.material("Blue", (0, 0, 1))
        empty = scenes.cube("Empty Slot", (6, 0, 0), data=data)  # Blender falls back to the mesh's
        empty.material_slots[0].link = "OBJECT"
        extraction, occurrences = self.extract()
        materials = sorted(leaf.materials for leaf in extraction.leaves)
        self.assertEqual(materials, [("Blue",), ("Red",)])
        self.assertEqual(len(occurrences), 3)

    def test_ids_are_the_same_in_a_second_reading(self):
        data = scenes.cube_mesh("Shared")
        for i in range(3):
            scenes.cube(f"Copy.{i}", (i, 0, 0), data=data)
        scenes.cube("Round").modifiers.new("Subdivision", "SUBSURF")
        uids = [sorted(s.uid for s in self.summaries(self.extract()[0])) for _ in range(2)]
        self.assertEqual(uids[0], uids[1])
        self.assertEqual(len(set(uids[0])), len(uids[0]))

    def test_environment_is_told_by_object_and_by_collection(self):
        ground = scenes.collection("Ground", self.root)
        ground.lodestone.role = "ENVIRONMENT"
        scenes.cube("Road", collection=ground)
        scenes.cube("Wall").lodestone.role = "ENVIRONMENT"
        scenes.cube("Car")
        scenes.cube("Crate").lodestone.role = "ORDINARY"
        extraction, _ = self.extract()
        roles = {s.name: s.role for s in self.summaries(extraction)}
        expected = {"Scene": 0, "Ground": 1, "Road": 1, "Wall": 1, "Car": 0, "Crate": 2}
        self.assertEqual(roles, expected)

    # ---- Everything else that makes instances ----

    def test_curves_texts_surfaces_and_metaballs_count_once(self):
        curve = bpy.data.curves.new("Curve", "CURVE")
        curve.splines.new("BEZIER").bezier_points.add(1)
        curve.splines[0].bezier_points[1].co = (2, 0, 0)
        curve.bevel_depth = 0.1
        inner = scenes.collection("Inner")
        scenes.link(bpy.data.objects.new("Curve", curve), inner)
        scenes.link(bpy.data.objects.new("Curve Too", curve))
        scenes.link(bpy.data.objects.new("Text", bpy.data.curves.new("Text", "FONT")))
        bpy.data.curves["Text"].body = "Lode"
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
        bpy.ops.object.metaball_add(location=(9, 0, 0))
        bpy.ops.object.metaball_add(location=(10, 0, 0))
        scenes.instance("Use", inner, (0, 5, 0))
        _, occurrences = self.extract()
        self.assertEqual(len(occurrences), 5)

    def test_vertex_instances_belong_to_their_parent(self):
        parent = scenes.link(
            bpy.data.objects.new("Points", scenes.mesh("P", [(0, 0, 0), (3, 0, 0)], []))
        )
        parent.instance_type = "VERTS"
        scenes.cube("Child").parent = parent
        _, occurrences = self.extract()
        self.assertEqual(len(occurrences), 2)

    def test_geometry_nodes_instances_belong_to_their_emitter(self):
        emitter = scenes.cube("Emitter", (0, 0, 2))
        stone = scenes.cube("Stone", size=0.2)
        _scatter(emitter, stone)
        box = scenes.collection("Box")
        for item in (emitter, stone):
            self.root.objects.unlink(item)
            box.objects.link(item)
        for i in range(3):
            scenes.instance(f"Use.{i}", box, (10 * i, 0, 0), (1, 1 + i, 1), (0, 0, i))
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 3 * (1 + 1 + 8))  # host, stone, one on each vertex
        named = [s.name for s in self.summaries(extraction)]
        self.assertEqual(named.count("Emitter instances"), 1)

    def test_particles_belong_to_their_emitter(self):
        emitter = scenes.cube("Emitter")
        stone = scenes.cube("Stone", (0, 0, 5), 0.2)
        emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
        settings = emitter.particle_systems[0].settings
        settings.type, settings.count = "HAIR", 20
        settings.render_type, settings.instance_object = "OBJECT", stone
        _, occurrences = self.extract()
        self.assertEqual(len(occurrences), 22)

    # ---- Hostile ----

    def test_any_name_goes_through(self):
        for name in ('quote"', "new\nline", "{brace}", "Ünïcode 名", "a/b", "\\", "  "):
            scenes.cube(name, collection=scenes.collection(name, self.root))
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 7)
        self.assertIn("Ünïcode 名", [s.name for s in self.summaries(extraction)])

    def test_vertices_that_are_no_numbers_are_named_and_the_rest_is_drawn(self):
        bad = scenes.cube("Broken")
        bad.data.vertices[0].co.x = math.nan
        scenes.cube("Whole", (3, 0, 0))
        extraction, request = scenes.extract(compare=False)
        with extraction.model as model:
            problems = model.problems()
            self.assertTrue(any("Broken" in p.object for p in problems), problems)
            self.assertGreaterEqual(len(model.occurrences()), 1)

    def test_a_transform_that_is_no_number_is_named_and_left_out(self):
        scenes.cube("Lost").location = (math.nan, 0, 0)
        scenes.cube("Whole", (3, 0, 0))
        extraction, request = scenes.extract(compare=False)
        with extraction.model as model:
            self.assertEqual([p.code for p in extraction.problems], ["bad_transform"])
            self.assertEqual(len(model.occurrences()), 1)

    def test_an_instance_flattened_to_nothing_does_no_harm(self):
        inner = scenes.collection("Inner")
        emitter = scenes.cube("Emitter", collection=inner)
        _scatter(emitter, scenes.cube("Stone", (0, 0, 9)))
        scenes.instance("Flat", inner, scale=(0, 0, 0))
        extraction, _ = scenes.extract(compare=False)
        extraction.model.close()

    # ---- Large ----

    def test_ten_thousand_instances(self):
        inner = scenes.collection("Inner")
        data = scenes.cube_mesh("Shared")
        for i in range(10):
            scenes.cube(f"Cube.{i}", (i, 0, 0), data=data, collection=inner)
        for i in range(1000):
            scenes.instance(f"Use.{i}", inner, (i % 40, i // 40, 0), turn=(0, 0, i))
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 10000)
        self.assertEqual(len(extraction.leaves), 1)


def _determinant(world):
    return Matrix((world[0:3], world[4:7], world[8:11])).determinant()


def _scatter(emitter, item):
    """Geometry nodes: the emitter's mesh, and item on each of its vertices."""
    group = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    nodes, links = group.nodes, group.links
    first, last = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    info, on = nodes.new("GeometryNodeObjectInfo"), nodes.new("GeometryNodeInstanceOnPoints")
    join = nodes.new("GeometryNodeJoinGeometry")
    info.inputs["Object"].default_value = item
    info.inputs["As Instance"].default_value = True
    links.new(first.outputs[0], on.inputs["Points"])
    links.new(info.outputs["Geometry"], on.inputs["Instance"])
    links.new(first.outputs[0], join.inputs[0])
    links.new(on.outputs[0], join.inputs[0])
    links.new(join.outputs[0], last.inputs[0])
    emitter.modifiers.new("Scatter", "NODES").node_group = group


if __name__ == "__main__":
    unittest.main()
