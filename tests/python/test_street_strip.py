# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the picture strip of the sample street: it finds the add-on's letters, and puts panels,
captions and the legend where they belong."""

import sys
import unittest
from array import array
from pathlib import Path
from types import SimpleNamespace

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "samples" / "street"), str(ROOT / "blender_addon" / "lodestone")]

import strip  # noqa: E402

sys.path.remove(str(ROOT / "blender_addon" / "lodestone"))


class Image:
    def __init__(self, width: int, height: int, pixels: array) -> None:
        self.width, self.height, self.pixels = width, height, pixels

    def at(self, x: int, y: int) -> tuple[float, ...]:
        return tuple(self.pixels[4 * (y * self.width + x) :][:3])


def plain(width: int, height: int, value: float, alpha: float = 1.0) -> Image:
    return Image(width, height, array("f", (value, value, value, alpha)) * (width * height))


class Strip(unittest.TestCase):
    def test_four_panels_stand_in_two_columns_with_captions_and_a_legend(self):
        panels = [(plain(60, 40, 0.25 * i), "A" if i else "") for i in range(4)]
        made = strip.make_strip(
            SimpleNamespace(Image=Image), panels, [("BOX", (0.0, 1.0, 0.0))], plain(60, 40, 0), 2
        )
        self.assertEqual((made.width, made.height), (60 + 4 + 60, 2 * (40 + 12) + 4))
        self.assertEqual(made.at(30, 30), (0.0,) * 3)
        self.assertEqual(made.at(64 + 30, 30), (0.25,) * 3)
        self.assertEqual(made.at(64 + 30, 52 + 4 + 30), (0.75,) * 3)
        self.assertEqual(made.at(6, 52 + 4 + 5), (0.0, 1.0, 0.0))  # the legend, in the third one
        lit = [made.at(x, y) for y in range(40, 52) for x in range(made.width)]
        self.assertIn(round(0.9, 3), [round(one[0], 3) for one in lit])  # letters of a caption

    def test_rows_without_anything_covered_are_left_out(self):
        mask = plain(4, 40, 0, alpha=0.0)
        self.assertEqual(strip.covered_rows(mask, 10), range(40))
        mask.pixels[4 * 4 * 20 + 3] = 1.0
        self.assertEqual(strip.covered_rows(mask, 3), range(17, 24))

    def test_the_difference_is_of_display_values_enlarged_and_at_most_white(self):
        black, gray, white = plain(1, 1, 0.0), plain(1, 1, 0.5), plain(1, 1, 1.0)
        self.assertEqual(strip.difference(gray, gray, 8.0).at(0, 0), (0.0,) * 3)
        self.assertEqual(strip.difference(black, white, 8.0).at(0, 0), (1.0,) * 3)
        near = strip.difference(black, plain(1, 1, 0.001), 8.0).at(0, 0)[0]
        self.assertAlmostEqual(near, strip._decode(8 * 12.92 * 0.001), 6)


if __name__ == "__main__":
    unittest.main()
