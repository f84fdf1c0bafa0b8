# SPDX-License-Identifier: GPL-3.0-or-later
"""How the Blender of a batch job is started."""

import unittest
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.batch import file_task


class Environment(unittest.TestCase):
    def test_its_temporary_files_go_to_its_folder_and_its_memory_comes_in_large_pages(self):
        given = file_task._environment({"TMPDIR": "/elsewhere", "HOME": "/h"}, Path("/place"))
        self.assertEqual(given, {"MALLOC_CONF": "thp:always", "TMPDIR": "/place", "HOME": "/h"})

    def test_how_it_asks_for_memory_is_left_as_the_user_has_it(self):
        given = file_task._environment({"MALLOC_CONF": "thp:never"}, Path("/place"))
        self.assertEqual(given["MALLOC_CONF"], "thp:never")


if __name__ == "__main__":
    unittest.main()
