# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards animations: every frame is that frame, and only what must be is built or written again."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
COMMAND = os.environ.get("LODESTONE_COMMAND") or str(ROOT / "build" / "release" / "lodestone")
FRAMES = 20
LEAST_SSIM = 0.93  # of a frame at Pixel Error 1 against full detail, on covered pixels


class Animation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not (STAGE / "addons" / "lodestone" / "batch.py").is_file():
            raise unittest.SkipTest("the add-on is not staged")
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.scratch.name)
        cls.blend = cls.folder / "stage.blend"
        script = ROOT / "tests" / "end_to_end" / "make_animation.py"
        command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(script), "--", str(cls.blend)]
        subprocess.run(command, check=True, capture_output=True)
        cls.one = cls.render("one", "1")
        cls.full = cls.render("full", "0")
        cls.mask = cls.render("mask", "0", "--covered-only")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def render(cls, name, pixel_error, *more):
        """The report's pictures, one a frame."""
        report = cls.folder / f"{name}.json"
        done = subprocess.run(
            ["/usr/bin/python3", str(ROOT / "blender_addon" / "lodestone" / "batch.py"), "render"]
            + [str(cls.blend), "--out", str(cls.folder / name), "--frames", f"1-{FRAMES}"]
            + ["--pixel-error", pixel_error, "--json", str(report), *more],
            capture_output=True,
            text=True,
            env={**os.environ, "LODESTONE_STAGE": str(STAGE)},
            timeout=240,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return json.loads(report.read_text())["pictures"]

    def ssim(self, a, b, mask):
        report = self.folder / "compare.json"
        command = [COMMAND, "compare", a, b, "--mask", mask, "--json", str(report)]
        subprocess.run(command, check=True, capture_output=True)
        return json.loads(report.read_text())["compare"]["ssim"]

    def test_every_frame_looks_like_its_full_detail(self):
        for one, full, mask in zip(self.one, self.full, self.mask, strict=True):
            self.assertEqual((one["frame"], mask["frame"]), (full["frame"], full["frame"]))
            found = self.ssim(one["picture"], full["picture"], mask["picture"])
            with self.subTest(frame=one["frame"], ssim=found):
                self.assertGreater(found, LEAST_SSIM)
                self.assertLess(one["cut"]["triangles"], full["cut"]["triangles"] / 2)

    def test_frames_differ(self):
        first, last = self.one[0]["picture"], self.one[-1]["picture"]
        self.assertLess(self.ssim(first, last, self.mask[0]["picture"]), LEAST_SSIM)

    def test_levels_are_built_once(self):
        self.assertGreater(self.one[0]["build"]["built"], 1)
        self.assertEqual({picture["build"]["built"] for picture in self.one[1:]}, {0})

    def test_what_does_not_change_is_not_written_again(self):
        for picture in self.full[1:]:  # scene.pov, scene.ini, the walker, the flag, the plant
            self.assertLessEqual(picture["export"]["written"], 5, picture["frame"])
        self.assertEqual(list(self.folder.glob("**/r/*.inc")), [])


if __name__ == "__main__":
    unittest.main()
