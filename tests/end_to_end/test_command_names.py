# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the command against names of files and in files: they are done, told, and nothing else."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blender"))
import hostile_names as hostile  # noqa: E402

COMMAND = os.environ.get("LODESTONE_COMMAND", "build/release/lodestone")
CUBE = b"""mtllib paint.mtl
o caf\xe9 \x1b[31m \xe2\x80\xae \xc2\x85 name\nusemtl \xff
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8
"""
PAINT = b"newmtl \xff\nKd 1 0 0\n"
STEMS = (
    hostile.full('"$(touch canary)\n', 251).encode(),
    b"\xff" * 251,
    b"--out",
    b"; touch canary #",
    b"%s%n",
)


class CommandNames(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.fsencode(folder.name)
        with open(self.folder + b"/paint.mtl", "wb") as file:
            file.write(PAINT)

    def made(self):
        return set(os.listdir(self.folder))

    def run_command(self, *arguments):
        done = subprocess.run(
            [os.path.abspath(COMMAND), *arguments],
            cwd=self.folder,
            capture_output=True,
            timeout=60,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout + done.stderr

    def test_a_full_disk_is_a_failure_even_when_nothing_but_words_are_lost(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([COMMAND, "version"], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1)
        self.assertIn(b"cannot write", done.stderr)

    def test_every_verb_takes_a_file_of_any_name_and_writes_what_it_was_told(self):
        for stem in STEMS:
            with self.subTest(stem):
                before = self.made()
                model, small, store = stem + b".obj", stem + b".glb", stem
                report = stem[:250] + b".json"
                with open(os.path.join(self.folder, model), "wb") as file:
                    file.write(CUBE)
                self.run_command("simplify", "--ratio", "0.5", "--", model, small)
                self.run_command("build", "--", model, store)
                self.run_command("cut", "--eye=9,9,9", "--json", report, "--", store)
                expected = {model, small, store, report}
                if shutil.which("povray") is not None:
                    picture = stem + b".png"
                    self.run_command("povray", "--size=8x6", "--out", picture, "--", store)
                    expected.add(picture)
                self.assertEqual(self.made() - before, expected)

    def test_names_in_a_file_steer_no_terminal_and_are_stored(self):
        with open(self.folder + b"/cube.obj", "wb") as file:
            file.write(CUBE)
        self.run_command("build", "cube.obj", "store")
        for verb in (("info",), ("measure", "--rays", "256"), ("cut", "--list", "--eye=9,9,9")):
            for model in ("cube.obj", "store"):
                said = self.run_command(*verb, model, "--json", "report.json")
                self.assertNotIn(b"\x1b", said)
                self.assertNotIn(b"\xe2\x80\xae", said)
                self.assertNotIn(b"\xc2\x85", said)
                with open(self.folder + b"/report.json", encoding="utf-8") as file:
                    self.assertEqual(json.load(file)["problems"], [])
        with open(self.folder + b"/store/tileset.json", encoding="utf-8") as file:
            self.assertIn("caf\ufffd \\u001b[31m", file.read())

    def test_names_of_ten_kilobytes(self):
        name = b"n" * 10_000
        with open(self.folder + b"/cube.obj", "wb") as file:
            file.write(CUBE.replace(b"caf\xe9", name).replace(b"usemtl \xff", b"usemtl " + name))
        with open(self.folder + b"/paint.mtl", "wb") as file:
            file.write(PAINT.replace(b"\xff", name))
        self.run_command("build", "cube.obj", "store")
        self.run_command("simplify", "cube.obj", "small.obj", "--ratio", "0.5")
        said = self.run_command("info", "store", "--json", "report.json")
        self.assertIn(name, said)


if __name__ == "__main__":
    unittest.main()
