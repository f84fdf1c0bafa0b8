# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of the extraction share: a fresh scene, read and compared with the depsgraph."""

import unittest

import blender_scenes as scenes


class Case(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.root = self.scene.collection

    def extract(self):
        """Extracts, compares with the depsgraph; returns (extraction, occurrences)."""
        extraction, request = scenes.extract()
        self.addCleanup(extraction.model.close)
        self.assertEqual(request.differences, [])
        occurrences = extraction.model.occurrences()
        self.assertEqual(len(occurrences), extraction.shown)
        return extraction, occurrences

    def named(self, extraction):
        """What is shown how often, by the names of data."""
        names = {leaf.object.key: leaf.data for leaf in extraction.leaves}
        found = {}
        for item, _ in extraction.model.occurrences():
            found[names[item.key]] = found.get(names[item.key], 0) + 1
        return found

    def codes(self, extraction):
        return sorted((problem.object, problem.code) for problem in extraction.problems)

    def triangles(self, extraction, data):
        (leaf,) = [leaf for leaf in extraction.leaves if leaf.data == data]
        return extraction.model.representation(leaf.object, 0).triangles
