# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards flights: a frame in which nothing but the camera moves builds nothing and writes nothing
of the store, in one run and in the next."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
FRAMES = 4


def state(folder):
    """What any write would change: the time, number and size of every file but the lock."""
    found = {}
    for path in sorted(folder.glob("**/*")):
        if path.is_file() and path.name != "lock":
            info = path.stat()
            found[str(path)] = (info.st_mtime_ns, info.st_ino, info.st_size)
    return found


class CameraFlight(unittest.TestCase):
    def setUp(self):
        if not (STAGE / "addons" / "lodestone" / "batch.py").is_file():
            self.skipTest("the add-on is not staged")
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.store = self.folder / "store"

    def pictures(self, name):
        """Exports every frame; the report's pictures."""
        report = self.folder / f"{name}.json"
        command = ["/usr/bin/python3", str(ROOT / "blender_addon" / "lodestone" / "batch.py")]
        command += ["export", str(self.folder / "flight.blend"), "--out", str(self.folder / name)]
        command += ["--pixel-error", "1", "--frames", f"1-{FRAMES}", "--json", str(report)]
        command += ["--store", str(self.store)]
        done = subprocess.run(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "LODESTONE_STAGE": str(STAGE)},
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        return json.loads(report.read_text())["pictures"]

    def test_a_frame_in_which_only_the_camera_moves_writes_nothing_of_the_store(self):
        script = ROOT / "tests" / "end_to_end" / "make_camera_flight.py"
        command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(script), "--", str(self.folder / "flight.blend")]
        subprocess.run(command, check=True, capture_output=True)
        first = self.pictures("first")
        self.assertEqual(len(first), FRAMES)
        self.assertGreater(first[0]["build"]["built"], 1)
        self.assertGreater(first[0]["build"]["bytes_written"], 0)
        self.assertEqual([one["build"]["built"] for one in first[1:]], [0] * (FRAMES - 1))
        self.assertEqual([one["build"]["bytes_written"] for one in first[1:]], [0] * (FRAMES - 1))
        self.assertGreater(len({one["cut"]["triangles"] for one in first}), 1, "the frames differ")
        before = state(self.store)
        again = self.pictures("again")
        self.assertEqual([one["build"]["bytes_written"] for one in again], [0] * FRAMES)
        after = state(self.store)
        self.assertEqual([path for path in after if after[path] != before.get(path)], [])


if __name__ == "__main__":
    unittest.main()
