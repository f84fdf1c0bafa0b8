# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that everything is in the picture of an overview."""

import math
import unittest

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.picture import overview_camera
from lodestone_native import Camera

CAMERA = Camera("C", False, (0, 0, 2), (0, 1, 0), (1, 0, 0), (0, 0, 0.5), 0.1, aperture=0.2)


class Overview(unittest.TestCase):
    def test_everything_and_the_camera_are_in_the_picture(self):
        for camera in (CAMERA, Camera("D", True, (50, 3, 9), (0, 0, -1), (1, 0, 0), (0, 1, 0), 1)):
            found = overview_camera.overview(camera, (3.0, 4.0, 5.0), 2.0, (200, 100))
            self.assertEqual((found.aperture, found.orthographic), (0.0, False))
            self.assertAlmostEqual(math.hypot(*found.direction), 1.0)
            inside = [camera.position, (5, 4, 5), (1, 4, 5), (3, 4, 7), (3, 6, 5), (3, 2, 3.1)]
            for point in inside:
                off = [p - e for p, e in zip(point, found.position)]
                depth = sum(a * b for a, b in zip(off, found.direction))
                for axis in (found.right, found.up):
                    size = math.hypot(*axis)
                    at = sum(a * b for a, b in zip(off, axis)) / size
                    self.assertLessEqual(abs(at / depth), size / 2 + 1e-9)


if __name__ == "__main__":
    unittest.main()
