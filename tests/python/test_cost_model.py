# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what a picture is expected to take, and what is learned from the one before."""

import math
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import cost_model, quality_tree
from lodestone_native import Antialias, Camera

WORK = cost_model.Work(95_000_000, 10_000_000, 640 * 360, 640, 360, 1, 1, 2)
EXPORTED = {
    "text_bytes": 1000,
    "texels": 10,
    "shadow_rays": 0.0,
    "lamp_rays": 0.0,
    "sky_lights": 0,
    "soft_lamps": 0,
    "covered": 0.5,
    "left_out": 1,
}
SUMMARY = SimpleNamespace(occurrences=4)
CAMERA = Camera("C", False, (0, 0, 2), (0, 1, 0), (1, 0, 0), (0, 0, 0.5), 0.1, aperture=0.2)


class Cost(unittest.TestCase):
    def test_nothing_to_draw_takes_the_start_and_the_empty_picture(self):
        found = cost_model.predict(cost_model.Work(0, 0, 0, 640, 360, 0, 1, 1))
        self.assertEqual((found.parse_cpu_s, found.trace_cpu_s, found.wall_s), (0, 0, 0.7))
        self.assertAlmostEqual(found.peak_bytes / 1e6, 18 + 3.6864, places=6)

    def test_texts_and_pictures_are_read_and_kept_as_was_measured(self):
        found = cost_model.predict(WORK)
        self.assertAlmostEqual(found.parse_cpu_s, 95 * 0.059 + 10 * 0.025)
        kept = 18 + 3.6864 + 3.85 * 95 + 2.57 * 10
        self.assertAlmostEqual(found.peak_bytes / 1e6, kept, places=5)
        # 3.08e-9 * (text + 5.4e5)^.5 * 1.13 each, 1 + .44 * 9 samples a pixel
        each = 3.08e-9 * math.sqrt(95.54e6) * 1.13
        self.assertAlmostEqual(found.trace_cpu_s, 230400 * 4.96 * each)
        self.assertAlmostEqual(found.wall_s, 0.7 + found.parse_cpu_s + found.trace_cpu_s / 2)

    def test_a_picture_of_much_sky_takes_less(self):
        whole = cost_model.predict(WORK).trace_cpu_s
        half = cost_model.predict(replace(WORK, covered=0.5)).trace_cpu_s
        self.assertAlmostEqual(half, 0.55 * whole)  # what meets nothing takes a tenth

    def test_the_covered_share_is_that_of_the_whole_picture(self):
        quality = quality_tree.quality(1.0)
        exported = SimpleNamespace(**EXPORTED)
        for border, expected in (((0, 0, 0, 0), 0.5), ((1, 1, 2, 2), 1.0)):
            view = SimpleNamespace(camera=CAMERA, width=4, height=3, border=border)
            work = cost_model.Work.of(SUMMARY, view, exported, Antialias.FINAL, 1, quality)
            self.assertEqual((work.covered, work.objects), (expected, 3))

    def test_bounces_are_expected_to_take_what_they_gather(self):
        direct = cost_model.predict(WORK).trace_cpu_s
        self.assertEqual(cost_model.gathering(0, 200, 0.6), 0.0)
        rays = cost_model.gathering(2, 200, 0.5)
        self.assertAlmostEqual(rays, 0.125 / 0.25 * 200 * 2)
        bouncing = cost_model.predict(replace(WORK, gathering=rays)).trace_cpu_s
        self.assertAlmostEqual(bouncing, direct * (WORK.samples + rays) / WORK.samples)

    def test_fewer_samples_a_pixel_are_expected_to_take_less(self):
        found = [replace(WORK, depth=depth).samples for depth in (2, 3)]
        found.append(replace(WORK, antialias=Antialias.REFERENCE).samples)
        found.insert(0, replace(WORK, antialias=Antialias.OFF).samples)
        self.assertEqual(found, sorted(found))
        self.assertAlmostEqual(found[1] / found[0], 1 + 0.44 * 4)

    def test_all_pixels_were_expected_to_differ_as_much_at_any_threshold(self):
        coarse, fine, all_of_them = (
            replace(WORK, threshold=threshold, depth=2).samples for threshold in (0.6, 0.3, 0.0)
        )
        self.assertAlmostEqual(coarse, 1 + 4 * 0.044 / 0.6)
        self.assertAlmostEqual(fine, 1 + 4 * 0.044 / 0.3)
        self.assertEqual(all_of_them, 5.0)
        quality = quality_tree.quality(4.0)
        view = SimpleNamespace(camera=CAMERA, width=4, height=3, border=(0, 0, 0, 0))
        exported = SimpleNamespace(**EXPORTED)
        work = cost_model.Work.of(SUMMARY, view, exported, Antialias.FINAL, 1, quality)
        self.assertEqual(work.threshold, 0.6)

    def test_full_detail_taught_that_levels_take_ten_times_as_long(self):
        slow = SimpleNamespace(parse_cpu_s=5.2, trace_cpu_s=300.0, peak_bytes=10**9)
        exact = replace(WORK, exact=True)
        ratios = cost_model.learn(exact, slow, cost_model.Ratios())
        self.assertAlmostEqual(cost_model.predict(exact, ratios).trace_cpu_s, 300.0)
        plain = cost_model.predict(WORK).trace_cpu_s
        self.assertEqual(cost_model.predict(WORK, ratios).trace_cpu_s, plain)

    def test_depth_of_field_was_expected_to_take_no_longer(self):
        sharp = cost_model.predict(WORK).trace_cpu_s
        blurred = cost_model.predict(replace(WORK, blurred=True)).trace_cpu_s
        self.assertAlmostEqual(blurred, sharp * 56 / WORK.samples)  # both at the usual antialiasing
        exported = SimpleNamespace(**EXPORTED)
        quality = quality_tree.quality(1.0)
        for camera, expected in (
            (CAMERA, True),
            (replace(CAMERA, aperture=0.0), False),
            (replace(CAMERA, orthographic=True), False),
        ):
            view = SimpleNamespace(camera=camera, width=4, height=3, border=(0, 0, 0, 0))
            work = cost_model.Work.of(SUMMARY, view, exported, Antialias.FINAL, 1, quality)
            self.assertEqual(work.blurred, expected)

    def test_leaves_shadow_rays_and_textures_were_forgotten(self):
        view = SimpleNamespace(camera=CAMERA, width=4, height=3, border=(0, 0, 0, 0))
        quality = quality_tree.quality(1.0)

        def work(**more):
            exported = SimpleNamespace(**{**EXPORTED, **more})
            return cost_model.Work.of(SUMMARY, view, exported, Antialias.FINAL, 1, quality)

        self.assertEqual((work().text_bytes, work().texels), (1000, 10))
        grown = work(text_bytes=10_001_000).bytes - work().bytes
        self.assertAlmostEqual(grown, 38_500_000)
        self.assertAlmostEqual(work(texels=1_000_010).bytes - work().bytes, 2_570_000)
        ratio = cost_model.predict(work(shadow_rays=20.0)).trace_cpu_s
        self.assertAlmostEqual(ratio / cost_model.predict(work()).trace_cpu_s, 3.6)
        ratio = cost_model.predict(work(shadow_rays=20.0, lamp_rays=20.0)).trace_cpu_s
        self.assertAlmostEqual(ratio / cost_model.predict(work()).trace_cpu_s, 9.2)

    def test_the_same_picture_again_is_predicted_exactly(self):
        measured = SimpleNamespace(parse_cpu_s=9.0, trace_cpu_s=4.0, peak_bytes=400_000_000)
        ratios = cost_model.learn(WORK, measured, cost_model.Ratios())
        found = cost_model.predict(WORK, ratios)
        self.assertAlmostEqual(found.parse_cpu_s, 9.0)
        self.assertAlmostEqual(found.trace_cpu_s, 4.0)
        self.assertAlmostEqual(found.peak_bytes / 4e8, 1.0, places=6)

    def test_what_is_too_short_or_absurd_teaches_nothing(self):
        before = cost_model.Ratios(2.0, 3.0, 1.5)
        short = SimpleNamespace(parse_cpu_s=0.01, trace_cpu_s=math.nan, peak_bytes=0)
        little = replace(WORK, text_bytes=10**5, texels=0)
        self.assertEqual(cost_model.learn(little, short, before), before)
        unknown = SimpleNamespace(parse_cpu_s=0.0, trace_cpu_s=0.0, peak_bytes=0)
        self.assertEqual(cost_model.learn(WORK, unknown, before), before)
        mad = SimpleNamespace(parse_cpu_s=1e9, trace_cpu_s=1.0, peak_bytes=1)
        self.assertEqual(cost_model.learn(WORK, mad, before).parse, 100.0)

    def test_a_picture_that_was_much_faster_than_expected_taught_nothing(self):
        fast = SimpleNamespace(parse_cpu_s=0.02, trace_cpu_s=0.02, peak_bytes=0)
        ratios = cost_model.learn(replace(WORK, text_bytes=10**6), fast, cost_model.Ratios())
        self.assertLess(ratios.trace, 0.1)

    def test_ratios_are_kept_beside_the_levels_and_survive_nonsense(self):
        with tempfile.TemporaryDirectory() as folder:
            store = Path(folder)
            costs = cost_model.CostMemory().of(store)
            self.assertEqual(costs.read("Camera"), cost_model.Ratios())
            costs.write("Camera", cost_model.Ratios(2.0, 0.5, 1.0))
            later = cost_model.CostMemory().of(store)
            self.assertEqual(later.read("Camera"), cost_model.Ratios(2.0, 0.5, 1.0))
            self.assertEqual(later.read("Other"), cost_model.Ratios(2.0, 0.5, 1.0))
            for text in (
                *("", "[]", '{"parse": 1e9, "trace": "x", "memory": NaN}', "9" * 70000),
                *('{"model": 2, "cameras": %s}' % cameras for cameras in ("[1]", '{"Camera": 1}')),
            ):
                (store / cost_model.FILE).write_text(text)
                later = cost_model.CostMemory().of(store)
                self.assertEqual(later.read("Camera"), cost_model.Ratios(), text[:40])
        memory = cost_model.CostMemory()
        memory.of(store).write(
            "Camera", cost_model.Ratios(3.0)
        )  # the folder is gone: still known here
        self.assertEqual(memory.of(store).read("Camera").parse, 3.0)

    def test_a_camera_before_dead_trees_says_nothing_of_another_that_was_asked(self):
        with tempfile.TemporaryDirectory() as folder:
            costs = cost_model.CostMemory().of(Path(folder))
            costs.write("Near", cost_model.Ratios(trace=1.0))
            costs.write("Far", cost_model.Ratios(trace=3.0))
            for known in (costs, cost_model.CostMemory().of(Path(folder))):
                self.assertEqual(known.read("Near").trace, 1.0)
                self.assertEqual(known.read("Far").trace, 3.0)
                self.assertEqual(known.read("New").trace, 3.0)
            for number in range(200):
                costs.write(f"Camera {number} \u2603" + 60 * "\u20ac", cost_model.Ratios(trace=2.0))
            later = cost_model.CostMemory().of(Path(folder))
            self.assertEqual(later.read("Near").trace, 2.0)  # forgotten: as the last
            self.assertEqual(later.read("").trace, 2.0)


if __name__ == "__main__":
    unittest.main()
