# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards surfaces: patches of every kind of material look as Cycles (direct light only) shows them.

Both engines draw the same grid of squares and balls under one sun and a gray world. What is left
per patch (root mean square of the display-encoded picture, in 255ths, without its border) is
bounded by what was measured; povray_export/docs/results has it, blender_patches.py draws it.
"""

import unittest

from blender_patches import Sheet, check, draw, principled

PATCHES = [
    principled("albedo", 3, color=(0.6, 0.3, 0.1)),
    principled("dark", 3, color=(0.02, 0.05, 0.2)),
    principled("textured", 3),
    principled("vertex_color", 3),
    principled("emission", 3, color=(0.0, 0.0, 0.0), emission=(0.2, 0.5, 0.1)),
    principled("alpha", 3, color=(0.7, 0.2, 0.2), alpha=0.4, alpha_mode=1),
    principled("clip", 3, alpha_mode=2),
    principled("matte_ball", 6, ball=True),
    principled("plastic", 6, ball=True, color=(0.1, 0.3, 0.6), specular=0.5),
    principled("gloss", 6, ball=True, color=(0.6, 0.1, 0.1), specular=0.5, roughness=0.1),
    principled("metal", 10, ball=True, color=(0.9, 0.6, 0.3), metallic=1.0, roughness=0.15),
    principled("rough_metal", 12, ball=True, color=(0.9, 0.6, 0.3), metallic=1.0),
    principled("half_metal", 7, ball=True, color=(0.6, 0.6, 0.7), metallic=0.5, roughness=0.6),
    principled("rough", 6, ball=True, color=(0.5, 0.5, 0.5), specular=0.5, roughness=1.0),
    principled("coat", 6, ball=True, color=(0.3, 0.05, 0.05), clearcoat=1.0),
    principled(
        "glass",
        14,
        ball=True,
        behind=True,
        color=(0.9, 1.0, 0.9),
        specular=0.5,
        roughness=0.0,
        transmission=1.0,
    ),
    principled("bump", 9, color=(0.5, 0.5, 0.5)),
    principled("normal", 7, color=(0.5, 0.5, 0.5)),
    principled("mixed", 3, color=(0.8, 0.1, 0.1)),
]
SHEET = Sheet("patches", PATCHES, columns=5, world=0.25, power=2.5)


class Patches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cycles, cls.ours = draw(SHEET)

    def test_every_patch_is_as_near_to_cycles_as_was_measured(self):
        check(self, SHEET, self.cycles, self.ours)

    def test_the_pictures_show_something(self):
        for rows in (self.cycles, self.ours):
            values = [max(texel) for row in rows for texel in row]
            self.assertGreater(max(values), 200)
            self.assertLess(min(values), 60)


if __name__ == "__main__":
    unittest.main()
