# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards Use and Importance: what the designer decides about an object or collection reaches the
placements of the model, through collections, instances and emitters."""

import math
import os
import tempfile
import unittest
from pathlib import Path

import bmesh
import bpy

import blender_scenes as scenes
from blender_case import Case
from lodestone.bridge import datablock_ids, object_decisions
from lodestone.core.native import lodestone_native as native

ANY = native.ANY_LEVEL
PLAIN = (1.0, ANY)


class Decisions(Case):
    def placed(self, extraction=None):
        """{path of names: (importance, coarsest)} of what has a decision."""
        model = (extraction or self.extract()[0]).model
        found = {}

        def look(group, path):
            for child, decided in zip(model.children(group), model.decided(group)):
                item, _, name, _ = child
                while f"{path}{name}" in found:
                    name += " again"
                if decided != PLAIN:
                    found[f"{path}{name}"] = decided
                look(item, f"{path}{name}/")

        look(model.find_object(datablock_ids.scene_uid("Scene")), "")
        return found

    def test_nothing_decided_leaves_no_trace(self):
        scenes.cube()
        self.assertEqual(self.placed(), {})

    def test_looking_at_the_panel_decides_nothing(self):
        cube = scenes.cube()
        self.assertEqual(cube.lodestone.importance, 1.0)
        self.assertFalse(object_decisions.decided(cube))
        self.assertEqual(self.placed(), {})

    def test_each_use_becomes_a_limit(self):
        for number, use in enumerate(("AUTOMATIC", "ORIGINAL", "LIMIT")):
            made = scenes.cube(use, (3 * number, 0, 0))
            made.lodestone.use = use
            made.lodestone.coarsest = 2
        self.assertEqual(self.placed(), {"ORIGINAL": (1.0, 0), "LIMIT": (1.0, 2)})

    def test_importances_of_collections_instances_and_objects_multiply_along_the_path(self):
        inner = scenes.collection("Inner")
        inner.lodestone.importance = 2.0
        scenes.cube("Screw", collection=inner).lodestone.importance = 0.5
        place = scenes.collection("Yard", self.root)
        place.lodestone.importance = 4.0
        scenes.instance("Crane", inner, parent=place).lodestone.importance = 3.0
        self.assertEqual(
            self.placed(),
            {"Yard": (4.0, ANY), "Yard/Crane": (6.0, ANY), "Yard/Crane/Screw": (0.5, ANY)},
        )

    def test_what_is_scattered_keeps_its_own(self):
        leaf = scenes.cube("Leaf", (0, 0, -5))
        leaf.lodestone.importance = 0.5
        ground = scenes.cube("Ground", size=4.0)
        ground.lodestone.importance = 2.0
        scenes.particles(ground, 3, instance_object=leaf)
        self.scene.frame_set(2)
        placed = {path.rpartition("in motion/")[2]: found for path, found in self.placed().items()}
        self.assertEqual(placed.pop("Leaf"), (0.5, ANY))
        self.assertEqual(placed.pop("Ground"), (2.0, ANY))
        self.assertEqual(placed.pop("Ground instances"), (2.0, ANY))
        self.assertEqual(list(placed.values()), [(0.5, ANY)] * 3)

    def test_what_is_excluded_is_in_no_collection_s_group(self):
        yard = scenes.collection("Yard", self.root)
        scenes.cube("Plain", collection=yard)
        scenes.cube("Hero", (3, 0, 0), collection=yard).lodestone.use = "EXCLUDE"
        stage = scenes.collection("Stage", yard)
        stage.lodestone.use = "EXCLUDE"
        scenes.cube("Prop", (6, 0, 0), collection=stage)
        self.assertEqual(
            self.placed(), {"Scene excluded/Stage": (1.0, 0), "Scene excluded/Hero": (1.0, 0)}
        )

    def test_two_users_of_one_mesh_may_differ(self):
        data = scenes.cube_mesh()
        scenes.cube("Left", data=data)
        scenes.cube("Right", (3, 0, 0), data=data).lodestone.importance = 8.0
        extraction, occurrences = self.extract()
        self.assertEqual(self.placed(extraction), {"Right": (8.0, ANY)})
        self.assertEqual(len({item.key for item, _ in occurrences}), 1)

    def test_equal_contents_with_other_decisions_are_other_groups(self):
        shared = scenes.collection("Shared")
        scenes.cube("Cube", collection=shared)
        scenes.instance("Left", shared, parent=self.root)
        scenes.instance("Right", shared, (5, 0, 0), parent=self.root).lodestone.use = "ORIGINAL"
        self.assertEqual(self.placed(), {"Right": (1.0, 0)})

    def test_environment_is_a_checkbox_that_leaves_nothing_when_it_is_off_again(self):
        floor = scenes.cube("Floor")
        self.assertFalse(floor.lodestone.environment)
        object_decisions.drop_empty(floor)  # looking at it decides nothing
        self.assertNotIn("lodestone", floor)
        floor.lodestone.environment = True
        self.assertEqual(
            (floor.lodestone.role, object_decisions.decided(floor)), ("ENVIRONMENT", True)
        )
        copied = scenes.cube("Copied")
        object_decisions.copy(floor, copied)
        self.assertTrue(copied.lodestone.environment)
        floor.lodestone.environment = False
        self.assertFalse(object_decisions.decided(floor))
        object_decisions.drop_empty(floor)
        self.assertNotIn("lodestone", floor)

    def test_deciding_about_a_thing_is_not_taken_for_another_shape(self):
        from lodestone.core.session.addon_session import addon_session

        mesh = scenes.cube_mesh()
        cube, twin = scenes.cube("Cube", data=mesh), scenes.cube("Twin", (3, 0, 0), data=mesh)
        other = scenes.cube("Other", (0, 3, 0))
        bpy.context.view_layer.update()
        for change in (
            lambda: setattr(cube.lodestone, "use", "ORIGINAL"),
            lambda: setattr(cube.lodestone, "environment", True),
            lambda: setattr(cube.lodestone, "environment", False),
            lambda: setattr(cube.lodestone, "use_pin_viewport", True),
            lambda: object_decisions.copy(other, cube),
        ):
            addon_session().changed_shapes.clear()
            change()
            bpy.context.view_layer.update()
            self.assertEqual(addon_session().changed_shapes.names(), set())
        mesh.vertices[0].co.z += 1.0
        mesh.update()
        bpy.context.view_layer.update()
        self.assertEqual(addon_session().changed_shapes.names(), {cube.name, twin.name})

    def test_copied_to_the_selected_and_taken_back(self):
        source = scenes.cube("Source")
        targets = [scenes.cube(f"Target {n}", (3 * n, 0, 0)) for n in (1, 2)]
        bystander = scenes.cube("Bystander", (0, 3, 0))
        targets[0].lodestone.role = "ENVIRONMENT"
        source.lodestone.use, source.lodestone.importance = "LIMIT", 2.0
        for item in (source, *targets):
            item.select_set(True)
        bpy.context.view_layer.objects.active = source
        bpy.ops.lodestone.copy_decisions()
        for item in targets:
            found = item.lodestone
            self.assertEqual((found.use, found.importance, found.role), ("LIMIT", 2.0, "AUTOMATIC"))
        self.assertNotIn("lodestone", bystander)
        object_decisions.forget(source, True)
        bpy.ops.lodestone.copy_decisions()
        for item in targets:
            self.assertNotIn("lodestone", item)
        bystander.select_set(False)
        for item in targets:
            item.select_set(False)
        with self.assertRaisesRegex(RuntimeError, "Select other objects too"):
            bpy.ops.lodestone.copy_decisions()


class Pictures(unittest.TestCase):
    """What F12 draws, at a Pixel Error that would make one thing of all."""

    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.lodestone.pixel_error_render = 512.0
        self.scene.lodestone.build_on_render = "ALL"
        self.balls = []
        for number in range(2):
            data = bpy.data.meshes.new(f"Ball {number}")
            made = bmesh.new()
            bmesh.ops.create_icosphere(made, subdivisions=3, radius=1.0 + number)
            for vertex in made.verts:  # a ball itself would be an ellipsoid at once
                vertex.co *= 1 + 0.2 * math.sin(5 * vertex.co.z)
            made.to_mesh(data)
            made.free()
            self.balls.append(scenes.cube(f"Ball {number}", (4 * number, 0, 0), data=data))
        bpy.ops.wm.save_as_mainfile(filepath=os.fspath(Path(folder.name) / "balls.blend"))

    def triangles(self):
        from lodestone.core.session.addon_session import addon_session

        bpy.ops.render.render()
        return addon_session().renders.get(self.scene.name).triangles

    def test_always_original_is_drawn_so_however_far(self):
        self.assertLess(self.triangles(), 320)
        self.balls[0].lodestone.use = "ORIGINAL"
        self.assertGreaterEqual(self.triangles(), 320)
        self.assertLess(self.triangles(), 640)
        self.balls[1].lodestone.use = "EXCLUDE"
        self.assertEqual(self.triangles(), 640)

    def test_important_things_have_more_triangles(self):
        self.scene.lodestone.pixel_error_render = 4.0
        before = self.triangles()
        for ball in self.balls:
            ball.lodestone.importance = 16.0
        self.assertGreater(self.triangles(), before)


if __name__ == "__main__":
    unittest.main()
