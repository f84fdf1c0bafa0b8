# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards structure: flat collections get groups without a change in the file, Auto-Structure makes
collections of them, and nothing is ever lost or moved."""

import tempfile
import unittest
from pathlib import Path
from unittest import mock

import bpy

import blender_scenes as scenes

HEAPS, EACH = 4, 20  # more than 64 in one collection


def flat(name="Yard"):
    """Heaps of cubes far from each other, all directly in one collection."""
    yard = scenes.collection(name, bpy.context.scene.collection)
    data = scenes.cube_mesh()
    for number in range(HEAPS * EACH):
        heap, place = divmod(number * 7 % (HEAPS * EACH), EACH)
        where = (100 * (heap % 2) + 2 * (place % 5), 100 * (heap // 2) + 2 * (place // 5), 0)
        scenes.cube(f"Cube {number}", where, data=data, collection=yard)
    return yard


def heap_of(item):
    return round(item.location.x / 100), round(item.location.y / 100)


def all_objects(collection):
    return sorted(item.name for item in collection.all_objects)


class AutoStructure(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.yard = flat()
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "yard.blend"))
        self.activate(self.yard)

    def activate(self, collection):
        layer = bpy.context.view_layer.layer_collection
        bpy.context.view_layer.active_layer_collection = layer.children[collection.name]

    def extracted(self, **options):
        from lodestone.engines import extract_engine

        request = extract_engine.Request(compare=True, **options)
        extraction = extract_engine.extract_now(self.scene, request)
        self.addCleanup(extraction.model.close)
        self.assertEqual(request.differences, [])
        return extraction

    def groups(self, extraction):
        summaries = map(extraction.model.object_summary, extraction.model.objects())
        return [summary for summary in summaries if summary.group]

    def test_a_flat_collection_has_groups_below_it_and_the_file_stays_as_it_is(self):
        extraction = self.extracted()
        groups = self.groups(extraction)
        self.assertGreater(len(groups), 5)
        self.assertLessEqual(max(group.child_count for group in groups), 64)
        self.assertEqual(extraction.model.totals().occurrences, HEAPS * EACH)
        self.assertEqual(len(self.yard.children), 0)
        self.assertFalse(self.scene.is_property_set("lodestone"))

    def test_collections_only_leaves_the_groups_to_the_designer(self):
        self.scene.lodestone.structure = "COLLECTIONS"
        self.assertEqual(len(self.groups(self.extracted())), 2)  # the scene's and the yard's

    def test_a_second_reading_finds_the_same_groups(self):
        first, second = ({g.uid for g in self.groups(self.extracted())} for _ in range(2))
        self.assertEqual(first, second)

    def test_exporting_the_originals_of_many_objects_took_three_times_as_long_for_groups(self):
        from lodestone.core.native import lodestone_native as native

        self.scene.render.engine = "LODESTONE_POVRAY"
        for pixel_error, wanted in ((0.0, 0), (1.0, 1)):
            self.scene.lodestone.pixel_error_render = pixel_error
            structure = native.Model.structure
            with mock.patch.object(native.Model, "structure", autospec=True) as asked:
                asked.side_effect = structure
                bpy.ops.render.render()
            self.assertEqual(asked.call_count, wanted, pixel_error)

    def test_makes_collections_of_what_stands_together(self):
        before = all_objects(self.yard)
        self.assertEqual(bpy.ops.lodestone.auto_structure(), {"FINISHED"})
        self.assertEqual(all_objects(self.yard), before)
        heaps = {heap_of(item): set() for item in self.yard.all_objects}
        for item in self.yard.all_objects:
            heaps[heap_of(item)].add(item.name)
        groups = [set(all_objects(child)) for child in self.yard.children_recursive]
        for heap in heaps.values():
            self.assertIn(heap, groups)
        for item in self.yard.all_objects:
            self.assertEqual(len(item.users_collection), 1)
        self.assertEqual(self.extracted().model.totals().occurrences, HEAPS * EACH)

    def test_child_collections_and_other_users_stay(self):
        other = scenes.collection("Other", self.scene.collection)
        other.objects.link(bpy.data.objects["Cube 3"])
        inner = scenes.collection("Inner", self.yard)
        scenes.cube("Inside", (1, 1, 5), collection=inner)
        before = all_objects(self.yard)
        bpy.ops.lodestone.auto_structure()
        self.assertEqual(all_objects(self.yard), before)
        self.assertEqual(all_objects(inner), ["Inside"])
        self.assertIn(other, bpy.data.objects["Cube 3"].users_collection)

    def test_the_preview_has_costs_and_no_triangles_without_levels(self):
        from lodestone.operators import auto_structure

        made, preview = auto_structure.auto_structure(bpy.context, self.yard)
        self.assertEqual(len(made), preview.groups)
        self.assertLess(preview.cost_after, 0.2 * preview.cost_before)
        self.assertIsNone(preview.bytes_before)
        self.assertEqual(len(preview.lines()), 2)

    def test_says_why_it_cannot(self):
        for item in list(self.yard.objects)[8:]:
            bpy.data.objects.remove(item)
        with self.assertRaisesRegex(RuntimeError, "At most 8 things"):
            bpy.ops.lodestone.auto_structure()


if __name__ == "__main__":
    unittest.main()
