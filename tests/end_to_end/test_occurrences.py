# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards truth on whole scenes: the model's occurrences equal Blender's instances, one to one."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
DATA = Path(os.environ.get("LODESTONE_DATA") or ROOT.parent / "shared" / "data")

# Instances with faces in what samples/real_scenes.py makes, counted by Blender's own list
REAL = {
    "armory-platformer": 91,
    "armory-race-track": 198,
    "cityjson-3dbag": 98,
    "godot-mesh-lod-room": 17,
    "kaykit-city-bits": 61,
    "stk-cocoa_temple": 2482,
    "tps-forklift": 1,
}


def in_blender(script, *arguments):
    """What Blender prints; fails with it when the script does."""
    command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
    done = subprocess.run(
        [*command, "--python", str(script), "--", *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, "BLENDER_USER_SCRIPTS": str(STAGE)},
        timeout=300,
    )
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)
    return done.stdout


class Occurrences(unittest.TestCase):
    def setUp(self):
        if not (STAGE / "addons" / "lodestone" / "__init__.py").is_file():
            self.skipTest("the add-on is not staged")

    def told(self, *files):
        said = in_blender(ROOT / "tests" / "end_to_end" / "print_differences.py", *files)
        lines = [line for line in said.splitlines() if line.startswith("DIFFERENCES ")]
        found = [json.loads(line.split(" ", 1)[1]) for line in lines]
        for item in found:
            for difference in item["differences"]:
                print(f"{item['file']}: {difference}")
        self.assertEqual([item["file"] for item in found], list(files))
        return found

    def test_the_street(self):
        with tempfile.TemporaryDirectory() as folder:
            blend = str(Path(folder) / "street.blend")
            in_blender(ROOT / "samples" / "street" / "make_street.py", "--out", blend)
            (street,) = self.told(blend)
        self.assertEqual(street["differences"], [])
        self.assertEqual(street["occurrences"], street["shown"])
        self.assertGreater(street["occurrences"], 5000)

    def test_real_scenes(self):
        if not (DATA / "scenes").is_dir():
            self.skipTest("no real scenes in LODESTONE_DATA")
        with tempfile.TemporaryDirectory() as folder:
            script = ROOT / "samples" / "real_scenes.py"
            done = subprocess.run(
                ["/usr/bin/python3", str(script), "--prepare-only"]
                + ["--data", str(DATA), "--out", folder],
                capture_output=True,
                text=True,
                timeout=300,
            )
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            made = {Path(line).stem: line for line in done.stdout.split()}
            self.assertEqual(sorted(made), sorted(REAL))
            for item in self.told(*made.values()):
                with self.subTest(item["file"]):
                    self.assertEqual(item["differences"], [])
                    self.assertEqual(item["occurrences"], item["shown"])
                    self.assertEqual(item["occurrences"], REAL[Path(item["file"]).stem])


if __name__ == "__main__":
    unittest.main()
