# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the arithmetic of the bench beside Cycles: differences, brightness, table, skips."""

import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

try:
    import numpy
except ImportError:  # benches alone need it
    raise unittest.SkipTest("python3-numpy is not installed") from None

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench.peers import bench_real as bench  # noqa: E402
from bench.peers.gray_with_alpha import is_gray_with_alpha  # noqa: E402


def view(cycles_s: float, cpu_s: float, difference: float) -> dict:
    one = dict.fromkeys(("reading_s", "export_s", "parse_s", "trace_s"), 0.5)
    one |= {"cpu_s": cpu_s, "memory_bytes": 2e6, "triangles": 12, "ssim": 0.9}
    one |= {"difference": difference, "brightness": 1.0}
    cycles = {"difference": 0.02, "brightness": 1.0}
    return {"cycles_s": cycles_s, "cycles": cycles, "build_s": 3.0, "ours": {"1": one}}


class Real(unittest.TestCase):
    def test_pictures_that_cycles_shows_too_bright_are_known(self):
        head = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(8) + b"\x08"
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "stream.png"
            self.assertFalse(is_gray_with_alpha(path))
            for content, expected in (
                (head + b"\x04\0\0\0", True),
                (head + b"\x06\0\0\0", False),
                (head, False),
                (b"\xff\xd8\xff" + head + b"\x04", False),
                (b"", False),
            ):
                path.write_bytes(content)
                self.assertEqual(is_gray_with_alpha(path), expected, content)
            self.assertFalse(is_gray_with_alpha(Path(folder)))

    def test_difference_and_brightness_are_of_covered_pixels(self):
        pictures = {"a": numpy.full((2, 2, 4), 0.5), "b": numpy.full((2, 2, 4), 0.4)}
        pictures["a"][0, 0] = 1.0
        covered = numpy.array([[False, True], [True, True]])
        with mock.patch.object(bench, "pixels", lambda path: pictures[path]):
            found = bench.compared("a", "b", covered)
        self.assertAlmostEqual(found["difference"], 0.1)
        self.assertAlmostEqual(found["brightness"], 1.25)

    def test_the_line_below_has_the_geometric_mean_and_the_worst(self):
        found = {"x/near": view(4.0, 2.0, 0.03), "y/far": view(4.0, 8.0, 0.03)}
        lines = bench.table(found)
        self.assertEqual(len([line for line in lines if line.startswith("| x/near | 1 ")]), 1)
        self.assertIn("1.00 in the geometric mean", lines[-1])
        self.assertIn("at most 2.00", lines[-1])
        self.assertIn("own 1.50", lines[-1])

    def test_short_ones_are_run_in_turns_and_the_least_counts(self):
        seconds = {"open": [2.0, 1.5, 1.8], "short": [3.5, 3.0, 4.5], "long": [9.0]}
        run = []

        def measure(name):
            run.append(name)
            return bench.Timed(seconds[name].pop(0), Path(name), {"turn": len(run)})

        with mock.patch.object(bench, "ROUNDS", 3):
            least = bench.least_of_rounds(
                {name: lambda name=name: measure(name) for name in seconds}
            )
        self.assertEqual(run, ["open", "short", "long", "open", "short", "open", "short"])
        self.assertEqual(
            {name: one.cpu for name, one in least.items()}, {"open": 1.5, "short": 3.0, "long": 9.0}
        )
        self.assertEqual(least["short"].report, {"turn": 5})

    def test_a_view_without_full_detail_has_no_ssim(self):
        found = {"x/near": view(4.0, 2.0, 0.03)}
        found["x/near"]["ours"]["1"]["ssim"] = None
        self.assertIn("| - |", bench.table(found)[2])

    def test_nothing_has_no_mean(self):
        self.assertEqual(bench.mean_ratio([]), 0.0)
        self.assertEqual(len(bench.table({})), 2)

    def test_a_camera_that_is_none_is_refused(self):
        with self.assertRaises(SystemExit), mock.patch("sys.stderr"):
            bench.options_of(["--views", "zengarden/below"])

    def test_without_the_tools_a_track_is_missing(self):
        with tempfile.TemporaryDirectory() as name:
            with mock.patch.object(bench, "TOOLS", Path(name)):
                with self.assertRaisesRegex(bench.Missing, "stk_scenes.py"):
                    bench.Scenes(Path(name)).blend("zengarden")

    def test_a_command_that_fails_is_missing(self):
        with tempfile.TemporaryDirectory() as name:
            with self.assertRaisesRegex(bench.Missing, "false failed"):
                bench.cpu_of(["false"], Path(name) / "log")
