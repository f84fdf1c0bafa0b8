# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what is told of slow pictures, and that what is said to help does."""

import math
import unittest
from dataclasses import replace

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import cost_model, quality_tree, slow_causes
from lodestone_native import Antialias

PLAIN = cost_model.Work(10**7, 100_000, 1920 * 1080, 1920, 1080, 2.0, Antialias.FINAL, 2)
QUALITY = quality_tree.quality(0.5)


def codes(work, took=60.0):
    return [problem.code for problem in slow_causes.problems(work, QUALITY, took)]


class SlowCauses(unittest.TestCase):
    def test_short_pictures_are_not_told_of(self):
        empty = cost_model.Work(0, 0, 0, 64, 64, 0, Antialias.FINAL, 2)
        self.assertEqual(codes(empty), [])
        lamps = replace(PLAIN, shadow_rays=900.0, lamp_rays=900.0)
        self.assertEqual(codes(lamps, 1.0), [])
        self.assertEqual(codes(lamps, math.nan), [])
        self.assertEqual(codes(lamps, 10.0), ["slow_lamps"])

    def test_a_picture_of_many_parts_has_no_one_cause(self):
        self.assertEqual(codes(PLAIN), [])

    def test_lamps_are_counted_and_their_share_is_told(self):
        work = replace(PLAIN, shadow_rays=28.5, lamp_rays=27.0, soft_lamps=25)
        (problem,) = slow_causes.problems(work, QUALITY, 60.0)
        plain = cost_model.predict(replace(work, shadow_rays=1.5))
        whole = cost_model.predict(work)
        rest = plain.parse_cpu_s + plain.trace_cpu_s
        share = 1 - rest / (whole.parse_cpu_s + whole.trace_cpu_s)
        self.assertEqual(
            problem.message,
            f"25 lamps with soft shadows: about {100 * share:.0f} % of the time; "
            "Area Samples 9 instead of 17 takes less",
        )
        self.assertEqual((problem.severity, problem.object), ("info", ""))
        (sharp,) = slow_causes.problems(replace(work, soft_lamps=0), QUALITY, 60.0)
        self.assertTrue(sharp.message.startswith("Lamps: about"))

    def test_each_kind_of_work_is_told_by_its_own_code(self):
        suns = replace(PLAIN, shadow_rays=24.0)
        self.assertEqual(codes(suns), ["slow_suns"])
        self.assertEqual(codes(replace(PLAIN, gathering=300.0)), ["slow_bounces"])
        reference = replace(PLAIN, antialias=Antialias.REFERENCE, shadow_rays=0.0)
        self.assertEqual(codes(reference), ["slow_reference"])

    def test_each_step_changes_its_control_and_the_steps_end(self):
        for code in ("slow_lamps", "slow_suns", "slow_bounces", "slow_reference"):
            overrides = {"bounces": 2, "antialias": quality_tree.REFERENCE}
            seen = []
            while True:
                quality = quality_tree.quality(1.0, overrides)
                faster = slow_causes.remedy(code, quality)
                if faster is None:
                    break
                self.assertEqual(faster.before, getattr(quality, faster.key))
                self.assertNotEqual(faster.before, faster.after)
                self.assertNotIn((faster.key, faster.after), seen)
                seen.append((faster.key, faster.after))
                overrides[faster.key] = faster.after
                self.assertEqual(
                    getattr(quality_tree.quality(1.0, overrides), faster.key), faster.after
                )
            self.assertTrue(seen, code)

    def test_other_problems_have_no_remedy(self):
        self.assertIsNone(slow_causes.remedy("povray_missing", QUALITY))

    def test_a_step_tells_itself_by_the_names_of_the_panel(self):
        steps = (
            ("slow_lamps", {"area_samples": 1}, "Lights 4 instead of 1"),
            ("slow_suns", {}, "Indirect 12 instead of 24"),
            ("slow_reference", {"antialias": "REFERENCE"}, "Antialiasing Final instead of Referen"),
        )
        for code, overrides, words in steps:
            faster = slow_causes.remedy(code, quality_tree.quality(1.0, overrides))
            self.assertTrue(faster.words.startswith(words), faster.words)


if __name__ == "__main__":
    unittest.main()
