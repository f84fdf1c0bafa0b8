# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the zip: whatever its libraries need is in it or on every machine that has Blender."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

from repository import ROOT, run

BUILD = Path(os.environ.get("LODESTONE_BUILD", ROOT / "build/release"))
STAGE = BUILD / "stage/addons/lodestone"

ON_EVERY_MACHINE = re.compile(
    r"(libc|libm|libdl|librt|libpthread|libstdc\+\+|libgcc_s|libz|ld-linux-[\w-]+)\.so\.\d+"
    r"|libtbb\.so\.12"
)
# Opened by name when rays are needed, so nothing NEEDs it.
OPENED_BY_NAME = ("libembree3.so.3",)


def dynamic(library: Path, tag: str) -> list[str]:
    text = run("readelf", "-dW", str(library)).stdout
    return re.findall(rf"\({tag}\)[^\[]*\[([^\]]*)\]", text)


def unmet_needs(folder: Path) -> list[str]:
    """`file needs name` for everything that is neither in the folder nor on every machine."""
    return [
        f"{library.name} needs {needed}"
        for library in sorted(folder.iterdir())
        for needed in dynamic(library, "NEEDED")
        if not ON_EVERY_MACHINE.fullmatch(needed) and not (folder / needed).is_file()
    ]


class TheCheck(unittest.TestCase):
    def test_a_missing_library_is_found(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.assertEqual(unmet_needs(folder), [])
            (folder / "x.c").write_text("int x(void) { return 1; }\n")
            common = ["cc", "-shared", "-fPIC", "-Wl,--no-as-needed"]
            run(*common, "-Wl,-soname,libx.so.1", "-o", f"{folder}/libx.so.1", f"{folder}/x.c")
            done = run(*common, "-o", f"{folder}/liby.so", f"{folder}/x.c", f"{folder}/libx.so.1")
            self.assertEqual(done.returncode, 0, done.stdout)
            (folder / "x.c").unlink()
            self.assertEqual(unmet_needs(folder), [])
            (folder / "libx.so.1").unlink()
            self.assertEqual(unmet_needs(folder), ["liby.so needs libx.so.1"])


@unittest.skipUnless(
    any((ROOT / "backend/src/capi").glob("*.cpp"))
    and (ROOT / "blender_addon/lodestone/__init__.py").is_file(),
    "there is no add-on to stage yet",
)
class TheStage(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.libraries = sorted(path.name for path in (STAGE / "lib").iterdir())

    def test_every_need_is_met(self):
        self.assertIn("liblodestone.so", self.libraries)
        for name in OPENED_BY_NAME:
            self.assertIn(name, self.libraries)
        self.assertEqual(unmet_needs(STAGE / "lib"), [])

    def test_files_are_named_as_others_ask_for_them(self):
        for name in self.libraries:
            self.assertEqual(dynamic(STAGE / "lib" / name, "SONAME"), [name])

    def test_bundled_libraries_are_found_from_their_own_folder(self):
        library = STAGE / "lib/liblodestone.so"
        self.assertEqual(dynamic(library, "RUNPATH"), [])
        self.assertEqual(dynamic(library, "RPATH")[0].split(":")[0], "$ORIGIN")
        code = "import ctypes, sys; ctypes.CDLL(sys.argv[1]); print(open('/proc/self/maps').read())"
        maps = subprocess.run(
            [sys.executable, "-c", code, str(library)], capture_output=True, text=True, check=True
        ).stdout
        loaded = {Path(path) for path in re.findall(r" (/\S+\.so\S*)$", maps, re.MULTILINE)}
        for name in set(self.libraries) - set(OPENED_BY_NAME):
            folders = {path.parent for path in loaded if path.name == name}
            self.assertEqual(folders, {(STAGE / "lib").resolve()}, name)

    def test_the_zip_holds_the_stage_below_one_folder(self):
        (archive,) = BUILD.glob("lodestone-*.zip")
        with zipfile.ZipFile(archive) as opened:
            packed = {entry.filename: opened.read(entry) for entry in opened.infolist()}
        staged = {
            f"lodestone/{path.relative_to(STAGE).as_posix()}": path.read_bytes()
            for path in STAGE.rglob("*")
            if path.is_file() and "__pycache__" not in path.parts
        }
        self.assertEqual(sorted(packed), sorted(staged))
        self.assertEqual([name for name in packed if packed[name] != staged[name]], [])
        for name in ("__init__.py", "lodestone_native/__init__.py", "lib/liblodestone.so"):
            self.assertIn(f"lodestone/{name}", packed)


if __name__ == "__main__":
    unittest.main()
