# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what faces become: the triangles and normals that Blender draws, the same each time."""

import random
import unittest
from unittest import mock

import bpy

import blender_scenes as scenes


def corrugated(faces_across, smooth=True):
    """A grid of warped and of concave faces."""
    rng = random.Random(1)
    count = faces_across + 1
    points = [
        (x + rng.uniform(-0.7, 0.7), y + rng.uniform(-0.7, 0.7), rng.uniform(0, 1))
        for y in range(count)
        for x in range(count)
    ]
    faces = [
        (at, at + 1, at + count + 1, at + count)
        for at in (y * count + x for y in range(faces_across) for x in range(faces_across))
    ]
    rng.shuffle(faces)  # Blender's threads meet at every vertex
    data = scenes.mesh("Corrugated", points, faces)
    data.polygons.foreach_set("use_smooth", [smooth] * len(data.polygons))
    return data


class Meshes(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()

    def extracted(self, item, in_place=0):
        from lodestone.bridge.nodes.materials import Wanted
        from lodestone.bridge.scene import mesh_buffers

        shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return mesh_buffers.extract(shown, [Wanted()], in_place)

    def source_hash(self, buffers):
        from lodestone.core.native import lodestone_native as native

        with native.Model() as model:
            item = model.add_faces("it", "It", buffers)
            model.set_root(item)
            return model.object_summary(item).source_hash

    def blenders(self, item):
        """The same faces with Blender's triangles and normals."""
        from lodestone.bridge import blender_versions
        from lodestone.bridge.scene import mesh_buffers

        buffers = self.extracted(item)
        made = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        buffers.triangles = mesh_buffers._triangles(made)
        buffers.corner_normals = blender_versions.buffer("f", 3 * len(made.loops))
        blender_versions.corner_normals(made, buffers.corner_normals)
        return buffers

    def test_triangles_and_normals_are_blenders(self):
        grid = scenes.link(bpy.data.objects.new("Grid", corrugated(24)))
        bpy.ops.mesh.primitive_monkey_add()
        monkey = bpy.context.object
        bpy.ops.object.shade_smooth()
        bpy.ops.mesh.primitive_cylinder_add(vertices=7)
        cylinder = bpy.context.object
        for polygon in cylinder.data.polygons:
            polygon.use_smooth = len(polygon.vertices) == 4
        for item in (grid, monkey, cylinder):
            mine = self.extracted(item)
            self.assertEqual(mine.triangles is None, item is not cylinder, item.name)
            self.assertIsNone(mine.corner_normals)
            self.assertEqual(
                self.source_hash(mine), self.source_hash(self.blenders(item)), item.name
            )

    def test_a_mesh_under_edit_is_what_blender_shows(self):
        bpy.ops.mesh.primitive_monkey_add()
        monkey = bpy.context.object
        corners = len(monkey.data.loops)
        before = self.extracted(monkey, corners)
        self.assertEqual(self.source_hash(before), self.source_hash(self.extracted(monkey)))
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.quads_convert_to_tris()
        bpy.ops.transform.resize(value=(2, 2, 2))
        under_edit = self.extracted(monkey, 2 * corners)
        bpy.ops.object.mode_set(mode="OBJECT")
        after = self.extracted(monkey, 2 * corners)
        self.assertEqual(max(after.positions), 2 * max(before.positions))
        self.assertEqual(self.source_hash(under_edit), self.source_hash(after))

    def test_split_normals_are_kept(self):
        bpy.ops.mesh.primitive_monkey_add()
        monkey = bpy.context.object
        bpy.ops.object.shade_smooth()
        before = self.source_hash(self.extracted(monkey))
        monkey.data.use_auto_smooth = True
        monkey.data.auto_smooth_angle = 0.3
        buffers = self.extracted(monkey)
        self.assertIsNotNone(buffers.corner_normals)
        self.assertNotEqual(self.source_hash(buffers), before)
        monkey.data.auto_smooth_angle = 3.1415
        self.assertEqual(self.source_hash(self.extracted(monkey)), before)

    def test_a_large_smooth_mesh_is_the_same_each_time_it_is_read(self):
        """Blender sums up normals on several threads: the hash changed from frame to frame."""
        data = corrugated(70)
        for auto_smooth in (False, True):
            data.use_auto_smooth, data.auto_smooth_angle = auto_smooth, 3.1415
            scenes.link(bpy.data.objects.new("Grid", data))
            hashes = set()
            for _ in range(6):
                data.update_tag()
                extraction, _ = scenes.extract()
                with extraction.model as model:
                    hashes |= {
                        model.object_summary(leaf.object).source_hash for leaf in extraction.leaves
                    }
            self.assertEqual(len(hashes), 1, f"auto smooth {auto_smooth}")

    def test_faces_that_use_what_is_not_there_are_named_and_the_rest_is_drawn(self):
        from lodestone.bridge.scene import mesh_buffers

        scenes.cube("Good")
        scenes.cube("Broken", (3, 0, 0))
        extract = mesh_buffers.extract

        def broken(shown, *rest):
            buffers = extract(shown, *rest)
            if shown.name == "Broken":
                buffers.corner_vertices[5] = 4_000_000_000
            return buffers

        with mock.patch.object(mesh_buffers, "extract", broken):
            extraction, _ = scenes.extract(compare=False)
        with extraction.model as model:
            self.assertEqual(model.totals().occurrences, 1)
        problem = extraction.problems.wrong[0]
        self.assertEqual((problem.code, problem.severity), ("mesh_unreadable", "error"))
        self.assertIn('Object "Broken"', problem.message)
        self.assertIn("corner 5 uses vertex 4000000000 of 8", problem.message)
