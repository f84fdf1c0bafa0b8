# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards one look of all code: clang-format, black, flake8, as the repository configures them."""

import unittest

from repository import CPP_ENDINGS, files_ending, run, text_of

FLAKE8 = ("flake8", "--isolated", "--max-line-length=100", "--extend-ignore=E203,W503,F722,F821")
# Blender's properties are annotations that no type has the name of; elsewhere a name without a
# meaning is an error that shows when it is used.
NAMES = ("flake8", "--isolated", "--select=F821")


class Formatting(unittest.TestCase):
    def assert_silent(self, *command: str):
        done = run(*command)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_clang_format_would_change_nothing(self):
        sources = files_ending(*CPP_ENDINGS)
        self.assertGreater(len(sources), 20)
        self.assert_silent("clang-format", "--dry-run", "-Werror", *sources)

    def test_black_would_change_nothing(self):
        sources = files_ending(".py")
        self.assertGreater(len(sources), 5)
        self.assert_silent("black", "-q", "--check", "--diff", "-l100", "-tpy310", *sources)

    def test_flake8_finds_nothing(self):
        self.assert_silent(*FLAKE8, *files_ending(".py"))

    def test_names_that_mean_nothing_were_found_by_blender_alone(self):
        sources = [path for path in files_ending(".py") if "bpy.props" not in text_of(path)]
        self.assertGreater(len(sources), 5)
        self.assert_silent(*NAMES, *sources)


if __name__ == "__main__":
    unittest.main()
