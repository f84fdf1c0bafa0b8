# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the shortcut for plain objects: what is read in columns is what would be read one by one,
and nothing is taken for plain that is not."""

import unittest
from unittest import mock

import bpy

import blender_scenes as scenes
from blender_case import Case

MANY = 4100  # more than are asked at a stroke


def bridge():
    from lodestone.bridge import listed_instances
    from lodestone.bridge.motion import motion_sampling
    from lodestone.bridge.scene import plain_objects, shown_instances

    return shown_instances, listed_instances, motion_sampling, plain_objects


def one_by_one():
    """While it lasts, no object is taken for plain."""
    instances, _, _, plain = bridge()
    return mock.patch.object(instances, "find", lambda *_: plain.Plain())


def everything_in(model):
    """All objects in order, with what they place, and all that is shown."""
    told = []
    for item in model.objects():
        placed = [(child.index, *how) for child, *how in model.children(item)]
        told.append((item.index, model.object_summary(item), placed, model.decided(item)))
    lights = model.light_count()
    shown = [(item.index, rows) for item, rows in model.occurrences()]
    return told, shown, model.occurrences_hidden(), lights


def driven(item, path, expression="0.5"):
    item.driver_add(path, 0).driver.expression = expression
    return item


def colored(name):
    """A material that shows the object's color."""
    made = scenes.material(name)
    nodes = made.node_tree.nodes
    info = nodes.new("ShaderNodeObjectInfo")
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    made.node_tree.links.new(info.outputs["Color"], shader.inputs["Base Color"])
    return made


def glowing(name):
    made = scenes.material(name)
    shader = next(n for n in made.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    shader.inputs["Emission"].default_value = (1, 1, 1, 1)
    shader.inputs["Emission Strength"].default_value = 20
    return made


def parts_of(extraction):
    """What every object and collection of the file became, by key; of the model, numbers."""
    from lodestone.bridge import datablock_ids

    keys = [datablock_ids.key_of("object", item) for item in bpy.data.objects]
    keys += [datablock_ids.key_of("collection", item) for item in bpy.data.collections]
    return {key: sorted(item.index for item in extraction.parts.get(key, ())) for key in keys}


class PlainObjects(Case):
    def plain(self):
        """The names of what is taken for plain, and shown as such."""
        _, _, _, plain = bridge()
        found, kept = [], plain.Plain.rows

        def rows(columns):
            if columns.numbers:
                found.extend(columns.names[row] for row in kept(columns).values())
            return kept(columns)

        with mock.patch.object(plain.Plain, "rows", rows):
            self.extract()
        return sorted(found)

    def alike(self):
        """Extracts, with and without the shortcut: both must be the same in everything."""
        short, _ = self.extract()
        with one_by_one():
            long, _ = self.extract()
        for ours, theirs in zip(everything_in(short.model), everything_in(long.model)):
            self.assertEqual(repr(ours), repr(theirs))
        self.assertEqual(short.users, long.users)
        self.assertEqual(list(short.problems), list(long.problems))
        self.assertEqual((short.shown, short.lights), (long.shown, long.lights))
        self.assertEqual(parts_of(short), parts_of(long))
        return short

    # ---- Empty, smallest, many ----

    def test_nothing_is_plain_in_an_empty_scene(self):
        self.assertEqual(self.plain(), [])

    def test_a_cube_is_plain(self):
        scenes.cube("Cube", (1, 2, 3))
        self.assertEqual(self.plain(), ["Cube"])
        self.alike()

    def test_more_objects_than_are_asked_at_a_stroke(self):
        data = [scenes.cube_mesh("A"), scenes.cube_mesh("B")]
        for i in range(MANY):
            scenes.cube(f"Cube {i}", (i % 64, i // 64, 0), data=data[i % 2])
        extraction, occurrences = self.extract()
        self.assertEqual(len(occurrences), MANY)
        self.assertEqual(len({tuple(rows) for _, rows in occurrences}), MANY)
        self.assertEqual(self.named(extraction), {"A": MANY // 2, "B": MANY // 2})

    # ---- What is not plain ----

    def everything(self):
        """A scene of all that must not be taken for plain, with plain objects between."""
        data = scenes.cube_mesh("Shared")
        spot = iter(range(1, 1000))

        def cube(name, collection=None, of=None):
            place = (3.0 * next(spot), 0, 0)
            return scenes.cube(name, place, data=of or data, collection=collection)

        near, far = scenes.collection("Near", self.root), scenes.collection("Far", self.root)
        cube("Plain 1", near)
        cube("Mirrored").scale = (-1, 2, 1)
        cube("Array").modifiers.new("Array", "ARRAY").count = 2
        cube("Hidden").hide_render = True
        cube("Not In Mirrors").visible_glossy = False
        cube("Holdout").is_holdout = True
        cube("Catcher").is_shadow_catcher = True
        cube("Fixed").parent = bpy.data.objects["Mirrored"]
        mover = driven(cube("Driven"), "location")
        cube("Carried").parent = mover
        cube("Limited").constraints.new("LIMIT_LOCATION")
        cube("Follower").constraints.new("COPY_LOCATION").target = mover
        cube("Decided").lodestone.importance = 4.0
        cube("Plain 2", far)
        scenes.particles(cube("Emitter", of=scenes.cube_mesh("Emits")), 5, render_type="HALO")
        keyed = cube("Keyed", of=scenes.cube_mesh("Keys"))
        keyed.shape_key_add(name="Basis")
        keyed.shape_key_add(name="Key").value = 1.0
        for name in ("Red", "Green"):
            owner = cube(name, far, scenes.cube_mesh(name))
            owner.data.materials.append(colored(f"Color {name}"))
            owner.color = (1, 0, 0, 1) if name == "Red" else (0, 1, 0, 1)
        twice = cube("Blue", far, bpy.data.meshes["Red"])
        twice.color = (0, 0, 1, 1)
        shines = cube("Lamp", of=scenes.cube_mesh("Bulb"))
        shines.data.materials.append(glowing("Glow"))
        cube("Second Lamp", of=shines.data)
        slots = scenes.cube_mesh("Slots")
        slots.materials.append(scenes.material("Data"))
        cube("By Data", of=slots)
        by_object = cube("By Object", of=slots)
        by_object.material_slots[0].link = "OBJECT"
        by_object.material_slots[0].material = scenes.material("Object")
        cube("By Nothing", of=slots).material_slots[0].link = "OBJECT"
        two = scenes.cube_mesh("Two Slots")
        for name in ("First", "Second"):
            two.materials.append(scenes.material(name))
        two.polygons[0].material_index = 1
        cube("Both By Data", of=two)
        half = cube("Half By Object", of=two)
        half.material_slots[1].link = "OBJECT"
        cube("Nothing", of=scenes.mesh("Nothing", [], []))
        scenes.link(bpy.data.objects.new("Empty", None))
        curve = bpy.data.curves.new("Text", "FONT")
        curve.body = "A"
        scenes.link(bpy.data.objects.new("Text", curve))
        tile = cube("Tiles", of=scenes.mesh("Tile", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
        tile.instance_type = "FACES"
        cube("Tiled", of=scenes.cube_mesh("Small", 0.1)).parent = tile
        scenes.instance("Far Again", far, (0, 50, 0))
        excluded = scenes.collection("Excluded", self.root)
        cube("Out", excluded)
        self.scene.view_layers[0].layer_collection.children["Excluded"].exclude = True
        scattered = cube("Scatter", of=scenes.cube_mesh("Ground"))
        modifier = scattered.modifiers.new("Nodes", "NODES")
        modifier.node_group = scenes.scatter_nodes(near)
        scenes.sun()
        cube("Plain 3")

    def test_what_is_not_plain_is_not_taken_for_it(self):
        self.everything()
        expected = {
            *("Plain 1", "Plain 2", "Plain 3", "Mirrored", "Fixed"),
            *("By Data", "By Object", "By Nothing", "Both By Data", "Half By Object"),
        }
        found = self.plain()
        self.assertEqual(len(found), len(set(found)))
        self.assertEqual(set(found) - {"Keyed"}, expected)

    def test_all_kinds_of_objects_are_read_as_one_by_one(self):
        self.everything()
        self.alike()

    def test_environment_is_told_from_what_is_made_of_the_same(self):
        data = scenes.cube_mesh("Shared")
        sky = scenes.collection("Sky", self.root)
        sky.lodestone.role = "ENVIRONMENT"
        for i in range(3):
            scenes.cube(f"Here {i}", (i, 0, 0), data=data)
            scenes.cube(f"There {i}", (i, 9, 0), data=data, collection=sky)
        self.assertEqual(len(self.plain()), 6)
        self.assertEqual(len(self.alike().leaves), 2)

    def test_a_collection_that_is_a_holdout_makes_nobody_plain(self):
        holes = scenes.collection("Holes", self.root)
        scenes.cube("Hole", collection=holes)
        scenes.cube("Plain", (3, 0, 0))
        self.scene.view_layers[0].layer_collection.children["Holes"].holdout = True
        self.assertEqual(self.plain(), [])

    # ---- Hostile ----

    def test_of_objects_at_places_that_are_no_numbers_only_these_are_left_out(self):
        data = scenes.cube_mesh("Shared")
        for i in range(4):
            scenes.cube(f"Cube {i}", (3 * i, 0, 0), data=data)
        for i in (0, 2):
            bpy.data.objects[f"Cube {i}"].scale = (float("nan"), 1, 1)
        extraction, request = scenes.extract(compare=False)
        self.addCleanup(extraction.model.close)
        places = sorted(rows[3] for _, rows in extraction.model.occurrences())
        self.assertEqual(places, [3.0, 9.0])
        self.assertEqual(
            self.codes(extraction), [("Cube 0", "bad_transform"), ("Cube 2", "bad_transform")]
        )

    # ---- What the columns rest upon ----

    def in_render(self, look):
        """Calls look(depsgraph) where a picture would be rendered."""

        class Engine(bpy.types.RenderEngine):
            bl_idname, bl_label = "LODESTONE_TEST_ORDER", "Order"

            def render(self, depsgraph):
                look(depsgraph)

        bpy.utils.register_class(Engine)
        try:
            self.scene.render.engine = Engine.bl_idname
            bpy.ops.render.render()
        finally:
            bpy.utils.unregister_class(Engine)

    def test_objects_are_listed_in_the_order_of_their_instances(self):
        _, listed, _, _ = bridge()
        self.everything()
        told = []

        def look(depsgraph):
            numbers, objects = listed.Listed(depsgraph).objects()
            names = dict(zip(numbers, (item.name for item in objects)))
            del objects
            for number, instance in enumerate(depsgraph.object_instances):
                if not instance.is_instance:
                    told.append((names.pop(number, None), instance.object.name))
            told.append((names, {}))

        self.in_render(look)
        self.assertGreater(len(told), 20)
        for ours, blenders in told:
            self.assertEqual(ours, blenders)

    def test_what_is_listed_is_what_blender_lists(self):
        _, listed, _, _ = bridge()
        told = []

        def about(number, instance):
            rows = [tuple(row) for row in instance.matrix_world]
            shown = (instance.is_instance, instance.show_self, instance.show_particles)
            return (number, instance.object.name, *shown, rows)

        def look(depsgraph):
            ours = [about(*item) for item in listed.Listed(depsgraph)]
            blenders = [about(*item) for item in enumerate(depsgraph.object_instances)]
            told.append((ours, blenders))

        for i in range(3):
            scenes.cube(f"Cube {i}", (i, 2, 3)).rotation_euler = (i, 1, 2)
        self.in_render(look)  # nothing emits
        instancer = scenes.cube("Instancer")
        instancer.instance_type, instancer.show_instancer_for_render = "VERTS", False
        self.in_render(look)  # nothing is instanced, but not all is shown
        emitter = scenes.cube("Emitter")
        emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
        emitter.show_instancer_for_render = False
        self.in_render(look)
        scenes.cube("Instance").parent = instancer
        self.in_render(look)
        self.assertEqual(len(told), 4)
        for ours, blenders in told:
            self.assertGreaterEqual(len(blenders), 3)
            self.assertEqual(ours, blenders)
        hidden = [name for _, name, _, shown, _, _ in told[2][0] if not shown]
        self.assertEqual(hidden, ["Emitter"])

    def test_a_check_of_the_scene_finds_the_same_one_by_one(self):
        from lodestone.operators.check_scene import check_scene

        self.everything()
        short = check_scene(bpy.context)
        with one_by_one():
            long = check_scene(bpy.context)
        self.assertEqual(short.problems, long.problems)
        self.assertEqual(short.users, long.users)


if __name__ == "__main__":
    unittest.main()
