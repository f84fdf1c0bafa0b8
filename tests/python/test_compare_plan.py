# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards which placements are named as differing most between two pictures."""

import unittest

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import compare_plan


class Blame(unittest.TestCase):
    def test_equal_pictures_blame_nothing(self):
        self.assertEqual(compare_plan.worst_of([(["a", "b"], [0.0, 0.0]), ([], [])]), ())

    def test_the_largest_three_with_their_shares(self):
        found = compare_plan.worst_of([(["a", "b", "c", "d"], [1, 5, 0, 2]), (["a"], [2])])
        self.assertEqual([path for path, _ in found], ["b", "a", "d"])
        self.assertEqual([round(share, 3) for _, share in found], [0.5, 0.3, 0.2])


if __name__ == "__main__":
    unittest.main()
