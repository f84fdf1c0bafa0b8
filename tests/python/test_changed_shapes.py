# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards which objects count as changed since levels were built."""

import unittest

import addon_path  # noqa: F401
from lodestone.core.session.changed_shapes import ChangedShapes


class Shapes(unittest.TestCase):
    def test_only_what_was_changed_after_the_last_reading_is_left(self):
        shapes = ChangedShapes()
        shapes.note(["Before"])
        shapes.reading()
        shapes.note(["While"])
        self.assertEqual(shapes.names(), {"Before", "While"})
        shapes.settle()
        self.assertEqual(shapes.names(), {"While"})
        shapes.clear()
        self.assertEqual(shapes.names(), set())


if __name__ == "__main__":
    unittest.main()
