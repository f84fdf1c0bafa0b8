# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the bench's arithmetic: which picture belongs to which round, ratios and their spread."""

import contextlib
import io
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench.speed import bench_street as bench  # noqa: E402


def picture(out, parse, peak, trace):
    povray = {"parse_cpu_s": parse, "peak_bytes": peak, "trace_cpu_s": trace}
    return {"picture": out, "povray": povray}


class Bench(unittest.TestCase):
    def test_kinds_take_turns_and_differ_in_nothing_but_pixel_error(self):
        views = bench.views_of(3, "far", [640, 360], 0.5, Path("/out"))
        names = [Path(view["out"]).stem for view in views]
        self.assertEqual(names[:3], ["0_full", "0_approximated", "1_approximated"])
        self.assertEqual(len(set(names)), 6)
        self.assertEqual({view["pixel_error"] for view in views}, {0.0, 0.5})
        for view in views:
            self.assertEqual(view["pixel_error"] == 0, view["out"].endswith("_full.png"))
        rest = [{k: v for k, v in w.items() if k not in ("out", "pixel_error")} for w in views]
        self.assertTrue(all(one == rest[0] for one in rest))

    def test_ratios_are_of_one_round_each(self):
        rounds = bench.measured(
            [
                picture("/t/1_approximated.png", 0.5, 30, 1.0),
                picture("/t/1_full.png", 4.0, 110, 3.0),
                picture("/t/0_full.png", 2.0, 110, 2.0),
                picture("/t/0_approximated.png", 1.0, 20, 2.0),
            ],
            empty=10,
        )
        found = bench.summary(rounds)
        self.assertEqual(found["parse_cpu_s"]["ratio"], {"min": 2.0, "median": 5.0, "max": 8.0})
        self.assertEqual(found["memory_bytes"]["ratio"], {"min": 5.0, "median": 7.5, "max": 10.0})
        self.assertEqual(found["trace_cpu_s"]["full"], {"min": 2.0, "median": 2.5, "max": 3.0})
        lines = bench.table(found)
        self.assertIn("| 2.0 / 5.0 / 8.0 | >= 5 |", lines[2])

    def test_nothing_divides_by_zero(self):
        rounds = bench.measured(
            [picture("0_full.png", 1.0, 9, 1.0), picture("0_approximated.png", 0.0, 5, 0.0)], 7
        )
        self.assertEqual(bench.summary(rounds)["memory_bytes"]["ratio"]["max"], 2.0)
        self.assertEqual(bench.summary(rounds)["parse_cpu_s"]["ratio"]["max"], 1000.0)

    def test_wrong_numbers_are_refused(self):
        for wrong in (["--rounds", "0"], ["--pixel-error", "0"], ["--pixel-error", "nan"]):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
                bench.options_of(wrong)


if __name__ == "__main__":
    unittest.main()
