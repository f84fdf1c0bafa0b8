# SPDX-License-Identifier: GPL-3.0-or-later
"""Object Info's Random: Cycles' own number of a name, and its grades."""

import unittest

import addon_path  # noqa: F401
from lodestone.core import object_random


class Random(unittest.TestCase):
    def test_known_names(self):
        for name, value in (("", 0.8603), ("Cube", 0.3131), ("Tree.001", 0.0213)):
            self.assertAlmostEqual(object_random.random_of(name), value, delta=1e-4)

    def test_names_of_any_letters_spread_evenly(self):
        values = sorted(object_random.random_of(f"木 {i}\udcff") for i in range(1000))
        for i, value in enumerate(values):
            self.assertAlmostEqual(value, i / 1000, delta=0.06)

    def test_an_instance_has_another_number_than_its_object_and_by_its_instancer(self):
        found = {object_random.random_of("Tree", by) for by in ("", "Here", "There")}
        self.assertEqual(len(found), 3)

    def test_grades_are_few_and_near(self):
        found = {object_random.graded(i / 999) for i in range(1000)}
        self.assertEqual(len(found), object_random.GRADES)
        self.assertEqual((min(found), max(found)), (0.0625, 0.9375))
        self.assertLess(abs(object_random.graded(0.3) - 0.3), 0.5 / object_random.GRADES)


if __name__ == "__main__":
    unittest.main()
