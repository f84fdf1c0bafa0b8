# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards motion.json: a hint that comes back as it was, and that nothing broken gets out of."""

import tempfile
import unittest
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.store import motion_file

NOTHING = {"still_shape": [], "still_place": []}


class MotionFile(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.store = Path(folder.name) / "new" / "store"

    def test_a_missing_one_says_nothing(self):
        self.assertEqual(motion_file.read(self.store), NOTHING)

    def test_what_was_written_comes_back(self):
        still = {"still_shape": ["0123456789abcdef"], "still_place": []}
        motion_file.write(self.store, still)
        self.assertEqual(motion_file.read(self.store), still)
        self.assertEqual([path.name for path in self.store.iterdir()], ["motion.json"])

    def test_the_same_again_is_not_written_again(self):
        still = {"still_shape": [], "still_place": ["0123456789abcdef"]}
        motion_file.write(self.store, still)
        before = (self.store / "motion.json").stat()
        motion_file.write(self.store, {kind: tuple(uids) for kind, uids in still.items()})
        after = (self.store / "motion.json").stat()
        self.assertEqual((before.st_ino, before.st_mtime_ns), (after.st_ino, after.st_mtime_ns))

    def test_broken_and_foreign_ones_say_nothing(self):
        self.store.mkdir(parents=True)
        for text in ("", "[1]", '{"still_shape": "x"}', '{"still_place": [1, "..", null]}', "{"):
            (self.store / "motion.json").write_text(text)
            self.assertEqual(motion_file.read(self.store), NOTHING, text)


if __name__ == "__main__":
    unittest.main()
