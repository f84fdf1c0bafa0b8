# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the first-picture bench's arithmetic: ratios are of one round each, goals are told."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench.speed import bench_first_picture as bench  # noqa: E402


def round_of(full, first):
    one = {"cpu_s": full, "wall_s": full, "triangles": 1000}
    return {name: dict(one) for name in bench.PICTURES} | {
        "first": {"cpu_s": first, "wall_s": first, "triangles": 900}
    }


class FirstPicture(unittest.TestCase):
    def test_a_ratio_is_of_the_pictures_of_one_round(self):
        found = bench.summary([round_of(10, 11), round_of(20, 18), round_of(10, 13)])
        self.assertEqual(found["full"]["ratio"], {"min": 1.0, "median": 1.0, "max": 1.0})
        self.assertEqual(found["first"]["ratio"], {"min": 0.9, "median": 1.1, "max": 1.3})

    def test_the_table_tells_goals_and_triangles(self):
        lines = bench.table(bench.summary([round_of(10, 11)]))
        first = next(line for line in lines if "first F12" in line)
        self.assertIn("1.10 / 1.10 / 1.10 | <= 1.2 | 900 |", first)

    def test_building_all_levels_draws_nothing(self):
        found = round_of(10, 11)
        found["whole"]["triangles"] = None
        lines = bench.table(bench.summary([found]))
        whole = next(line for line in lines if "Update Levels" in line)
        self.assertTrue(whole.endswith("| <= 3 |  |"), whole)

    def test_a_picture_that_took_no_time_divides_by_nothing(self):
        self.assertGreater(bench.summary([round_of(0.0, 1.0)])["first"]["ratio"]["max"], 1)

    def test_rounds_may_leave_out_what_takes_long(self):
        options = bench.options_of(["--rounds", "2", "--pictures", "full", "whole", "--whole", "1"])
        self.assertEqual(bench.pictures_of(0, options), ["full", "whole"])
        self.assertEqual(bench.pictures_of(1, options), ["full"])
        short = {"full": round_of(10, 11)["full"]}
        found = bench.summary([round_of(10, 11), short])
        self.assertEqual((found["full"]["rounds"], found["first"]["rounds"]), (2, 1))
        with self.assertRaises(SystemExit):
            bench.options_of(["--pictures", "first"])

    def test_rounds_are_at_least_one(self):
        with self.assertRaises(SystemExit):
            bench.options_of(["--rounds", "0"])


if __name__ == "__main__":
    unittest.main()
