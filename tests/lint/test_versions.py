# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that one version is told everywhere: CMake, add-on, manifest, change log, library."""

import ast
import ctypes
import os
import re
import unittest
from pathlib import Path

from repository import ROOT, text_of

ADDON = "blender_addon/lodestone/__init__.py"
MANIFEST = "blender_addon/lodestone/blender_manifest.toml"
LIBRARY = Path(os.environ.get("LODESTONE_BUILD", ROOT / "build/release")) / (
    "backend/liblodestone.so"
)


def cmake_version(text: str) -> str:
    return re.search(r"project\(lodestone VERSION ([\d.]+)", text).group(1)


def newest_change(text: str) -> str:
    return re.search(r"^## (?:Version )?(\d+\.\d+\.\d+)\b", text, re.MULTILINE).group(1)


def addon_version(text: str) -> str:
    """From bl_info, read as Blender does: without running the file."""
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "bl_info":
            return ".".join(map(str, ast.literal_eval(node.value)["version"]))
    raise ValueError("no bl_info")


class TheCheck(unittest.TestCase):
    def test_versions_are_read(self):
        self.assertEqual(cmake_version("project(lodestone VERSION 1.2.3 LANGUAGES C)"), "1.2.3")
        self.assertEqual(newest_change("# Changes\n\n## 2.0.1\n\n## 1.0.0\n"), "2.0.1")
        self.assertEqual(addon_version("bl_info = {'version': (0, 10, 2)}"), "0.10.2")
        with self.assertRaises(ValueError):
            addon_version("")


class TheRepository(unittest.TestCase):
    def setUp(self):
        self.version = cmake_version(text_of("CMakeLists.txt"))

    def test_newest_change_is_of_this_version(self):
        self.assertEqual(newest_change(text_of("CHANGELOG.md")), self.version)

    def test_add_on_tells_this_version(self):
        self.assertEqual(addon_version(text_of(ADDON)), self.version)
        if (ROOT / MANIFEST).is_file():
            told = re.search(r'^version\s*=\s*"([^"]+)"', text_of(MANIFEST), re.MULTILINE)
            self.assertEqual(told.group(1), self.version)

    def test_library_tells_this_version(self):
        library = ctypes.CDLL(str(LIBRARY))
        library.lds_version.restype = ctypes.c_char_p
        library.lds_abi_version.restype = ctypes.c_uint32
        self.assertEqual(library.lds_version().decode(), self.version)
        header = text_of("backend/include/lodestone/lodestone.h")
        macros = dict(re.findall(r'#define (LDS_\w*VERSION) "?([\w.]+)"?', header))
        self.assertEqual(library.lds_abi_version(), int(macros["LDS_ABI_VERSION"]))
        self.assertEqual(macros.get("LDS_VERSION", self.version), self.version)


if __name__ == "__main__":
    unittest.main()
