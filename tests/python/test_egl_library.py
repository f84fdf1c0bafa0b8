# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the look for libEGL: Blender ends where it is missing, and needs none on a display."""

import os
import shutil
import subprocess
import unittest
from unittest import mock

import addon_path  # noqa: F401
from lodestone.core import egl_library


class EglLibrary(unittest.TestCase):
    def found(self, library, display=""):
        """Whether Blender finds the library, or a display that makes it needless."""
        with mock.patch.object(egl_library, "LIBRARY", library):
            with mock.patch.dict(os.environ, {"DISPLAY": display}):
                return not egl_library.missing()

    def test_a_library_that_no_machine_has_is_missing(self):
        self.assertFalse(self.found("libEGL_of_no_machine.so"))

    def test_a_library_that_every_machine_has_is_not(self):
        self.assertTrue(self.found("libc.so.6"))

    def test_a_display_that_does_not_answer_is_none(self):
        self.assertFalse(self.found("libEGL_of_no_machine.so", "nowhere:7"))

    @unittest.skipIf(shutil.which("Xvfb") is None, "no Xvfb")
    def test_on_a_display_the_library_is_not_needed(self):
        read, write = os.pipe()
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24"]
        server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        os.close(write)
        with os.fdopen(read) as numbers:
            display = f":{numbers.readline().strip()}"
        self.assertTrue(self.found("libEGL_of_no_machine.so", display))


if __name__ == "__main__":
    unittest.main()
