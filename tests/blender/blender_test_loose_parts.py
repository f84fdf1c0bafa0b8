# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards meshes of many loose parts: clusters of them are drawn, one object is told."""

import unittest

import bmesh
import bpy

import blender_scenes as scenes

PARTS, EACH = 180, 320  # more than 50,000 triangles


def strewn():
    """Balls over a square, in one mesh."""
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=3, radius=0.5)
    ball.verts.index_update()
    points = [tuple(vertex.co) for vertex in ball.verts]
    around = [[vertex.index for vertex in face.verts] for face in ball.faces]
    ball.free()
    vertices, faces = [], []
    for number in range(PARTS):
        x, y, first = 10 * (number % 15), 10 * (number // 15), len(vertices)
        vertices += [(x + a, y + b, c) for a, b, c in points]
        faces += [[first + i for i in face] for face in around]
    return scenes.mesh("Rocks", vertices, faces)


class LooseParts(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.rocks = scenes.link(bpy.data.objects.new("Rocks", strewn()))
        self.copy = scenes.link(bpy.data.objects.new("Copy", self.rocks.data))
        self.copy.location = (300, 0, 0)

    def extracted(self, **options):
        from lodestone.engines import extract_engine

        request = extract_engine.Request(compare=True, **options)
        extraction = extract_engine.extract_now(self.scene, request)
        self.addCleanup(extraction.model.close)
        self.assertEqual(request.differences, [])
        return extraction

    def rocks_in(self, extraction):
        """The summary under the first uid that the panel looks for."""
        from lodestone.bridge import object_decisions

        model = extraction.model
        found = map(model.find_object, object_decisions.levels_uids(self.rocks))
        return model.object_summary(next(item for item in found if item is not None))

    def test_they_are_clusters_below_one_object_in_two_places(self):
        extraction = self.extracted()
        summary = self.rocks_in(extraction)
        self.assertTrue(summary.group)
        self.assertGreater(summary.child_count, 4)
        totals = extraction.model.totals()
        self.assertEqual((totals.objects, totals.occurrences), (2, 2))  # with the scene's group
        self.assertEqual(totals.triangles_placed, 2 * PARTS * EACH)
        self.assertEqual(totals.triangles_unique, PARTS * EACH)

    def test_a_second_reading_finds_the_same(self):
        first, second = (self.rocks_in(self.extracted()) for _ in range(2))
        self.assertEqual(first.source_hash, second.source_hash)

    def test_the_designer_decides_for_each_object(self):
        self.rocks.lodestone.loose_parts = "ONE"
        extraction = self.extracted()
        self.assertFalse(self.rocks_in(extraction).group)
        self.assertEqual(extraction.model.totals().occurrences, 2)
        groups = [extraction.model.object_summary(item) for item in extraction.model.objects()]
        self.assertTrue(any(one.group and one.name == "Rocks" for one in groups))  # the copy

    def test_collections_only_leaves_it_to_objects(self):
        self.scene.lodestone.structure = "COLLECTIONS"
        self.assertFalse(self.rocks_in(self.extracted()).group)
        self.rocks.lodestone.loose_parts = "OBJECTS"
        self.assertTrue(self.rocks_in(self.extracted()).group)


if __name__ == "__main__":
    unittest.main()
