# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards tidiness: licenses, sizes, places; nothing of one machine gets in."""

import re
import unittest

from repository import ROOT, files, run, text_of

TOP_LEVEL = {
    "CMakeLists.txt",
    "CMakePresets.json",
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "LICENSE",
    "backend",
    "blender_addon",
    "povray_export",
    "tests",
    "samples",
}
SOURCE = re.compile(r".*\.(h|cpp|c|py|sh|cmake|pov|inc)|(.*/)?CMakeLists\.txt|\.ci/run")
PICTURE = re.compile(r".*\.(png|jpe?g|gif|svg|webp|exr)", re.IGNORECASE)
BINARY = re.compile(r".*\.(png|jpe?g|gif|webp|exr|blend|glb|zip|bin)", re.IGNORECASE)
# A path of one machine: /work/ and the like at the start of a path, not inside a longer one.
MACHINE_PATH = re.compile(r"(?<![\w.$}*-])/(work|tmp|root|home|farm)/")
# A file above the limit says why near its top.
LONG_REASON = re.compile(r"(over|above|more than) 500 lines", re.IGNORECASE)
LONGEST = 500


def machine_paths(text: str) -> list[str]:
    """The lines of a text that name a path of one machine."""
    return [line.strip() for line in text.splitlines() if MACHINE_PATH.search(line)]


def is_too_long(text: str) -> bool:
    lines = text.splitlines()
    return len(lines) > LONGEST and not LONG_REASON.search("\n".join(lines[:30]))


def lacks_license(text: str) -> bool:
    return "SPDX-License-Identifier: GPL-3.0-or-later" not in "\n".join(text.splitlines()[:3])


class TheCheck(unittest.TestCase):
    def test_machine_paths_are_found_and_others_are_not(self):
        for bad in ("cd /work/main", '"/tmp/x"', "see /home/me/a", "PATH=/root/bin"):
            self.assertEqual(len(machine_paths(bad)), 1, bad)
        for good in ("build/tmp/x", "$TMPDIR/tmp/", "frame/work/", "//lodestone/NAME/", "a/root/b"):
            self.assertEqual(machine_paths(good), [], good)

    def test_a_long_file_needs_a_reason(self):
        self.assertFalse(is_too_long("x\n" * LONGEST))
        self.assertTrue(is_too_long("x\n" * (LONGEST + 1)))
        self.assertFalse(is_too_long("// Over 500 lines: one table.\n" + "x\n" * LONGEST))

    def test_a_missing_license_is_found(self):
        self.assertTrue(lacks_license("int x;\n"))
        self.assertTrue(lacks_license("\n\n\n// SPDX-License-Identifier: GPL-3.0-or-later\n"))
        self.assertFalse(lacks_license("#!/bin/sh\n# SPDX-License-Identifier: GPL-3.0-or-later\n"))


class TheRepository(unittest.TestCase):
    maxDiff = None

    def test_files_are_found(self):
        self.assertIn("CMakeLists.txt", files())
        self.assertGreater(len([name for name in files() if SOURCE.fullmatch(name)]), 40)

    def test_top_level_holds_only_what_the_design_names(self):
        entries = {name.split("/")[0] for name in files()}
        self.assertEqual({e for e in entries if not e.startswith(".")} - TOP_LEVEL, set())

    def test_sources_name_their_license(self):
        lacking = [n for n in files() if SOURCE.fullmatch(n) and lacks_license(text_of(n))]
        self.assertEqual(lacking, [])
        self.assertIn("GNU GENERAL PUBLIC LICENSE", text_of("LICENSE"))

    def test_long_files_say_why(self):
        long = [n for n in files() if SOURCE.fullmatch(n) and is_too_long(text_of(n))]
        self.assertEqual(long, [])

    def test_no_path_of_one_machine(self):
        found = {
            name: lines
            for name in files()
            if not name.startswith("tests/") and not BINARY.fullmatch(name)
            if (lines := machine_paths((ROOT / name).read_text("utf-8", errors="replace")))
        }
        self.assertEqual(found, {})

    def test_nothing_is_large(self):
        sizes = {name: (ROOT / name).stat().st_size for name in files()}
        self.assertEqual([name for name, size in sizes.items() if size > 2**20], [])
        pictures = [n for n, size in sizes.items() if PICTURE.fullmatch(n) and size > 300_000]
        self.assertEqual(pictures, [])

    def test_shell_scripts_parse_and_stop_at_the_first_error(self):
        scripts = [name for name in files() if name.endswith(".sh") or name == ".ci/run"]
        self.assertIn("tests/run.sh", scripts)
        for name in scripts:
            with self.subTest(name):
                done = run("bash", "-n", name)
                self.assertEqual((done.returncode, done.stdout), (0, ""))
                self.assertIn("\nset -euo pipefail\n", text_of(name))

    def test_every_backend_test_opens_with_what_it_guards(self):
        for name in files():
            if re.fullmatch(r"tests/(backend|povray|capi)/(\w+/)*test_\w+\.(cpp|c)", name):
                self.assertRegex(text_of(name).split("\n")[1], r"^(//|/\*) \w", name)

    def test_package_lists_are_sound(self):
        seen = []
        for name in ("samples/packages.txt", "tests/packages.txt"):
            for line in text_of(name).splitlines():
                package = line.split("#")[0].strip()
                if package:
                    self.assertRegex(package, r"^[a-z0-9][a-z0-9.+-]+$")
                    seen.append(package)
        self.assertEqual(len(seen), len(set(seen)), "a package is listed twice")


if __name__ == "__main__":
    unittest.main()
