# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards `lodestone build`: what it groups, and what it refuses."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

COMMAND = os.environ.get("LODESTONE_COMMAND", "build/release/lodestone")
SIDE = 14
CUBE = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def cube(number, x, y):
    """OBJ text of a unit cube, the number-th of its file."""
    lines = [f"o cube {number}"]
    lines += [f"v {x + (i & 1)} {y + (i >> 1 & 1)} {i >> 2}" for i in range(8)]
    lines += ["f " + " ".join(str(8 * number + i + 1) for i in face) for face in CUBE]
    return "\n".join(lines) + "\n"


class CommandBuild(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_command(self, *arguments):
        return subprocess.run(
            [COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=120
        )

    def model(self, text, name="model.obj"):
        path = self.folder / name
        path.write_text(text)
        return path

    def built(self, model, *arguments):
        """The groups by name, and the model's totals, of a store that is built."""
        store, found = self.folder / "store", self.folder / "info.json"
        done = self.run_command("build", model, store, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(
            self.run_command("info", store, "--objects", 1000, "--json", found).returncode, 0
        )
        report = json.loads(found.read_text())
        return [one["name"] for one in report["objects"] if one["group"]], report["model"]

    def test_a_model_of_nothing_is_built(self):
        done = self.run_command("build", self.model(""), self.folder / "store")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_many_things_in_one_group_get_nested_ones(self):
        model = self.model("".join(cube(i, i % SIDE * 3, i // SIDE * 3) for i in range(SIDE**2)))
        given, flat = self.built(model, "--groups", "given")
        self.assertEqual(len(given), 1)
        groups, nested = self.built(model)
        self.assertGreater(len(groups), 4)
        self.assertEqual(nested["triangles_placed"], flat["triangles_placed"])
        self.assertEqual(self.built(model)[0], groups)

    def test_few_things_stay_as_they_are(self):
        model = self.model("".join(cube(i, 3 * i, 0) for i in range(20)))
        self.assertEqual(len(self.built(model)[0]), 1)

    def test_groups_that_nobody_knows_are_usage(self):
        done = self.run_command("build", self.model(""), self.folder / "s", "--groups", "some")
        self.assertEqual(done.returncode, 2)
        self.assertIn("auto or given", done.stderr)

    # It ended with 0 and an empty store, after a line of "error:".
    def test_a_file_of_which_nothing_can_be_read_is_refused(self):
        far = self.model("v 0 0 0\nv 1 0 0\nf 1 2 9\n", "far.obj")
        head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        head += "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        nan = self.model(head + "end_header\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "nan.ply")
        for path in (far, nan):
            for verb in (("build", path, self.folder / "s"), ("measure", path)):
                with self.subTest(verb=verb):
                    done = self.run_command(*verb)
                    self.assertEqual(done.returncode, 4, done.stderr)
                    self.assertIn(f"nothing of '{path}' can be read", done.stderr)
        self.assertFalse((self.folder / "s").exists())


if __name__ == "__main__":
    unittest.main()
