# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the simplification bench's arithmetic: ratios, spread, what counts, and that it skips."""

import contextlib
import io
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench.peers import bench_simplify as bench  # noqa: E402


def result(mean, cpus, got=100, want=100, **more):
    judged = {"mean": mean, "rms": 1e-3, "hausdorff": 1e-2, "normal_deg": 1, "sil_iou_err": 0.01}
    one = {"judged": judged, "cpus": cpus, "got": got, "want": want, "dropped": 0, "error": ""}
    return one | more


class Bench(unittest.TestCase):
    def test_ratios_are_geometric_means_and_cpu_is_of_one_round_each(self):
        found = {
            ("blender", "a", 0.1): result(1e-3, [1.0, 2.0, 4.0]),
            ("blender", "b", 0.1): result(1e-3, [1.0, 2.0, 4.0]),
            ("fast", "a", 0.1): result(5e-4, [0.1, 0.1, 0.1]),
            ("fast", "b", 0.1): result(2e-3, [0.1, 0.1, 0.1]),
        }
        one = bench.compared(found, "fast", "blender")
        self.assertEqual(one["pairs"], 2)
        self.assertAlmostEqual(one["mean"], 1)
        self.assertAlmostEqual(one["rms"], 1)
        self.assertAlmostEqual(one["cpu"]["max"], 0.1)
        self.assertAlmostEqual(one["cpu"]["median"], 0.05)
        self.assertAlmostEqual(one["cpu"]["min"], 0.025)
        lines = bench.table(found)
        self.assertIn("1.00 (<= 0.6)", lines[-1])
        self.assertIn("0.025 / 0.050 / 0.100 (<= 0.12)", lines[-1])
        self.assertEqual({line.count("|") for line in lines}, {12})

    def test_what_misses_its_target_is_counted_and_not_compared(self):
        found = {
            ("blender", "a", 0.1): result(1e-3, [1]),
            ("best", "a", 0.1): result(1e-9, [1], got=114),
            ("blender", "b", 0.1): result(1e-3, [1], got=500),
            ("best", "b", 0.1): result(1e-9, [1]),
            ("best", "c", 0.1): result(1e-9, [1], got=0, dropped=3),
        }
        one = bench.compared(found, "best", "blender")
        self.assertEqual(one["pairs"], 0)
        self.assertTrue(math.isnan(one["mean"]))
        self.assertNotIn("cpu", one)
        self.assertEqual((one["missed"], one["empty"], one["dropped"], one["runs"]), (1, 1, 3, 3))
        self.assertFalse(bench.missed({"got": 113, "want": 100}))

    def test_exact_flat_models_do_not_decide(self):
        found = {
            ("blender", "a", 0.5): result(1e-12, [1]),
            ("best", "a", 0.5): result(1e-15, [1]),
        }
        self.assertEqual(bench.compared(found, "best", "blender")["mean"], 1)

    def test_cluster_stands_beside_sloppy_or_says_why_not(self):
        found = {("cluster", "a", 0.1): result(1e-3, [0.2])}
        self.assertIn("not measured", bench.sloppy_sentence(found))
        found["mo018_sloppy", "a", 0.1] = result(2e-3, [0.1])
        said = bench.sloppy_sentence(found)
        self.assertIn("mean 0.50 (<= 0.6), CPU 2.000 / 2.000 / 2.000 (<= 1.3)", said)
        self.assertNotIn("a process for each target (", said)
        found[bench.ALONE, "a", 0.1] = result(2e-3, [0.16])
        said = bench.sloppy_sentence(found)
        self.assertIn("a process for each target (1 pairs): mean 0.50 (<= 0.6), CPU 1.250", said)
        self.assertIn("one for all targets (1 pairs): mean 0.50 (<= 0.6), CPU 2.000", said)

    def test_sloppy_gets_a_process_for_each_target_and_is_not_reused(self):
        with tempfile.TemporaryDirectory() as name:
            options = bench.options_of(["--folder", name])
            runs = bench.Bench(options, Path(name))
            told = '{"peer": "mo018_sloppy", "target": %s, "cpu": 0.1, "got": 7}'
            with mock.patch.object(
                bench, "run", side_effect=lambda command: told % command[3]
            ) as process:
                runs.run_sloppy_alone(Path("a.ply"))
            self.assertEqual(process.call_count, len(bench.TARGETS))
            self.assertEqual({one["peer"] for one in runs.found.values()}, {bench.ALONE})
            self.assertEqual(
                set(runs.found), {(bench.ALONE, "a", target) for target in bench.TARGETS}
            )
            file = Path(name, "earlier.json")
            one = {"model": "a", "target": 0.5}
            ones = [{"peer": bench.ALONE, **one}, {"peer": "mo018_sloppy", **one}]
            file.write_text(json.dumps({"results": ones}), "utf-8")
            runs.found.clear()
            runs.reuse(file)
        self.assertEqual(list(runs.found), [("mo018_sloppy", "a", 0.5)])

    def test_the_first_rounds_result_is_kept_with_all_rounds_seconds(self):
        with tempfile.TemporaryDirectory() as name:
            options = bench.options_of(["--folder", name])
            runs = bench.Bench(options, Path(name))
            for cpu in (1.0, 2.0):
                runs.keep("om", "a", {"target": "0.5", "cpu": cpu, "got": 7})
        self.assertEqual(runs.found["om", "a", 0.5]["cpus"], [1.0, 2.0])

    def test_small_is_small_and_wrong_numbers_are_refused(self):
        small = bench.options_of(["--small"])
        self.assertEqual((small.rounds, small.slow_rounds, len(small.targets)), (1, 0, 2))
        for wrong in (["--rounds", "0"], ["--samples", "0"], ["--slow-rounds", "-1"]):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
                bench.options_of(wrong)

    def test_without_the_tools_it_is_skipped_with_a_sentence(self):
        with tempfile.TemporaryDirectory() as name:
            said = io.StringIO()
            with mock.patch.object(bench, "TOOLS", Path(name)), contextlib.redirect_stderr(said):
                self.assertIsNone(bench.build_peers(Path(name)))
            self.assertIn("skipped, there is no", said.getvalue())

    def test_a_failing_peer_is_said_and_gives_nothing(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            self.assertIsNone(bench.run(["false"]))
        self.assertIn("false", said.getvalue())
        self.assertEqual(bench.records(None), [])
        self.assertEqual(bench.records('x\n{"a": 1}\n'), [{"a": 1}])


if __name__ == "__main__":
    unittest.main()
