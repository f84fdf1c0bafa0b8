# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the words of the C++ sources: a type name means one thing, and most say it in two words;
no folder is so full that nobody oversees it."""

import unittest
from collections import Counter

from repository import files, files_ending, text_of
from type_names import bare_words, defined_twice, definitions, is_bare

SOURCES = ("backend/", "povray_export/")
# Type names that are defined more than once. The list only ever shrinks.
DEFINED_TWICE: set[str] = set()
MOST_BARE = 0.30  # share of one-word names; anchors of the field have 0.07 to 0.27
MOST_FILES = 30  # in a folder, tests aside


def product_definitions() -> dict[str, list[str]]:
    names = [n for n in files_ending(".h", ".cpp") if n.startswith(SOURCES)]
    return definitions({name: text_of(name) for name in names})


class TheCheck(unittest.TestCase):
    def test_nothing_defines_nothing(self):
        self.assertEqual(definitions({"a.h": "struct Part;\nclass Mesh* mesh;\n"}), {})

    def test_nested_derived_and_enumerated_types_are_found(self):
        text = (
            "struct Mesh {\n    struct Corner { int x; };\n};\n"
            "class Reader final : public Base<int> {\n};\n"
            "enum class Kind : uint8_t { A };\ntemplate <typename T>\nstruct Grid\n{\n};\n"
        )
        found = definitions({"a.h": text})
        self.assertEqual(sorted(found), ["Corner", "Grid", "Kind", "Mesh", "Reader"])

    def test_a_name_of_two_files_or_twice_in_one_is_found(self):
        found = definitions({"a.cpp": "struct Part {};\n", "b.cpp": "class Part {\n};\n"})
        self.assertEqual(defined_twice(found), {"Part": ["a.cpp", "b.cpp"]})
        twice = "struct A {\n    struct Part {};\n};\nstruct B {\n    struct Part {};\n};\n"
        self.assertEqual(defined_twice(definitions({"a.h": twice})), {"Part": ["a.h", "a.h"]})

    def test_a_nested_type_that_is_defined_outside_its_class_is_found(self):
        found = definitions({"a.cpp": "struct Mesh::Corner {\n    int x;\n};\n"})
        self.assertEqual(sorted(found), ["Corner"])

    def test_words_are_counted_as_read(self):
        for bare in ("Part", "Box3", "RGBA", "Glb"):
            self.assertTrue(is_bare(bare), bare)
        for said in ("CollapsePart", "RGBImage", "Box3Tree"):
            self.assertFalse(is_bare(said), said)


class TheSources(unittest.TestCase):
    maxDiff = None

    def test_a_type_name_is_defined_once(self):
        twice = defined_twice(product_definitions())
        new = {name: places for name, places in twice.items() if name not in DEFINED_TWICE}
        self.assertEqual(new, {})
        self.assertEqual(DEFINED_TWICE - set(twice), set(), "mended: take it off the list")

    def test_most_type_names_are_more_than_one_word(self):
        found = product_definitions()
        bare = bare_words(found)
        self.assertGreater(len(found), 300)
        self.assertLessEqual(len(bare) / len(found), MOST_BARE, " ".join(bare))

    def test_no_folder_is_too_full(self):
        folders = Counter(
            name.rpartition("/")[0]
            for name in files()
            if name.endswith((".h", ".cpp", ".py")) and not name.startswith("tests/")
        )
        self.assertEqual({f: n for f, n in folders.items() if n > MOST_FILES}, {})


if __name__ == "__main__":
    unittest.main()
