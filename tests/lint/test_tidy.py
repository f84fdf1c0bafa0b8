# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards names and common mistakes: clang-tidy on what changed lately, the newest first and for
TIDY_SECONDS at most; on all, and looking deeper, with TIDY_ALL=1."""

import json
import math
import os
import tempfile
import time
import unittest
from pathlib import Path

from repository import ROOT, files_ending, run
from tidy import Tidy

BUILD = ROOT / "build/debug"  # nothing is precompiled there: a forgotten include is an error
COMMITS = 50
AT_LEAST = 12  # files, however little time there is


def lately_changed() -> list[str]:
    """The .cpp files of the work not committed yet and of the last commits, that still exist, the
    newest first."""
    names = (
        run("git", "ls-files", "--others", "--exclude-standard", "*.cpp").stdout.split()
        + run("git", "diff", "--name-only", "HEAD", "--", "*.cpp").stdout.split()
        + run("git", "log", f"-{COMMITS}", "--format=", "--name-only", "--", "*.cpp").stdout.split()
    )
    there = set(files_ending(".cpp"))
    return [name for name in dict.fromkeys(names) if name in there]


class Tidiness(unittest.TestCase):
    def test_a_bad_name_is_found_and_a_clean_file_is_remembered(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            (root / ".clang-tidy").write_bytes((ROOT / ".clang-tidy").read_bytes())
            (root / "part.h").write_text("inline int one() { return 1; }\n")
            (root / "good.cpp").write_text('#include "part.h"\nint two() { return one() + 1; }\n')
            (root / "bad.cpp").write_text(
                "int TwoWords() { return 2; }\nint _Reserved() { return 2; }\n"
            )
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

            complaints, ran, left = tidy.check_all(["good.cpp", "bad.cpp"])
            self.assertIn("TwoWords", complaints)
            self.assertIn("_Reserved", complaints)
            self.assertNotIn("good.cpp", complaints)
            self.assertEqual((ran, left), (2, 0))
            self.assertEqual(tidy.check_all(["good.cpp"]), ("", 0, 0))
            (root / "part.h").write_text("inline int one() { return 3; }\n")
            self.assertEqual(tidy.check_all(["good.cpp", "bad.cpp"], -1, 1), ("", 1, 1))
            self.assertIn("not part of the build", tidy.check_all(["gone.cpp"]).complaints)

    def test_clang_tidy_finds_nothing(self):
        everything = bool(os.environ.get("TIDY_ALL"))
        names = files_ending(".cpp") if everything else lately_changed()
        start = time.monotonic()
        configured = run("cmake", "--preset", "debug", "-DLODESTONE_TESTS=ON")
        self.assertEqual(configured.returncode, 0, configured.stdout)
        tidy = Tidy(ROOT, BUILD, ROOT / "build/tidy-cache", deep=everything)
        seconds = math.inf if everything else float(os.environ.get("TIDY_SECONDS") or math.inf)
        complaints, ran, left = tidy.check_all(names, seconds, AT_LEAST)
        print(
            f"{len(names) - left} files, {ran} not known yet, {left} left to --tidy-all, "
            f"{time.monotonic() - start:.0f} s ...",
            end=" ",
            flush=True,
        )
        if complaints:
            self.fail("\n" + complaints)


if __name__ == "__main__":
    unittest.main()
