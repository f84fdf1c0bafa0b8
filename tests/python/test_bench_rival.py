# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the arithmetic of the bench beside full detail with fewer samples."""

import sys
import unittest
from pathlib import Path

try:
    __import__("numpy")
except ImportError:  # benches alone need it
    raise unittest.SkipTest("python3-numpy is not installed") from None

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench.peers import bench_rival as bench  # noqa: E402

INI = "Width=320\nAntialias=On\nSampling_Method=1\nAntialias_Threshold=0.1\nAntialias_Depth=3\n"


def picture(cpu_s: float, ssim: float, antialias: str = "off") -> dict:
    return {"antialias": antialias, "area_samples": 1, "cpu_s": cpu_s, "ssim": ssim}


class Rival(unittest.TestCase):
    def test_a_scene_is_sampled_otherwise_and_nothing_else_changes(self):
        off, coarse, _ = bench.SAMPLINGS
        self.assertEqual(bench.sampled(INI, off), "Width=320\nAntialias=Off\n")
        lines = bench.sampled(INI, coarse).splitlines()
        self.assertEqual(lines[:2], ["Width=320", "Antialias=On"])
        self.assertEqual(sorted(lines[2:]), [
            "Antialias_Depth=2", "Antialias_Threshold=0.4", "Sampling_Method=1",
        ])  # fmt: skip
        self.assertEqual(bench.sampled(bench.sampled(INI, off), coarse).splitlines(), lines)

    def test_the_best_is_the_nearest_that_takes_no_longer(self):
        rival = [picture(2, 0.7), picture(4, 0.8), picture(9, 0.9)]
        self.assertEqual(bench.best(rival, 4.0), (rival[1], True))
        self.assertEqual(bench.best(rival, 8.9), (rival[1], True))
        self.assertEqual(bench.best(rival, 1.0), (rival[0], False))

    def test_each_pixel_error_has_a_row_and_a_count(self):
        ours = {"1": {"cpu_s": 4.0, "ssim": 0.85}, "4": {"cpu_s": 3.0, "ssim": 0.6}}
        rival = [picture(2, 0.7), picture(4, 0.8)]
        lines = bench.table({"a/near": {"ours": ours, "rival": rival}})
        self.assertEqual(len([line for line in lines if line.startswith("| a/near |")]), 2)
        for error, lost in (("1", 0), ("4", 1)):
            start = f"- At {error} px, 1 views: in {lost} a rival's picture is nearer"
            self.assertTrue(any(line.startswith(start) for line in lines), lines)
        slow = bench.table({"a/near": {"ours": ours, "rival": [picture(5, 0.9)]}})
        self.assertEqual(sum("the rival, but it takes longer" in line for line in slow), 2)
        self.assertTrue(slow[-1].endswith("In 1 none is as fast; the fastest is nearer in 1."))

    def test_nothing_has_no_rows(self):
        self.assertEqual(len(bench.table({})), 3)
