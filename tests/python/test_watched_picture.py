# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards how often a picture is shown while it is drawn, and how long it is said to take."""

import tracemalloc
import unittest

import addon_path  # noqa: F401
from lodestone.core.native import lodestone_native as native
from lodestone.core.picture.watched_picture import WatchedPicture, watched


class _Drawing:
    """Takes the place of a live picture: what is new, and how much is finished."""

    def __init__(self):
        self.finished = 0.0
        self.waiting = []

    def take(self, bottom_up):
        assert bottom_up
        while self.waiting:
            yield self.waiting.pop(0)


class Watching(unittest.TestCase):
    def setUp(self):
        self.now = 100.0
        self.picture = WatchedPicture((0, 0, 64, 36), clock=lambda: self.now)
        self.live = self.picture.live
        self.drawing = self.picture.live = _Drawing()

    def look(self, after):
        self.now += after
        return list(self.picture.news())

    def test_nothing_is_drawn_before_povray_draws(self):
        self.picture.live = self.live
        self.assertEqual(list(self.picture.news()), [])
        self.assertEqual(list(self.picture.rest()), [])
        self.assertEqual(self.picture.finished, 0.0)
        self.assertIsNone(self.picture.seconds_left())
        with self.assertRaises(native.LodestoneError):
            WatchedPicture((0, 0, 0, 36))

    def test_the_first_pixels_are_shown_at_once_and_the_next_ones_in_a_moment(self):
        self.assertEqual(self.look(0.05), [])
        self.drawing.waiting = ["mosaic"]
        self.assertEqual(self.look(0.05), ["mosaic"])
        self.drawing.waiting = ["finer"]
        self.assertEqual(self.look(0.05), [])
        self.assertEqual(self.look(0.25), ["finer"])
        self.drawing.waiting = ["a", "b"]
        self.assertEqual(list(self.picture.rest()), ["a", "b"])  # at once

    def test_where_showing_is_slow_it_is_shown_less_often(self):
        def slow():
            self.drawing.waiting = ["part"]
            for part in self.picture.news():
                self.now += 1.0

        slow()
        self.drawing.waiting = ["part"]
        self.assertEqual(self.look(9.0), [])
        self.assertEqual(self.look(1.1), ["part"])

    def test_pixels_that_come_faster_than_they_are_shown_do_not_keep_the_window_busy(self):
        self.drawing.waiting = list(range(1000))
        shown = 0
        for _ in self.picture.news():
            self.now += 0.01
            shown += 1
            self.drawing.waiting.append(0)
        self.assertLess(shown, 60)
        self.assertEqual(len(list(self.picture.rest())), 1000)

    def test_a_picture_of_a_poster_is_not_copied_to_be_watched(self):
        self.assertIsNone(watched((0, 0, 65000, 1000)))
        self.assertIsNone(watched((0, 0, 65536, 65536)))
        self.assertIsNone(watched((0, 0, 70000, 1)))  # larger than the library takes
        self.assertEqual(watched((0, 0, 64, 36)).live.part, (0, 0, 64, 36))

    def test_asking_again_takes_no_memory_again(self):
        self.assertEqual(list(self.live.take()), [])
        tracemalloc.start()
        self.addCleanup(tracemalloc.stop)
        for _ in range(3):
            self.assertEqual(list(self.live.take()), [])
        self.assertLess(tracemalloc.get_traced_memory()[1], 100_000)

    def test_the_time_left_is_that_of_the_pixels_before(self):
        def left(share, after):
            self.now += after
            self.drawing.finished = share
            return self.picture.seconds_left()

        self.assertIsNone(left(0.0, 50.0))  # gathering light takes none of the pixels' time
        self.assertIsNone(left(0.01, 1.0))
        self.assertIsNone(left(0.02, 10.0))  # too few
        self.assertIsNone(WatchedPicture((0, 0, 64, 36)).seconds_left())
        self.assertAlmostEqual(left(0.11, 10.0), 20.0 * 0.89 / 0.1)
        self.assertAlmostEqual(left(0.51, 20.0), 40.0 * 0.49 / 0.5)
        self.assertEqual(left(1.0, 1.0), 0.0)


if __name__ == "__main__":
    unittest.main()
