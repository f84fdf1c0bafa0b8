# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the language of the C++ sources' comments: a comment names its subject, and a number is
written 0.67, not .67."""

import re
import unittest

from cpp_comments import blocks, not_agreed, product_sources, to_do
from repository import text_of

# Files with comments of the old kind. The list only ever shrinks.
TO_DO = "comments_to_do.txt"
# First words of comments that leave out the subject, as the declaration below would be it.
FORBIDDEN = re.compile(r"(?:Also of|Inside of|Of|What|The rest|Likewise|As)\b")
BARE_NUMBER = re.compile(r"(?<![\w.)\]}\"'*])\.\d")


def faults(text: str) -> list[str]:
    found = []
    for block in blocks(text):
        if block.alone and FORBIDDEN.match(block.text):
            found.append(f"{block.line}: begins with {FORBIDDEN.match(block.text)[0]!r}")
        if BARE_NUMBER.search(block.text):
            found.append(f"{block.line}: a number without its 0")
    return found


class TheCheck(unittest.TestCase):
    def test_a_comment_without_its_subject_is_found(self):
        for bad in (
            "/// Of a Matrix.\ndouble area();\n",
            "    // What is left.\n    double rest;\n",
            "// SPDX-License-Identifier: GPL-3.0-or-later\n// Likewise of a level.\n#pragma once\n",
            "/* The rest of it. */\n",
            "/// Inside of budget.\n",
        ):
            self.assertEqual(len(faults(bad)), 1, bad)

    def test_a_sentence_may_go_on_with_any_word(self):
        for good in (
            "/// The area of a Matrix.\n",
            "/// The factors of a view, of a node, and\n/// Of all their lenses.\n",
            "/// Offers a step.\n/// Whatever is asked.\n",
            "double rest;  // of the budget\n",
            'const char* text = "// Of a matrix.";\n',
            "double x = .5;\n",
        ):
            self.assertEqual(faults(good), [], good)

    def test_a_number_without_its_zero_is_found(self):
        for bad in ("// From .67 to 1.\n", "int x;  // (-.5)\n", "/// .25 of it.\n"):
            self.assertEqual(len(faults(bad)), 1, bad)
        for good in ("// From 0.67 to 1.\n", "// 1.5.2, x.0, file.3mf ...\n"):
            self.assertEqual(faults(good), [], good)

    def test_both_faults_are_told_with_their_lines(self):
        text = "int a;\n// Of it.\nint b;  // .5\n"
        self.assertEqual(faults(text), ["2: begins with 'Of'", "3: a number without its 0"])

    def test_a_list_holds_no_file_that_is_clean_and_misses_none_that_is_not(self):
        found = {"a.h": ["1: x"], "b.h": ["2: y"]}
        self.assertEqual(not_agreed(found, {"a.h", "b.h"}), {})
        self.assertEqual(not_agreed(found, {"a.h"}), {"b.h": ["2: y"]})
        self.assertEqual(list(not_agreed(found, {"a.h", "b.h", "c.h"})), ["c.h"])


class TheSources(unittest.TestCase):
    maxDiff = None

    def test_comments_name_their_subject_and_write_numbers_whole(self):
        sources = product_sources()
        self.assertGreater(len(sources), 400)
        found = {name: lines for name in sources if (lines := faults(text_of(name)))}
        self.assertEqual(not_agreed(found, to_do(TO_DO)), {})


if __name__ == "__main__":
    unittest.main()
