# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the last line of tests/run.sh: nothing that went wrong is counted as passed, or lost."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from repository import ROOT

HEAD = "import os, sys, unittest\nclass A(unittest.TestCase):\n    def test(self):\n        "


def counts(*files: str) -> tuple[int, str]:
    """(exit code, last line) of count.py after run_python.py ran files with these texts."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"test_{i}.py" for i in range(len(files))]
        for path, text in zip(paths, files):
            path.write_text(text, encoding="utf-8")
        junit = Path(folder) / "out.xml"
        command = [sys.executable, str(ROOT / "tests/run_python.py"), "--junit", str(junit)]
        if files:
            subprocess.run([*command, *map(str, paths)], capture_output=True)
        done = subprocess.run(
            [sys.executable, str(ROOT / "tests/count.py"), str(junit)],
            capture_output=True,
            text=True,
        )
        return done.returncode, done.stdout.splitlines()[-1]


class Counting(unittest.TestCase):
    def test_a_missing_result_fails(self):
        self.assertEqual(counts(), (1, "0 passed, 1 failed, 0 skipped"))

    def test_passed_is_passed(self):
        self.assertEqual(counts(HEAD + "pass"), (0, "1 passed, 0 failed, 0 skipped"))

    def test_skipped_alone_is_not_enough(self):
        self.assertEqual(counts(HEAD + "self.skipTest('')"), (1, "0 passed, 0 failed, 1 skipped"))

    def test_every_way_to_fail_is_counted_once(self):
        for text in (
            HEAD + "self.fail('\\x00 <&>')",
            HEAD + "raise KeyError",
            HEAD + "for i in range(3):\n            with self.subTest(i): self.fail()",
            HEAD + "pass\n    @classmethod\n    def setUpClass(cls): raise OSError",
            HEAD + "os._exit(0)",
            HEAD + "os.abort()",
            "import a_module_that_is_not_there",
            "import sys; sys.exit(0)",
            "x = 1",
        ):
            with self.subTest(text):
                self.assertEqual(counts(text), (1, "0 passed, 1 failed, 0 skipped"))

    def test_a_crash_keeps_what_was_before_and_fails_what_would_have_come(self):
        files = (HEAD + "pass", HEAD + "os.abort()", HEAD + "pass")
        self.assertEqual(counts(*files), (1, "1 passed, 2 failed, 0 skipped"))


if __name__ == "__main__":
    unittest.main()
