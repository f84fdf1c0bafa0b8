# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the bench's arithmetic: what is near a contact, what its lines say, how models stand."""

import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

try:
    import numpy
except ImportError:
    raise unittest.SkipTest("numpy is not installed") from None

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench.speed import bench_rays as bench  # noqa: E402
from bench.scenes import ray_scenes  # noqa: E402

# Along Y from the origin; its frame is 2 by 1 at distance 1, 40 x 20 pixels
CAMERA = SimpleNamespace(
    position=(0, 0, 0), direction=(0, 1, 0), right=(2, 0, 0), up=(0, 0, 1), near_clip=0.1
)


def near(contacts):
    scene = SimpleNamespace(contacts=contacts)
    made = SimpleNamespace(scene=scene, camera=CAMERA, size=[40, 20])
    return bench.Bench.near_contact(made)


class Contact(unittest.TestCase):
    def test_without_contacts_there_is_none(self):
        self.assertIsNone(near(None))

    def test_a_disk_of_three_pixels_around_where_it_is_seen(self):
        found = near(numpy.array([[0.025, 1.0, 0.025]]))
        self.assertEqual(found.sum(), 29)  # whole points within 3 of one
        rows, columns = numpy.nonzero(found)
        self.assertEqual((rows.min(), rows.max(), columns.min(), columns.max()), (6, 12, 17, 23))

    def test_twice_as_far_is_half_as_far_from_the_middle(self):
        found = near(numpy.array([[0.8, 2.0, 0.4]]))
        rows, columns = numpy.nonzero(found)
        middle = (rows.min() + rows.max()) / 2, (columns.min() + columns.max()) / 2
        self.assertEqual(middle, (6, 28))

    def test_what_is_behind_or_beside_the_picture_is_not_in_it(self):
        self.assertEqual(near(numpy.array([[0, -1.0, 0], [9.0, 1, 0], [0, 0.05, 0]])).sum(), 0)


class Told(unittest.TestCase):
    def line(self, kind, **values):
        spread = {"min": 1.0, "median": 2.0, "max": 4.0}
        one = {key: spread for key in ("parse_cpu_s", "trace_cpu_s", "triangles", "triangles_met")}
        one |= {"memory_bytes": {"min": 1e7, "median": 2e7, "max": 3e7}}
        one |= {"to_full": {"mean": 1.5, "ssim": 0.99}, "to_off": {"mean": 0.5, "max": 7.0}}
        return bench.table({"mirror": {kind: one | values}})[-1]

    def test_each_kind_has_what_it_is_compared_with(self):
        self.assertIn("| 20 | 2, 2 | 1.50, 0.9900 |  |", self.line("off"))
        self.assertIn("| 1.50, 0.9900 | 0.50, 7 | 4 |", self.line("on", contact=4.2))
        self.assertIn("| 1.00 / 2.00 / 4.00 | 1.00 / 2.00 / 4.00 |", self.line("on"))
        self.assertIn("| 2, 2 |  | 0.50, 7 |  |", self.line("full", contact=4.2))

    def test_one_run_has_no_spread(self):
        once = {"min": 0.25, "median": 0.25, "max": 0.25}
        self.assertIn("| 0.25 | 1.00 / 2.00", self.line("shadow", parse_cpu_s=once))


class Models(unittest.TestCase):
    def test_a_model_stands_on_the_floor_as_high_as_asked(self):
        points = numpy.array([[1.0, 5, 2], [3, 9, 2], [1, 5, 6]])
        for up in ("y", "z"):
            found = ray_scenes.stood(points, up, 2.0)
            self.assertEqual((found[:, 2].min(), found[:, 2].max()), (0.0, 2.0))
            self.assertEqual(tuple(found[:, :2].min(0) + found[:, :2].max(0)), (0.0, 0.0))

    def test_a_file_that_is_not_of_triangles_is_refused(self):
        head = (
            b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nelement face 1\nend_header\n"
        )
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "x.ply"
            path.write_bytes(head + bytes(12) + b"\3" + bytes(12))
            points, triangles = ray_scenes.read_ply(path)
            self.assertEqual((points.shape, triangles.tolist()), ((1, 3), [[0, 0, 0]]))
            path.write_bytes(head + bytes(12) + b"\4" + bytes(12))
            with self.assertRaisesRegex(ValueError, "not of triangles"):
                ray_scenes.read_ply(path)


if __name__ == "__main__":
    unittest.main()
