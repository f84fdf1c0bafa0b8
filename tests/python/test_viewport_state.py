# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what a viewport keeps between two redraws: pictures, what is in sight, its lines."""

import unittest
from dataclasses import replace
from types import SimpleNamespace

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.preview import viewport_state
from lodestone.core.preview.preview_tree import Change
from lodestone.core.preview.preview_worker import Picture, Things, Wanted
from lodestone_native import Camera

CAMERA = Camera("C", False, (0, -10, 0), (0, 1, 0), (1, 0, 0), (0, 0, 0.6), 0.1)
WANTED = Wanted(CAMERA, (640, 384), 0.0, things=Things())


class Views(unittest.TestCase):
    def picture(self, keys, final=True):
        return SimpleNamespace(keys=keys, final=final)

    def test_a_picture_is_shown_when_all_its_batches_are_there(self):
        view, there = viewport_state.View(), {1}
        view.next = self.picture((1, 2))
        self.assertEqual(view.advance(there.__contains__), [2])
        self.assertIsNone(view.shown)
        there.add(2)
        self.assertEqual(view.advance(there.__contains__), [])
        self.assertEqual(set(view.keys()), {1, 2})
        self.assertIsNone(view.next)

    def test_the_same_is_asked_for_once(self):
        view = viewport_state.View()
        self.assertTrue(view.wants(WANTED))
        self.assertFalse(view.wants(replace(WANTED, things=Things({(1, 1): Change()}))))
        self.assertTrue(view.wants(replace(WANTED, state=1)))
        view.again()
        self.assertTrue(view.wants(replace(WANTED, state=1)))

    def test_boxes_outside_of_the_view_are_told(self):
        # Looks along -z from the origin, 90 degrees, near .1, far 100
        near, far = 0.1, 100.0
        a, b = (far + near) / (near - far), 2 * far * near / (near - far)
        matrix = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, a, b), (0, 0, -1, 0))
        planes = viewport_state.planes_of(matrix)
        self.assertFalse(viewport_state.outside(planes, (-1, -1, -6, 1, 1, -5)))
        self.assertFalse(viewport_state.outside(planes, (-9, -9, -9, 9, 9, 9)))
        self.assertTrue(viewport_state.outside(planes, (-1, -1, 5, 1, 1, 6)))
        self.assertTrue(viewport_state.outside(planes, (7, -1, -6, 9, 1, -5)))
        self.assertTrue(viewport_state.outside(planes, (-1, -1, -300, 1, 1, -200)))

    def test_what_is_drawn_is_told_in_words(self):
        view = viewport_state.View()
        self.assertEqual(view.line(), "Lodestone: reading levels")
        things = Things({}, (), 2, 1)
        view.shown = Picture(
            1, WANTED, (), False, 1_200, 22_400_000, 12, 5000, 4.0, False, things, 0.0
        )
        for word in ("1,200 of 22.4 M", "12 drawn of 5,000", "Pixel Error 4", "budget", "refining",
                     "2 without levels", "1 without levels are too much"):  # fmt: skip
            self.assertIn(word, view.line())
        view.problem = "out of memory"
        self.assertEqual(view.line(), "Lodestone: out of memory")


if __name__ == "__main__":
    unittest.main()
