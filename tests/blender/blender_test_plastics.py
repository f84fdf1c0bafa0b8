# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards black and saturated plastics: what they reflect of a uniform sky is white.

Balls of four colors and three kinds of gloss, under a bright sky alone and under a dim one with a
sun; metals, coats, paint and glow of the same kind. Bounds are what was measured, as
povray_export/docs/results has it; blender_patches.py draws it.
"""

import unittest

from blender_patches import Sheet, check, draw, principled

PLASTICS = {
    "black": (0.0, 0.0, 0.0),
    "dark": (0.01, 0.01, 0.01),
    "red": (0.8, 0.0, 0.0),
    "blue": (0.0, 0.02, 0.4),
}
ROUGHNESS = (0.1, 0.4, 0.8)


# What was measured and a seventh more, in the order of patches().
UNDER_SKY = (7, 20, 8, 6, 18, 7, 12, 24, 15, 10, 18, 9, 10, 4, 16, 8, 9, 9)
UNDER_SUN = (6, 13, 6, 5, 11, 5, 7, 13, 7, 8, 10, 5, 7, 9, 11, 8, 21, 17)


def patches(bounds):
    def patch(name, **fields):
        made.append(principled(name, bounds[len(made)], **fields))

    made = []
    for name, color in PLASTICS.items():
        for roughness in ROUGHNESS:
            fields = {"specular": 0.5, "roughness": roughness}
            patch(f"{name} {roughness}", ball=True, color=color, **fields)
    black = {"ball": True, "color": PLASTICS["black"]}
    gloss = {"specular": 0.5, "roughness": 0.4}
    glow = {"emission": (0.0, 0.2, 0.0)}
    patch("coat", clearcoat=1.0, clearcoat_roughness=0.4, **black)
    patch("metal", metallic=1.0, roughness=0.4, **black)
    patch("glow", **black, **gloss, **glow)
    patch("vertex_color", **gloss)
    patch("halves", **gloss)
    patch("halves glow", **gloss, **glow)
    return made


SKY = Sheet("plastics_sky", patches(UNDER_SKY), columns=6, world=1.0, power=0.0)
SUN = Sheet("plastics_sun", patches(UNDER_SUN), columns=6, world=0.3, power=2.5)


class Plastics(unittest.TestCase):
    def test_under_a_bright_sky(self):
        check(self, SKY, *draw(SKY))

    def test_under_a_dim_sky_and_a_sun(self):
        check(self, SUN, *draw(SUN))


if __name__ == "__main__":
    unittest.main()
