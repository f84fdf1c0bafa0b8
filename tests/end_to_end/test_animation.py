# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards animations: every frame is that frame, and only what must be is built or written again.

What deforms (a walker, a flag, a plant) is drawn with levels of one collapse for all frames.
"""

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
        # POV-Ray mostly sleeps over pictures as small as these: all at once
        one = cls.start("one", "render", (1, FRAMES), "1")
        full = cls.start("full", "render", (1, FRAMES), "0")
        last = cls.start("last", "export", (FRAMES, FRAMES), "1", "--store", cls.folder / "other")
        cls.one, cls.full, cls.last = cls.finish(one), cls.finish(full), cls.finish(last)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def start(cls, name, verb, frames, pixel_error, *more):
        report = cls.folder / f"{name}.json"
        command = ["/usr/bin/python3", str(ROOT / "blender_addon" / "lodestone" / "batch.py"), verb]
        command += [str(cls.blend), "--out", str(cls.folder / name), "--pixel-error", pixel_error]
        command += ["--frames", "{}-{}".format(*frames), "--json", str(report), *map(str, more)]
        process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "LODESTONE_STAGE": str(STAGE)},
        )
        return process, report

    @classmethod
    def finish(cls, started):
        """The report's pictures, one a frame."""
        process, report = started
        said, _ = process.communicate(timeout=240)
        assert process.returncode == 0, said
        return json.loads(report.read_text())["pictures"]

    def ssim(self, a, b):
        report = self.folder / "compare.json"
        command = [COMMAND, "compare", a, b, "--json", str(report)]
        subprocess.run(command, check=True, capture_output=True)
        return json.loads(report.read_text())["compare"]["ssim"]

    def test_every_frame_looks_like_its_full_detail(self):
        for one, full in zip(self.one, self.full, strict=True):
            self.assertEqual(one["frame"], full["frame"])
            found = self.ssim(one["picture"], full["picture"])
            with self.subTest(frame=one["frame"], ssim=found):
                self.assertGreater(found, LEAST_SSIM)
                # The walker, the flag and the plant alone have half of all triangles
                self.assertLess(one["cut"]["triangles"], full["cut"]["triangles"] / 50)
                self.assertEqual(one["cut"]["kinds"]["mesh"], 3)

    def test_frames_differ(self):
        first, last = self.one[0]["picture"], self.one[-1]["picture"]
        self.assertLess(self.ssim(first, last), LEAST_SSIM)

    def test_levels_are_built_once(self):
        self.assertGreater(self.one[0]["build"]["built"], 1)
        self.assertEqual({picture["build"]["built"] for picture in self.one[1:]}, {0})

    def test_what_does_not_change_is_not_written_again(self):
        for picture in self.full[1:]:  # scene.pov, scene.ini, the walker, the flag, the plant
            self.assertLessEqual(picture["export"]["written"], 5, picture["frame"])
        for made in ("one", "full", "lodestone"):
            self.assertEqual(list((self.folder / made).glob("**/r/*.inc")), [])

    def levels(self, store):
        """By what deforms: its levels in the frame the store is of, (triangles, file) each."""
        model = json.loads((store / "tileset.json").read_text())["asset"]["extras"]["lodestone"]
        found = {}
        for item in model["objects"]:
            if item["deforms"] and "bind_hash" in item:
                levels = item["representations"]
                files = [store / "r" / f"{level['hash']}.glb" for level in levels]
                found[item["name"]] = [
                    (level["triangles"], file.read_bytes()) for level, file in zip(levels, files)
                ]
        return found

    def test_a_process_that_renders_only_the_last_frame_makes_the_same_levels(self):
        after_all = self.levels(self.folder / "lodestone" / "stage")
        alone = self.levels(self.folder / "other")
        self.assertEqual(set(after_all), {"Walker", "Flag", "Plant"})
        self.assertEqual(after_all, alone)
        self.assertEqual(self.last[0]["cut"], self.one[-1]["cut"])
        for name, levels in after_all.items():
            self.assertGreater(len(levels), 3, name)


if __name__ == "__main__":
    unittest.main()
