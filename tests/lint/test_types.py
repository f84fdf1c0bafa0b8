# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the types of Python: mypy --strict on the binding, on what makes it, and on the add-on's
core. Above core there is bpy, which has no types in Debian."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from repository import ROOT

BUILD = Path(os.environ.get("LODESTONE_BUILD", ROOT / "build/release"))
MAKERS = ROOT / "backend/python"


def complaints(*arguments: str | Path, path: tuple[Path, ...] = ()) -> list[str]:
    """What mypy says of files or packages (-p NAME), without its last line."""
    done = subprocess.run(
        ["/usr/bin/python3", "-m", "mypy", "--strict", "--no-error-summary"]
        + ["--cache-dir", BUILD / "mypy", *arguments],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "MYPYPATH": os.pathsep.join(map(str, (*path, BUILD / "python")))},
    )
    lines = done.stdout.splitlines()
    return lines if lines or done.returncode == 0 else [f"mypy: exit code {done.returncode}"]


class TheCheck(unittest.TestCase):
    def complaints_about(self, text: str) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "caller.py"
            file.write_text("import lodestone_native as native\n" + text)
            return complaints(file)

    def test_right_calls_are_right(self):
        text = "with native.Model() as model:\n    print(model.totals().triangles_placed + 1)\n"
        self.assertEqual(self.complaints_about(text), [])

    def test_wrong_names_and_types_are_found(self):
        wrong = {
            "native.Model().totals().triangles": 'has no attribute "triangles"',
            "native.Model().write(3)": 'incompatible type "int"; expected "str"',
            "library().lds_model_destroy(1)": 'incompatible type "int"; expected "c_void_p"',
            "structs.Camera(naem=b'')": 'Unexpected keyword argument "naem"',
        }
        uses = (
            "from lodestone_native import structs\nfrom lodestone_native.library import library\n"
        )
        found = self.complaints_about(uses + "\n".join(wrong))
        self.assertEqual(len(found), len(wrong), found)
        for line, said in zip(found, wrong.values()):
            self.assertIn(said, line)


class TheRepository(unittest.TestCase):
    maxDiff = None

    def test_the_binding_is_strict(self):
        self.assertEqual(complaints("-p", "lodestone_native"), [])

    def test_the_core_of_the_add_on_is_strict(self):
        self.assertEqual(complaints("-p", "lodestone.core", path=(ROOT / "blender_addon",)), [])

    def test_what_makes_the_binding_is_strict(self):
        self.assertEqual(complaints(MAKERS / "generate_binding.py", path=(MAKERS,)), [])


if __name__ == "__main__":
    unittest.main()
