# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what is drawn of a lens: its rim, and where half of it is left."""

import math
import unittest

import addon_path  # noqa: F401
from lodestone.core.picture import lens_rim


class Rim(unittest.TestCase):
    def test_half_is_left_where_the_backend_says_so(self):
        for falloff in (0.5, 1.0, 2.0, 8.0):
            d = lens_rim.half_way(falloff)
            self.assertAlmostEqual(math.cos(math.pi * d / 2.0) ** falloff, 0.5)
        self.assertAlmostEqual(lens_rim.half_way(1.0), 2.0 / 3.0)

    def test_a_hard_rim_is_the_rim(self):
        for falloff in (0.0, -1.0, math.nan):
            self.assertEqual(lens_rim.half_way(falloff), 1.0)

    def test_circles_and_edges_lie_on_the_lens(self):
        for point in lens_rim.circles(2.0):
            self.assertAlmostEqual(math.hypot(*point), 2.0)
        self.assertEqual(len(set(lens_rim.box(1.5))), 8)
        for point in lens_rim.box(1.5):
            self.assertEqual({abs(value) for value in point}, {1.5})
        self.assertEqual(len(lens_rim.box(1.0)) % 2, 0)
        for x, y, z in lens_rim.disc(3.0, 4.0, 5.0):
            self.assertAlmostEqual(math.hypot(x - 3.0, y - 4.0), 5.0)
            self.assertEqual(z, 0.0)


if __name__ == "__main__":
    unittest.main()
