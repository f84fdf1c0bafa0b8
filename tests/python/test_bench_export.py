# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the export bench's arithmetic: turns, ratios and their spread, and that it skips."""

import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench.peers import bench_export as bench  # noqa: E402
from bench import benching  # noqa: E402


def round_of(bundled, ours, triangles=500_000):
    first = {"cpu_s": ours, "bytes": 20, "memory_bytes": 5, "triangles": triangles}
    first |= {"extract_cpu_s": ours / 4, "write_cpu_s": 3 * ours / 4, "depsgraph_cpu_s": 0.5}
    first["second_frame"] = {"cpu_s": ours / 8, "files_written": 2}
    return {
        "bundled": {"cpu_s": bundled, "bytes": 60, "memory_bytes": 50},
        "lodestone": first,
    }


class Bench(unittest.TestCase):
    def test_kinds_take_turns(self):
        self.assertEqual(
            benching.turns(2, bench.KINDS),
            [(0, "bundled"), (0, "lodestone"), (1, "lodestone"), (1, "bundled")],
        )

    def test_ratios_are_of_one_round_each(self):
        found = bench.summary([round_of(8, 0.5), round_of(6, 1.0), round_of(9, 0.75)])
        self.assertEqual(found["cpu_s_ratio"], {"min": 6.0, "median": 12.0, "max": 16.0})
        self.assertEqual(found["per_million"], {"min": 1.0, "median": 1.5, "max": 2.0})
        self.assertEqual(found["bytes_ratio"]["median"], 3.0)
        self.assertEqual(found["second_cpu_s"]["max"], 0.125)
        lines = bench.table({"S1": found})
        self.assertIn("| **bundled / Lodestone** | 6.0 / 12.0 / 16.0 | >= 12 |", lines)
        self.assertIn(
            "| **Lodestone, CPU s / 1 M triangles** | 1.00 / 1.50 / 2.00 | <= 1.3 |", lines
        )
        self.assertEqual({line.count("|") for line in lines}, {4})

    def test_few_triangles_have_no_time_per_million(self):
        small, large = bench.summary([round_of(1, 1, 10_000)]), bench.summary([round_of(1, 1)])
        self.assertNotIn("per_million", small)
        lines = bench.table({"S2": small, "S1": large})
        self.assertIn(
            "| **Lodestone, CPU s / 1 M triangles** |  | 2.00 / 2.00 / 2.00 | <= 1.3 |", lines
        )

    def test_nothing_divides_by_zero(self):
        found = bench.summary([round_of(2, 0.0)])
        self.assertEqual(found["cpu_s_ratio"]["max"], 2000.0)

    def test_small_is_small_and_wrong_numbers_are_refused(self):
        small = bench.options_of(["--small"])
        self.assertEqual((small.scenes, small.rounds), (["S1", "S2"], 2))
        for wrong in (["--rounds", "0"], ["--scenes", "S9"]):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
                bench.options_of(wrong)

    def test_without_the_maker_a_scene_is_skipped_and_one_that_is_there_is_used(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            said = io.StringIO()
            with mock.patch.object(bench, "TOOLS", folder), contextlib.redirect_stderr(said):
                self.assertIsNone(bench.make_scene("S1", folder))
                (folder / "S1.blend").write_bytes(b"")
                self.assertEqual(bench.make_scene("S1", folder), folder / "S1.blend")
            self.assertIn("S1 is skipped", said.getvalue())


if __name__ == "__main__":
    unittest.main()
