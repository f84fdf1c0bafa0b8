# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what is told of slow pictures: the right cause, and a control that is about it."""

import math
import unittest
from dataclasses import replace

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import cost_model, quality_tree, slow_causes
from lodestone.core.problems import Problems
from lodestone_native import Antialias

PLAIN = cost_model.Work(10**7, 100_000, 1920 * 1080, 1920, 1080, 2.0, Antialias.FINAL, 2)
LAMPS = replace(PLAIN, shadow_rays=28.5, lamp_rays=27.0, soft_lamps=25)
SKY = replace(PLAIN, shadow_rays=26.0, sky_lights=24)
SUNS = replace(PLAIN, shadow_rays=24.0)
BOUNCES = replace(PLAIN, gathering=300.0)
QUALITY = quality_tree.quality(0.5)


def causes(work, took=60.0, **overrides):
    quality = quality_tree.quality(0.5, overrides)
    return slow_causes.found(work, quality, took)


def codes(work, took=60.0):
    return [cause.problem.code for cause in causes(work, took)]


def remedy(work, **overrides):
    (cause,) = causes(work, **overrides)
    return cause.remedy


class SlowCauses(unittest.TestCase):
    def test_short_pictures_are_not_told_of(self):
        empty = cost_model.Work(0, 0, 0, 64, 64, 0, Antialias.FINAL, 2)
        self.assertEqual(codes(empty), [])
        self.assertEqual(codes(LAMPS, 1.0), [])
        self.assertEqual(codes(LAMPS, math.nan), [])
        self.assertEqual(codes(LAMPS, 10.0), ["slow_lamps"])

    def test_a_picture_of_many_parts_has_no_one_cause(self):
        self.assertEqual(codes(PLAIN), [])
        self.assertEqual(codes(replace(LAMPS, texels=10**12)), [])  # reading it takes longer

    def test_each_kind_of_work_is_told_by_its_own_code(self):
        for work, code in (
            (LAMPS, "slow_lamps"),
            (SKY, "slow_sky"),
            (SUNS, "slow_suns"),
            (BOUNCES, "slow_bounces"),
        ):
            self.assertEqual(codes(work), [code])

    def test_lamps_are_counted_and_their_share_is_told(self):
        (cause,) = causes(LAMPS)
        took = [
            cost_model.predict(work)
            for work in (replace(LAMPS, shadow_rays=1.5, lamp_rays=0.0), LAMPS)
        ]
        rest, whole = (one.parse_cpu_s + one.trace_cpu_s for one in took)
        self.assertEqual(
            cause.problem.message,
            f"25 lamps with soft shadows: about {100 * (1 - rest / whole):.0f} % of the time; "
            "Lights 4 instead of 0.5 takes less",
        )
        self.assertEqual((cause.problem.severity, cause.problem.object), ("info", ""))
        (sharp,) = causes(replace(LAMPS, soft_lamps=0))
        self.assertTrue(sharp.problem.message.startswith("Lamps: about"))

    def test_the_control_is_one_that_the_work_depends_on(self):
        self.assertEqual(remedy(LAMPS), ("lights", 0.5, 4.0))
        for lights in (4.0, 16.0):
            self.assertEqual(remedy(LAMPS, lights=lights), ("area_samples", 17, 9))
        self.assertIsNone(remedy(replace(LAMPS, soft_lamps=0), lights=16.0))
        self.assertIsNone(remedy(LAMPS, lights=64.0, area_samples=1))
        self.assertEqual(remedy(SKY), ("indirect", 24, 12))
        self.assertIsNone(remedy(replace(SKY, shadow_rays=12.0, sky_lights=12), indirect=12))
        self.assertEqual(remedy(SUNS), ("area_samples", 17, 9))
        self.assertIsNone(remedy(SUNS, area_samples=1))

    def test_faster_made_a_room_dark(self):
        self.assertEqual(remedy(BOUNCES, bounces=3), ("bounces", 3, 2))
        self.assertIsNone(remedy(BOUNCES, bounces=1))

    def test_each_step_is_a_value_of_its_control_and_the_steps_end(self):
        for work in (LAMPS, SKY, SUNS, BOUNCES):
            overrides = {"bounces": 3}
            for _ in range(16):
                step = remedy(work, **overrides)
                if step is None:
                    break
                self.assertEqual(
                    step.before, getattr(quality_tree.quality(0.5, overrides), step.key)
                )
                self.assertNotEqual(step.before, step.after)
                overrides[step.key] = step.after
                self.assertEqual(
                    step.after, getattr(quality_tree.quality(0.5, overrides), step.key)
                )
            self.assertIsNone(step)

    def test_frames_and_view_layers_told_one_cause_many_times(self):
        told = Problems()
        told.add("Bark", "warning", "texture", 'Material "Bark": a texture')
        for lamps in (25, 26):
            told.extend(one.problem for one in causes(replace(LAMPS, soft_lamps=lamps)))
            told.add("Leaf", "warning", "texture", 'Material "Leaf": a texture')
        self.assertEqual([one.code for one in told], ["texture", "slow_lamps", "texture"])
        self.assertIn("26 lamps", list(told)[1].message)


if __name__ == "__main__":
    unittest.main()
