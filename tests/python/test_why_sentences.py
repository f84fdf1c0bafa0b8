# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the sentences that explain why a thing is drawn as it is."""

import math
import unittest
from types import SimpleNamespace

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import why_sentences
from lodestone_native import Drawn, Kind, Object, structs


def reason(**values):
    usual = {"lod": 2, "z": 41.0, "pixel": 0.012, "error": 0.011, "stretch": 1.0}
    usual |= {"error_px": 0.9, "factor": 1.0, "importance": 1.0, "demand": 1.0, "lenses": 1.0}
    usual |= {"screen_lenses": 1.0, "depth": 1.0, "motion": 1.0, "darkness": 1.0}
    usual |= {"off_screen": 1.0}
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

    def test_each_factor_of_the_library_has_its_words(self):
        facts = {"struct_size", "lod", "pinned", "unused", "z", "pixel", "error", "stretch"}
        facts |= {"error_px", "factor", "demand"}  # `demand` has a sentence of its own
        fields = {name for name, *_ in structs.Reason._fields_ if not name.startswith("coarser_")}
        words = (*why_sentences._FINER, *why_sentences._COARSER)
        self.assertEqual(fields - facts, {name for name, _ in words})

    def test_a_thing_behind_the_camera_was_coarser_for_no_reason_that_was_named(self):
        lines = explain(factor=0.25, off_screen=4.0, error_px=3.0).lines
        self.assertIn("Not seen directly × 4 coarser", lines)

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


if __name__ == "__main__":
    unittest.main()
