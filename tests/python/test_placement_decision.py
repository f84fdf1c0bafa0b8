# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what decisions about one placement amount to together."""

import math
import unittest

import addon_path  # noqa: F401
from lodestone.core.placement_decision import ANY_LEVEL, UNDECIDED, Decision, decision
from lodestone_native import ANY_LEVEL as NATIVE_ANY_LEVEL


class Decisions(unittest.TestCase):
    def test_nothing_decided_is_the_one_undecided(self):
        self.assertIs(decision("AUTOMATIC", 3, 1.0), UNDECIDED)
        self.assertIs(UNDECIDED.inside(UNDECIDED), UNDECIDED)
        self.assertIs(Decision(2.0).inside(Decision(0.5)), UNDECIDED)

    def test_each_use(self):
        self.assertEqual(decision("ORIGINAL", 3, 1.0), Decision(1.0, 0, False))
        self.assertEqual(decision("LIMIT", 3, 2.0), Decision(2.0, 3, False))
        self.assertEqual(decision("EXCLUDE", 3, 1.0), Decision(1.0, 0, True))

    def test_both_of_two_count(self):
        inner, outer = Decision(2.0, 3, False), Decision(3.0, ANY_LEVEL, True)
        self.assertEqual(inner.inside(outer), Decision(6.0, 3, True))
        self.assertEqual(outer.inside(inner), inner.inside(outer))

    def test_importance_stays_in_its_range(self):
        self.assertEqual(Decision(32.0).inside(Decision(32.0)).importance, 64.0)
        self.assertEqual(Decision(1 / 32).inside(Decision(1 / 32)).importance, 1 / 64)
        self.assertEqual(decision("AUTOMATIC", 1, 1e30).importance, 64.0)

    def test_an_importance_that_is_no_number_kept_a_scene_from_rendering(self):
        self.assertIs(decision("AUTOMATIC", 1, math.nan), UNDECIDED)
        self.assertEqual(decision("LIMIT", 2, math.nan), Decision(1.0, 2, False))

    def test_any_level_is_the_librarys(self):
        self.assertEqual(ANY_LEVEL, NATIVE_ANY_LEVEL)

    def test_a_pin_wins_over_a_use_and_that_of_what_instances_it_over_its_own(self):
        inner = decision("LIMIT", 3, 1.0, 2)
        self.assertEqual(inner, Decision(1.0, 2, False, True))
        self.assertEqual(decision("ORIGINAL", 3, 1.0, -1).pinned, False)
        outer = decision("AUTOMATIC", 1, 1.0, 5)
        self.assertEqual(inner.inside(outer).coarsest, 5)
        self.assertEqual(inner.inside(UNDECIDED), inner)
        self.assertEqual(Decision().inside(outer), outer)


if __name__ == "__main__":
    unittest.main()
