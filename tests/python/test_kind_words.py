# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that every kind of representation has its words."""

import unittest

import addon_path  # noqa: F401
from lodestone.core.kind_words import DRAWN_KINDS, KIND_WORDS, level_word
from lodestone.core.native import lodestone_native as native


class Words(unittest.TestCase):
    def test_every_kind_has_a_row(self):
        self.assertEqual(set(KIND_WORDS), set(native.Kind))

    def test_groups_are_drawn_by_what_is_in_them(self):
        self.assertEqual(set(native.Kind) - set(DRAWN_KINDS), {native.Kind.ASSEMBLY})

    def test_levels(self):
        self.assertEqual(level_word(0, native.Kind.BOX), "Original")
        self.assertEqual(level_word(2, native.Kind.BOX), "Box")
        self.assertEqual(level_word(1, native.KIND_COUNT), "?")


if __name__ == "__main__":
    unittest.main()
