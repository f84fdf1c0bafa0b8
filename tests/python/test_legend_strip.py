# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the legend below false colors."""

import unittest
from array import array

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import legend_strip
from lodestone_native import Image


class Legend(unittest.TestCase):
    def test_it_is_added_below_in_as_many_lines_as_it_takes(self):
        image = Image(40, 2, array("f", (0.5, 0.25, 0.0, 0.0) * 80))
        entries = [("LONG WORD", (1.0, 0.0, 0.0)), ("OTHER", (0.0, 1.0, 0.0))]
        found = legend_strip.with_legend(image, "T", entries)
        self.assertEqual((found.width, found.height), (40, 2 + 3 * 13 + 4))
        self.assertEqual(len(found.pixels), 4 * 40 * found.height)
        self.assertEqual(set(found.pixels[3::4]), {1.0})
        self.assertEqual(list(found.pixels[:3]), [0.5, 0.25, 0.0])
        self.assertEqual(image.pixels[3], 0.0)
        self.assertIn(1.0, found.pixels[4 * 80 :: 4])

    def test_flipping_twice_is_nothing(self):
        image = Image(2, 3, array("f", range(24)))
        once = legend_strip.flipped(image)
        self.assertEqual(list(once.pixels[:8]), list(range(16, 24)))
        self.assertEqual(legend_strip.flipped(once).pixels, image.pixels)


if __name__ == "__main__":
    unittest.main()
