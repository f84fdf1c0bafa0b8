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


class Shards(unittest.TestCase):
    def counts(self, script: str) -> tuple[int, str]:
        """The same after run_shards.py ran a program in the place of a GoogleTest one."""
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "program"
            program.write_text("#!/bin/sh\n" + script, encoding="utf-8")
            program.chmod(0o755)
            junit = Path(folder) / "out.xml"
            command = [sys.executable, str(ROOT / "tests/run_shards.py"), "--junit", str(junit)]
            subprocess.run([*command, "--seconds", "5", str(program)], capture_output=True)
            command = [sys.executable, str(ROOT / "tests/count.py"), str(junit)]
            done = subprocess.run(command, capture_output=True, text=True)
            return done.returncode, done.stdout

    WRITE = (
        'out=${1#--gtest_output=xml:}\n[ "$GTEST_SHARD_INDEX" != 0 ] || tests="'
        "<testcase classname='A' name='b' status='run'/>\"\n"
        "echo \"<testsuite><testcase classname='C' name='$GTEST_SHARD_INDEX'/>$tests"
        '</testsuite>" >"$out"\n'
    )

    def test_every_process_counts(self):
        code, said = self.counts(self.WRITE)
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"\d+ passed, 0 failed, 0 skipped")

    def test_a_leak_after_passed_tests_fails(self):
        code, said = self.counts(self.WRITE + '[ "$GTEST_SHARD_INDEX" != 1 ] || exit 23')
        self.assertEqual(code, 1)
        self.assertIn("part 2 of", said)
        self.assertIn(" 1 failed, ", said)

    def test_a_crash_is_named_by_the_test_it_was_in(self):
        crash = "echo '[ RUN      ] A.Crashes'; kill -SEGV $$"
        code, said = self.counts(
            f'if [ "$GTEST_SHARD_INDEX" = 1 ]; then {crash}; fi\n' + self.WRITE
        )
        self.assertEqual(code, 1)
        self.assertIn("A.Crashes (exit code -11)", said)
        self.assertIn(" 1 failed, ", said)


if __name__ == "__main__":
    unittest.main()
