# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what is told about pictures: costs before them, colors and blame after, reasons."""

import math
import tempfile
import unittest
from array import array
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import (
    compare_plan,
    cost_model,
    false_colors,
    legend_strip,
    overview_camera,
    why_sentences,
)
from lodestone_native import Antialias, Camera, Drawn, Image, Kind, Object

WORK = cost_model.Work(245_000_000, 1_000_000, 640 * 360, 640, 360, 1, 1, 2)
CAMERA = Camera("C", False, (0, 0, 2), (0, 1, 0), (1, 0, 0), (0, 0, 0.5), 0.1, aperture=0.2)


class Cost(unittest.TestCase):
    def test_nothing_to_draw_takes_the_start_and_the_empty_picture(self):
        found = cost_model.predict(cost_model.Work(0, 0, 0, 640, 360, 0, 1, 1))
        self.assertEqual((found.parse_cpu_s, found.trace_cpu_s, found.wall_s), (0, 0, 0.6))
        self.assertAlmostEqual(found.peak_bytes / 1e6, 18 + 3.6864, places=6)

    def test_a_million_triangles_are_read_as_was_measured(self):
        found = cost_model.predict(WORK)
        self.assertAlmostEqual(found.parse_cpu_s, 5.2)
        # 1.65e-7 * 1e6^.2 * 1.5 each, 4 samples a pixel
        self.assertAlmostEqual(found.trace_cpu_s, 230400 * 4 * 1.65e-7 * 1e6**0.2 * 1.5)
        self.assertAlmostEqual(found.wall_s, 0.6 + 5.2 + found.trace_cpu_s / 2)

    def test_bounces_are_expected_to_take_what_they_gather(self):
        direct = cost_model.predict(WORK).trace_cpu_s
        self.assertEqual(cost_model.gathering(0, 200, 0.6), 0.0)
        rays = cost_model.gathering(2, 200, 0.5)
        self.assertAlmostEqual(rays, 0.1 / 0.25 * 200 * 2)
        bouncing = cost_model.predict(replace(WORK, gathering=rays)).trace_cpu_s
        self.assertAlmostEqual(bouncing, direct * (4 + rays) / 4)

    def test_depth_of_field_was_expected_to_take_no_longer(self):
        sharp = cost_model.predict(WORK).trace_cpu_s
        blurred = cost_model.predict(replace(WORK, blurred=True)).trace_cpu_s
        self.assertAlmostEqual(blurred, sharp * 45 / 4)  # both at the usual antialiasing
        summary = SimpleNamespace(bytes=1, triangles=1)
        quality = SimpleNamespace(bounces=0, bounce_rays=0, bounce_error=1.0)
        for camera, expected in (
            (CAMERA, True),
            (replace(CAMERA, aperture=0.0), False),
            (replace(CAMERA, orthographic=True), False),
        ):
            view = SimpleNamespace(camera=camera, width=4, height=3, border=(0, 0, 0, 0))
            work = cost_model.Work.of(summary, view, 1, Antialias.FINAL, 1, quality)
            self.assertEqual(work.blurred, expected)

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
        self.assertEqual(cost_model.learn(WORK, short, before), before)
        mad = SimpleNamespace(parse_cpu_s=1e9, trace_cpu_s=1.0, peak_bytes=1)
        self.assertEqual(cost_model.learn(WORK, mad, before).parse, 100.0)

    def test_ratios_are_kept_beside_the_levels_and_survive_nonsense(self):
        with tempfile.TemporaryDirectory() as folder:
            store = Path(folder)
            costs = cost_model.CostMemory().of(store)
            self.assertEqual(costs.read(), cost_model.Ratios())
            costs.write(cost_model.Ratios(2.0, 0.5, 1.0))
            later = cost_model.CostMemory().of(store)
            self.assertEqual(later.read(), cost_model.Ratios(2.0, 0.5, 1.0))
            for text in ("", "[]", '{"parse": 1e9, "trace": "x", "memory": NaN}', "9" * 5000):
                (store / cost_model.FILE).write_text(text)
                later = cost_model.CostMemory().of(store)
                self.assertEqual(later.read(), cost_model.Ratios(), text[:20])
        memory = cost_model.CostMemory()
        memory.of(store).write(cost_model.Ratios(3.0))  # the folder is gone: still known here
        self.assertEqual(memory.of(store).read().parse, 3.0)


class Blame(unittest.TestCase):
    def test_equal_pictures_blame_nothing(self):
        self.assertEqual(compare_plan.worst_of([(["a", "b"], [0.0, 0.0]), ([], [])]), ())

    def test_the_largest_three_with_their_shares(self):
        found = compare_plan.worst_of([(["a", "b", "c", "d"], [1, 5, 0, 2]), (["a"], [2])])
        self.assertEqual([path for path, _ in found], ["b", "a", "d"])
        self.assertEqual([round(share, 3) for _, share in found], [0.5, 0.3, 0.2])


class Colors(unittest.TestCase):
    def test_errors_run_from_blue_to_red_and_stand_out_above(self):
        self.assertEqual(false_colors.of_error(0.0, 0.0), false_colors.ORIGINAL)
        self.assertEqual(false_colors.of_error(1.0, 0.0), false_colors.ABOVE)
        most = [round(part, 9) for part in false_colors.of_error(2.0, 2.0)]
        self.assertEqual(most, [0.8, 0.06, 0.03])
        self.assertEqual(false_colors.of_error(2.1, 2.0), false_colors.ABOVE)
        self.assertEqual(false_colors.of_error(math.nan, 2.0), false_colors.ABOVE)
        self.assertAlmostEqual(false_colors.of_error(0.5, 2.0)[2], (0.6 + 0.2) / 2)

    def test_costs_go_by_decades(self):
        colors = [false_colors.of_cost(n) for n in (0, 12, 13, 100, 101, 10**5, 10**9)]
        self.assertEqual(colors[0], colors[1])
        self.assertEqual(colors[2], colors[3])
        self.assertEqual(len(set(colors)), 5)

    def test_the_table_is_the_transfer_function(self):
        self.assertEqual((false_colors.LINEAR[0], false_colors.LINEAR[255]), (0, 255))
        self.assertEqual(false_colors.LINEAR[188], 128)
        self.assertAlmostEqual(false_colors.displayed((0.5, 0, 1))[0], 0.7354, places=4)


class Legend(unittest.TestCase):
    def test_it_is_added_below_in_as_many_lines_as_it_takes(self):
        image = Image(40, 2, array("f", (0.5, 0.25, 0.0, 0.0) * 80))
        entries = [("LONG WORD", (1.0, 0.0, 0.0)), ("OTHER", (0.0, 1.0, 0.0))]
        found = legend_strip.with_legend(image, "T", entries)
        self.assertEqual((found.width, found.height), (40, 2 + 3 * 13 + 4))
        self.assertEqual(len(found.pixels), 4 * 40 * found.height)
        self.assertEqual(set(found.pixels[3::4]), {1.0})
        self.assertEqual(list(found.pixels[:3]), [0.5, 0.25, 0.0])
        self.assertEqual(image.pixels[3], 0.0)
        self.assertIn(1.0, found.pixels[4 * 80 :: 4])

    def test_flipping_twice_is_nothing(self):
        image = Image(2, 3, array("f", range(24)))
        once = legend_strip.flipped(image)
        self.assertEqual(list(once.pixels[:8]), list(range(16, 24)))
        self.assertEqual(legend_strip.flipped(once).pixels, image.pixels)


class Overview(unittest.TestCase):
    def test_everything_and_the_camera_are_in_the_picture(self):
        for camera in (CAMERA, Camera("D", True, (50, 3, 9), (0, 0, -1), (1, 0, 0), (0, 1, 0), 1)):
            found = overview_camera.overview(camera, (3.0, 4.0, 5.0), 2.0, (200, 100))
            self.assertEqual((found.aperture, found.orthographic), (0.0, False))
            self.assertAlmostEqual(math.hypot(*found.direction), 1.0)
            inside = [camera.position, (5, 4, 5), (1, 4, 5), (3, 4, 7), (3, 6, 5), (3, 2, 3.1)]
            for point in inside:
                off = [p - e for p, e in zip(point, found.position)]
                depth = sum(a * b for a, b in zip(off, found.direction))
                for axis in (found.right, found.up):
                    size = math.hypot(*axis)
                    at = sum(a * b for a, b in zip(off, axis)) / size
                    self.assertLessEqual(abs(at / depth), size / 2 + 1e-9)


def reason(**values):
    usual = {"lod": 2, "z": 41.0, "pixel": 0.012, "error": 0.011, "stretch": 1.0}
    usual |= {"error_px": 0.9, "factor": 1.0, "importance": 1.0, "demand": 1.0, "lenses": 1.0}
    usual |= {"screen_lenses": 1.0, "depth": 1.0, "motion": 1.0, "darkness": 1.0}
    usual |= {"coarser_object": Object(7, 1), "coarser_lod": 3, "coarser_kind": Kind.BOX}
    usual |= {"coarser_error": 0.2, "coarser_error_px": 19.0, "coarser_factor": 1.0, "pinned": 0}
    return SimpleNamespace(**(usual | values))


class _Cut:
    """As native.Cut, of one choice: an object 7 in group "House"."""

    view = SimpleNamespace(pixel_error=1.0, modifiers=None)

    def __init__(self, **values):
        self._reason = reason(**values)
        self.model = SimpleNamespace(
            object_summary=lambda item: SimpleNamespace(name="House"),
        )

    def choices(self):
        return [SimpleNamespace(object=Object(7, 1), lod=2, kind=Kind.MESH)]

    def choice_path(self, position):
        return "Town/House"

    def reason(self, position):
        return self._reason


def explain(drawn=Drawn.ITSELF, **values):
    return why_sentences.explain(_Cut(**values), drawn, 0)


class Why(unittest.TestCase):
    def test_the_line_has_every_number(self):
        found = explain()
        self.assertEqual(found.title, "LOD 2  Simplified")
        self.assertEqual(found.lines[0], "41 m · 11 mm = 0.9 px ≤ 1 px")
        self.assertEqual(found.lines[1], "LOD 3  Box would be 19 px")
        self.assertEqual(len(found.lines), 2)

    def test_factors_are_named_with_their_way(self):
        lines = explain(factor=1.5, importance=3.0, motion=2.0, error_px=0.5).lines
        self.assertIn("= 0.5 px × 1.5 = 0.75 px ≤ 1 px", lines[0])
        self.assertIn("Importance × 3 finer", lines)
        self.assertIn("Motion × 2 coarser", lines)

    def test_what_cannot_be_finer_says_so(self):
        self.assertIn("> 1 px: nothing finer can be drawn", explain(error_px=3.0).lines[0])

    def test_a_limit_is_named(self):
        self.assertIn("Use does not allow that one", explain(pinned=1).lines)

    def test_a_neighbor_that_opens_the_group_is_named(self):
        before = why_sentences.native.most_demanding
        self.addCleanup(setattr, why_sentences.native, "most_demanding", before)
        why_sentences.native.most_demanding = lambda model, group: "Kitchen/Door"
        values = {"coarser_object": Object(9, 1), "coarser_factor": math.inf, "lod": 0}
        lines = explain(**values).lines
        self.assertIn("Group House as LOD 3  Box would be 19 px", lines)
        self.assertTrue(any("opened for Door" in line for line in lines), lines)

    def test_what_is_within_a_group_names_it(self):
        self.assertEqual(explain(Drawn.IN_GROUP).title, "In group House: LOD 2  Simplified")

    def test_all_of_the_scene_was_a_group_called_as_the_object(self):
        class Root(_Cut):
            def choice_path(self, position):
                return ""

        found = why_sentences.explain(Root(), Drawn.IN_GROUP, 0)
        self.assertEqual(found.title, "In group House: LOD 2  Simplified")

    def test_nothing_coarser_and_nothing_drawn(self):
        self.assertIn("There is no coarser level", explain(coarser_object=Object()).lines)
        for drawn in (Drawn.MISSING, Drawn.NOT, Drawn.OPENED):
            self.assertEqual(len(explain(drawn).lines), 1)
