# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards names and common mistakes: clang-tidy on what changed lately, on all with TIDY_ALL=1."""

import json
import os
import tempfile
import time
import unittest
from pathlib import Path

from repository import ROOT, files_ending, run
from tidy import Tidy

BUILD = ROOT / "build/debug"  # nothing is precompiled there: a forgotten include is an error
COMMITS = 50


def lately_changed() -> list[str]:
    """The .cpp files of the last commits and of the work not committed yet, that still exist."""
    names = set(
        run("git", "log", f"-{COMMITS}", "--format=", "--name-only", "--", "*.cpp").stdout.split()
        + run("git", "diff", "--name-only", "HEAD", "--", "*.cpp").stdout.split()
        + run("git", "ls-files", "--others", "--exclude-standard", "*.cpp").stdout.split()
    )
    return [name for name in files_ending(".cpp") if name in names]


class Tidiness(unittest.TestCase):
    def test_a_bad_name_is_found_and_a_clean_file_is_remembered(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            (root / ".clang-tidy").write_bytes((ROOT / ".clang-tidy").read_bytes())
            (root / "part.h").write_text("inline int one() { return 1; }\n")
            (root / "good.cpp").write_text('#include "part.h"\nint two() { return one() + 1; }\n')
            (root / "bad.cpp").write_text("int TwoWords() { return 2; }\n")
            commands = [
                {
                    "directory": str(root),
                    "file": str(root / name),
                    "command": f"c++ -std=c++20 -I{root} -c {root / name}",
                }
                for name in ("good.cpp", "bad.cpp")
            ]
            (root / "compile_commands.json").write_text(json.dumps(commands))
            tidy = Tidy(root, root, root / "cache")

            complaints, ran = tidy.check_all(["good.cpp", "bad.cpp"])
            self.assertIn("TwoWords", complaints)
            self.assertNotIn("good.cpp", complaints)
            self.assertEqual(ran, 2)
            self.assertEqual(tidy.check_all(["good.cpp"]), ("", 0))
            (root / "part.h").write_text("inline int one() { return 3; }\n")
            self.assertEqual(tidy.check_all(["good.cpp"]), ("", 1))
            self.assertIn("not part of the build", tidy.check_all(["gone.cpp"])[0])

    def test_clang_tidy_finds_nothing(self):
        names = files_ending(".cpp") if os.environ.get("TIDY_ALL") else lately_changed()
        start = time.monotonic()
        configured = run("cmake", "--preset", "debug", "-DLODESTONE_TESTS=ON")
        self.assertEqual(configured.returncode, 0, configured.stdout)
        tidy = Tidy(ROOT, BUILD, ROOT / "build/tidy-cache")
        complaints, ran = tidy.check_all(names)
        print(
            f"{len(names)} files, {ran} not known yet, {time.monotonic() - start:.0f} s ...",
            end=" ",
            flush=True,
        )
        if complaints:
            self.fail("\n" + complaints)


if __name__ == "__main__":
    unittest.main()
