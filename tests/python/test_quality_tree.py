# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the tree of controls: one number decides everything, everything can be overridden."""

import math
import unittest

import addon_path  # noqa: F401
from lodestone.core.picture import quality_tree
from lodestone.core.picture.quality_tree import CONTROLS, inherits, quality

PRESETS = (8.0, 2.0, 1.0, 0.0)


class Inherited(unittest.TestCase):
    def test_final_and_exact_are_shaded_alike(self):
        for error in (0.0, 0.5, 1.0):
            found = quality(error)
            self.assertEqual(found.antialias, "FINAL")
            self.assertEqual((found.area_samples, found.indirect), (17, 24))
            self.assertEqual(found.trace_depth, 5)

    def test_pixels_get_fewer_samples_from_a_pixel_on(self):
        found = [quality(error).antialias_depth for error in (0.0, 0.5, 0.99, 1.0, 2.0)]
        self.assertEqual(found, [3, 3, 3, 2, 2])
        found = [quality(error).antialias_threshold for error in (0.0, 0.99, 1.0, 4.0)]
        self.assertEqual(found, [0.1, 0.1, 0.3, 0.6])

    def test_errors_are_the_one_number(self):
        for error in PRESETS:
            found = quality(error)
            self.assertEqual((found.shadows, found.reflections), (error,) * 2)

    def test_lamps_may_be_off_by_some_steps_from_a_pixel_on(self):
        found = [quality(error).lights for error in (0.0, 0.5, 1.0, 4.0, 16.0, 64.0)]
        self.assertEqual(found, [0.0, 0.5, 4.0, 8.0, 16.0, 64.0])

    def test_textures_stay_as_they_are_below_a_pixel(self):
        found = [quality(error).textures for error in (0.0, 0.5, 0.99, 1.0, 1.5, 8.0)]
        self.assertEqual(found, [0.0, 0.0, 0.0, 1.0, 1.5, 8.0])

    def test_the_sky_is_occluded_but_in_draft_by_as_many_rays(self):
        found = [quality(error).sky_occlusion for error in (0.0, 1.0, 2.0, 4.0, 7.9, 8.0)]
        self.assertEqual(found, [128] * 5 + [0])
        self.assertEqual(quality(1.0, {"shadows": 9.0}).sky_occlusion, 0)
        self.assertEqual(quality(8.0).povray()["sky_rays"], -1)
        self.assertEqual(quality(8.0, {"sky_occlusion": 16}).povray()["sky_rays"], 16)

    def test_preview_and_draft(self):
        preview, draft = quality(2.0), quality(8.0)
        self.assertEqual((preview.antialias, preview.antialias_threshold), ("FINAL", 0.424264))
        self.assertEqual((preview.area_samples, preview.trace_depth, preview.indirect), (9, 4, 20))
        self.assertEqual((draft.antialias, draft.area_samples), ("OFF", 1))
        self.assertEqual((draft.trace_depth, draft.indirect), (2, 12))

    def test_a_larger_error_is_never_shaded_finer(self):
        errors = [0.0, 0.3, 1.0, 1.1, 2.0, 3.0, 4.0, 5.5, 7.9, 8.0, 64.0, 1024.0]
        for finer, coarser in zip(map(quality, errors), map(quality, errors[1:])):
            for key in ("area_samples", "indirect", "trace_depth", "antialias_depth"):
                self.assertGreaterEqual(getattr(finer, key), getattr(coarser, key), key)
            self.assertLessEqual(finer.antialias_threshold, coarser.antialias_threshold)
            self.assertLessEqual(finer.lights, coarser.lights)
            self.assertGreaterEqual(finer.bounce_rays, coarser.bounce_rays)
            self.assertLessEqual(finer.bounce_error, coarser.bounce_error)

    def test_light_goes_from_surface_to_surface_only_where_asked_for(self):
        for error in PRESETS:
            self.assertEqual(quality(error).bounces, 0)
            self.assertEqual(quality(error, {"bounces": 3}).povray()["bounces"], 3)

    def test_a_rough_model_gathers_light_roughly(self):
        found = [(one.bounce_rays, one.bounce_error) for one in map(quality, PRESETS)]
        self.assertEqual(found, [(60, 1.0), (100, 0.848528), (200, 0.6), (200, 0.6)])
        exact = quality(8.0, {"antialias": "REFERENCE"})
        self.assertEqual((exact.bounce_rays, exact.bounce_error), (800, 0.4))


class Overridden(unittest.TestCase):
    def test_a_control_of_its_own_changes_itself_and_what_is_below_it_only(self):
        found, plain = quality(1.0, {"reflections": 8.0}), quality(1.0)
        self.assertEqual((found.reflections, found.trace_depth), (8.0, 2))
        self.assertEqual(found._replace(reflections=1.0, trace_depth=5), plain)

    def test_antialiasing_hands_on_to_area_samples_and_indirect(self):
        off, reference = quality(1.0, {"antialias": "OFF"}), quality(
            8.0, {"antialias": "REFERENCE"}
        )
        self.assertEqual((off.area_samples, off.indirect), (1, 12))
        self.assertEqual((reference.area_samples, reference.indirect), (17, 64))

    def test_final_antialiasing_is_final_at_any_pixel_error(self):
        for error in (4.0, 8.0, 100.0):
            found = quality(error, {"antialias": "FINAL"})
            self.assertEqual((found.antialias_threshold, found.antialias_depth), (0.1, 3))
            self.assertEqual(found.area_samples, 17)

    def test_a_child_of_its_own_stays_while_its_parent_changes(self):
        found = quality(8.0, {"area_samples": 9, "antialias": "OFF"})
        self.assertEqual(found.area_samples, 9)

    def test_what_a_control_would_have_does_not_see_its_own_override(self):
        own = {"shadows": 3.0, "antialias": "OFF", "area_samples": 5}
        self.assertEqual(inherits("shadows", 2.0, own), 2.0)
        self.assertEqual(inherits("area_samples", 2.0, own), 1)
        self.assertEqual(inherits("antialias", 2.0, own), "FINAL")

    def test_every_override_reaches_what_povray_gets(self):
        plain = quality(1.0).povray()
        own = {"textures": 4.0, "shadows": 4.0, "reflections": 4.0, "trace_depth": 9, "lights": 8.0}
        own |= {"area_samples": 3, "indirect": 0, "bounces": 2, "sky_occlusion": 16}
        changed = set()
        for key, value in own.items():
            found = quality(1.0, {key: value}).povray()
            changed |= {name for name in found if found[name] != plain[name]}
        gathering = {"bounce_rays", "bounce_error"}
        self.assertEqual(
            set(plain) - changed, {"antialias_threshold", "antialias_depth"} | gathering
        )
        self.assertEqual(quality(1.0, {"indirect": 0}).povray()["sky_lights"], -1)


class Hostile(unittest.TestCase):
    def test_nonsense_gives_the_nearest_limit_or_what_is_inherited(self):
        self.assertEqual(quality(-5.0).pixel_error, 0.0)
        self.assertEqual(quality(math.inf).pixel_error, quality_tree.MOST_PIXELS)
        self.assertEqual(quality(math.nan), quality(0.0))
        plain = quality(2.0)
        for control in CONTROLS:
            for nonsense in (math.nan, "PURPLE"):
                self.assertEqual(quality(2.0, {control.key: nonsense}), plain, control.key)
            for value in (-1e300, 1e300, math.inf, -math.inf):
                found = getattr(quality(2.0, {control.key: value}), control.key)
                if control.least is not None:
                    self.assertTrue(control.least <= found <= control.most, (control.key, value))
        self.assertEqual(quality(2.0, {"no such control": 1.0}), plain)

    def test_povray_gets_numbers_that_mean_something_at_any_error(self):
        for error in (0.0, 1e-9, 1.0, 1024.0):
            for name, value in quality(error).povray().items():
                self.assertTrue(math.isfinite(value), name)
            self.assertGreater(quality(error).povray()["shadow_error"], 0.0)


class Tree(unittest.TestCase):
    def test_parents_come_before_their_children(self):
        known = {quality_tree.ROOT}
        for control in CONTROLS:
            self.assertIn(control.parent, known)
            known.add(control.key)

    def test_every_control_has_words_without_a_full_stop(self):
        for control in CONTROLS:
            self.assertTrue(control.label and control.description)
            self.assertFalse(control.description.endswith("."))


if __name__ == "__main__":
    unittest.main()
