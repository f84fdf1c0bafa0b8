# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards `lodestone povray`: a picture of a model or store without Blender, and what it refuses."""

import json
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

COMMAND = os.environ.get("LODESTONE_COMMAND", "build/release/lodestone")
CUBE = """o Cube
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8
"""


@unittest.skipIf(shutil.which("povray") is None, "no POV-Ray")
class CommandPovray(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.model = self.folder / "cube.obj"
        self.model.write_text(CUBE)
        self.out = self.folder / "cube.png"

    def run_command(self, *arguments):
        return subprocess.run(
            [COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=60
        )

    def picture(self, *arguments):
        report = self.folder / "report.json"
        done = self.run_command("povray", *arguments, "--out", self.out, "--json", report)
        self.assertEqual(done.returncode, 0, done.stderr)
        data = self.out.read_bytes()
        return struct.unpack(">II", data[16:24]), data, json.loads(report.read_text())

    def test_a_model_without_camera_and_light_is_framed_and_lit(self):
        size, data, report = self.picture(self.model, "--size", "64x48", "--antialias", "off")
        self.assertEqual(size, (64, 48))
        self.assertIn(b"tEXtLodestone\0", data)
        self.assertEqual(report["cut"]["triangles"], 12)
        self.assertEqual(report["povray"]["exit_code"], 0)
        other = self.folder / "black.png"
        eye = ("--eye", "0,0,100", "--look-at", "0,0,200")  # looks away
        done = self.run_command("povray", self.model, *eye, "--size", "64x48", "--out", other)
        self.assertEqual(done.returncode, 0, done.stderr)
        compared = self.run_command("compare", self.out, other)
        self.assertGreater(float(compared.stdout.split()[1]), 0.02, compared.stdout)

    def test_a_store_is_rendered_and_its_scene_kept_where_asked(self):
        store, scene = self.folder / "store", self.folder / "scene"
        self.assertEqual(self.run_command("build", self.model, store).returncode, 0)
        size, _, report = self.picture(
            store, "--size", "32x18", "--pixel-error", "50", "--scene", scene
        )
        self.assertEqual(report["pixel_error"], 50)
        self.assertTrue((scene / "scene.pov").is_file())
        self.assertEqual(size, (32, 18))

    def test_classes_of_rays_are_reported_and_nonsense_refused(self):
        look = ("cut", self.model, "--eye", "5,5,5")
        report = self.folder / "cut.json"
        done = self.run_command(*look, "--ray-classes", "shadow,reflection", "--json", report)
        self.assertEqual(done.returncode, 0, done.stderr)
        rays = json.loads(report.read_text())["rays"]
        self.assertEqual(list(rays), ["shadow", "reflection"])
        self.assertEqual((rays["shadow"]["own"], rays["shadow"]["triangles"]), (0, 12))
        for nonsense in ("shadows", "shadow,", "", "camera"):
            done = self.run_command(*look, "--ray-classes", nonsense)
            self.assertEqual(done.returncode, 2, nonsense)
            self.assertIn("expected", done.stderr)

    def test_an_eye_that_is_too_far_away_is_named(self):
        for eye in ("1e300,0,0", "0,-1e200,0", "nan,0,0"):
            done = self.run_command("cut", self.model, "--eye", eye)
            self.assertEqual(done.returncode, 2, eye)
            self.assertIn("--eye is", done.stderr)
            self.assertNotIn("camera.right", done.stderr)

    def test_a_budget_finds_the_pixel_error_that_fits(self):
        store, report = self.folder / "store", self.folder / "cut.json"
        self.assertEqual(self.run_command("build", self.model, store).returncode, 0)
        look = (store, "--eye", "5,5,5", "--json", report)
        plain = self.run_command("cut", *look, "--max-triangles", "12")
        self.assertEqual(plain.returncode, 0, plain.stderr)
        said = json.loads(report.read_text())
        self.assertEqual((said["pixel_error"], said["cut"]["triangles"]), (0, 12))
        self.assertEqual(said["budget"], {"triangles": 12, "bytes": 0, "fits": True})
        done = self.run_command("cut", *look, "--max-memory", "0.000001")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("even the coarsest levels cost more", done.stderr)
        self.assertFalse(json.loads(report.read_text())["budget"]["fits"])
        for wrong in (("--max-triangles", "0"), ("--criterion", "beauty")):
            done = self.run_command("cut", *look, *wrong)
            self.assertEqual(done.returncode, 2)
            self.assertIn(wrong[0], done.stderr)

    def test_mistakes_are_sentences_and_leave_the_old_picture(self):
        self.out.write_bytes(b"last night's picture")
        out = ("--out", self.out)
        cases = (
            (2, ("povray", self.model), "--out"),
            (2, ("povray", self.model, "--out", "x.jpg"), "--out"),
            (2, ("povray", self.model, *out, "--size", "0x3"), "--size"),
            (2, ("povray", self.model, *out, "--bounces", "9"), "a number from 0 to 8 expected"),
            (2, ("povray", self.model, *out, "--camera", "Far"), "Far"),
            (2, ("povray", self.model, *out, "--antialias", "some"), "--antialias"),
            (4, ("povray", self.folder / "none.obj", *out), "none.obj"),
            (1, ("povray", self.model, *out, "--program", "/nowhere/povray"), "/nowhere/povray"),
            (1, ("povray", self.model, *out, "--program", "/bin/false"), "POV-Ray"),
        )
        for code, arguments, text in cases:
            with self.subTest(text):
                done = self.run_command(*arguments)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(text, done.stderr)
        self.assertEqual(self.out.read_bytes(), b"last night's picture")
        self.assertEqual(
            sorted(item.name for item in self.folder.iterdir()), ["cube.obj", "cube.png"]
        )


if __name__ == "__main__":
    unittest.main()
