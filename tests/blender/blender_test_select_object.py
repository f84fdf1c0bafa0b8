# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what is selected by a path of placements that a panel names."""

import unittest

import bpy

import blender_scenes as scenes


class SelectObject(unittest.TestCase):
    def setUp(self):
        self.root = scenes.fresh().collection

    def selected(self, path):
        """The object that is selected by it, None when it is refused and nothing has changed."""
        before = (bpy.context.view_layer.objects.active, bpy.context.selected_objects)
        if bpy.ops.lodestone.select_object(path=path) == {"CANCELLED"}:
            now = (bpy.context.view_layer.objects.active, bpy.context.selected_objects)
            self.assertEqual(now, before)
            return None
        found = bpy.context.object
        self.assertEqual(bpy.context.selected_objects, [found])
        return found

    def test_the_innermost_object_that_can_be_seen_by_itself(self):
        shown = scenes.collection("Shown", self.root)
        chair = scenes.cube("Chair", collection=shown)
        self.assertEqual(self.selected("Shown/Chair"), chair)
        copy = scenes.instance("Copy", shown, (3, 0, 0))
        self.assertEqual(self.selected("Copy/Chair"), chair)
        hidden = scenes.collection("Hidden")
        scenes.cube("Table", collection=hidden)
        other = scenes.instance("Other", hidden)
        self.assertEqual(self.selected("Other/Table"), other)
        self.assertEqual(self.selected("Other"), other)
        self.assertIsNone(self.selected("Gone/Lost"))
        self.assertIsNone(self.selected(""))
        copy.hide_set(True)
        self.assertIsNone(self.selected("Copy"))

    def test_another_object_of_the_same_name_was_selected_for_one_in_a_library(self):
        """As of a library override beside instances of what it overrides."""
        inner = scenes.collection("Props")
        scenes.cube("Head", collection=inner)
        copy = scenes.instance("Copy", inner)
        inner.objects["Head"].name = "Was"  # two datablocks of one name are in two libraries
        own = scenes.cube("Own")
        nested = scenes.collection("Outer")
        scenes.instance("Own", inner, parent=nested)
        outer = scenes.instance("Place", nested)
        self.assertEqual(self.selected("Place/Own.001/Was"), outer)
        self.assertEqual(self.selected("Copy/Own"), copy)
        self.assertNotEqual(self.selected("Copy/Was"), own)

    def test_names_that_hold_slashes_were_not_found(self):
        wall = scenes.cube("House/Wall")
        scenes.cube("Wall")
        self.assertEqual(self.selected("House/Wall"), wall)
        inner = scenes.collection("In/ner", self.root)
        deep = scenes.cube("a/b/c", collection=inner)
        self.assertEqual(self.selected("In/ner/a/b/c"), deep)

    def test_what_nodes_and_particles_show_is_their_emitters(self):
        emitter = scenes.cube("Meadow")
        self.assertEqual(self.selected("Meadow instances/Meadow instances 3/Mesh"), emitter)
        emitter.hide_set(True)
        self.assertIsNone(self.selected("Meadow instances/Mesh"))


if __name__ == "__main__":
    unittest.main()
