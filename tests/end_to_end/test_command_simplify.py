# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards `lodestone simplify`: modes and targets do what they say, also for several objects."""

import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

COMMAND = os.environ.get("LODESTONE_COMMAND", "build/release/lodestone")
MODES = ("best", "fast", "cluster")
CELLS = 24
TRIANGLES = 2 * CELLS * CELLS


def waves(name, first, x, side):
    """OBJ text of a wavy square sheet of `side` metres at x, its first vertex numbered `first`."""
    lines = [f"o {name}"]
    for j in range(CELLS + 1):
        for i in range(CELLS + 1):
            u, v = i / CELLS, j / CELLS
            height = 0.05 * side * math.sin(9 * u) * math.cos(7 * v)
            lines.append(f"v {x + side * u:.6f} {height:.6f} {side * v:.6f}")
    for j in range(CELLS):
        for i in range(CELLS):
            a = first + j * (CELLS + 1) + i
            lines.append(f"f {a} {a + 1} {a + CELLS + 2} {a + CELLS + 1}")
    return "\n".join(lines) + "\n"


class CommandSimplify(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.model = self.folder / "two.obj"
        second = (CELLS + 1) ** 2 + 1
        self.model.write_text(waves("Small", 1, 0, 1) + waves("Large", second, 5, 15))

    def run_command(self, *arguments):
        return subprocess.run(
            [COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=60
        )

    def simplified(self, *arguments):
        """The report's "simplify", and the triangles of each object of the result by name."""
        out, report = self.folder / "out.glb", self.folder / "report.json"
        done = self.run_command("simplify", self.model, out, *arguments, "--json", report)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = self.folder / "info.json"
        self.assertEqual(self.run_command("info", out, "--json", found).returncode, 0)
        objects = json.loads(found.read_text())["objects"]
        counts = {one["name"]: one["levels"][0]["triangles"] for one in objects if not one["group"]}
        return json.loads(report.read_text())["simplify"], counts

    def test_every_mode_keeps_the_target_in_every_object(self):
        for mode in MODES:
            for target in (("--ratio", 0.25), ("--triangles", TRIANGLES // 2)):
                with self.subTest(mode=mode, target=target):
                    report, counts = self.simplified(*target, "--mode", mode)
                    self.assertEqual(report["mode"], mode)
                    self.assertEqual(report["triangles_before"], 2 * TRIANGLES)
                    self.assertEqual(sum(counts.values()), report["triangles"])
                    for name in ("Small", "Large"):
                        self.assertLessEqual(counts[name], TRIANGLES // 4)
                        self.assertGreater(counts[name], TRIANGLES // 5)
                    self.assertGreater(report["cpu_s"], 0)
                    self.assertLess(report["cpu_s"], 1)
                    self.assertNotIn("error", report)

    def test_fast_is_the_default(self):
        report, counts = self.simplified("--ratio", 0.2)
        self.assertEqual(report["mode"], "fast")
        self.assertEqual(counts, self.simplified("--ratio", 0.2, "--mode", "fast")[1])

    def test_nothing_vanishes_however_little_is_wanted(self):
        for mode in MODES:
            _, counts = self.simplified("--triangles", 1, "--mode", mode)
            self.assertGreaterEqual(min(counts.values()), 1, mode)

    def test_an_error_is_kept_and_larger_ones_save_more(self):
        for mode in MODES:
            fine, _ = self.simplified("--error", 0.01, "--mode", mode)
            coarse, _ = self.simplified("--error", 0.1, "--mode", mode)
            self.assertLessEqual(fine["error"], 0.01)
            self.assertLessEqual(coarse["error"], 0.1)
            self.assertLess(coarse["triangles"], fine["triangles"])
            self.assertLess(fine["triangles"], 2 * TRIANGLES)

    def test_the_distance_is_measured_when_asked_for(self):
        report, _ = self.simplified("--ratio", 0.1, "--measure")
        self.assertGreater(report["error"], 0)
        self.assertGreaterEqual(report["max_error"], report["error"])

    def test_pixels_at_a_distance_are_metres_there(self):
        half = 0.5 * math.radians(40)
        metres = 2 * 50 * 2 * math.tan(half) / 720
        seen = ("--pixels", 2, "--distance", 50, "--height", 720, "--angle-deg", 40)
        report, counts = self.simplified(*seen)
        self.assertAlmostEqual(report["wanted_error"], metres, places=9)
        self.assertLessEqual(report["error"], metres)
        self.assertEqual(counts, self.simplified("--error", repr(metres))[1])

    def test_height_in_pixels_is_the_models_largest_side(self):
        side = 20  # from x = 0 to 20
        report, counts = self.simplified("--height", 100)
        self.assertLessEqual(report["error"], side / 100)
        self.assertEqual(counts, self.simplified("--error", side / 100)[1])
        finer, _ = self.simplified("--height", 100, "--pixels", 0.1)
        self.assertGreater(finer["triangles"], report["triangles"])

    def test_a_scaled_occurrence_enlarges_its_error(self):
        glb = self.folder / "once.glb"
        done = self.run_command("simplify", self.model, glb, "--ratio", 1)
        self.assertEqual(done.returncode, 0, done.stderr)
        data = bytearray(glb.read_bytes())
        length = int.from_bytes(data[12:16], "little")
        scene = json.loads(data[20 : 20 + length])
        for node in scene["nodes"]:
            if "mesh" in node:
                node.pop("matrix", None)
                node["scale"] = [10, 10, 10]
        text = json.dumps(scene).encode()
        text += b" " * (-len(text) % 4)
        rest = bytes(data[20 + length :])
        size = (12 + 8 + len(text) + len(rest)).to_bytes(4, "little")
        head = bytes(data[:8]) + size + len(text).to_bytes(4, "little") + b"JSON"
        glb.write_bytes(head + text + rest)
        plain, _ = self.simplified("--error", 0.02)
        self.model = glb
        scaled, _ = self.simplified("--error", 0.2)
        self.assertEqual(scaled["triangles"], plain["triangles"])
        self.assertAlmostEqual(scaled["error"], 10 * plain["error"], delta=0.02)

    def test_wrong_words_are_refused(self):
        out = self.folder / "out.glb"
        for words in (
            (),
            ("--ratio", 0.1, "--triangles", 10),
            ("--ratio", 0.1, "--pixels", 1, "--height", 100),
            ("--pixels", 1),
            ("--pixels", 0, "--height", 100),
            ("--pixels", 1, "--distance", 0),
            ("--ratio", 0.1, "--mode", "quick"),
            ("--ratio", 0.1, "--mode", ""),
        ):
            with self.subTest(words):
                done = self.run_command("simplify", self.model, out, *words)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("lodestone: ", done.stderr)
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
