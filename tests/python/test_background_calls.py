# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards work on a thread of its own: it never goes on after the one who waits for it."""

import threading
import unittest

import addon_path  # noqa: F401
from lodestone.core.background_calls import Stopped, Work


class Waiting(unittest.TestCase):
    def setUp(self):
        self.work = Work()
        self.ended = threading.Event()

    def long_call(self):
        while not self.work.stopping:
            self.ended.wait(0.01)
        self.ended.set()
        raise RuntimeError("it was stopped")

    def test_the_result_is_returned_and_an_error_raised(self):
        self.assertEqual(self.work.run(lambda: 7, lambda: None), 7)
        with self.assertRaises(ZeroDivisionError):
            self.work.run(lambda: 1 // 0, lambda: None)

    def test_a_failure_while_waiting_leaves_no_work_behind(self):
        for error in (ValueError("no room for a picture"), KeyboardInterrupt()):
            self.work, self.ended = Work(), threading.Event()

            def poll(error=error):
                raise error

            with self.assertRaises(type(error)):
                self.work.run(self.long_call, poll)
            self.assertTrue(self.ended.is_set())
            self.assertFalse(any(t.name == "lodestone" for t in threading.enumerate()))

    def test_stopping_ends_it_as_stopped(self):
        with self.assertRaises(Stopped):
            self.work.run(self.long_call, self.work.stop)

    def test_work_that_ended_as_it_was_stopped_still_gave_its_result(self):
        def ends_at_once():
            while not self.work.stopping:
                self.ended.wait(0.01)
            return 7

        with self.assertRaises(Stopped):
            self.work.run(ends_at_once, self.work.stop)


if __name__ == "__main__":
    unittest.main()
