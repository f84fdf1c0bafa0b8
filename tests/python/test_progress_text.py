# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the numbers people read: units, rounding, and progress lines."""

import unittest

import addon_path  # noqa: F401
from lodestone.core import progress_text


class Texts(unittest.TestCase):
    def test_clock(self):
        for seconds, text in ((0, "0:00"), (59.9, "0:59"), (754, "12:34"), (3723, "1:02:03")):
            self.assertEqual(progress_text.clock(seconds), text)

    def test_count(self):
        for number, text in (
            (0, "0"),
            (812, "812"),
            (9999, "9,999"),
            (41300, "41.3 k"),
            (184020, "184 k"),
            (1.2e6, "1.2 M"),
            (22410332, "22.4 M"),
            (3.4e9, "3.4 G"),
        ):
            self.assertEqual(progress_text.count(number), text)

    def test_length(self):
        for metres, text in ((0, "0 mm"), (0.0004, "0.4 mm"), (0.011, "11 mm"), (1.25, "1.25 m")):
            self.assertEqual(progress_text.length(metres), text)

    def test_memory(self):
        for size, text in ((12, "12 B"), (310e6, "310 MB"), (5.2e9, "5.2 GB")):
            self.assertEqual(progress_text.memory(size), text)

    def test_triangles_that_are_drawn_and_placed(self):
        self.assertEqual(progress_text.triangles(48500, 2900000), "48.5 k of 2.9 M triangles")
        self.assertEqual(progress_text.triangles(812, 812), "812 triangles")

    def test_percent_of_nothing_is_nothing(self):
        self.assertEqual(progress_text.percent(1, 0), "0 %")
        self.assertEqual(progress_text.percent(1, 20), "5 %")


class StageClock(unittest.TestCase):
    def test_finished_stages_keep_their_time_and_the_running_one_its_share(self):
        clock = progress_text.StageClock(7)
        clock.tail = "22.4 M triangles"
        self.assertEqual(clock.line("Export", 10.0), "Frame 7 | Export | 22.4 M triangles")
        clock.line("Parse", 13.0)
        line = clock.line("Trace", 24.0, 0.64)
        self.assertEqual(line, "Frame 7 | Export 0:03 | Parse 0:11 | Trace 64 % | 22.4 M triangles")

    def test_between_two_stages_the_line_stays(self):
        clock = progress_text.StageClock(1)
        clock.line("Extract", 1.0)
        self.assertEqual(clock.line("", 2.0), "Frame 1 | Extract")
        self.assertEqual(clock.line("Levels", 3.0), "Frame 1 | Extract 0:02 | Levels")

    def test_the_time_left_stands_beside_the_share(self):
        line = progress_text.StageClock(1).line("Trace", 24.0, 0.64, 75.0)
        self.assertEqual(line, "Frame 1 | Trace 64 %, about 1:15 left")


if __name__ == "__main__":
    unittest.main()
