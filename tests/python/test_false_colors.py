# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the colors of errors and costs."""

import math
import unittest

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import false_colors


class Colors(unittest.TestCase):
    def test_errors_run_from_blue_to_red_and_stand_out_above(self):
        self.assertEqual(false_colors.of_error(0.0, 0.0), false_colors.ORIGINAL)
        self.assertEqual(false_colors.of_error(1.0, 0.0), false_colors.ABOVE)
        most = [round(part, 9) for part in false_colors.of_error(2.0, 2.0)]
        self.assertEqual(most, [0.8, 0.06, 0.03])
        self.assertEqual(false_colors.of_error(2.1, 2.0), false_colors.ABOVE)
        self.assertEqual(false_colors.of_error(math.nan, 2.0), false_colors.ABOVE)
        self.assertAlmostEqual(false_colors.of_error(0.5, 2.0)[2], (0.6 + 0.2) / 2)

    def test_costs_go_by_decades(self):
        colors = [false_colors.of_cost(n) for n in (0, 12, 13, 100, 101, 10**5, 10**9)]
        self.assertEqual(colors[0], colors[1])
        self.assertEqual(colors[2], colors[3])
        self.assertEqual(len(set(colors)), 5)

    def test_the_table_is_the_transfer_function(self):
        self.assertEqual((false_colors.LINEAR[0], false_colors.LINEAR[255]), (0, 255))
        self.assertEqual(false_colors.LINEAR[188], 128)
        self.assertAlmostEqual(false_colors.displayed((0.5, 0, 1))[0], 0.7354, places=4)


if __name__ == "__main__":
    unittest.main()
