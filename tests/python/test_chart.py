# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the charts of samples/curves.py: what stands where; names cannot break the SVG."""

import sys
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "samples"))

from chart import PANEL, TOP, Chart, svg  # noqa: E402


def lines_of(text):
    root = xml.fromstring(text)
    found = root.iter("{http://www.w3.org/2000/svg}polyline")
    return [
        [tuple(map(float, point.split(","))) for point in line.get("points").split()]
        for line in found
    ]


class Charts(unittest.TestCase):
    def test_without_charts_it_is_still_a_picture(self):
        self.assertEqual(lines_of(svg([], [], "")), [])

    def test_one_value_stands_at_the_left(self):
        ((point,),) = lines_of(svg([Chart("", 0, 1, (), {"a": [1]})], ["1"], "px"))
        self.assertEqual(point[1], TOP)

    def test_values_stand_at_their_share_of_the_height(self):
        chart = Chart("", 10, 20, (10, 20), {"a": [10, 15, 20], "b": [5, 15, 99]})
        first, second = lines_of(svg([chart], ["1", "2", "4"], "px"))
        middle = TOP + PANEL[1] / 2
        self.assertEqual([y for _, y in first], [TOP + PANEL[1], middle, TOP])
        self.assertEqual(second, first)  # what is beyond an end is drawn at it
        self.assertEqual(first[2][0] - first[0][0], PANEL[0])

    def test_names_are_no_markup(self):
        name = '<script>&"'
        text = svg([Chart(name, 0, 1, (), {name: [0, 1]})], [name, ""], name)
        shown = [part.text for part in xml.fromstring(text).iter() if part.text]
        self.assertGreaterEqual(shown.count(name), 4)


if __name__ == "__main__":
    unittest.main()
