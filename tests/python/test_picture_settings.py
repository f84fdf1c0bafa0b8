# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what a picture's file is stamped with of what bends quality: all that shows, and the same
in every session."""

import unittest
from dataclasses import fields, replace

import addon_path  # noqa: F401
from lodestone.core.native import lodestone_native as native
from lodestone.core.picture.picture_maker import bent_by

EYE = native.Camera("eye", False, (0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1), 0.1)
PLACE = (1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)


class BentBy(unittest.TestCase):
    def test_nothing_is_the_same_as_no_modifiers(self):
        self.assertEqual(bent_by(None), ())
        self.assertEqual(bent_by(native.Modifiers()), ())

    def test_each_of_them_shows(self):
        plain = native.Modifiers()
        lens = native.Lens("a", PLACE)
        changes = [
            {"off_screen": native.OffScreen.SHADOWS},
            {"off_screen": native.OffScreen.REFLECTED},
            {"when_dark": True},
            {"when_moving": True},
            {"depth": 2.0},
            {"depth_focus": 3.0},
            {"ray_classes": native.Rays.SHADOW},
            {"criterion": native.Criterion.AREA},
            {"lenses": (lens,)},
            {"lenses": (replace(lens, strength=2.0),)},
            {"screen_lenses": (native.ScreenLens("b", (1.0, 2.0), 3.0),)},
        ]
        said = [bent_by(replace(plain, **change)) for change in changes] + [()]
        self.assertEqual(len(set(said)), len(said))
        tried = {name for change in changes for name in change}
        self.assertEqual(tried, {one.name for one in fields(plain)} - {"closing"})

    def test_ids_of_a_session_and_places_of_a_frame_do_not(self):
        def bent(generation: int, closing: object) -> tuple[str, ...]:
            objects = (native.Object(3, generation),)
            lens = native.Lens("a", PLACE, filter=native.LensFilter.SHOW, objects=objects)
            return bent_by(native.Modifiers(lenses=(lens,), closing=closing))

        self.assertEqual(bent(7, None), bent(8, None))
        self.assertEqual(bent(7, None), bent(7, EYE))
        self.assertEqual(bent_by(native.Modifiers(closing=EYE)), ())


if __name__ == "__main__":
    unittest.main()
