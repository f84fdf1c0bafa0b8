# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the texts that list file formats: each names those that the library reads or writes."""

import re
import unittest

import addon_path
from lodestone_native import LodestoneError, Model

TEXTS = (
    "backend/include/lodestone/lodestone.h",
    "backend/src/format/model_file.h",
    "backend/python/lodestone_native/model.py",
    "backend/tools/verbs.cpp",
)
ENDING = r"\.(?=\d*[a-z])[a-z\d]{1,6}\b"
LIST = re.compile(rf"{ENDING}(?:(?:, (?:or |and )?| or | and )(?:a )?{ENDING})+")


class Formats(unittest.TestCase):
    def setUp(self):
        with self.assertRaisesRegex(LodestoneError, "is not read") as caught:
            Model.read("a.nothing")
        self.read = set(re.findall(ENDING, str(caught.exception).split("only")[1]))
        with Model() as model, self.assertRaisesRegex(LodestoneError, "is not written") as caught:
            model.write("a.nothing")
        self.written = set(re.findall(ENDING, str(caught.exception).split("only")[1]))

    def test_endings_with_digits_and_short_ones_were_not_seen(self):
        self.assertEqual(re.findall(ENDING, "x.3mf, .x3d or .o; 0.125 m"), [".3mf", ".x3d", ".o"])

    def test_what_is_written_is_read(self):
        self.assertLess(self.written, self.read)
        self.assertIn(".glb", self.written)

    def test_each_text_that_lists_formats_lists_all(self):
        lists = 0
        for name in TEXTS:
            text = (addon_path.ROOT / name).read_text()
            plain = re.sub(r' ?"?\s*\n[ /*"]*', " ", text)  # lines of comments and strings joined
            self.assertEqual({one for one in self.read if one not in plain}, set(), name)
            for found in LIST.findall(plain):
                endings = set(re.findall(ENDING, found))
                if len(endings) > 2:
                    self.assertIn(endings, (self.read, self.written), f"{name}: {found}")
                    lists += 1
        self.assertGreaterEqual(lists, 6)


if __name__ == "__main__":
    unittest.main()
