# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that every kind of representation has its words, and that texts that list solids list
all of them."""

import re
import sys
import unittest

import addon_path
from lodestone.core.kind_words import (
    DRAWN_KINDS,
    KIND_WORDS,
    SOLID_KINDS,
    any_solid,
    level_word,
)
from lodestone.core.picture import false_colors
from lodestone.core.native import lodestone_native as native

sys.path[:0] = [str(addon_path.ROOT / "samples"), str(addon_path.ROOT / "samples" / "street")]

import real_scenes  # noqa: E402
import report  # noqa: E402

# The pages and the help text that name solids only where they list them all
TEXTS = (
    "backend/README.md",
    "backend/docs/how-it-works.md",
    "backend/tools/verbs.cpp",
    "blender_addon/docs/viewport.md",
)


class Words(unittest.TestCase):
    def test_every_kind_has_a_row(self):
        self.assertEqual(set(KIND_WORDS), set(native.Kind))

    def test_groups_are_drawn_by_what_is_in_them(self):
        self.assertEqual(set(native.Kind) - set(DRAWN_KINDS), {native.Kind.ASSEMBLY})

    def test_levels(self):
        self.assertEqual(level_word(0, native.Kind.BOX), "Original")
        self.assertEqual(level_word(2, native.Kind.BOX), "Box")
        self.assertEqual(level_word(1, native.KIND_COUNT), "?")

    def test_solids_are_drawn_and_no_meshes(self):
        self.assertEqual(set(DRAWN_KINDS) - set(SOLID_KINDS), {native.Kind.MESH})


class Lists(unittest.TestCase):
    def setUp(self):
        self.words = [kind.name.lower() for kind in SOLID_KINDS]

    def test_a_sentence_names_each_solid(self):
        self.assertRegex(any_solid(), r"^an? \w+(, an? \w+)* or an? \w+$")
        for word in self.words:
            self.assertIn(f" {word}", f" {any_solid()}")

    def test_legends_name_each_solid(self):
        for mode in (false_colors.LEVEL, false_colors.COST):
            named = ", ".join(word.lower() for word, _ in false_colors.legend(mode, 1.0))
            for word in self.words:
                self.assertIn(word, named, mode)

    def test_each_text_that_lists_solids_lists_all(self):
        one = rf"(?:an? )?(?:{'|'.join(self.words)})(?:e?s)?\b"
        listing = re.compile(rf"\b{one}(?:(?:, (?:or |and )?| or | and ){one})+", re.IGNORECASE)
        for name in TEXTS:
            found = listing.findall((addon_path.ROOT / name).read_text())
            self.assertTrue(found, name)
            for text in found:
                missing = [word for word in self.words if word not in text.lower()]
                self.assertEqual(missing, [], f"{name}: {text}")

    def test_tables_of_samples_count_each_kind_that_is_drawn(self):
        counts = native.kind_counts(range(native.KIND_COUNT))
        words, numbers = " / ".join(counts), " / ".join(map(str, counts.values()))
        cut = {"occurrences": 9, "kinds": counts, "triangles": 1, "largest_error_px": 0.5}
        export, povray = {"bytes": 1, "cpu_s": 1}, {"peak_bytes": 1}
        povray |= {"parse_cpu_s": 1, "trace_cpu_s": 1}
        made = {"cut": cut, "export": export, "povray": povray, "pixel_error": 1.0}
        self.assertIn(f"({numbers})", real_scenes.row("a", made, 0, None))
        self.assertIn(f"({words})", real_scenes.header(made))
        off = dict.fromkeys(("mean", "p999", "max", "ssim"), 0.5)
        table = report._table([report._row("a", made, off, 0)])
        self.assertIn(f"({words})", table[0])
        self.assertIn(f"({numbers})", table[-1])


if __name__ == "__main__":
    unittest.main()
