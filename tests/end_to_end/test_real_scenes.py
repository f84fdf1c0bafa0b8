# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards work on files nobody made for us: each renders at Pixel Error 1 and 0, whole reports."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
DATA = Path(os.environ.get("LODESTONE_DATA") or ROOT.parent / "shared" / "data")
SCENES = (
    "armory-race-track/race_track.blend",
    "armory-platformer/platformer.blend",
    "stk-cocoa_temple/cocoa_temple.blend",
)


class RealScenes(unittest.TestCase):
    def setUp(self):
        if not (STAGE / "addons" / "lodestone" / "batch.py").is_file():
            self.skipTest("the add-on is not staged")
        if not all((DATA / "scenes" / name).is_file() for name in SCENES):
            self.skipTest("no real scenes in LODESTONE_DATA")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_each_renders_approximated_and_whole(self):
        for name in SCENES:
            with self.subTest(name):
                self.render(name)

    def render(self, name):
        place = self.folder / Path(name).parent
        shutil.copytree(DATA / "scenes" / Path(name).parent, place)
        place.chmod(0o755)
        outs = [str(place / "one.png"), str(place / "zero.png")]
        views = [{"out": out, "pixel_error": t} for out, t in zip(outs, (1, 0))]
        (place / "views.json").write_text(json.dumps(views))
        done = subprocess.run(
            ["/usr/bin/python3", str(ROOT / "blender_addon" / "lodestone" / "batch.py"), "render"]
            + [str(place / Path(name).name), "--views", str(place / "views.json")]
            + ["--size", "160x90", "--antialias", "off", "--json", str(place / "report.json")],
            capture_output=True,
            text=True,
            env={**os.environ, "LODESTONE_STAGE": str(STAGE)},
            timeout=240,
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        report = json.loads((place / "report.json").read_text())
        one, zero = report["pictures"]
        self.assertEqual(zero["cut"]["triangles"], report["model"]["triangles_placed"])
        self.assertEqual(zero["cut"]["occurrences"], report["model"]["placements"])
        self.assertLess(one["cut"]["triangles"], zero["cut"]["triangles"])
        self.assertLessEqual(one["cut"]["largest_error_px"], 1.0)
        for out in outs:
            self.assertGreater(Path(out).stat().st_size, 1000)
        # Every image is drawn; what is not exact is named with its material or world
        codes = {p["code"] for p in report["problems"]}
        self.assertFalse(codes & {"texture_mean", "image_missing", "texture_coordinates"})
        for problem in report["problems"]:
            self.assertTrue(problem["object"] and problem["message"], problem)


if __name__ == "__main__":
    unittest.main()
