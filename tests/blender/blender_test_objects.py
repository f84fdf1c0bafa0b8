# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that all a .blend can show goes through, once and in its place (table B: B1, B7).

Every case compares the model's occurrences with the render depsgraph's instances one to one."""

import tempfile
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes
from blender_case import Case
from lodestone.core import object_random


class WithoutFaces(Case):
    """B1 and its like: nothing to draw is no reason to crash, nor a problem."""

    def test_empties_of_every_kind_are_silent(self):
        for kind in ("PLAIN_AXES", "ARROWS", "SPHERE", "IMAGE"):
            empty = scenes.link(bpy.data.objects.new(kind, None))
            empty.empty_display_type = kind
        parent = bpy.data.objects["ARROWS"]
        scenes.cube("Child", (1, 0, 0)).parent = parent
        parent.location = (0, 0, 5)
        extraction, occurrences = self.extract()
        self.assertEqual(occurrences[0][1][3::4], (1.0, 0.0, 5.0))
        self.assertEqual((len(occurrences), list(extraction.problems)), (1, []))

    def test_an_empty_and_a_mesh_without_faces_alone(self):
        scenes.link(bpy.data.objects.new("Empty", None))
        scenes.link(bpy.data.objects.new("Bare", bpy.data.meshes.new("Bare")))
        extraction, occurrences = self.extract()
        self.assertEqual((occurrences, list(extraction.problems)), ([], []))

    def test_instances_of_empties_and_of_nothing(self):
        inner = scenes.collection("Inner")
        scenes.link(bpy.data.objects.new("Empty", None), inner)
        scenes.instance("Of Empty", inner)
        scenes.instance("Of Nothing", scenes.collection("Nothing"))
        scenes.instance("Of None", None)
        extraction, occurrences = self.extract()
        self.assertEqual((occurrences, list(extraction.problems)), ([], []))

    def test_edges_points_and_bare_curves_are_silent(self):
        edge = bpy.data.meshes.new("Edge")
        edge.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
        scenes.link(bpy.data.objects.new("Edge", edge))
        curve = bpy.data.curves.new("Bare", "CURVE")
        curve.splines.new("POLY").points.add(3)
        scenes.link(bpy.data.objects.new("Bare", curve))
        text = scenes.link(bpy.data.objects.new("Text", bpy.data.curves.new("Text", "FONT")))
        text.data.body = ""
        for name, new in (("Lattice", bpy.data.lattices), ("Bones", bpy.data.armatures)):
            scenes.link(bpy.data.objects.new(name, new.new(name)))
        scenes.link(bpy.data.objects.new("Speaker", bpy.data.speakers.new("Speaker")))
        scenes.link(bpy.data.objects.new("Probe", bpy.data.lightprobes.new("Probe", "CUBE")))
        extraction, occurrences = self.extract()
        self.assertEqual((occurrences, list(extraction.problems)), ([], []))

    def test_wire_and_bounds_display_is_for_the_viewport_only(self):
        scenes.cube("Wire").display_type = "WIRE"
        scenes.cube("Bounds", (2, 0, 0)).display_type = "BOUNDS"
        self.assertEqual(len(self.extract()[1]), 2)

    def test_volumes_and_grease_pencil_are_named(self):
        scenes.link(bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke")))
        scenes.link(bpy.data.objects.new("Ink", bpy.data.grease_pencils.new("Ink")))
        extraction, occurrences = self.extract()
        self.assertEqual(occurrences, [])
        self.assertEqual(
            self.codes(extraction), [("Ink", "grease_pencil"), ("Smoke", "object_kind")]
        )


class Instancing(Case):
    """B7: every way to show a thing more than once."""

    def pair(self):
        """A collection of two cubes, in no scene."""
        made = scenes.collection("Pair")
        made.instance_offset = (0.5, 0.25, -1)
        scenes.cube("A", (1, 0, 0), 0.3, collection=made)
        scenes.cube("B", (0, 2, 0), 0.2, collection=made)
        return made

    def scatter(self, emitter, **keywords):
        modifier = emitter.modifiers.new("Scatter", "NODES")
        modifier.node_group = scenes.scatter_nodes(**keywords)

    def test_collections_in_collections_with_offsets_mirrors_and_stretch(self):
        pair = self.pair()
        twice = scenes.collection("Twice")
        twice.instance_offset = (3, 0, 0)
        scenes.instance("P1", pair, (1, 2, 3), (1, -1, 1), (0.1, 0.2, 0.3), twice)
        scenes.instance("P2", pair, (4, 5, 6), (1, 2, 0.5), (0, 0, 1), twice)
        for i in range(3):
            scenes.instance(f"T{i}", twice, (10 * i, 0, 0), (1, 1, -1 - i), (0, i, 0))
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"A": 6, "B": 6})

    def test_nodes_place_a_collection_whole_and_in_parts(self):
        pair = self.pair()
        self.scatter(scenes.cube("Whole"), collection=pair)
        self.scatter(scenes.cube("Parts", (9, 0, 0)), collection=pair, separate=True)
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"A": 8 + 4, "B": 8 + 4})

    def test_nodes_make_instances_real(self):
        self.scatter(scenes.cube("Real"), collection=self.pair(), realize=True)
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 1)
        self.assertEqual(self.triangles(extraction, "Real"), 8 * 24)

    def test_nodes_place_a_mesh_they_made(self):
        self.scatter(scenes.cube("Host"), primitive=True, join=True)
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 9)
        self.assertEqual(extraction.model.totals().triangles_unique, 12 + 12)

    def test_nodes_place_a_collection_that_holds_instances(self):
        outer = scenes.collection("Outer")
        scenes.instance("Inner Use", self.pair(), (0, 0, 1), (2, 1, 1), parent=outer)
        self.scatter(scenes.cube("Host"), collection=outer)
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"A": 8, "B": 8})

    def test_an_emitter_within_instanced_collections_is_one_group(self):
        box = scenes.collection("Box")
        host = scenes.cube("Host", collection=box)
        self.scatter(host, collection=self.pair(), join=True)
        for i in range(3):
            scenes.instance(f"Use {i}", box, (10 * i, 0, 0), (1, 1 + i, -1), (0, 0, i))
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Host": 3, "A": 24, "B": 24})
        groups = [
            s.name
            for s in map(extraction.model.object_summary, extraction.model.objects())
            if s.group
        ]
        self.assertEqual(sorted(groups), ["Box", "Host instances", "Scene"])

    def test_particles_show_an_object_a_collection_or_all_of_it(self):
        pair = self.pair()
        scenes.particles(scenes.cube("One"), 5, instance_object=pair.objects["A"])
        scenes.particles(scenes.cube("Some", (5, 0, 0)), 6, instance_collection=pair)
        scenes.particles(
            scenes.cube("All", (9, 0, 0)), 7, instance_collection=pair, use_whole_collection=True
        )
        self.scene.frame_set(2)
        extraction, _ = self.extract()
        shown = self.named(extraction)
        self.assertEqual(shown["A"] + shown["B"], 5 + 6 + 14)
        self.assertEqual((shown["One"], shown["Some"], shown["All"]), (1, 1, 1))

    def test_an_emitter_that_is_not_shown_shows_its_particles(self):
        emitter = scenes.cube("Emitter")
        scenes.particles(emitter, 5, instance_object=scenes.cube("Stone", (0, 0, 5), 0.2))
        emitter.show_instancer_for_render = False
        self.scene.frame_set(2)
        extraction, _ = self.extract()
        self.assertEqual(self.named(extraction), {"Stone": 6})

    def test_vertices_and_faces_show_children_and_their_collections(self):
        verts = scenes.cube("Verts", size=3)
        verts.instance_type = "VERTS"
        scenes.cube("Child", size=0.3).parent = verts
        faces = scenes.cube("Faces", (9, 0, 0), 3)
        faces.instance_type, faces.use_instance_faces_scale = "FACES", True
        scenes.instance("Pairs", self.pair()).parent = faces
        extraction, _ = self.extract()
        shown = self.named(extraction)
        # An instancing parent is drawn only when told so, which is Blender's default
        self.assertEqual((shown["Child"], shown["A"], shown["B"]), (8, 6, 6))

    def test_a_meadow_is_grouped_by_position_under_its_emitter(self):
        grid = 25
        vertices = [(i % grid, i // grid, 0) for i in range(grid * grid)]
        host = scenes.link(bpy.data.objects.new("Meadow", scenes.mesh("Meadow", vertices, [])))
        self.scatter(host, collection=self.pair())
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 2 * grid * grid)
        model = extraction.model
        summaries = [model.object_summary(item) for item in model.objects()]
        self.assertLessEqual(max(s.child_count for s in summaries), 64)
        uids = {s.uid for s in summaries}
        self.assertEqual(len(uids), len(summaries))
        self.assertGreater(len(uids), 2 * grid * grid // 64)
        again, _ = self.extract()
        other = {again.model.object_summary(item).uid for item in again.model.objects()}
        self.assertEqual(uids, other)


class Families(Case):
    def test_arrays_and_mirrors_are_one_mesh_at_render_level(self):
        item = scenes.cube("Row")
        item.modifiers.new("Array", "ARRAY").count = 5
        item.modifiers.new("Mirror", "MIRROR").use_axis = (False, True, False)
        subdivided = scenes.cube("Round", (0, 9, 0)).modifiers.new("Subdivision", "SUBSURF")
        subdivided.levels, subdivided.render_levels = 0, 3
        off = scenes.cube("Off", (0, 5, 0)).modifiers.new("Subdivision", "SUBSURF")
        off.show_render = False
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 3)
        self.assertEqual(self.triangles(extraction, "Row"), 2 * 5 * 12)
        self.assertEqual(self.triangles(extraction, "Round"), 2 * 6 * 4**3)
        self.assertEqual(self.triangles(extraction, "Off"), 12)

    def test_a_metaball_family_is_one_mesh_on_its_mother(self):
        for i in range(3):
            bpy.ops.object.metaball_add(location=(9 + i, 0, 0))
        bpy.ops.object.metaball_add(location=(0, 0, 9))
        bpy.context.object.name = "Loner"
        self.assertEqual(len(self.extract()[1]), 2)

    def test_curves_of_all_kinds_within_instanced_collections(self):
        inner = scenes.collection("Inner")
        curve = bpy.data.curves.new("Pipe", "CURVE")
        curve.splines.new("POLY").points.add(1)
        curve.splines[0].points[1].co = (2, 0, 0, 1)
        curve.bevel_depth = 0.1
        scenes.link(bpy.data.objects.new("Pipe", curve), inner)
        text = bpy.data.curves.new("Words", "FONT")
        text.body, text.extrude = "Lode", 0.1
        scenes.link(bpy.data.objects.new("Words", text), inner)
        for i in range(4):
            scenes.instance(f"Use {i}", inner, (0, 5 * i, 0))
        extraction, occurrences = self.extract()
        self.assertEqual((len(occurrences), len(extraction.leaves)), (8, 2))


class Sharing(Case):
    def test_content_equal_meshes_of_many_datablocks_are_built_and_stored_once(self):
        for i in range(6):
            scenes.cube(f"Copy {i}", (2 * i, 0, 0))
        rounded = scenes.cube_mesh("Rounded")
        for i in range(4):  # a mesh each, made by the modifier
            item = scenes.cube(f"Round {i}", (2 * i, 5, 0), data=rounded)
            item.modifiers.new("Subdivision", "SUBSURF").render_levels = 4
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 10)
        model = extraction.model
        hashes = {model.representation(leaf.object, 0).hash for leaf in extraction.leaves}
        self.assertEqual(len(hashes), 2)
        with tempfile.TemporaryDirectory() as folder:
            report = model.build(folder)
            stored = len(list(Path(folder, "r").glob("*.glb")))
        self.assertEqual(report.built, 3)  # a cube, a round one, the scene
        distinct = {
            model.representation(item, lod).hash
            for item in model.objects()
            for lod in range(model.object_summary(item).representation_count)
            if model.representation(item, lod).kind != 8
        }
        self.assertEqual(stored, len(distinct))
        lists = {
            tuple(
                model.representation(leaf.object, lod).hash
                for lod in range(model.object_summary(leaf.object).representation_count)
            )
            for leaf in extraction.leaves
        }
        self.assertEqual(len(lists), 2)

    def test_object_color_splits_leaves_where_a_material_shows_it(self):
        plain, shows = scenes.material("Plain"), scenes.material("Shows")
        nodes = shows.node_tree.nodes
        info = nodes.new("ShaderNodeObjectInfo")
        socket = nodes["Principled BSDF"].inputs["Base Color"]
        shows.node_tree.links.new(info.outputs["Color"], socket)
        for material in (plain, shows):
            data = scenes.cube_mesh(material.name)
            data.materials.append(material)
            for i in range(4):
                item = scenes.cube(f"{material.name} {i}", (2 * i, 0, 0), data=data)
                item.color = (0.25 * (i % 2), 0.5, 0, 1)
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 8)
        self.assertEqual(
            sorted(leaf.data for leaf in extraction.leaves), ["Plain", "Shows", "Shows"]
        )
        colors = set()
        for leaf in extraction.leaves:
            if leaf.data == "Shows":
                colors.add(tuple(round(c, 5) for c in extraction.model.measure(leaf.object).color))
        self.assertEqual(colors, {(0.0, 0.5, 0.0), (0.25, 0.5, 0.0)})

    def test_random_splits_leaves_of_a_shared_mesh_into_a_few(self):
        """Trees whose color is Random's were all the mean's."""
        shows = scenes.material("Shows")
        info = shows.node_tree.nodes.new("ShaderNodeObjectInfo")
        socket = shows.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
        shows.node_tree.links.new(info.outputs["Random"], socket)
        shared, own = scenes.cube_mesh("Shared"), scenes.cube_mesh("Own")
        for data in (shared, own):
            data.materials.append(shows)
        for i in range(100):
            scenes.cube(f"Cube {i}", (2 * i, 0, 0), data=shared).color = (0, 0, i / 100, 1)
        scenes.cube("Alone", (0, 2, 0), data=own)
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), 101)
        grays = {"Shared": set(), "Own": set()}
        for leaf in extraction.leaves:
            grays[leaf.data].add(extraction.model.measure(leaf.object).color[0])
        self.assertEqual(len(grays["Shared"]), object_random.GRADES)
        (alone,) = grays["Own"]
        self.assertAlmostEqual(alone, object_random.random_of("Alone"), delta=1e-6)

    def test_an_instance_has_the_color_of_its_instancer_also_the_second_one(self):
        shows = scenes.material("Shows")
        nodes = shows.node_tree.nodes
        info = nodes.new("ShaderNodeObjectInfo")
        socket = nodes["Principled BSDF"].inputs["Base Color"]
        shows.node_tree.links.new(info.outputs["Color"], socket)
        inner = scenes.collection("Inner")
        cube = scenes.cube("Cube", collection=inner)
        cube.data.materials.append(shows)
        cube.color = (1.0, 0.0, 0.0, 1.0)
        for i, green in enumerate((0.25, 0.5, 0.75)):
            empty = scenes.instance(f"Empty {i}", inner, (2 * i, 0, 0))
            empty.color = (0.0, green, 0.0, 1.0)
        extraction, occurrences = self.extract()
        shown = {}
        for item, world in occurrences:
            shown[world[3]] = extraction.model.measure(item).color[1]
        self.assertEqual([round(shown[x], 5) for x in (0.0, 2.0, 4.0)], [0.25, 0.5, 0.75])

    def test_an_instance_is_textured_from_where_it_stands_also_the_second_one(self):
        """Coordinates of the world: at every place the same mesh shows another part."""
        paint = scenes.material("Paint")
        tree = paint.node_tree
        image = tree.nodes.new("ShaderNodeTexImage")
        image.image = bpy.data.images.new("Grid", 4, 4)
        place = tree.nodes.new("ShaderNodeNewGeometry")
        tree.links.new(place.outputs["Position"], image.inputs["Vector"])
        socket = tree.nodes["Principled BSDF"].inputs["Base Color"]
        tree.links.new(image.outputs["Color"], socket)
        inner = scenes.collection("Inner")
        scenes.cube("Cube", collection=inner).data.materials.append(paint)
        for i in range(3):
            scenes.instance(f"Empty {i}", inner, (0.3 * i, 0, 0))
        extraction, _ = self.extract()
        hashes = {
            extraction.model.representation(leaf.object, 0).hash for leaf in extraction.leaves
        }
        self.assertEqual(len(hashes), 3)


class Libraries(Case):
    def test_linked_and_overridden_collections(self):
        with tempfile.TemporaryDirectory() as folder:
            library = str(Path(folder) / "library.blend")
            shelf = scenes.collection("Shelf", self.root)
            scenes.cube("Book", (1, 0, 0), collection=shelf)
            scenes.cube("Lamp", (2, 0, 0), collection=shelf)
            shelf.objects["Lamp"].lodestone.role = "ENVIRONMENT"
            bpy.ops.wm.save_as_mainfile(filepath=library)
            self.scene = scenes.fresh()
            with bpy.data.libraries.load(library, link=True) as (_, wanted):
                wanted.collections = ["Shelf"]
            shelf = bpy.data.collections["Shelf", library]
            scenes.instance("Linked", shelf, (0, 5, 0))
            scenes.instance("Linked Too", shelf, (0, 9, 0))
            override = shelf.override_hierarchy_create(
                bpy.context.scene, bpy.context.view_layer, do_fully_editable=True
            )
            override.objects["Book"].location = (7, 7, 7)
            extraction, occurrences = self.extract()
            self.assertEqual(self.named(extraction), {"Book": 3, "Lamp": 3})
            places = {tuple(round(v, 3) for v in world[3::4]) for _, world in occurrences}
            self.assertIn((7.0, 7.0, 7.0), places)
            uids = [extraction.model.object_summary(o).uid for o in extraction.model.objects()]
            self.assertEqual(len(uids), len(set(uids)))
            again, _ = self.extract()
            others = [again.model.object_summary(o).uid for o in again.model.objects()]
            self.assertEqual(uids, others)

    def test_roles_of_linked_things_are_kept_in_the_local_file(self):
        from lodestone.bridge import object_decisions

        with tempfile.TemporaryDirectory() as folder:
            library = str(Path(folder) / "library.blend")
            shelf = scenes.collection("Shelf", self.root)
            scenes.cube("Book", collection=shelf)
            scenes.cube("Lamp", (2, 0, 0), collection=shelf)
            shelf.objects["Lamp"].lodestone.role = "ENVIRONMENT"
            bpy.ops.wm.save_as_mainfile(filepath=library)
            self.scene = scenes.fresh()
            with bpy.data.libraries.load(library, link=True) as (_, wanted):
                wanted.collections = ["Shelf"]
            shelf = bpy.data.collections["Shelf", library]
            scenes.instance("Use", shelf)
            self.assertEqual(self.roles(), {"Book": 0, "Lamp": 1})
            objects, scene = bpy.data.objects, bpy.context.scene
            object_decisions.decide_linked(scene, "object", objects["Book", library], "ENVIRONMENT")
            object_decisions.decide_linked(scene, "object", objects["Lamp", library], "ORDINARY")
            self.assertEqual(self.roles(), {"Book": 1, "Lamp": 2})
            user = str(Path(folder) / "user.blend")
            bpy.ops.wm.save_as_mainfile(filepath=user)
            bpy.ops.wm.open_mainfile(filepath=user)
            self.assertEqual(self.roles(), {"Book": 1, "Lamp": 2})
            objects, scene = bpy.data.objects, bpy.context.scene
            library = bpy.data.libraries[0].filepath
            self.assertTrue(library.startswith("//"), library)  # saving made it relative
            book, lamp = objects["Book", library], objects["Lamp", library]
            self.assertEqual(object_decisions.linked_role(scene, "object", lamp), "ORDINARY")
            object_decisions.decide_linked(scene, "object", book, None)
            object_decisions.decide_linked(scene, "object", lamp, None)
            self.assertEqual(self.roles(), {"Book": 0, "Lamp": 1})
            self.assertFalse(scene.is_property_set("lodestone"))
            shelf = bpy.data.collections["Shelf", library]
            object_decisions.decide_linked(scene, "collection", shelf, "ENVIRONMENT")
            self.assertEqual(self.roles(), {"Book": 1, "Lamp": 1})
            self.assertTrue(object_decisions.forget_linked(scene))
            self.assertEqual(self.roles(), {"Book": 0, "Lamp": 1})

    def roles(self):
        extraction, _ = self.extract()
        model = extraction.model
        return {leaf.data: model.object_summary(leaf.object).role for leaf in extraction.leaves}

    def test_a_library_that_is_gone_leaves_the_rest(self):
        with tempfile.TemporaryDirectory() as folder:
            library = Path(folder) / "library.blend"
            scenes.cube("Gone", collection=scenes.collection("Gone", self.root))
            bpy.ops.wm.save_as_mainfile(filepath=str(library))
            self.scene = scenes.fresh()
            with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
                wanted.collections = ["Gone"]
            scenes.instance("Linked", bpy.data.collections["Gone", str(library)])
            scenes.cube("Here")
            user = str(Path(folder) / "user.blend")
            bpy.ops.wm.save_as_mainfile(filepath=user)
            library.unlink()
            bpy.ops.wm.open_mainfile(filepath=user)
            extraction, _ = self.extract()
            self.assertEqual(self.named(extraction), {"Here": 1})


if __name__ == "__main__":
    unittest.main()
