# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what a farm reads: the exit code of one file and of many."""

import unittest

import addon_path  # noqa: F401
from lodestone.core.exit_codes import STATUS, ExitCode, of_many


class OfMany(unittest.TestCase):
    def test_one_file_speaks_for_itself(self):
        for code in ExitCode:
            self.assertEqual(of_many([code]), code)

    def test_all_done_is_done(self):
        self.assertEqual(of_many([0, 0]), 0)

    def test_any_incomplete_is_incomplete(self):
        self.assertEqual(of_many([0, 3, 0]), 3)

    def test_any_failure_is_failure_whatever_its_kind(self):
        for code in (1, 4, 5):
            self.assertEqual(of_many([3, code, 0]), 1)

    def test_cancelled_is_cancelled(self):
        self.assertEqual(of_many([1, 0, 130]), 130)

    def test_every_code_has_a_status(self):
        self.assertEqual(set(STATUS), set(ExitCode))
        self.assertEqual(len(set(STATUS.values())), len(ExitCode))


if __name__ == "__main__":
    unittest.main()
