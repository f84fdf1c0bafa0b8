# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards Check Scene: it finds what F12 would report, without a render, and in no time."""

import os
import tempfile
import time
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes

FEW = {"no_camera", "povray_missing", "folder_unwritable", "nothing_to_render"}


def check():
    from lodestone.operators.check_scene import check_scene

    return check_scene(bpy.context)


def told(problems):
    return sorted((p.severity, p.code, p.kind, p.object, p.message) for p in problems)


def odd_material(name="Odd", image=None):
    """A material that is not exact: its color comes from a noise texture or an image."""
    made = scenes.material(name)
    tree = made.node_tree
    node = tree.nodes.new("ShaderNodeTexImage" if image else "ShaderNodeTexNoise")
    if image:
        node.image = image
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    tree.nodes["Principled BSDF"].inputs["Subsurface"].default_value = 0.5
    return made


def wearing(item, *materials):
    for material in materials:
        item.data.materials.append(material)
    return item


class Problems(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def with_environment(self, name, value):
        before = os.environ.get(name)
        self.addCleanup(
            lambda: os.environ.pop(name, None)
            if before is None
            else os.environ.__setitem__(name, before)
        )
        os.environ[name] = value

    def finds_what_a_render_finds(self):
        """Check Scene against the extraction of F12; returns the check."""
        found = check()
        extraction, _ = scenes.extract(False, [("", None)])
        with extraction.model as model:
            empty = model.totals().occurrences == 0
        expected = told(extraction.problems)
        mine = [p for p in found.problems if p.code not in FEW]
        self.assertEqual(told(mine), expected)
        self.assertEqual(found.users, extraction.users)
        self.assertEqual(empty, any(p.code == "nothing_to_render" for p in found.problems))
        return found

    def codes(self, found):
        return [p.code for p in found.problems]

    # ---- What is found ----

    def test_an_empty_scene_has_nothing_to_render(self):
        found = self.finds_what_a_render_finds()
        self.assertEqual(self.codes(found), ["nothing_to_render"])

    def test_a_plain_scene_has_no_problem(self):
        wearing(scenes.cube(), scenes.material("Plain"))
        scenes.sun().data.angle = 0.0
        found = self.finds_what_a_render_finds()
        self.assertEqual((self.codes(found), found.exact_materials), ([], (1, 1)))

    def test_materials_lights_world_camera_and_kinds_as_in_a_render(self):
        wearing(scenes.cube("Cube"), odd_material("Bark"), scenes.material("Plain"))
        for kind in ("AREA", "SPOT", "POINT", "SUN"):
            data = bpy.data.lights.new(kind, kind)
            scenes.link(bpy.data.objects.new(kind, data))
        world = bpy.data.worlds.new("World")
        world.use_nodes = True
        sky = world.node_tree.nodes.new("ShaderNodeTexSky")
        background = world.node_tree.nodes["Background"]
        world.node_tree.links.new(sky.outputs[0], background.inputs["Color"])
        self.scene.world = world
        self.scene.camera.data.type = "PANO"
        scenes.link(bpy.data.objects.new("Fog", bpy.data.volumes.new("Fog")))
        broken = scenes.cube("Broken")
        broken.location.x = float("nan")
        found = self.finds_what_a_render_finds()
        kinds = {p.kind for p in found.problems}
        self.assertTrue({"material", "object", "world", "camera"} <= kinds, found.problems)
        self.assertEqual(found.exact_materials[0], 0)  # the second slot has no face

    def test_what_povray_cannot_do_of_lights_is_found_as_by_a_render(self):
        from lodestone.core.session.addon_session import addon_session

        scenes.cube("Cube")
        kinds = {"Softbox": "AREA", "Dot": "AREA", "Lamp": "SPOT", "Ball": "POINT"}
        for name, kind in kinds.items():
            data = bpy.data.lights.new(name, kind)
            data.use_shadow = False
            item = scenes.link(bpy.data.objects.new(name, data))
            item.location.z = 3.0
            if kind == "AREA":
                data.spread = 0.8
        bpy.data.objects["Dot"].scale.x = 0.0
        found = told(check().problems)
        self.assertEqual([code for _, code, *_ in found].count("light_shadow"), 3)
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.render.resolution_x, self.scene.render.resolution_y = 8, 8
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        bpy.ops.render.render()
        self.assertEqual(told(addon_session().checks.get(self.scene.name).problems), found)

    def test_texts_curves_and_metaballs_wear_materials_too(self):
        for kind, data in (
            ("Text", bpy.data.curves.new("Text", "FONT")),
            ("Ball", bpy.data.metaballs.new("Ball")),
        ):
            data.materials.append(odd_material(f"{kind} paint"))
            scenes.link(bpy.data.objects.new(kind, data))
        bpy.data.curves["Text"].body = "ab"
        bpy.data.metaballs["Ball"].elements.new()
        found = self.finds_what_a_render_finds()
        self.assertEqual(len(found.users), 2, found.users)

    def test_collections_in_collections_are_looked_into(self):
        house = scenes.collection("House")
        wearing(scenes.cube("Wall", collection=house), odd_material("Plaster"))
        row = scenes.collection("Row")
        for i in range(3):
            scenes.instance(f"House.{i}", house, (3 * i, 0, 0), parent=row)
        scenes.instance("Street", row)
        found = self.finds_what_a_render_finds()
        self.assertEqual(found.users, {("material", "", "Plaster"): (("object", "", "Wall"),)})

    def test_the_same_material_counts_every_object_that_shows_it(self):
        shared = odd_material("Bark_old")
        for i in range(12):
            wearing(scenes.cube(f"Tree.{i}", (2 * i, 0, 0)), shared)
        found = self.finds_what_a_render_finds()
        rows = [row.sentence for row in found.split().shown]
        self.assertTrue(all(row.startswith('Material "Bark_old": ') for row in rows), rows)
        self.assertTrue(all(row.endswith(" (12 objects)") for row in rows), rows)

    # ---- What is not ----

    def test_no_rows_for_empties_faceless_meshes_and_unused_materials(self):
        wearing(scenes.cube("Cube"), scenes.material("Plain"))
        scenes.link(bpy.data.objects.new("Empty", None))
        wire = scenes.mesh("Wire", [(0, 0, 0), (1, 0, 0)], [])
        wearing(scenes.link(bpy.data.objects.new("Wire", wire)), odd_material("On no face"))
        odd_material("On nothing").use_fake_user = True
        leftover = wearing(scenes.cube("Left"), scenes.material("Used"), odd_material("Left over"))
        self.assertEqual([p.material_index for p in leftover.data.polygons], [0] * 6)
        found = self.finds_what_a_render_finds()
        self.assertEqual(self.codes(found), [])
        self.assertEqual(found.exact_materials, (2, 2))

    def test_what_renders_hide_is_not_looked_at(self):
        wearing(scenes.cube("Cube"), scenes.material("Plain"))
        wearing(scenes.cube("Hidden"), odd_material("A")).hide_render = True
        hidden = scenes.collection("Hidden", self.scene.collection)
        wearing(scenes.cube("In hidden", collection=hidden), odd_material("B"))
        hidden.hide_render = True
        out = scenes.collection("Excluded", self.scene.collection)
        wearing(scenes.cube("In excluded", collection=out), odd_material("C"))
        layer = bpy.context.view_layer.layer_collection
        layer.children["Excluded"].exclude = True
        self.assertEqual(self.codes(self.finds_what_a_render_finds()), [])

    def test_what_only_renders_show_is_looked_at(self):
        wearing(scenes.cube("Cube"), scenes.material("Plain"))
        wearing(scenes.cube("No viewport"), odd_material("A")).hide_viewport = True
        wearing(scenes.cube("Eye"), odd_material("B")).hide_set(True)
        data = bpy.data.lights.new("Lamp", "AREA")
        scenes.link(bpy.data.objects.new("Lamp", data)).hide_viewport = True
        inner, outer = scenes.collection("Inner"), scenes.collection("Outer")
        wearing(scenes.cube("Deep", collection=inner), odd_material("C"))
        scenes.instance("House", inner, parent=outer)
        scenes.instance("Street", outer).hide_viewport = True
        found = self.finds_what_a_render_finds()
        names = {p.object for p in found.problems if p.kind == "material"}
        self.assertEqual(names, {"A", "B", "C"})

    def test_what_nodes_and_particles_show_is_looked_at(self):
        host = wearing(scenes.cube("Host", size=4.0), scenes.material("Plain"))
        pebble = wearing(scenes.cube("Pebble", size=0.1), odd_material("Pebble paint"))
        pebble.hide_render = pebble.hide_viewport = True
        tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
        made = [
            tree.nodes.new(kind)
            for kind in (
                "NodeGroupInput",
                "GeometryNodeInstanceOnPoints",
                "GeometryNodeMeshCube",
                "GeometryNodeSetMaterial",
                "NodeGroupOutput",
            )
        ]
        start, instance, box, paint, end = made
        paint.inputs["Material"].default_value = odd_material("By nodes")
        tree.links.new(start.outputs[0], instance.inputs["Points"])
        tree.links.new(box.outputs[0], paint.inputs[0])
        tree.links.new(paint.outputs[0], instance.inputs["Instance"])
        tree.links.new(instance.outputs[0], end.inputs[0])
        host.modifiers.new("Scatter", "NODES").node_group = tree
        field = wearing(scenes.cube("Field", (9, 0, 0)), scenes.material("Grass"))
        settings = field.modifiers.new("Particles", "PARTICLE_SYSTEM").particle_system.settings
        settings.count, settings.frame_end = 5, 1
        settings.render_type, settings.instance_object = "OBJECT", pebble
        found = self.finds_what_a_render_finds()
        names = {name for _, _, name in found.users}
        self.assertEqual(names, {"By nodes", "Grass", "Pebble paint"})

    def test_every_view_layer_that_renders_is_checked(self):
        from lodestone.core.session.addon_session import addon_session

        for name in ("A", "B", "C"):
            kept = scenes.collection(name, self.scene.collection)
            wearing(scenes.cube(name, collection=kept), odd_material(name))
        first = bpy.context.view_layer
        second, unused = (self.scene.view_layers.new(name) for name in ("Second", "Unused"))
        unused.use = False
        for layer, wanted in ((first, "A"), (second, "B"), (unused, "C")):
            for child in layer.layer_collection.children:
                child.exclude = child.name != wanted
        found = check()
        self.assertEqual({name for _, _, name in found.users}, {"A", "B"})
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.render.resolution_x, self.scene.render.resolution_y = 8, 8
        bpy.ops.render.render()
        rendered = addon_session().checks.get(self.scene.name)
        self.assertEqual(told(rendered.problems), told(found.problems))
        self.assertEqual(rendered.users, found.users)
        self.scene.render.use_single_layer = True
        self.assertEqual({name for _, _, name in check().users}, {"A"})

    # ---- The setup ----

    def test_a_missing_camera_povray_and_folder_are_found(self):
        scenes.cube()
        bpy.data.objects.remove(self.scene.camera)
        self.with_environment("LODESTONE_POVRAY", "/nowhere/povray")
        blocked = self.folder / "file"
        blocked.write_text("in the way")
        self.with_environment("LODESTONE_CACHE", str(blocked))
        found = check()
        self.assertEqual(
            sorted(self.codes(found)), ["folder_unwritable", "no_camera", "povray_missing"]
        )
        self.assertTrue(all(row.about_setup for row in found.split().shown))

    def test_a_missing_library_and_a_missing_image_are_found(self):
        library = self.folder / "library.blend"
        wearing(scenes.cube("Linked"), scenes.material("Paint"))
        bpy.data.libraries.write(str(library), {bpy.data.objects["Linked"]})
        self.scene = scenes.fresh()
        with bpy.data.libraries.load(str(library), link=True) as (_, target):
            target.objects = ["Linked"]
        scenes.link(target.objects[0])
        image = bpy.data.images.load(str(self._picture("gone.png")))
        wearing(scenes.cube("Cube"), odd_material("Poster", image))
        before = check().problems
        self.assertEqual([p for p in before if p.code == "library_missing"], [])
        image.filepath = str(self.folder / "nowhere.png")
        image.reload()
        library.unlink()
        found = check()
        libraries = [p for p in found.problems if p.code == "library_missing"]
        self.assertEqual([(p.object, p.severity) for p in libraries], [("library.blend", "error")])
        images = [p for p in found.problems if "gone.png" in p.message]
        self.assertEqual([p.object for p in images], ["Poster"], found.problems)
        self.assertTrue(all("gone.png" not in p.message for p in before), before)

    def _picture(self, name):
        path = self.folder / name
        image = bpy.data.images.new(name, 2, 2)
        image.filepath_raw, image.file_format = str(path), "PNG"
        image.save()
        bpy.data.images.remove(image)
        return path

    def test_equal_names_in_two_libraries_stay_apart(self):
        library = self.folder / "library.blend"
        wearing(scenes.cube("Tree"), odd_material("Bark"))
        bpy.data.libraries.write(str(library), {bpy.data.objects["Tree"]})
        wearing(scenes.cube("Own"), bpy.data.materials["Bark"])
        bpy.data.objects.remove(bpy.data.objects["Tree"])
        with bpy.data.libraries.load(str(library), link=True) as (_, target):
            target.objects = ["Tree"]
        scenes.link(target.objects[0])
        found = self.finds_what_a_render_finds()
        self.assertEqual(len(found.users), 2)
        self.assertEqual(len({p.subject for p in found.problems}), 2)
        rows = found.split().shown
        self.assertTrue(all(len(row.problems) == 2 and len(row.objects) == 2 for row in rows))

    # ---- F12 ----

    def test_a_render_leaves_its_check_even_when_it_is_refused(self):
        from lodestone.core.session.addon_session import addon_session

        wearing(scenes.cube(), odd_material("Bark"))
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.render.resolution_x, self.scene.render.resolution_y = 8, 8
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        checked = check()
        addon_session().checks.clear()
        bpy.ops.render.render()
        rendered = addon_session().checks.get(self.scene.name)
        self.assertEqual(told(rendered.problems), told(checked.problems))
        self.assertEqual(rendered.users, checked.users)
        self.assertFalse(self.scene.is_property_set("lodestone"), "rendering writes nothing")
        self.with_environment("LODESTONE_POVRAY", "/nowhere/povray")
        with self.assertRaisesRegex(RuntimeError, "/nowhere/povray"):
            bpy.ops.render.render()
        refused = addon_session().checks.get(self.scene.name)
        self.assertEqual([p.code for p in refused.problems], ["povray_missing"])

    # ---- Buttons ----

    def row(self, words):
        found = check().split(self.ignored())
        (cause,) = [row for row in found.shown if words in row.sentence]
        return cause.key

    def ignored(self):
        from lodestone.bridge import ignored_problems

        return ignored_problems.keys(self.scene)

    def test_select_selects_what_wears_a_material(self):
        shared = odd_material("Bark")
        trees = [wearing(scenes.cube(f"Tree.{i}", (2 * i, 0, 0)), shared) for i in range(4)]
        scenes.cube("Other").select_set(True)
        trees[3].hide_set(True)
        outcome = bpy.ops.lodestone.select_problem(key=self.row("Noise"))
        self.assertEqual(outcome, {"FINISHED"})
        selected = {item.name for item in bpy.context.selected_objects}
        self.assertEqual(selected, {"Tree.0", "Tree.1", "Tree.2"})
        self.assertIn(bpy.context.view_layer.objects.active.name, selected)

    def test_select_finds_the_instances_of_what_is_no_object_of_the_scene(self):
        inner = scenes.collection("Inner")
        wearing(scenes.cube("Wall", collection=inner), odd_material("Plaster"))
        outer = scenes.collection("Outer")
        scenes.instance("House", inner, parent=outer)
        for i in range(2):
            scenes.instance(f"Street.{i}", outer, (5 * i, 0, 0))
        bpy.ops.lodestone.select_problem(key=self.row("Noise"))
        selected = {item.name for item in bpy.context.selected_objects}
        self.assertEqual(selected, {"Street.0", "Street.1"})

    def test_select_of_something_that_is_gone_says_so(self):
        scenes.cube("Other").select_set(True)
        wearing(scenes.cube("Cube"), odd_material("Bark"))
        key = self.row("Noise")
        bpy.data.objects.remove(bpy.data.objects["Cube"])
        self.assertEqual(bpy.ops.lodestone.select_problem(key=key), {"CANCELLED"})
        self.assertEqual(bpy.ops.lodestone.select_problem(key="nonsense"), {"CANCELLED"})
        self.assertTrue(bpy.data.objects["Other"].select_get())

    def test_ignored_problems_are_kept_in_the_file_and_can_be_restored(self):
        wearing(scenes.cube("Cube"), odd_material("Bark"))
        before = len(check().split().shown)
        self.assertFalse(self.scene.is_property_set("lodestone"), "checking writes nothing")
        bpy.ops.lodestone.ignore_problem(key=self.row("Noise"))
        self.assertEqual(len(check().split(self.ignored()).shown), before - 1)
        path = str(self.folder / "ignored.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        self.scene = bpy.context.scene
        found = check().split(self.ignored())
        self.assertEqual((len(found.shown), len(found.ignored)), (before - 1, 1))
        bpy.ops.lodestone.restore_problems()
        self.assertEqual(len(check().split(self.ignored()).shown), before)
        self.assertFalse(self.scene.is_property_set("lodestone"), "nothing of ours is left")

    def test_copied_text_tells_everything(self):
        from lodestone.operators.problems import text_of

        self.assertFalse(bpy.ops.lodestone.copy_problems.poll())
        name = 'Ba"rk\n#*/'
        wearing(scenes.cube("Cube"), odd_material(name))
        key = self.row("Noise")
        one, every = text_of(bpy.context, key), text_of(bpy.context)
        self.assertIn(name, one)
        self.assertIn('"Cube"', one)
        self.assertNotIn("materials exact", one)
        self.assertIn("0 of 1 materials exact (0 %)", every)
        bpy.ops.lodestone.ignore_problem(key=key)
        self.assertIn("ignored warning: ", text_of(bpy.context))

    def test_another_file_has_not_been_checked(self):
        from lodestone.core.session.addon_session import addon_session

        wearing(scenes.cube(), odd_material())
        check()
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        self.assertIsNone(addon_session().checks.get(self.scene_name()))

    def scene_name(self):
        return bpy.context.scene.name

    # ---- Nothing is touched, and fast ----

    def test_checking_changes_nothing(self):
        wearing(scenes.cube("Cube"), odd_material("Bark"))
        blocks = (*bpy.data.objects, *bpy.data.materials, *bpy.data.collections, self.scene)
        keys = [list(item.keys()) for item in blocks]
        count = len(bpy.data.user_map())
        for _ in range(2):
            self.assertEqual(bpy.ops.lodestone.check_scene(), {"FINISHED"})
        self.assertEqual([list(item.keys()) for item in blocks], keys)
        self.assertEqual(len(bpy.data.user_map()), count)

    def test_a_million_instances_that_only_renders_show_are_looked_at_once(self):
        inner = scenes.collection("Inner")
        wearing(scenes.cube("Deep", collection=inner), odd_material("Deep"))
        for level in range(6):
            outer = scenes.collection(f"Level {level}")
            for i in range(10):
                scenes.instance(f"Level {level} {i}", inner, (i, level, 0), parent=outer)
            inner = outer
        scenes.instance("All", inner).hide_viewport = True
        start = time.process_time()
        found = check()
        self.assertLess(time.process_time() - start, 2.0)
        self.assertEqual(list(found.users.values()), [(("object", "", "Deep"),)])

    def test_five_thousand_objects_are_checked_in_two_seconds(self):
        materials = [odd_material(f"Odd.{i}") for i in range(171)]
        materials += [scenes.material(f"Plain.{i}") for i in range(171)]
        meshes = []
        for number, material in enumerate(materials):
            made = scenes.cube_mesh(f"Mesh.{number}")
            made.materials.append(material)
            meshes.append(made)
        for i in range(5_000):
            scenes.cube(f"Cube.{i}", (i % 71, i // 71, 0), data=meshes[i % len(meshes)])
        bpy.context.view_layer.update()
        wall, cpu = time.monotonic(), time.process_time()
        found = check()
        wall, cpu = time.monotonic() - wall, time.process_time() - cpu
        rows = found.split().shown
        print(f"Check Scene, 5,000 objects, 342 materials: {wall:.2f} s, {cpu:.2f} s of processor")
        self.assertEqual(found.exact_materials, (171, 342))
        self.assertEqual(sum(len(users) for users in found.users.values()), 5_000)
        self.assertTrue(rows and all(len(row.problems) == 171 for row in rows), rows[:1])
        # The promise is 2 s of an idle processor; a busy machine must not fail the test
        self.assertLess(cpu, 4.0)


if __name__ == "__main__":
    unittest.main()
